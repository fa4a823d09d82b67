#include "mechanics/solve/increment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/stopwatch.hpp"
#include "mechanics/solve/balance.hpp"
#include "mechanics/solve/edge_slip.hpp"

namespace langer {

Increment::Increment(Assembler& equilibrium, std::vector<RigidContact> contacts,
                     const IncrementOptions& options, std::vector<SurfaceContact> surfaces)
    : state_(equilibrium, std::move(contacts), options, std::move(surfaces)),
      body_(state_.body),
      now_(state_.now),
      before_(state_.before),
      trial_(state_.trial),
      border_(state_),
      factors_(state_, border_),
      step_(state_, border_, factors_),
      signs_(state_, border_, factors_),
      motion_(state_) {}

Increment::Cost Increment::cost() const {
  Cost cost = state_.cost;
  cost.factorizations = factors_.factorizations();
  return cost;
}

Problem Increment::problem() {
  Problem p;
  p.size = state_.scale.length;
  p.least_force = state_.scale.least_force;
  p.assess = [this](const VecX& u, bool with_tangent) {
    return assess(u, with_tangent);
  };
  p.correction = [this] {
    return step_.correction();
  };
  const bool conserves = state_.options.inertia && state_.options.inertia->conserves();
  if (body_.formulation() != Formulation::displacement && !factors_.factor.iterative() &&
      !conserves) {
    p.correction_again = [this] {
      return step_.correction_again();
    };
    // bonds that let go solve several times within an increment, and only the first time with what
    // the state before left
    p.cost_ratio = factors_.cost_ratio();
    p.begins_again = factors_.serves && state_.bonds.none();
  }
  p.admissible = [this](const VecX& u) {
    return state_.admissible(u);
  };
  p.moved = [this](const VecX& du, double step) {
    step_.moved(du, step);
  };
  return p;
}

std::optional<std::string> Increment::edge_passed() const {
  for (std::size_t k = 0; k < state_.contacts.size(); ++k) {
    const Vec3 begin = indenter_displacement(state_.contacts[k], now_.t, now_.travel);
    const Vec3 end = indenter_displacement(state_.contacts[k], trial_.t, trial_.travel);
    if (node_past_edge(
            {state_.contacts[k], body_.mesh().X, now_.u, trial_.u, begin, end, trial_.r[k]}))
      return state_.contacts[k].name;
  }
  return std::nullopt;
}

const std::vector<std::vector<MortarNode>>& Increment::surface_averages() const {
  return state_.surfaces.at(body_.mesh().X, trial_.u);
}

std::vector<double> Increment::surface_penetrations() const {
  return state_.surfaces.penetrations(body_.mesh().X, trial_.u);
}

VecX Increment::reactions() const {
  if (state_.options.inertia) return now_.motion.reactions;
  return trial_reactions(state_);
}

// Continues from a recorded state. The state before it serves the extrapolation.
void Increment::restore(const BodyState& accepted, const BodyState* before) {
  now_ = accepted;
  if (before) {
    before_ = *before;
  } else {
    before_ = accepted;
  }
  // The tangent of the accepted state has the mass of the increment that led to it.
  if (before && state_.options.inertia && now_.t > before->t) {
    const double seconds = (now_.t - before->t) * state_.options.seconds;
    state_.options.inertia->begin(before->u, before->travel, before->motion, seconds);
  }
  factors_.forget();
  step_.begin();
  trial_.t = now_.t;
  trial_.u = now_.u;
  trial_.r = state_.next.r = now_.r;
  trial_.travel = now_.travel;
  body_.load_to(trial_.t);
  state_.u_start.assign(state_.contacts.size(), now_.u);
  border_.take_pressures_of(now_);
  if (!state_.bonds.none()) begin_bonds();
}

double Increment::end_at_touch(double t) {
  constexpr double least = 0.05;  // of the increment: a shorter rest is not cut off
  if (!state_.may_touch()) return t;
  begin(t);
  const double share = state_.share_before_touch();
  if (share < least || share > 1 - least) return t;
  return now_.t + share * (t - now_.t);
}

void Increment::begin(double t) {
  border_.leave_arc();
  trial_.t = t;
  trial_.extrapolated = 0;
  unsettled_ = false;
  factors_.begin_increment();
  step_.begin();
  trial_.u = now_.u;
  trial_.r = state_.next.r = now_.r;
  trial_.travel = now_.travel;
  state_.u_start.assign(state_.contacts.size(), now_.u);
  if (!state_.bonds.none()) begin_bonds();
  body_.begin_increment((t - now_.t) * state_.options.seconds);
  if (state_.options.inertia) {
    motion_.begin((t - now_.t) * state_.options.seconds);
    return;
  }
  body_.load_to(t);
  border_.take_pressures_of(now_);
  body_.pressures_from(now_.u);
  const bool pushed =
      state_.controlled_index >= 0 &&
      state_.controlled()->control->force.at(t) != state_.controlled()->control->force.at(now_.t);
  // If nothing moves in this increment, the last movement does not continue.
  const bool rests = state_.motion(now_.t) == 0 && !body_.loads().moves(now_.t, t) && !pushed;
  if (const double last = now_.t - before_.t; last > 0 && !rests && continues_motion())
    extrapolate(std::min((t - now_.t) / last, 2.0));
  if (state_.controlled_index >= 0) state_.move_to_touch();
  state_.slip_from_touch();
  state_.turn_surfaces();
  if (state_.starts_with_travel()) trial_.expected = trial_.u;
  const int level = factors_.level_of_increment(now_, t, now_.travel - before_.travel);
  if (level != factors_.factor.level()) factors_.take_level(level);
}

// Whether the last increment predicts this one: no prescribed movement, rotation or load has a
// kink between them.
bool Increment::continues_motion() const {
  for (const Prescribed& p : body_.dofs().prescribed)
    if (!p.in_proportion() && !p.keeps_rate(before_.t, now_.t, trial_.t)) return false;
  for (const RigidContact& contact : state_.contacts)
    if (contact.rotation && !contact.rotation->angle.keeps_rate(before_.t, now_.t, trial_.t))
      return false;
  return body_.loads().keeps_rate(before_.t, now_.t, trial_.t);
}

// Starts the increment from u_n + s (u_n - u_{n-1}), unless an element would be inverted there.
void Increment::extrapolate(double s) {
  const VecX step = s * (now_.u - before_.u);
  if (!state_.options.extrapolate || !state_.admissible(now_.u + step)) return;
  body_.extrapolate_pressures(before_.u, s);
  trial_.u += step;
  if (trial_.pressures.size() > 0 && before_.pressures.size() == trial_.pressures.size()) {
    trial_.pressures += s * (now_.pressures - before_.pressures);
    body_.set_load_pressures(trial_.pressures);
  }
  trial_.extrapolated = s;
  trial_.travel += s * (now_.travel - before_.travel);
}

double Increment::time_error() { return body_.end_increment(trial_.u); }

void Increment::replay(const BodyState& next) {
  body_.begin_increment((next.t - now_.t) * state_.options.seconds);
  body_.end_increment(next.u);
  body_.accept_increment(now_.u, next.u);
  // Bonds come with the state: nothing of them is computed again.
  before_ = std::move(now_);
  now_ = next;
  trial_.t = now_.t;
  trial_.u = now_.u;
  trial_.r = now_.r;
  trial_.travel = now_.travel;
  border_.take_pressures_of(now_);
}

void Increment::accept() {
  if (state_.options.inertia) {
    motion_.accept();
    return;
  }
  body_.accept_increment(now_.u, trial_.u);
  before_ = std::move(now_);
  now_ = {trial_.t, trial_.u, trial_.r, trial_.travel};
  now_.pressures = trial_.pressures;
  if (!state_.bonds.none()) accept_bonds();
}

// Residual (and tangent) at u, and the first condition of equilibrium that does not hold.
Assessment Increment::assess(const VecX& u, bool with_tangent) {
  const Stopwatch watch(state_.cost.assembly);
  Assessment out;
  const VecX du = state_.remaining_prescribed(u);
  const VecX direction = border_.imposed_direction(u);
  if (std::exchange(unsettled_, false)) body_.pressures_from(u);
  out.admissible = body_.assemble(u, with_tangent, &direction);
  factors_.K_is_current = with_tangent;
  if (!out.admissible) {
    if (body_.J_min() > 0) {
      out.missing =
          "a force is not finite: the exponential of a fibre overflows where c2 (I4_bar - 1)^2 > 300, or the start "
          "of the step is too far away";
    } else {
      out.missing = "an element is turned inside out";
    }
    return out;
  }
  if (!state_.bonds.none())
    state_.bonds.evaluate(body_.mesh().X, u, state_.indenters(trial_.t, trial_.travel));
  out.residual = free_residual(state_).norm();
  out.reference = force_scale(state_);
  out.floor = 3 * body_.rounding_floor();
  if (body_.conserves()) {
    // An increment has the rounding of both of its ends; of a body that turns, displacements are as
    // large as the body, and what rounds is not only the volume, but also 4 M (u_m - u0) / h^2.
    const VecX rounded = std::numeric_limits<double>::epsilon() * u.cwiseAbs();
    out.floor = 2 * (out.floor + state_.scale.least_force) +
                state_.on_free_rows(state_.options.inertia->tangent_times(rounded)).norm();
  }
  if (!contact_law_holds(state_, u))
    out.missing = "the contact law does not hold";
  else if (state_.controlled_index >= 0 && !force_is_given(state_))
    out.missing = "the force on the indenter is not the given one";
  else if (!state_.prescribed_reached(u, du))
    out.missing = "prescribed displacements not reached";
  else if (border_.active())
    out.missing = border_.defect(u);
  if (out.missing.empty() && factors_.factor.held_by_contact() && slips_away(state_))
    out.missing = "the body slips away from under the indenter, and nothing else holds it";
  out.others = out.missing.empty();
  return out;
}

// The balance of the free dofs with fixed contact reactions, for solvers that know no contact
// (KINSOL).
FreeBalance Increment::free_balance() {
  FreeBalance b;
  b.free = body_.dofs().free;
  b.residual = [this](const VecX& u, VecX& f) {
    const Stopwatch watch(state_.cost.assembly);
    if (!body_.assemble(u, false)) return false;
    f = -free_residual(state_);
    return true;
  };
  b.tangent = [this](const VecX& u) {
    if (!body_.assemble(u, true)) return false;
    const Stopwatch watch(state_.cost.factor);
    factors_.serves = factors_.of_accepted = false;
    factors_.factored_at = u;
    return factors_.factor.factorize_fixed_reactions(body_);
  };
  b.solve = [this](const VecX& rhs, bool fresh) {
    const Stopwatch watch(state_.cost.solve);
    const VecX step = factors_.factor.linear().solve(rhs);
    unsettled_ = body_.formulation() == Formulation::linear_dilatation;
    if (!fresh) return step;
    VecX du = VecX::Zero(trial_.u.size());
    for (Eigen::Index i = 0; i < step.size(); ++i) du[body_.dofs().free[i]] = step[i];
    body_.predict_pressures(du, 1);
    return step;
  };
  return b;
}

void Increment::begin_arc(double length, const VecX* towards) {
  begin(now_.t);
  const Dofs& dofs = body_.dofs();
  const double nodes = (dofs.n_free() + static_cast<double>(dofs.prescribed.size())) / 3;
  Arc arc;
  arc.size = length * std::sqrt(nodes);
  arc.nodes = nodes;
  if (towards) arc.towards = *towards;
  follow(arc);
}

void Increment::begin_along(const VecX& mode, double amplitude) {
  begin(now_.t);
  follow(Arc{amplitude, 0, mode, amplitude * mode});
}

void Increment::begin_from(const VecX& u) {
  const VecX step = u - now_.u;
  trial_.u = now_.u;
  body_.assemble(trial_.u, true);
  body_.pressures_from(trial_.u);
  factors_.K_is_current = false;
  if (!state_.admissible(u)) return;
  body_.predict_pressures(step, 1);
  trial_.u = u;
}

void Increment::restart() {
  if (!border_.arc()) {
    begin(trial_.t);
    return;
  }
  const Arc arc = *border_.arc();
  begin(now_.t);
  follow(arc);
}

// In an increment that has begun. How far the indenter goes is not known before, so any candidate
// may close.
void Increment::follow(const Arc& arc) {
  border_.begin(arc);
  if (state_.contacts.empty() && state_.surfaces.empty()) return;
  trial_.expected = trial_.u;
  for (std::size_t k = 0; k < state_.contacts.size(); ++k)
    if (state_.contacts[k].mu > 0) state_.slip_from_touch(k, trial_.expected);
  state_.turn_surfaces();
  factors_.take_level(factors_.factor.levels().all());
}

void Increment::begin_bonds() {
  state_.bonds.begin(now_.bonds, (trial_.t - now_.t) * state_.options.seconds, body_.mesh().X,
                     now_.u, state_.indenters(now_.t, now_.travel));
  state_.bonds.evaluate(body_.mesh().X, trial_.u, state_.indenters(trial_.t, trial_.travel));
  jump_ = {};
}

// Called with what the last increment left in before_.
void Increment::accept_bonds() {
  const bool jumped = jump_.work_of_jumps != 0 || jump_.released != 0;
  now_.bonds =
      state_.bonds.after(trial_.r, before_.r, trial_.u, state_.indenters(trial_.t, trial_.travel));
  now_.in_bonds = before_.in_bonds;
  if (jumped) {
    now_.in_bonds.dissipated += state_.bonds.dissipated_since(before_.bonds);
  } else {
    now_.in_bonds.dissipated += state_.bonds.dissipated();
  }
  now_.in_bonds.released += jump_.released;
  now_.in_bonds.work_of_jumps += jump_.work_of_jumps;
  now_.in_bonds.stored = stored();
}

void Increment::restore_trial(const Trial& trial) {
  trial_.u = trial.u;
  trial_.r = state_.next.r = trial.r;
  factors_.K_is_current = factors_.serves = false;
  step_.begin();
  body_.pressures_from(trial_.u);
  state_.bonds.evaluate(body_.mesh().X, trial_.u, state_.indenters(trial_.t, trial_.travel));
}

double Increment::stored() const { return body_.W() + state_.bonds.stored(); }

double Increment::work_of_loads(const VecX& from) const {
  if (body_.loads().empty()) return 0;
  return body_.f_ext().dot(trial_.u - from);
}

}  // namespace langer
