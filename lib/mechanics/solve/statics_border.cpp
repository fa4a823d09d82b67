// Unknowns beside the displacements, each with an equation of its own:
//   t            the factor of all loads, while the increment has a given length (arc length)
//   pressures    of surfaces that are given a volume
// With K the tangent, c the forces per unit of such an unknown x and g its equation, a correction
// is
//   K du - c dx = r,    dg/du . du = -g
// Two back-substitutions with the factor of K, a = K^-1 r and b = K^-1 c, give du = a + b dx. K may
// be indefinite on the way, and singular at limit points, which no iterate meets exactly.
//   sphere   |u - u_n|^2 = L^2:  (u - u_n) . du = (L^2 - |u - u_n|^2) / 2      [Crisfield 1981; Riks]
//   plane    normal . (u - u_n) = a
//   volume   V(u) = V_given:     c . du = V_given - V(u)
#include <algorithm>
#include <cmath>

#include "core/tensor/dense.hpp"
#include "mechanics/linear/krylov.hpp"
#include "mechanics/solve/statics.hpp"

namespace langer {

namespace {

constexpr double arc_reached = 1e-7;     // of its length
constexpr double volume_reached = 1e-9;  // of the largest volume that is given

}  // namespace

void Statics::take_border_of(const BodyState& state) {
  const int n = equilibrium_.loads().n_volumes();
  if (n == 0) return;
  if (state.pressures.size() == n) {
    p_ = state.pressures;
  } else {
    p_ = VecX::Zero(n);
  }
  equilibrium_.set_load_pressures(p_);
}

void Statics::begin_arc(double length, const VecX* towards) {
  begin(now_.t);
  const Dofs& dofs = equilibrium_.dofs();
  const double nodes = (dofs.n_free() + static_cast<double>(dofs.prescribed.size())) / 3;
  Arc arc;
  arc.size = length * std::sqrt(nodes);
  if (towards) arc.towards = *towards;
  arc_ = arc;
  begin_border();
}

void Statics::begin_along(const VecX& mode, double amplitude) {
  begin(now_.t);
  arc_ = Arc{amplitude, mode, amplitude * mode};
  begin_border();
}

void Statics::begin_from(const VecX& u) {
  const VecX step = u - now_.u;
  u_ = now_.u;
  equilibrium_.assemble(u_, true);
  equilibrium_.pressures_from(u_);
  K_current_ = false;
  if (!admissible(u)) return;
  equilibrium_.predict_pressures(step, 1);
  u_ = u;
}

void Statics::restart() {
  if (!arc_) {
    begin(t_);
    return;
  }
  const Arc arc = *arc_;
  begin(now_.t);
  arc_ = arc;
  begin_border();
}

// The trial state of an arc: towards a given direction, else along the last increment. The first
// one of a path has neither: its first correction takes the direction of the loads.
void Statics::begin_border() {
  rates_ = VecX::Zero(u_.size());
  for (const Prescribed& p : equilibrium_.dofs().prescribed) rates_[p.dof] = p.rate(1);
  if (arc_->towards.size() > 0) {
    const VecX step = std::abs(arc_->size) / arc_->towards.norm() * arc_->towards;
    equilibrium_.assemble(now_.u, true);
    if (!admissible(now_.u + step)) return;
    equilibrium_.predict_pressures(step, 1);
    u_ = now_.u + step;
    K_current_ = false;
    return;
  }
  const VecX last = now_.u - before_.u;
  if (!(last.norm() > 0) || arc_->normal.size() > 0) return;
  const double s = arc_->size / last.norm();
  if (!options_.extrapolate || !admissible(now_.u + s * last)) return;
  equilibrium_.extrapolate_pressures(before_.u, s);
  u_ = now_.u + s * last;
  t_ = now_.t + s * (now_.t - before_.t);
  travel_ = now_.travel + s * (now_.travel - before_.travel);
  equilibrium_.load_to(t_);
  K_current_ = false;
}

VecX Statics::imposed_direction(const VecX& u) const {
  if (arc_) return rates_;
  return remaining_prescribed(u);
}

std::vector<VecX> Statics::volume_gradients() const {
  std::vector<VecX> rows;
  for (int i = 0; i < equilibrium_.loads().n_volumes(); ++i)
    rows.push_back(on_free_rows(equilibrium_.unit_pressure(i, u_)));
  return rows;
}

// Forces per unit of each unknown, at the trial. Loads are in proportion to t where t is unknown.
void Statics::update_border() {
  columns_.clear();
  if (arc_) {
    VecX column = -equilibrium_.K_du();
    if (!equilibrium_.loads().empty()) column += equilibrium_.load_forces(1, u_);
    columns_.push_back(on_free_rows(column));
  }
}

// What the equation of an arc adds to t, where du = a + x b.
double Statics::arc_step(const VecX& a, const VecX& b) const {
  const VecX moved = u_ - now_.u;
  if (arc_->normal.size() > 0)
    return (arc_->size - arc_->normal.dot(moved + a)) / arc_->normal.dot(b);
  const double squared = moved.squaredNorm();
  if (squared == 0) return arc_->size / b.norm();
  return (0.5 * (arc_->size * arc_->size - squared) - moved.dot(a)) / moved.dot(b);
}

void Statics::solve_border(VecX& move) {
  if (arc_) {
    const VecX b = solve_near_factor(columns_.front());
    t_next_ = 0;
    const VecX a_all = with_prescribed_dofs(move);
    VecX b_all = rates_;
    for (Eigen::Index row = 0; row < b.size(); ++row) b_all[equilibrium_.dofs().free[row]] = b[row];
    t_next_ = arc_step(a_all, b_all);
    move += t_next_ * b;
    return;
  }
  gradients_.clear();
  const auto m = p_.size();
  std::vector<VecX> moves;
  MatX M(m, m);
  VecX lacking(m);
  const VecX a_all = with_prescribed_dofs(move);
  for (int i = 0; i < m; ++i) {
    gradients_.push_back(equilibrium_.unit_pressure(i, u_));
    moves.push_back(solve_near_factor(on_free_rows(gradients_.back())));
    lacking[i] = equilibrium_.loads().given_volume(i, t_) - equilibrium_.swept_volume(i, u_) -
                 gradients_.back().dot(a_all);
  }
  for (int i = 0; i < m; ++i) {
    const VecX row = on_free_rows(gradients_[static_cast<std::size_t>(i)]);
    for (int j = 0; j < m; ++j) M(i, j) = row.dot(moves[static_cast<std::size_t>(j)]);
  }
  Lu factors;
  factors.compute(M);
  p_next_ = factors.solve(lacking);
  for (int j = 0; j < m; ++j) move += p_next_[j] * moves[static_cast<std::size_t>(j)];
}

void Statics::move_border(double step) {
  if (arc_) {
    t_ += step * t_next_;
    equilibrium_.load_to(t_);
    return;
  }
  p_ += step * p_next_;
  equilibrium_.set_load_pressures(p_);
}

// The equation of the border that does not hold yet; empty if all do.
std::string Statics::border_defect(const VecX& u) const {
  if (arc_) {
    const VecX moved = u - now_.u;
    double size = moved.norm();
    if (arc_->normal.size() > 0) size = arc_->normal.dot(moved);
    if (std::abs(size - arc_->size) > arc_reached * std::abs(arc_->size))
      return "the length of the arc is not the given one";
    return "";
  }
  for (int i = 0; i < p_.size(); ++i) {
    const double given = equilibrium_.loads().given_volume(i, t_);
    const double largest = std::abs(*equilibrium_.loads().volume_load(i).volume);
    if (std::abs(equilibrium_.swept_volume(i, u) - given) > volume_reached * largest)
      return "a volume is not the given one";
  }
  return "";
}

}  // namespace langer
