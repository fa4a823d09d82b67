// One correction of an increment: linearise the balance, condense the contact to the candidates,
// solve, and choose the factorization that serves for it.
//   whole tangent, no contact        K du = rhs
//   contact condensed                Schur complement of K on the candidates; the contact law is
//                                    solved on it (contact_linearisation.hpp)
//   contact in the tangent itself    rows of closed contacts join K (contact_in_tangent.hpp)
// A factor of an earlier state of the increment serves for cheaper corrections (modified Newton).
#include <algorithm>

#include "core/base/stopwatch.hpp"
#include "mechanics/linear/krylov.hpp"
#include "mechanics/mesh/reference.hpp"
#include "mechanics/solve/statics.hpp"

namespace langer {

bool Statics::factorize() {
  const Stopwatch watch(cost_.factor);
  factored_at_ = u_;
  of_accepted_ = false;
  return factor_.factorize(equilibrium_);
}

TangentFactor& Statics::condensed_factor() {
  if (!contact_in_tangent()) return factor_;
  if (!second_factor_)
    second_factor_ = std::make_unique<TangentFactor>(equilibrium_, contacts_, options_.threads,
                                                     ContactBy::compliance);
  return *second_factor_;
}

bool Statics::factorize_accepted() {
  {
    const Stopwatch watch(cost_.assembly);
    equilibrium_.pressures_from(now_.u);
    equilibrium_.assemble(now_.u, true);
    K_current_ = true;
  }
  TangentFactor& factor = condensed_factor();
  int level = level_of_increment(before_, now_.t, now_.travel - before_.travel);
  level = std::max(level, level_of_increment(now_, now_.t, 0));
  factor.take_level(equilibrium_, level);
  const TangentFactor::Counts needed = factor.counts();
  factor_serves_ = false;
  bool solvable = false;
  if (&factor == &factor_) {
    solvable = factorize();
    of_accepted_ = solvable && factor.kind() == TangentFactor::Kind::whole &&
                   equilibrium_.formulation() != Formulation::displacement;
    if (of_accepted_) equilibrium_.keep_dilatations();
  } else {
    const Stopwatch watch(cost_.factor);
    factor.begin_increment();
    solvable = factor.factorize(equilibrium_);
  }
  factor.uncount(needed);  // the counts show what the solution itself needed
  return solvable;
}

void Statics::update_tangent() {
  if (K_current_) return;
  const Stopwatch watch(cost_.assembly);
  const VecX du = imposed_direction(u_);
  equilibrium_.assemble(u_, true, &du);
  K_current_ = true;
}

// The cost of a correction with a new tangent, in corrections with the last one. It is computed
// from operation counts and not measured with a clock: the same scene takes the same steps on every
// machine. The rates are those of one thread of a machine of 2020 (`langer-bench indentation`);
// only their ratio matters.
double Statics::cost_ratio() const {
  const LinearSolver::Size size = factor_.size();
  const ReferenceCell& cell = equilibrium_.mesh().cell();
  const double points = static_cast<double>(equilibrium_.mesh().n_cells()) * cell.n_gauss;
  const double n = cell.n_nodes;
  const double factor = size.flops / 20e9;
  const double through_factor = 16 * size.factor_nonzeros / 10e9;
  const double tangents = 4e-9 * points * n * n;
  const double forces = 15e-9 * points * n;
  return (factor + tangents + through_factor + forces) / (through_factor + forces);
}

std::optional<VecX> Statics::correction() {
  update_tangent();
  again_ = false;
  VecX rhs = free_residual();
  if (!arc_) rhs -= on_free_rows(equilibrium_.K_du());
  if (bordered()) update_border();
  std::optional<VecX> du;
  if (contact_in_tangent())
    du = solve_with_contact(rhs);
  else if (!factorize())
    return std::nullopt;
  // Supporting springs change the tangent too much to reuse its factor. The displacement
  // formulation has no mixed equations in which an old tangent could stand for the new one.
  // Without contact an indefinite tangent is factorized as it is, between the limit points of an
  // arc.
  const bool as_it_is =
      factor_.kind() == TangentFactor::Kind::whole ||
      (bordered() && contacts_.empty() && factor_.kind() == TangentFactor::Kind::indefinite);
  factor_serves_ =
      !iterative() && as_it_is && equilibrium_.formulation() != Formulation::displacement;
  if (factor_serves_) equilibrium_.keep_dilatations();
  if (contact_in_tangent()) return du;
  return solve_condensed(rhs);
}

// A correction with the factor of an earlier state of this increment, in the mixed equations of u
// and p. Nothing if there is no such factor, or if prescribed dofs still have to move.
std::optional<VecX> Statics::correction_again() {
  if (!factor_serves_ || !prescribed_reached(u_, remaining_prescribed(u_))) return std::nullopt;
  again_ = true;
  const VecX rhs = free_residual() + on_free_rows(equilibrium_.dilatation_residual());
  if (contact_in_tangent()) return solve_with_contact(rhs);
  return solve_condensed(rhs);
}

VecX Statics::with_prescribed_dofs(const VecX& free) const {
  VecX du = remaining_prescribed(u_);
  if (arc_) du += t_next_ * rates_;
  for (Eigen::Index row = 0; row < free.size(); ++row)
    du[equilibrium_.dofs().free[row]] = free[row];
  return du;
}

// Contact in the tangent itself: iteratively with the mixed equations if they are used, otherwise
// by a factorization with contact rows (again_: the last one).
std::optional<VecX> Statics::solve_with_contact(const VecX& rhs) {
  const double factor_before = cost_.factor;
  std::optional<ContactInTangent::Answer> answer;
  dp_.resize(0);
  if (MixedTangent* mixed = factor_.mixed()) {
    const Stopwatch watch(cost_.solve);
    mixed->linearise(equilibrium_, remaining_prescribed(u_));
    const std::vector<Vec3> c = indenters(t_, travel_);
    const std::vector<Vec3> c_start = indenters(now_.t, now_.travel);
    answer = factor_.in_tangent()->solve(
        {contacts_, equilibrium_.mesh().X, u_, u_start_, c, c_start, r_}, equilibrium_, rhs, *mixed,
        dp_);
    if (!answer && equilibrium_.division()) return std::nullopt;  // shorter increments are left
    if (!answer) {
      factor_.take_factor(equilibrium_);
      dp_.resize(0);
    }
  }
  if (!answer) {
    const Stopwatch watch(cost_.contact);
    const std::vector<Vec3> c = indenters(t_, travel_);
    const std::vector<Vec3> c_start = indenters(now_.t, now_.travel);
    const ContactState state{contacts_, equilibrium_.mesh().X, u_, u_start_, c, c_start, r_};
    const auto factorize = [this](const std::vector<double>& values) {
      const Stopwatch factoring(cost_.factor);
      factored_at_ = u_;
      return factor_.factorize_with_contact(values);
    };
    ContactInTangent& contact = *factor_.in_tangent();
    if (again_) {
      answer = contact.solve_again(state, rhs, factor_.linear());
    } else {
      answer = contact.solve(state, equilibrium_.K(), rhs, factor_.linear(), factorize);
    }
  }
  cost_.contact -= cost_.factor - factor_before;
  if (!answer) return std::nullopt;
  r_next_ = std::move(answer->r);
  cost_.sweeps += answer->solutions;
  return with_prescribed_dofs(answer->move);
}

// Follower pressures with a free edge and the forces of an energy-momentum scheme have a skew part
// of the stiffness, which the symmetric tangent omits.
bool Statics::omits_stiffness() const {
  return equilibrium_.loads().follow() || equilibrium_.conserves();
}

// That part times du, on the side of the internal forces: (3 n) [N].
VecX Statics::omitted_stiffness(const VecX& du) const {
  VecX out = VecX::Zero(du.size());
  if (equilibrium_.loads().follow()) out -= equilibrium_.skew_pressures(u_, du);
  if (equilibrium_.conserves()) out += equilibrium_.conserving_skew(du);
  return out;
}

// The factor of K is a good preconditioner of K + S with the skew part S: (I + K^-1 S) du = K^-1
// rhs converges in a few iterations.
VecX Statics::solve_nonsymmetric(const VecX& rhs) {
  // Share of the correction that is left. What a correction leaves of the residual is more than
  // this: 0.03 to 0.3 by an old tangent, and by a new one what the step is too long for. A scheme
  // that keeps the energy is solved to rounding, and has a new tangent each time.
  double accurate = again_ ? 1e-2 : 1e-3;
  if (equilibrium_.conserves()) accurate = 1e-7;
  if (!omits_stiffness()) return factor_.linear().solve(rhs);
  return solve_near_factor(rhs - on_free_rows(omitted_stiffness(remaining_prescribed(u_))),
                           accurate);
}

// The same where no prescribed dof moves.
VecX Statics::solve_near_factor(const VecX& known, double accurate) {
  LinearSolver& linear = factor_.linear();
  if (!omits_stiffness()) return linear.solve(known);
  const auto product = [&](const VecX& x) {
    VecX du = VecX::Zero(u_.size());
    for (Eigen::Index row = 0; row < x.size(); ++row) du[equilibrium_.dofs().free[row]] = x[row];
    return VecX(x + linear.solve(on_free_rows(omitted_stiffness(du))));
  };
  return solve_near_identity(product, linear.solve(known), accurate, 40);
}

// Contact condensed to the candidates: forward half of the solve, contact law on the Schur
// complement, backward half.
std::optional<ContactChange> Statics::change_of_contact(const VecX& rhs, LinearSolver::Half& half) {
  LinearSolver& linear = factor_.linear();
  VecX free;  // movement of all rows, where candidates stand among them
  {
    const Stopwatch watch(cost_.solve);
    half = linear.start(rhs);
    if (factor_.leaves_out()) free = linear.finish(half, VecX::Zero(half.last.size()));
  }
  const auto move_of_node = [&](int node) {
    Vec3 d = Vec3::Zero();
    for (int j = 0; j < 3; ++j) {
      const int dof = 3 * node + j;
      const int row = free.size() > 0 ? equilibrium_.dofs().equation[dof] : factor_.last_of(dof);
      if (row >= 0) d[j] = free.size() > 0 ? free[row] : half.last[row];
    }
    return d;
  };
  const Stopwatch watch(cost_.contact);
  const std::vector<Vec3> c = indenters(t_, travel_);
  const std::vector<Vec3> c_start = indenters(now_.t, now_.travel);
  if (!bodies_.empty()) {
    const ContactState state{contacts_, equilibrium_.mesh().X, u_, u_start_, c, c_start, r_};
    return linearised_bodies(state, bodies_, now_.u, remaining_prescribed(u_), factor_, half.last);
  }
  if (arc_) {  // its travel is an unknown of the border
    const ContactState state{contacts_, equilibrium_.mesh().X, u_, u_start_, c, c_start, r_};
    return linearised_contact(state, factor_, move_of_node);
  }
  double force = 0;
  if (controlled_ >= 0) force = required_force();
  return linearised_contact({contacts_, equilibrium_.mesh().X, u_, u_start_, c, c_start, r_,
                             controlled_, force, start_moves(), &bonds_, force_falls()},
                            factor_, move_of_node);
}

// The level of candidates with which an increment to t begins, from the state before it: those that
// the indenter can reach. A linear step that reaches further takes a higher one.
int Statics::level_of_increment(const BodyState& from, double t, double last_travel) const {
  if (!factor_.may_leave_out()) return factor_.level();
  const std::vector<Vec3> begin = indenters(from.t, from.travel);
  const std::vector<Vec3> end = indenters(t, from.travel);
  int level = 0;
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    double reach = 3 * (end[k] - begin[k]).norm() + 0.05;
    if (static_cast<int>(k) == controlled_) reach += 0.1 + 2 * std::abs(last_travel);
    for (std::size_t i = 0; i < contacts_[k].nodes.size(); ++i) {
      if (factor_.levels().of(k, i) <= level) continue;
      const int node = contacts_[k].nodes[i];
      const Vec3 x = equilibrium_.mesh().X[node] + from.u.segment<3>(3 * node);
      const bool bonded = !bonds_.none() && bonds_.holds(k, i);
      if (bonded || !from.r[k][i].isZero(0) ||
          shape_at(contacts_[k].shape, x - end[k]).gap <= reach)
        level = factor_.levels().of(k, i);
    }
  }
  return level;
}

