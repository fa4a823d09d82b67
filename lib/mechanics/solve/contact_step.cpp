// The corrections of an increment, and which factor serves for them.
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
  if (!beside_)
    beside_ = std::make_unique<TangentFactor>(equilibrium_, contacts_, options_.threads,
                                              ContactBy::compliance);
  return *beside_;
}

bool Statics::factorize_accepted() {
  {
    const Stopwatch watch(cost_.assembly);
    equilibrium_.pressures_from(now_.u);
    equilibrium_.assemble(now_.u, true);
    K_current_ = true;
  }
  TangentFactor& factor = condensed_factor();
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
  factor.uncount(needed);  // they count what the solution needed
  return solvable;
}

void Statics::need_tangent() {
  if (K_current_) return;
  const Stopwatch watch(cost_.assembly);
  const VecX du = remaining_prescribed(u_);
  equilibrium_.assemble(u_, true, &du);
  K_current_ = true;
}

// From counts, not from a clock: the same scene takes the same way on every machine. The rates are
// those of one thread of a machine of 2020 (`langer-bench indentation`); what counts is their
// ratio.
double Statics::price() const {
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
  need_tangent();
  again_ = false;
  const VecX rhs = free_residual() - on_free_rows(equilibrium_.K_du());
  std::optional<VecX> du;
  if (contact_in_tangent())
    du = corrected_with_contact(rhs);
  else if (!factorize())
    return std::nullopt;
  // springs of either kind hide what the body does; pressures of Gauss points are none of the mixed
  // equations
  factor_serves_ = !iterative() && factor_.kind() == TangentFactor::Kind::whole &&
                   equilibrium_.formulation() != Formulation::displacement;
  if (factor_serves_) equilibrium_.keep_dilatations();
  if (contact_in_tangent()) return du;
  return corrected(rhs);
}

// K at another state of this increment stands for the one here, in the mixed equations of u and p.
std::optional<VecX> Statics::correction_again() {
  if (!factor_serves_ || !prescribed_reached(u_, remaining_prescribed(u_))) return std::nullopt;
  again_ = true;
  const VecX rhs = free_residual() + on_free_rows(equilibrium_.dilatation_residual());
  if (contact_in_tangent()) return corrected_with_contact(rhs);
  return corrected(rhs);
}

VecX Statics::with_prescribed(const VecX& free) const {
  VecX du = remaining_prescribed(u_);
  for (Eigen::Index row = 0; row < free.size(); ++row)
    du[equilibrium_.dofs().free[row]] = free[row];
  return du;
}

// Contact in the tangent itself; again_: by the last one.
std::optional<VecX> Statics::corrected_with_contact(const VecX& rhs) {
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
  return with_prescribed(answer->move);
}

// The rims of pressures add a skew part to the symmetric tangent, whose factor is near enough to
// the whole for a few iterations.
VecX Statics::with_free_rims(const VecX& rhs) {
  constexpr double accurate = 1e-6;  // of the correction
  LinearSolver& linear = factor_.linear();
  if (!equilibrium_.loads().follow()) return linear.solve(rhs);
  const VecX known = rhs + on_free_rows(equilibrium_.skew_pressures(u_, remaining_prescribed(u_)));
  const auto product = [&](const VecX& x) {
    VecX du = VecX::Zero(u_.size());
    for (Eigen::Index row = 0; row < x.size(); ++row) du[equilibrium_.dofs().free[row]] = x[row];
    return VecX(x - linear.solve(on_free_rows(equilibrium_.skew_pressures(u_, du))));
  };
  return solve_near_identity(product, linear.solve(known), accurate, 40);
}

std::optional<VecX> Statics::corrected(const VecX& rhs) {
  LinearSolver& linear = factor_.linear();
  VecX move;
  if (contacts_.empty()) {
    const Stopwatch watch(cost_.solve);
    move = with_free_rims(rhs);
  } else {
    LinearSolver::Half half;
    {
      const Stopwatch watch(cost_.solve);
      half = linear.start(rhs);
    }
    std::optional<ContactChange> change;
    {
      const Stopwatch watch(cost_.contact);
      const std::vector<Vec3> c = indenters(t_, travel_);
      const std::vector<Vec3> c_start = indenters(now_.t, now_.travel);
      double force = 0;
      if (controlled_ >= 0) force = controlled()->control->force.at(t_);
      change = linearised_contact({contacts_, equilibrium_.mesh().X, u_, u_start_, c, c_start, r_,
                                   controlled_, force, start_moves(), &bonds_},
                                  factor_, half.last);
    }
    if (!change) return std::nullopt;
    r_next_ = std::move(change->r);
    travel_next_ = change->travel;
    cost_.sweeps += change->sweeps;
    const Stopwatch watch(cost_.solve);
    if (factor_.kind() == TangentFactor::Kind::whole) {
      move = linear.finish(half, change->force);
    } else {  // where springs cancel against forces, they had better do so before the elimination
      VecX all = rhs;
      for (std::size_t i = 0; i < factor_.last().size(); ++i)
        all[factor_.last()[i]] += change->force[static_cast<Eigen::Index>(i)];
      move = linear.solve(all);
    }
  }
  return with_prescribed(move);
}

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
