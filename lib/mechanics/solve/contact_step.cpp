#include "mechanics/solve/contact_step.hpp"

#include <cmath>
#include <utility>

#include "core/base/stopwatch.hpp"
#include "mechanics/linear/krylov.hpp"
#include "mechanics/solve/balance.hpp"

namespace langer {

std::optional<VecX> ContactStep::correction() {
  factors_.update_tangent();
  again_ = false;
  VecX rhs = free_residual(state_);
  if (!border_.arc()) rhs -= state_.on_free_rows(body_.K_du());
  if (border_.active()) border_.update();
  if (factors_.bodies_in_tangent() && !border_.arc() && !border_.active()) {
    if (std::optional<VecX> du = solve_with_bodies(rhs)) {
      factors_.of_accepted = false;
      factors_.serves = body_.formulation() != Formulation::displacement;
      if (factors_.serves) body_.keep_dilatations();
      return du;
    }
    factors_.condense_bodies();
  }
  std::optional<VecX> du;
  if (factors_.contact_in_tangent())
    du = solve_with_contact(rhs);
  else if (!factors_.factorize_or_stop())
    return std::nullopt;
  // Supporting springs change the tangent too much to reuse its factor. The displacement
  // formulation has no mixed equations in which an old tangent could stand for the new one.
  // Without contact an indefinite tangent is factorized as it is, between the limit points of an
  // arc.
  const bool as_it_is = factors_.factor.kind() == TangentFactor::Kind::whole ||
                        (border_.active() && state_.contacts.empty() &&
                         factors_.factor.kind() == TangentFactor::Kind::indefinite);
  factors_.serves =
      !factors_.factor.iterative() && as_it_is && body_.formulation() != Formulation::displacement;
  if (factors_.serves) body_.keep_dilatations();
  if (factors_.contact_in_tangent()) return du;
  return solve_condensed(rhs);
}

// A correction with the factor of an earlier state of this increment, in the mixed equations of u
// and p. Nothing if there is no such factor, or if prescribed dofs still have to move.
std::optional<VecX> ContactStep::correction_again() {
  if (!factors_.serves ||
      !state_.prescribed_reached(trial_.u, state_.remaining_prescribed(trial_.u)))
    return std::nullopt;
  again_ = true;
  const VecX rhs = free_residual(state_) + state_.on_free_rows(body_.dilatation_residual());
  if (factors_.bodies_in_tangent()) return solve_with_bodies(rhs);
  if (factors_.contact_in_tangent()) return solve_with_contact(rhs);
  return solve_condensed(rhs);
}

VecX ContactStep::with_prescribed_dofs(const VecX& free) const {
  VecX du = state_.remaining_prescribed(trial_.u);
  if (border_.arc()) du += next_.t * border_.rates();
  for (Eigen::Index row = 0; row < free.size(); ++row) du[body_.dofs().free[row]] = free[row];
  return du;
}

// Contact in the tangent itself: iteratively with the mixed equations if they are used, otherwise
// by a factorization with contact rows (again_: the last one).
std::optional<VecX> ContactStep::solve_with_contact(const VecX& rhs) {
  const double factor_before = state_.cost.factor;
  std::optional<ContactInTangent::Answer> answer;
  dp_.resize(0);
  if (MixedTangent* mixed = factors_.factor.mixed()) {
    const Stopwatch watch(state_.cost.solve);
    mixed->linearise(body_, state_.remaining_prescribed(trial_.u));
    const std::vector<Vec3> c = state_.indenters(trial_.t, trial_.travel);
    const std::vector<Vec3> c_start = state_.indenters(now_.t, now_.travel);
    answer = factors_.factor.in_tangent()->solve(state_.contact_state(c, c_start), body_, rhs,
                                                 *mixed, dp_);
    if (!answer && body_.division()) return std::nullopt;  // shorter increments are left
    if (!answer) {
      factors_.factor.take_factor(body_);
      dp_.resize(0);
    }
  }
  if (!answer) {
    const Stopwatch watch(state_.cost.contact);
    const std::vector<Vec3> c = state_.indenters(trial_.t, trial_.travel);
    const std::vector<Vec3> c_start = state_.indenters(now_.t, now_.travel);
    const ContactState state = state_.contact_state(c, c_start);
    const auto factorize = [this](const std::vector<double>& values) {
      const Stopwatch factoring(state_.cost.factor);
      factors_.factored_at = trial_.u;
      return factors_.factor.factorize_with_contact(values);
    };
    ContactInTangent& contact = *factors_.factor.in_tangent();
    if (again_) {
      answer = contact.solve_again(state, rhs, factors_.factor.linear());
    } else {
      answer = contact.solve(state, body_.K(), rhs, factors_.factor.linear(), factorize);
      if (answer && factors_.gives_up(answer->settled)) return std::nullopt;
    }
  }
  state_.cost.contact -= state_.cost.factor - factor_before;
  if (!answer) return std::nullopt;
  next_.r = std::move(answer->r);
  state_.cost.sweeps += answer->solutions;
  return with_prescribed_dofs(answer->move);
}

// The same of deformable surfaces.
std::optional<VecX> ContactStep::solve_with_bodies(const VecX& rhs) {
  BodiesInTangent& contact = *factors_.bodies_in_tangent();
  const double factored_before = contact.seconds_of_factors();
  std::optional<BodiesInTangent::Answer> answer;
  {
    const Stopwatch watch(state_.cost.contact);
    const std::vector<Vec3> none;
    const ContactState state = state_.contact_state(none, none);
    if (again_)
      answer = contact.solve_again(state, state_.surfaces, now_.u, rhs);
    else
      answer = contact.solve(state, state_.surfaces, now_.u, state_.remaining_prescribed(trial_.u),
                             body_.K(), rhs);
  }
  const double factored = contact.seconds_of_factors() - factored_before;
  state_.cost.factor += factored;
  state_.cost.contact -= factored;
  if (!answer) return std::nullopt;
  next_.r = std::move(answer->r);
  state_.cost.sweeps += answer->solutions;
  return with_prescribed_dofs(answer->move);
}

// Follower pressures with a free edge and the forces of an energy-momentum scheme have a skew part
// of the stiffness, which the symmetric tangent omits.
bool ContactStep::omits_stiffness() const { return body_.loads().follow() || body_.conserves(); }

// That part times du, on the side of the internal forces: (3 n) [N].
VecX ContactStep::omitted_stiffness(const VecX& du) const {
  VecX out = VecX::Zero(du.size());
  if (body_.loads().follow()) out -= body_.skew_pressures(trial_.u, du);
  if (body_.conserves()) out += body_.conserving_skew(du);
  return out;
}

// The factor of K is a good preconditioner of K + S with the skew part S: (I + K^-1 S) du = K^-1
// rhs converges in a few iterations. An old factor leaves more of the residual than the skew part
// does, so there the first of them is enough.
VecX ContactStep::solve_nonsymmetric(const VecX& rhs) {
  LinearSolver& linear = factors_.factor.linear();
  if (!omits_stiffness()) return linear.solve(rhs);
  const VecX known =
      rhs - state_.on_free_rows(omitted_stiffness(state_.remaining_prescribed(trial_.u)));
  // A scheme that keeps the energy is solved to rounding, and has a new tangent each time.
  if (body_.conserves()) return solve_near_factor(known, 1e-7);
  if (again_) return linear.solve(known);
  return solve_near_factor(known, 1e-3);  // what the step is too long for leaves more
}

// The same where no prescribed dof moves.
VecX ContactStep::solve_near_factor(const VecX& known, double accurate) {
  LinearSolver& linear = factors_.factor.linear();
  if (!omits_stiffness()) return linear.solve(known);
  const auto product = [&](const VecX& x) {
    VecX du = VecX::Zero(trial_.u.size());
    for (Eigen::Index row = 0; row < x.size(); ++row) du[body_.dofs().free[row]] = x[row];
    return VecX(x + linear.solve(state_.on_free_rows(omitted_stiffness(du))));
  };
  return solve_near_identity(product, linear.solve(known), accurate, 40);
}

// Contact condensed to the candidates: forward half of the solve, contact law on the Schur
// complement, backward half.
std::optional<ContactChange> ContactStep::change_of_contact(const VecX& rhs,
                                                            LinearSolver::Half& half) {
  LinearSolver& linear = factors_.factor.linear();
  {
    const Stopwatch watch(state_.cost.solve);
    half = linear.start(rhs);
  }
  const auto move_of_node = [&](int node) {
    Vec3 d = Vec3::Zero();
    for (int j = 0; j < 3; ++j) {
      if (const int row = factors_.factor.last_of(3 * node + j); row >= 0) d[j] = half.last[row];
    }
    return d;
  };
  const Stopwatch watch(state_.cost.contact);
  const std::vector<Vec3> c = state_.indenters(trial_.t, trial_.travel);
  const std::vector<Vec3> c_start = state_.indenters(now_.t, now_.travel);
  if (!state_.surfaces.empty()) {
    ContactState state = state_.contact_state(c, c_start);
    state.bonds = &state_.bonds;
    return linearised_bodies(state, state_.surfaces, now_.u, state_.remaining_prescribed(trial_.u),
                             factors_.factor, half.last);
  }
  if (border_.arc()) {  // its travel is an unknown of the border
    const ContactState state = state_.contact_state(c, c_start);
    return linearised_contact(state, factors_.factor, move_of_node);
  }
  ContactState state = state_.contact_state(c, c_start);
  state.controlled = state_.controlled_index;
  if (state_.controlled_index >= 0) state.force = state_.required_force();
  state.start_moves = state_.start_moves();
  state.bonds = &state_.bonds;
  state.force_falls = state_.force_falls();
  return linearised_contact(state, factors_.factor, move_of_node);
}

// The movement of the free rows, with the change of contact that belongs to it.
std::optional<VecX> ContactStep::move_with_contact(const VecX& rhs) {
  LinearSolver& linear = factors_.factor.linear();
  LinearSolver::Half half;
  std::optional<ContactChange> change = change_of_contact(rhs, half);
  while (change && change->level) {  // more candidates may close than the factor keeps apart
    factors_.take_level(*change->level);
    factors_.of_accepted = false;
    if (again_ || !factors_.factorize_or_stop()) return std::nullopt;
    factors_.serves = factors_.factor.kind() == TangentFactor::Kind::whole &&
                      body_.formulation() != Formulation::displacement;
    change = change_of_contact(rhs, half);
  }
  if (!change) return std::nullopt;
  next_.r = std::move(change->r);
  next_.travel = change->travel;
  state_.cost.sweeps += change->sweeps;
  const Stopwatch watch(state_.cost.solve);
  if (factors_.factor.kind() == TangentFactor::Kind::whole)
    return linear.finish(half, change->force);
  // Supporting springs cancel against contact forces: less rounding if before the elimination.
  VecX all = rhs;
  for (std::size_t i = 0; i < factors_.factor.last().size(); ++i)
    all[factors_.factor.last()[i]] += change->force[static_cast<Eigen::Index>(i)];
  return linear.solve(all);
}

std::optional<VecX> ContactStep::solve_condensed(const VecX& rhs) {
  if (state_.contacts.empty() && state_.surfaces.empty()) {
    const Stopwatch watch(state_.cost.solve);
    VecX move = solve_nonsymmetric(rhs);
    if (border_.active()) border_.solve(move, linear_answers());
    return with_prescribed_dofs(move);
  }
  if (border_.arc()) return border_.solve_with_contact(rhs, linear_answers());
  const std::optional<VecX> move = move_with_contact(rhs);
  if (!move) return std::nullopt;
  return with_prescribed_dofs(*move);
}

LinearAnswers ContactStep::linear_answers() {
  LinearAnswers answers;
  answers.movement = [this](const VecX& forces) {
    return solve_near_factor(forces);
  };
  answers.movement_with_contact = [this](const VecX& forces) {
    return move_with_contact(forces);
  };
  answers.all_dofs = [this](const VecX& free) {
    return with_prescribed_dofs(free);
  };
  return answers;
}

// Called before u becomes u + step du: pressures, travel and contact reactions follow. Reactions
// turn with the normal of a curved indenter, which keeps them inside Coulomb's cone.
void ContactStep::moved(const VecX& du, double step) {
  const Stopwatch watch(state_.cost.assembly);
  if (dp_.size() > 0)
    body_.move_pressures(dp_, step);
  else
    body_.predict_pressures(du, step, again_);
  const std::vector<Vec3>& X = body_.mesh().X;
  // the law was linearised at the end of an arc, and else where the indenter is
  const double dt = border_.arc() ? next_.t : 0;
  const double d_travel = border_.arc() ? next_.travel : 0;
  for (std::size_t k = 0; k < state_.contacts.size(); ++k) {
    const Vec3 c =
        indenter_displacement(state_.contacts[k], trial_.t + dt, trial_.travel + d_travel);
    const Vec3 end = indenter_displacement(state_.contacts[k], trial_.t + step * dt,
                                           trial_.travel + step * next_.travel);
    const Vec3 dc = end - c;
    for (std::size_t i = 0; i < trial_.r[k].size(); ++i) {
      if (next_.r[k][i].isZero(0) && trial_.r[k][i].isZero(0)) continue;
      const int node = state_.contacts[k].nodes[i];
      const Vec3 x = X[node] + trial_.u.segment<3>(3 * node) - c;
      const Vec3 moved_x = x + step * du.segment<3>(3 * node) - dc;
      Vec3 r = next_.r[k][i];
      if (step != 1) r = trial_.r[k][i] + step * (next_.r[k][i] - trial_.r[k][i]);
      trial_.r[k][i] = turn_with_normal(r, shape_at(state_.contacts[k].shape, x).normal,
                                        shape_at(state_.contacts[k].shape, moved_x).normal);
    }
  }
  if (border_.active()) border_.move(step);
  if (!state_.surfaces.empty()) {
    for (std::size_t k = state_.contacts.size(); k < trial_.r.size(); ++k)
      for (std::size_t i = 0; i < trial_.r[k].size(); ++i)
        trial_.r[k][i] += step * (next_.r[k][i] - trial_.r[k][i]);
    state_.surfaces.turn(X, trial_.u, step * du, trial_.r, state_.contacts.size());
  }
  if (state_.controlled_index >= 0) trial_.travel += step * next_.travel;
  for (std::size_t k = 0; k < state_.contacts.size(); ++k) {
    const bool follows_travel =
        state_.starts_with_travel() && static_cast<int>(k) == state_.controlled_index;
    if (state_.contacts[k].mu > 0 && (border_.arc() || follows_travel))
      state_.slip_from_touch(k, trial_.expected);
  }
}

}  // namespace langer