// The movement of the free rows, with the change of contact that belongs to it.
std::optional<VecX> Statics::move_with_contact(const VecX& rhs) {
  LinearSolver& linear = factor_.linear();
  LinearSolver::Half half;
  std::optional<ContactChange> change = change_of_contact(rhs, half);
  while (change && change->level) {  // more candidates may close than the factor keeps apart
    factor_.take_level(equilibrium_, *change->level);
    factor_serves_ = of_accepted_ = false;
    if (again_ || !factorize()) return std::nullopt;
    factor_serves_ = factor_.kind() == TangentFactor::Kind::whole &&
                     equilibrium_.formulation() != Formulation::displacement;
    change = change_of_contact(rhs, half);
  }
  if (!change) return std::nullopt;
  r_next_ = std::move(change->r);
  travel_next_ = change->travel;
  cost_.sweeps += change->sweeps;
  const Stopwatch watch(cost_.solve);
  if (factor_.kind() == TangentFactor::Kind::whole) return linear.finish(half, change->force);
  // Supporting springs cancel against contact forces: less rounding if before the elimination.
  VecX all = rhs;
  for (std::size_t i = 0; i < factor_.last().size(); ++i)
    all[factor_.last()[i]] += change->force[static_cast<Eigen::Index>(i)];
  return linear.solve(all);
}

