#include "scene/run/impact_results.hpp"

#include <algorithm>

#include "core/base/text.hpp"

namespace langer {

ImpactResults::ImpactResults(const Scene& scene, const Inertia* inertia) {
  moves_ = inertia && !(scene.contacts.empty() && scene.surfaces.empty());
  if (!moves_) return;
  for (const SurfaceContact& surface : scene.surfaces) surfaces_.push_back(surface.name);
  const std::vector<MovingBody>& bodies = inertia->options().bodies;
  if (!surfaces_.empty() && bodies.size() == 2) {
    for (const MovingBody& body : bodies) pair_.emplace_back(body.name, inertia->mass_of(body));
  }
  free_ = scene.motion->travel_mass > 0;
  State start;
  start.speed = scene.motion->travel_velocity;
  states_.push_back(start);
}

void ImpactResults::add(const StepRecord& step) {
  if (!moves_) return;
  State state;
  state.time = step.scalars.at("time");
  if (surfaces_.empty()) state.force = step.force_ind.norm();
  for (const std::string& name : surfaces_) state.force += step.scalars.at("force_" + name);
  state.speed = value_or(step.scalars, "indenter_velocity", 0);
  for (int k = 0; k < 3; ++k) {
    state.momentum[k] = step.scalars.at(std::string("momentum_") + "xyz"[k]);
    double sign = 1;
    for (const auto& [name, mass] : pair_) {
      state.separation[k] += sign * step.scalars.at("momentum_" + name + "_" + "xyz"[k]) / mass;
      sign = -1;
    }
  }
  states_.push_back(state);
}

std::vector<Summary> ImpactResults::summary() const {
  if (!moves_) return {};
  std::size_t first = 0;  // first and last state in contact
  std::size_t last = 0;
  double peak = 0;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if (!(states_[i].force > 0)) continue;
    if (first == 0) first = i;
    last = i;
    peak = std::max(peak, states_[i].force);
  }
  if (first == 0) return {};
  std::vector<Summary> out{{"peak_force", peak, "N"}};
  if (last + 1 >= states_.size()) return out;
  // The time at which the line through two forces reaches 0, within [low, high].
  const auto zero_of = [](const State& near, const State& next, double low, double high) {
    const double slope = (next.force - near.force) / (next.time - near.time);
    if (slope == 0) return 0.5 * (low + high);
    return std::clamp(near.time - near.force / slope, low, high);
  };
  double begin = states_[first].time;
  double end = states_[last].time;
  if (last > first) {
    begin =
        zero_of(states_[first], states_[first + 1], states_[first - 1].time, states_[first].time);
    end = zero_of(states_[last], states_[last - 1], states_[last].time, states_[last + 1].time);
  }
  out.push_back({"contact_time", end - begin, "s"});
  if (!surfaces_.empty() && pair_.empty()) return out;  // the momentum of all is that of the start
  out.push_back({"restitution", restitution(first, last), "-"});
  return out;
}

double ImpactResults::restitution(std::size_t first, std::size_t last) const {
  const State& before = states_[first - 1];
  const State& after = states_[last + 1];
  if (free_) return -after.speed / before.speed;
  // The state at rest is not recorded: its momentum is that of the first step without contact.
  const State& arrival = first == 1 ? states_[first] : before;
  const bool two_bodies = !pair_.empty();
  const Vec3 p = two_bodies ? arrival.separation : arrival.momentum;
  const Vec3 p_after = two_bodies ? after.separation : after.momentum;
  const Vec3 impulse = p_after - p;
  const double arriving = p.dot(impulse);
  if (arriving == 0) return 0;
  return -p_after.dot(impulse) / arriving;
}

}  // namespace langer
