#include "solve/statics.hpp"

#include <algorithm>
#include <cmath>

#include "base/stopwatch.hpp"
#include "mesh/quality.hpp"
#include "mesh/reference.hpp"
#include "solve/zero_energy_modes.hpp"

namespace langer {

Statics::Statics(Equilibrium& equilibrium, std::vector<RigidContact> contacts, const StaticsOptions& options)
    : equilibrium_(equilibrium), contacts_(std::move(contacts)), options_(options) {
  const Dofs& dofs = equilibrium_.dofs();
  if (!contacts_.empty()) {
    last_of_.assign(dofs.n, -1);
    for (const RigidContact& contact : contacts_)
      for (int node : contact.nodes)
        for (int dof = 3 * node; dof < 3 * node + 3; ++dof)
          if (dofs.equation[dof] >= 0 && last_of_[dof] < 0) {
            last_of_[dof] = static_cast<int>(last_.size());
            last_.push_back(dofs.equation[dof]);
          }
  }
  {
    const Stopwatch watch(cost_.analysis);
    linear_ = std::make_unique<LinearSolver>(equilibrium_.pattern(), last_, options_.threads);
  }
  if (!last_.empty() && !zero_energy_modes(equilibrium_.mesh(), dofs).empty()) {
    // of the order of what the body opposes to a movement of one node: the weak resistance of contact to a free motion stays visible
    double mu = 0;
    const int n_cells = equilibrium_.mesh().n_cells();
    for (int e = 0; e < n_cells; ++e) mu = std::max(mu, std::abs(shear_modulus(equilibrium_.material(e))));
    loose_spring_ = mu * std::cbrt(quality(equilibrium_.mesh()).volume / n_cells);
  }
  now_.u = VecX::Zero(dofs.n);
  for (const RigidContact& contact : contacts_) now_.r.emplace_back(contact.nodes.size(), Vec3::Zero());
  before_ = now_;
  u_ = u_start_ = now_.u, r_ = r_next_ = now_.r;
}

void Statics::restore(const BodyState& accepted, const BodyState* before) {
  now_ = accepted;
  before_ = before ? *before : accepted;
  K_current_ = factor_serves_ = again_ = false;
  t_ = now_.t, u_ = u_start_ = now_.u, r_ = r_next_ = now_.r;
}

void Statics::begin(double t) {
  t_ = t, supported_ = K_current_ = factor_serves_ = again_ = false;
  u_ = u_start_ = now_.u, r_ = r_next_ = now_.r;
  equilibrium_.pressures_from(now_.u);
  const bool rests = motion(now_.t) == 0 && F_ext_.size() == 0;  // then the last movement does not go on
  if (const double last = now_.t - before_.t; last > 0 && !rests) extrapolate(std::min((t - now_.t) / last, 2.0));
  slip_from_touch();
}

void Statics::extrapolate(double s) {
  const VecX step = s * (now_.u - before_.u);
  if (!options_.extrapolate || !admissible(now_.u + step)) return;
  equilibrium_.extrapolate_pressures(before_.u, s);
  u_ += step;
}

// A node that is open where the increment begins slips only from where it touches: at the share of the extrapolated movement that
// its gap takes to close. Without this its reaction is that of a slip it never made, an error of first order in the increment.
void Statics::slip_from_touch() {
  const std::vector<Vec3>& X = equilibrium_.mesh().X;
  for (const RigidContact& contact : contacts_) {
    if (contact.mu == 0) continue;
    const Vec3 c = indenter_displacement(contact, t_), c0 = indenter_displacement(contact, now_.t);
    for (int node : contact.nodes) {
      const auto u0 = now_.u.segment<3>(3 * node), u = u_.segment<3>(3 * node);
      const double gap = shape_at(contact.shape, X[node] + u0 - c0).gap;
      if (!(gap > options_.gap_tolerance)) continue;
      const double closed = gap - shape_at(contact.shape, X[node] + u - c).gap;
      u_start_.segment<3>(3 * node) = u0 + (closed > gap ? gap / closed : 1) * (u - u0 - (c - c0));
    }
  }
}

void Statics::accept() {
  before_ = std::move(now_);
  now_ = {t_, u_, r_};
}

double Statics::motion(double t0) const {
  double largest = 0;
  for (const RigidContact& contact : contacts_)
    largest = std::max(largest, (indenter_displacement(contact, t_) - indenter_displacement(contact, t0)).norm());
  for (const Prescribed& p : equilibrium_.dofs().prescribed) largest = std::max(largest, std::abs(p.value * (t_ - t0)));
  return largest;
}

VecX Statics::remaining_prescribed(const VecX& u) const {
  VecX du = VecX::Zero(u.size());
  for (const Prescribed& p : equilibrium_.dofs().prescribed) du[p.dof] = p.value * t_ - u[p.dof];
  return du;
}

VecX Statics::free_residual() const {
  const Dofs& dofs = equilibrium_.dofs();
  VecX f = -equilibrium_.f_int();
  if (F_ext_.size() > 0) f += t_ * F_ext_;
  for (std::size_t k = 0; k < contacts_.size(); ++k)
    for (std::size_t i = 0; i < contacts_[k].nodes.size(); ++i) f.segment<3>(3 * contacts_[k].nodes[i]) += r_[k][i];
  VecX free(dofs.n_free());
  for (int row = 0; row < dofs.n_free(); ++row) free[row] = f[dofs.free[row]];
  return free;
}

Assessment Statics::assess(const VecX& u, bool with_tangent) {
  const Stopwatch watch(cost_.assembly);
  Assessment out;
  const VecX du = remaining_prescribed(u);
  out.admissible = equilibrium_.assemble(u, with_tangent, &du);
  K_current_ = with_tangent;
  if (!out.admissible) {
    out.missing = equilibrium_.J_min() > 0
                      ? "a force is not finite: the exponential of a fibre overflows where c2 (I4_bar - 1)^2 > 300, or the start "
                        "of the step is too far away"
                      : "an element is turned inside out";
    return out;
  }
  out.residual = free_residual().norm();
  double reference = 0;
  for (const Prescribed& p : equilibrium_.dofs().prescribed) reference += std::pow(equilibrium_.f_int()[p.dof], 2);
  for (const auto& r : r_)
    for (const Vec3& r_i : r) reference += r_i.squaredNorm();
  if (F_ext_.size() > 0) reference += (t_ * F_ext_).squaredNorm();
  out.reference = std::sqrt(reference);
  out.floor = 3 * equilibrium_.rounding_floor();
  out.others = du.lpNorm<Eigen::Infinity>() <= 1e-14 * (1 + u.lpNorm<Eigen::Infinity>());
  if (!out.others) out.missing = "prescribed displacements not reached";
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const ContactDefect d =
        contact_defect(contacts_[k], equilibrium_.mesh().X, u, u_start_, indenter_displacement(contacts_[k], t_),
                       indenter_displacement(contacts_[k], now_.t), r_[k], motion(now_.t));
    if (d.penetration > options_.gap_tolerance || d.complementarity > options_.law_tolerance || d.cone > options_.law_tolerance) {
      out.others = false;
      out.missing = "the contact law does not hold";
    }
  }
  if (out.others && loose_spring_ > 0 && slips_away()) {
    out.others = false;
    out.missing = "the body slips away from under the indenter, and nothing else holds it";
  }
  return out;
}

