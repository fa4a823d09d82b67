// An increment of Statics from its start to its acceptance: the trial state is predicted from the
// last increment, and becomes the accepted state once it is in equilibrium.
//   predict   u = u_n + s (u_n - u_{n-1}), s the ratio of the two increments of t, if the loading
//             goes on without a kink; an indenter under force control is moved to its first touch
//   accept    u_{n+1} = u, with the reactions of contact and the state of viscous points and bonds
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mechanics/solve/statics.hpp"

namespace langer {

// Continues from a recorded state. The state before it serves the extrapolation.
void Statics::restore(const BodyState& accepted, const BodyState* before) {
  now_ = accepted;
  if (before) {
    before_ = *before;
  } else {
    before_ = accepted;
  }
  K_current_ = factor_serves_ = again_ = of_accepted_ = false;
  t_ = now_.t;
  u_ = now_.u;
  r_ = r_next_ = now_.r;
  travel_ = now_.travel;
  equilibrium_.load_to(t_);
  u_start_.assign(contacts_.size(), now_.u);
  take_border_of(now_);
  if (!bonds_.none()) begin_bonds();
}

void Statics::begin(double t) {
  arc_.reset();
  t_ = t;
  K_current_ = again_ = unsettled_ = false;
  extrapolated_ = 0;
  factor_serves_ = std::exchange(of_accepted_, false);
  factor_.begin_increment();
  u_ = now_.u;
  r_ = r_next_ = now_.r;
  travel_ = now_.travel;
  u_start_.assign(contacts_.size(), now_.u);
  if (!bonds_.none()) begin_bonds();
  equilibrium_.begin_increment((t - now_.t) * options_.seconds);
  if (options_.inertia) {
    begin_motion((t - now_.t) * options_.seconds);
    return;
  }
  equilibrium_.load_to(t);
  take_border_of(now_);
  equilibrium_.pressures_from(now_.u);
  const bool pushed = controlled_ >= 0 &&
                      controlled()->control->force.at(t) != controlled()->control->force.at(now_.t);
  // If nothing moves in this increment, the last movement does not continue.
  const bool rests = motion(now_.t) == 0 && !equilibrium_.loads().moves(now_.t, t) && !pushed;
  if (const double last = now_.t - before_.t; last > 0 && !rests && continues_motion())
    extrapolate(std::min((t - now_.t) / last, 2.0));
  if (controlled_ >= 0) move_to_touch();
  slip_from_touch();
  if (!bodies_.empty())
    bodies_.turn(equilibrium_.mesh().X, now_.u, u_ - now_.u, r_, contacts_.size());
  if (starts_with_travel()) expected_ = u_;
  const int level = level_of_increment(now_, t, now_.travel - before_.travel);
  if (level == factor_.level()) return;
  factor_.take_level(equilibrium_, level);
  factor_serves_ = false;
}

// Whether the last increment predicts this one: no prescribed movement, rotation or load has a
// kink between them.
bool Statics::continues_motion() const {
  for (const Prescribed& p : equilibrium_.dofs().prescribed)
    if (!p.in_proportion() && !p.keeps_rate(before_.t, now_.t, t_)) return false;
  for (const RigidContact& contact : contacts_)
    if (contact.rotation && !contact.rotation->angle.keeps_rate(before_.t, now_.t, t_))
      return false;
  return equilibrium_.loads().keeps_rate(before_.t, now_.t, t_);
}

// Starts the increment from u_n + s (u_n - u_{n-1}), unless an element would be inverted there.
void Statics::extrapolate(double s) {
  const VecX step = s * (now_.u - before_.u);
  if (!options_.extrapolate || !admissible(now_.u + step)) return;
  equilibrium_.extrapolate_pressures(before_.u, s);
  u_ += step;
  if (p_.size() > 0 && before_.pressures.size() == p_.size()) {
    p_ += s * (now_.pressures - before_.pressures);
    equilibrium_.set_load_pressures(p_);
  }
  extrapolated_ = s;
  travel_ += s * (now_.travel - before_.travel);
}

// An indenter under force control that touches nothing finds no equilibrium: no travel balances
// the force. Moves it to its first touch.
void Statics::move_to_touch() {
  const auto k = static_cast<std::size_t>(controlled_);
  if (std::any_of(r_[k].begin(), r_[k].end(), [](const Vec3& r) { return !r.isZero(0); })) return;
  const auto position = [&](int node) {
    return Vec3(equilibrium_.mesh().X[node] + u_.segment<3>(3 * node));
  };
  if (const auto touch = travel_to_touch(contacts_[k], t_, travel_, position)) travel_ = *touch;
}

void Statics::slip_from_touch() {
  for (std::size_t k = 0; k < contacts_.size(); ++k)
    if (contacts_[k].mu > 0) slip_from_touch(k, u_);
}

// Sets where the slip of each candidate of contact k starts within this increment.
void Statics::slip_from_touch(std::size_t k, const VecX& expected) {
  const IncrementMove move = increment_move(expected);
  for (int node : contacts_[k].nodes)
    u_start_[k].segment<3>(3 * node) =
        slip_origin(contacts_[k], move.of(contacts_[k], node), slip_tolerance());
}

// The gap up to which a node slips from the beginning of an increment on, and not from its touch. A
// body in motion has a velocity there: the law is that of the mean velocity in the increment
// (Moreau, Jean), for nodes that touch within it, too. Measured from the touch, or where that was
// not foreseen from the expected end, a node that goes on sliding would stick.
double Statics::slip_tolerance() const {
  if (options_.inertia) return std::numeric_limits<double>::infinity();
  return gap_tolerance_;
}

IncrementMove Statics::increment_move(const VecX& expected) const {
  return {equilibrium_.mesh().X, now_.u, expected, now_.t, now_.travel, t_, travel_};
}

// The slip of a node is measured from where the path of the indenter touches it. Under force
// control that path is an unknown, and the start of the slip follows it: an indenter that is pushed
// and one that is moved along the same path have the same slip.
bool Statics::starts_with_travel() const { return controlled_ >= 0 && controlled()->mu > 0; }

std::vector<Vec3> Statics::start_moves() const {
  if (!starts_with_travel()) return {};
  return slip_origin_change_with_travel(*controlled(), increment_move(expected_), slip_tolerance());
}

double Statics::time_error() { return equilibrium_.end_increment(u_); }

void Statics::replay(const BodyState& next) {
  equilibrium_.begin_increment((next.t - now_.t) * options_.seconds);
  equilibrium_.end_increment(next.u);
  equilibrium_.accept_increment(now_.u, next.u);
  // Bonds come with the state: nothing of them is computed again.
  before_ = std::move(now_);
  now_ = next;
  t_ = now_.t;
  u_ = now_.u;
  r_ = now_.r;
  travel_ = now_.travel;
  take_border_of(now_);
}

void Statics::accept() {
  if (options_.inertia) {
    accept_motion();
    return;
  }
  equilibrium_.accept_increment(now_.u, u_);
  before_ = std::move(now_);
  now_ = {t_, u_, r_, travel_};
  now_.pressures = p_;
  if (!bonds_.none()) accept_bonds();
}

// The largest movement that is imposed from t0 to the trial: it scales the error allowed in slip.
double Statics::motion(double t0) const {
  double largest = 0;
  double travel = before_.travel;
  if (t0 == now_.t) travel = now_.travel;
  for (const RigidContact& contact : contacts_) {
    const Vec3 start = indenter_displacement(contact, t0, travel);
    const Vec3 end = indenter_displacement(contact, t_, travel_);
    largest = std::max({largest, (end - start).norm(), turning(contact, t0, start)});
  }
  for (const Prescribed& p : equilibrium_.dofs().prescribed) {
    double moved = p.at(t_) - p.at(t0);
    if (p.in_proportion()) moved = p.value * (t_ - t0);
    largest = std::max(largest, std::abs(moved));
  }
  return largest;
}

double Statics::turning(const RigidContact& contact, double t0, const Vec3& c0) const {
  if (!contact.rotation) return 0;
  const double angle = contact.rotation->angle.at(t_) - contact.rotation->angle.at(t0);
  const std::vector<Vec3>& r = r_[static_cast<std::size_t>(&contact - contacts_.data())];
  double largest = 0;
  for (std::size_t i = 0; i < r.size(); ++i) {
    const int node = contact.nodes[i];
    if (r[i].isZero(0)) continue;
    const Vec3 x = equilibrium_.mesh().X[node] + u_.segment<3>(3 * node);
    largest = std::max(largest, carried(contact, angle, x, c0).norm());
  }
  return largest;
}

}  // namespace langer
