#include "scene/run/impact_results.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/fields.hpp"
#include "core/base/text.hpp"
#include "scene/model/scene_motion.hpp"

namespace langer {

namespace {

double smallest_gap(const StepRecord& step) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const auto& [name, contact] : step.contacts) {
    for (double gap : contact.gap) smallest = std::min(smallest, gap);
  }
  return smallest;
}

// Where the line through two points (x, y) reaches 0, within [low, high].
double zero_of_line(std::pair<double, double> a, std::pair<double, double> b, double low,
                    double high) {
  const double slope = (b.second - a.second) / (b.first - a.first);
  if (slope == 0) return 0.5 * (low + high);
  return std::clamp(a.first - a.second / slope, low, high);
}

// The part of a name after `prefix`; empty: it begins otherwise.
std::string after(const std::string& name, const std::string& prefix) {
  if (name.starts_with(prefix)) return name.substr(prefix.size());
  return "";
}

// Derivatives of the force's size, F . dF/|F|, and of the speed of an indenter with mass, by
// number.
void add_derivatives_of(const StepRecord& step, std::map<std::string, double>& force,
                        std::map<std::string, double>& speed) {
  const double size = step.force_ind.norm();
  for (const auto& [name, value] : step.scalars) {
    if (!name.starts_with("d_")) continue;
    for (int k = 0; k < 3 && size > 0; ++k) {
      const std::string component = std::string("d_force_") + "xyz"[k] + "_N_d_";
      const std::string number = after(name, component);
      if (!number.empty()) force[number] += value * step.force_ind[k] / size;
    }
    const std::string number = after(name, std::string("d_") + indenter_velocity + "_d_");
    if (!number.empty()) speed[number] = value;
  }
}

}  // namespace

ImpactResults::ImpactResults(const Scene& scene, const Inertia* inertia) {
  moves_ = scene.motion && !(scene.contacts.empty() && scene.surfaces.empty());
  if (!moves_) return;
  for (const SurfaceContact& surface : scene.surfaces) surfaces_.push_back(surface.name);
  if (inertia && !surfaces_.empty() && inertia->options().bodies.size() == 2) {
    for (const MovingBody& body : inertia->options().bodies) {
      pair_.emplace_back(body.name, inertia->mass_of(body));
    }
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
  state.gap = smallest_gap(step);
  state.speed = value_or(step.scalars, indenter_velocity, 0);
  for (int k = 0; k < 3; ++k) {
    state.momentum[k] = step.scalars.at(std::string("momentum_") + "xyz"[k]);
    double sign = 1;
    for (const auto& [name, mass] : pair_) {
      state.separation[k] += sign * step.scalars.at("momentum_" + name + "_" + "xyz"[k]) / mass;
      sign = -1;
    }
  }
  add_derivatives_of(step, state.d_force, state.d_speed);
  states_.push_back(state);
}

std::vector<Summary> ImpactResults::summary() const {
  if (!moves_) return {};
  std::size_t first = 0;  // first and last state in contact
  std::size_t last = 0;
  std::size_t peak = 0;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if (!(states_[i].force > 0)) continue;
    if (first == 0) first = i;
    last = i;
    if (states_[i].force > states_[peak].force) peak = i;
  }
  if (first == 0) return {};
  std::vector<Summary> out{{"peak_force", states_[peak].force, unit::N}};
  add_derivatives(peak, first, last, out);
  if (last + 1 >= states_.size()) return out;
  out.push_back({"contact_time", parting_time(last) - touch_time(first), "s"});
  if (!surfaces_.empty() && pair_.empty()) return out;  // the momentum of all is that of the start
  out.push_back({"restitution", restitution(first, last), "-"});
  return out;
}

// Between the last state before the contact and the first one in it.
double ImpactResults::touch_time(std::size_t first) const {
  const State& touching = states_[first];
  const State& before = states_[first - 1];
  // The state at rest is not recorded, and has no gap here.
  // Surfaces that face nothing have no finite gap.
  if (first >= 3 && std::isfinite(states_[first - 2].gap) && std::isfinite(before.gap)) {
    const State& earlier = states_[first - 2];
    return zero_of_line({before.time, before.gap}, {earlier.time, earlier.gap}, before.time,
                        touching.time);
  }
  if (first == 2 && free_) {
    const double rest = before.gap / before.speed;
    return std::clamp(before.time + rest, before.time, touching.time);
  }
  const State& next = states_[std::min(first + 1, states_.size() - 1)];
  return zero_of_line({touching.time, touching.force}, {next.time, next.force}, before.time,
                      touching.time);
}

// Between the last state in contact and the first one after it.
double ImpactResults::parting_time(std::size_t last) const {
  const State& touching = states_[last];
  const State& after = states_[last + 1];
  if (last + 2 < states_.size() && std::isfinite(after.gap) &&
      std::isfinite(states_[last + 2].gap)) {
    const State& later = states_[last + 2];
    return zero_of_line({after.time, after.gap}, {later.time, later.gap}, touching.time,
                        after.time);
  }
  const State& earlier = states_[last - 1];
  return zero_of_line({touching.time, touching.force}, {earlier.time, earlier.force}, touching.time,
                      after.time);
}

void ImpactResults::add_derivatives(std::size_t peak, std::size_t first, std::size_t last,
                                    std::vector<Summary>& out) const {
  for (const auto& [number, derivative] : states_[peak].d_force) {
    out.push_back({"d_peak_force_d_" + number, derivative, "-"});
  }
  if (!free_ || last + 1 >= states_.size()) return;
  // Before the first touch nothing depends on the numbers.
  for (const auto& [number, derivative] : states_[last + 1].d_speed) {
    out.push_back({"d_restitution_d_" + number, -derivative / states_[first - 1].speed, "-"});
  }
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