// nothing touches the body, but something would if it were where the increment began
bool Statics::slips_away() const {
  bool in_the_way = false;
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const Vec3 c = indenter_displacement(contacts_[k], t_);
    for (std::size_t i = 0; i < r_[k].size(); ++i) {
      if (!r_[k][i].isZero(0)) return false;
      const int node = contacts_[k].nodes[i];
      const Vec3 x = equilibrium_.mesh().X[node] + now_.u.segment<3>(3 * node);
      in_the_way = in_the_way || shape_at(contacts_[k].shape, x - c).gap < -options_.gap_tolerance;
    }
  }
  return in_the_way;
}

bool Statics::admissible(const VecX& u) const { return u.allFinite() && equilibrium_.smallest_J(u) > 0.02; }

// K by Cholesky; where it is not positive definite, K with springs on the candidates, which contact_forces() takes out
// again exactly; where that is not either, with stabilisation springs in the body, or without contact as it is by UMFPACK.
bool Statics::factorize() {
  const Stopwatch watch(cost_.factor);
  ++cost_.factorizations;
  factored_at_ = u_, factor_ = Factor::whole;
  if (!supported_ && loose_spring_ == 0 && linear_->factorize(equilibrium_.K())) return true;
  ++n_indefinite_;
  factor_ = Factor::supported;
  if (!last_.empty()) {
    const Pattern& pattern = equilibrium_.pattern();
    double diagonal = 0;  // a column starts with its diagonal
    for (int row : last_) diagonal += std::abs(equilibrium_.K()[pattern.column_start[row]]) / static_cast<double>(last_.size());
    for (double spring : {loose_spring_, diagonal, 30 * diagonal, 1000 * diagonal}) {
      if (spring == 0 || (supported_ && spring < 0.5 * gamma_)) continue;  // softer springs were not enough in this increment
      gamma_ = spring;
      std::vector<double> K = equilibrium_.K();
      for (int row : last_) K[pattern.column_start[row]] += gamma_;
      if (linear_->factorize(K)) return supported_ = true;
      if (spring < 1000 * diagonal) continue;
      // The body itself gives way. In a few directions stabilisation springs help; where they are many, the increment was too long: K there
      // says nothing, and the same point comes within reach by shorter ones.
      factor_ = Factor::indefinite, ++n_unstable_;
      return supported_ = linear_->factorize_with_springs(K);
    }
  }
  ++n_unstable_;
  factor_ = Factor::indefinite;
  return linear_->factorize_indefinite(equilibrium_.K());
}