std::optional<VecX> Statics::solve_condensed(const VecX& rhs) {
  if (contacts_.empty() && bodies_.empty()) {
    const Stopwatch watch(cost_.solve);
    VecX move = solve_nonsymmetric(rhs);
    if (bordered()) solve_border(move);
    return with_prescribed_dofs(move);
  }
  if (arc_) return solve_arc_with_contact(rhs);
  const std::optional<VecX> move = move_with_contact(rhs);
  if (!move) return std::nullopt;
  return with_prescribed_dofs(*move);
}

// The balance of the free dofs with fixed contact reactions, for solvers that know no contact
// (KINSOL).
FreeBalance Statics::free_balance() {
  FreeBalance b;
  b.free = equilibrium_.dofs().free;
  b.residual = [this](const VecX& u, VecX& f) {
    const Stopwatch watch(cost_.assembly);
    if (!equilibrium_.assemble(u, false)) return false;
    f = -free_residual();
    return true;
  };
  b.tangent = [this](const VecX& u) {
    if (!equilibrium_.assemble(u, true)) return false;
    const Stopwatch watch(cost_.factor);
    factor_serves_ = of_accepted_ = false;
    factored_at_ = u;
    return factor_.factorize_fixed_reactions(equilibrium_);
  };
  b.solve = [this](const VecX& rhs, bool fresh) {
    const Stopwatch watch(cost_.solve);
    const VecX step = factor_.linear().solve(rhs);
    unsettled_ = equilibrium_.formulation() == Formulation::linear_dilatation;
    if (!fresh) return step;
    VecX du = VecX::Zero(u_.size());
    for (Eigen::Index i = 0; i < step.size(); ++i) du[equilibrium_.dofs().free[i]] = step[i];
    equilibrium_.predict_pressures(du, 1);
    return step;
  };
  return b;
}

}  // namespace langer
