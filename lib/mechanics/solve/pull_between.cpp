#include "mechanics/solve/pull_between.hpp"

#include <algorithm>
#include <limits>

#include "mechanics/solve/increment.hpp"

namespace langer {

namespace {

// On the body, reactions and bonds, of the k-th contact at an accepted state [N].
Vec3 force_at(const IncrementState& state, std::size_t k, const BodyState& at) {
  const RigidContact& contact = state.contacts[k];
  const Vec3 c = indenter_displacement(contact, at.t, at.travel);
  Vec3 sum = Vec3::Zero();
  for (const Vec3& r : at.r[k]) sum += r;
  for (std::size_t i = 0; i < at.bonds[k].size(); ++i) {
    const Bond& bond = at.bonds[k][i];
    if (!bond.made) continue;
    const int node = contact.nodes[i];
    const Vec3 v = at.u.segment<3>(3 * node) - c;
    const ShapePoint shape = shape_at(contact.shape, state.body.mesh().X[node] + v);
    const double as_it_is = std::numeric_limits<double>::infinity();
    sum += contact.area[i] * adhesive(*contact.adhesion, shape, v, bond, as_it_is).force;
  }
  return sum;
}

struct Pull {
  double t, value;
};

// of the next increment too, which is as long as the last one
double left_out(const Pull& before, const Pull& now, const Pull& next) {
  const double first = now.t - before.t;
  const double second = next.t - now.t;
  const double greatest = std::max(now.value, next.value);
  if (first <= 0 || second <= 0 || greatest <= 0) return 0;
  const double left = (now.value - before.value) / first;
  const double right = (next.value - now.value) / second;
  const double curvature = 2 * (right - left) / (first + second);
  if (!(curvature < 0)) return 0;
  const double slope_now = (left * second + right * first) / (first + second);
  const double top = now.t - slope_now / curvature;
  if (top < now.t - first || top > next.t + second) return 0;
  return -curvature * second * second / (8 * greatest);
}

}  // namespace

double pull_between(const Increment& increment) {
  const IncrementState& state = increment.state();
  const BodyState& now = state.now;
  const BodyState& before = state.before;
  double most = 0;
  for (std::size_t k = 0; k < state.contacts.size(); ++k) {
    const RigidContact& contact = state.contacts[k];
    if (!contact.adhesion || contact.control) continue;
    const Vec3 way =
        indenter_displacement(contact, state.trial.t) - indenter_displacement(contact, now.t);
    if (way.isZero(0)) continue;
    const Vec3 along = way.normalized();
    // The body holds the indenter back: its force on the indenter is against the way, and on the
    // body along it.
    Vec3 trial = state.bonds.sum(k);
    for (const Vec3& r : state.trial.r[k]) trial += r;
    most = std::max(most, left_out({before.t, along.dot(force_at(state, k, before))},
                                   {now.t, along.dot(force_at(state, k, now))},
                                   {state.trial.t, along.dot(trial)}));
  }
  return most;
}

}  // namespace langer