void Statics::need_tangent() {
  if (K_current_) return;
  const Stopwatch watch(cost_.assembly);
  const VecX du = remaining_prescribed(u_);
  equilibrium_.assemble(u_, true, &du);
  K_current_ = true;
}

// From counts, not from a clock: the same scene takes the same way on every machine. The rates are those of one thread of a
// machine of 2020 (`langer-bench indentation`); what counts is their ratio.
double Statics::price() const {
  const LinearSolver::Size size = linear_->size();
  const ReferenceCell& cell = reference(nodes_per_cell(equilibrium_.mesh().type));
  const double points = static_cast<double>(equilibrium_.mesh().n_cells()) * cell.n_gauss, n = cell.n_nodes;
  const double factor = size.flops / 20e9, through_factor = 16 * size.factor_nonzeros / 10e9;
  const double tangents = 4e-9 * points * n * n, forces = 15e-9 * points * n;
  return (factor + tangents + through_factor + forces) / (through_factor + forces);
}

std::optional<VecX> Statics::correction() {
  const Dofs& dofs = equilibrium_.dofs();
  need_tangent();
  again_ = false;
  if (!factorize()) return std::nullopt;
  // springs of either kind hide what the body does; pressures of Gauss points are none of the mixed equations
  factor_serves_ = factor_ == Factor::whole && equilibrium_.formulation() != Formulation::displacement;
  if (factor_serves_) equilibrium_.keep_dilatations();
  VecX rhs = free_residual();
  for (int row = 0; row < dofs.n_free(); ++row) rhs[row] -= equilibrium_.K_du()[dofs.free[row]];
  return corrected(rhs);
}

// K at another state of this increment stands for the one here, in the mixed equations of u and p.
std::optional<VecX> Statics::correction_again() {
  const Dofs& dofs = equilibrium_.dofs();
  if (!factor_serves_ || !remaining_prescribed(u_).isZero(0)) return std::nullopt;
  again_ = true;
  const VecX turned = equilibrium_.turned_dilatations();
  VecX rhs = free_residual();
  for (int row = 0; row < dofs.n_free(); ++row) rhs[row] += turned[dofs.free[row]];
  return corrected(rhs);
}

std::optional<VecX> Statics::corrected(const VecX& rhs) {
  const Dofs& dofs = equilibrium_.dofs();
  VecX move;
  if (contacts_.empty()) {
    const Stopwatch watch(cost_.solve);
    move = linear_->solve(rhs);
  } else {
    LinearSolver::Half half;
    {
      const Stopwatch watch(cost_.solve);
      half = linear_->start(rhs);
    }
    const auto forces = contact_forces(half.last);
    if (!forces) return std::nullopt;
    const Stopwatch watch(cost_.solve);
    if (factor_ == Factor::whole) {
      move = linear_->finish(half, *forces);
    } else {  // where springs cancel against forces, they had better do so before the elimination
      VecX all = rhs;
      for (std::size_t i = 0; i < last_.size(); ++i) all[last_[i]] += (*forces)[i];
      move = linear_->solve(all);
    }
  }
  VecX du = remaining_prescribed(u_);
  for (int row = 0; row < dofs.n_free(); ++row) du[dofs.free[row]] = move[row];
  return du;
}

void Statics::moved(const VecX& du, double step) {
  const Stopwatch watch(cost_.assembly);
  equilibrium_.predict_pressures(du, step, again_);
  const std::vector<Vec3>& X = equilibrium_.mesh().X;
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const Vec3 c = indenter_displacement(contacts_[k], t_);
    for (std::size_t i = 0; i < r_[k].size(); ++i) {
      if (r_next_[k][i].isZero(0) && r_[k][i].isZero(0)) continue;
      const int node = contacts_[k].nodes[i];
      const Vec3 x = X[node] + u_.segment<3>(3 * node) - c, moved_x = x + step * du.segment<3>(3 * node);
      const Vec3 r = step == 1 ? r_next_[k][i] : Vec3(r_[k][i] + step * (r_next_[k][i] - r_[k][i]));
      r_[k][i] = turn_with_normal(r, shape_at(contacts_[k].shape, x).normal, shape_at(contacts_[k].shape, moved_x).normal);
    }
  }
}

Problem Statics::problem() {
  Problem p;
  p.assess = [this](const VecX& u, bool with_tangent) { return assess(u, with_tangent); };
  p.correction = [this] { return correction(); };
  if (equilibrium_.formulation() != Formulation::displacement) {
    p.correction_again = [this] { return correction_again(); };
    p.price = price();
  }
  p.admissible = [this](const VecX& u) { return admissible(u); };
  p.moved = [this](const VecX& du, double step) { moved(du, step); };
  p.free = equilibrium_.dofs().free;
  p.residual = [this](const VecX& u, VecX& f) {
    const Stopwatch watch(cost_.assembly);
    if (!equilibrium_.assemble(u, false)) return false;
    f = -free_residual();
    return true;
  };
  p.tangent = [this](const VecX& u) {
    if (!equilibrium_.assemble(u, true)) return false;
    supported_ = factor_serves_ = false;
    ++cost_.factorizations;
    const Stopwatch watch(cost_.factor);
    factored_at_ = u, factor_ = Factor::whole;
    if (linear_->factorize(equilibrium_.K())) return true;
    ++n_indefinite_, factor_ = Factor::indefinite;
    return linear_->factorize_indefinite(equilibrium_.K());
  };
  p.solve = [this](const VecX& rhs) {
    const Stopwatch watch(cost_.solve);
    return linear_->solve(rhs);
  };
  p.predicted = [this](const VecX& step) {
    VecX du = VecX::Zero(u_.size());
    for (Eigen::Index i = 0; i < step.size(); ++i) du[equilibrium_.dofs().free[i]] = step[i];
    equilibrium_.predict_pressures(du, 1);
  };
  // cells that oppose the remainder of J - 1 as their pressures demand
  if (equilibrium_.formulation() == Formulation::linear_dilatation)
    p.settled = [this](const VecX& u) { equilibrium_.pressures_from(u); };
  return p;
}

std::vector<ContactDefect> Statics::defects() const {
  const double t0 = now_.t == t_ ? before_.t : now_.t;
  std::vector<ContactDefect> out;
  for (std::size_t k = 0; k < contacts_.size(); ++k)
    out.push_back(contact_defect(contacts_[k], equilibrium_.mesh().X, u_, u_start_, indenter_displacement(contacts_[k], t_),
                                 indenter_displacement(contacts_[k], t0), r_[k], motion(t0)));
  return out;
}

VecX Statics::reactions() const {
  VecX out = VecX::Zero(equilibrium_.dofs().n);
  for (const Prescribed& p : equilibrium_.dofs().prescribed) out[p.dof] = equilibrium_.f_int()[p.dof];
  for (std::size_t k = 0; k < contacts_.size(); ++k)
    for (std::size_t i = 0; i < r_[k].size(); ++i) out.segment<3>(3 * contacts_[k].nodes[i]) += r_[k][i];
  return out;
}

}  // namespace langer
