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
// With contact, the movement du is piecewise linear in dx. Under force control the travel of the
// indenter is one more unknown of the border, and the given force its equation. Indenters that move
// join the sphere, each with the weight of all nodes:
//   |u - u_n|^2 + nodes |c - c_n|^2 = L^2
#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "core/tensor/dense.hpp"
#include "mechanics/linear/krylov.hpp"
#include "mechanics/solve/statics.hpp"

namespace langer {

namespace {

constexpr double arc_reached = 1e-7;     // of its length
constexpr double volume_reached = 1e-9;  // of the largest volume that is given

// A movement of the body, with contact, for trial values of the unknowns of the border.
struct BorderPoint {
  VecX x;           // change of t, and under force control of the travel [mm]
  VecX miss;        // of their equations
  double open = 0;  // the larger miss, that of the force relative to the force
  VecX du;
  Reactions r;
};
using MoveAt = std::function<std::optional<BorderPoint>(const VecX& x)>;

// Where no equation is missed, by Newton's method from 0. Its matrix is made of differences over
// `probe`, and corrected by Broyden's update where the contact changes on the way. Nothing where
// the next correction would not find the rest.
std::optional<BorderPoint> root_of(const MoveAt& at, const VecX& probe) {
  constexpr double exact = 1e-11;
  constexpr double enough = 1e-3;
  constexpr int most = 30;
  const Eigen::Index n = probe.size();
  std::optional<BorderPoint> here = at(VecX::Zero(n));
  MatX slopes(n, n);
  bool known = false;      // the slopes
  bool of_before = false;  // they are corrected ones
  for (int i = 0; i < most && here && here->open > exact; ++i) {
    for (Eigen::Index k = 0; k < n && !known; ++k) {
      VecX x = here->x;
      x[k] += probe[k];
      const std::optional<BorderPoint> moved = at(x);
      if (!moved) return std::nullopt;
      slopes.col(k) = (moved->miss - here->miss) / probe[k];
    }
    of_before = std::exchange(known, true);
    const VecX step = Lu(slopes).solve(-here->miss);
    if (!step.allFinite()) break;
    std::optional<BorderPoint> next;
    double share = 1;
    for (; share > 0.02; share *= 0.5) {
      next = at(here->x + share * step);
      if (next && next->miss.norm() < (1 - 0.1 * share) * here->miss.norm()) break;
    }
    if (share > 0.02) {
      const VecX taken = next->x - here->x;
      const VecX unforeseen = next->miss - here->miss - slopes * taken;
      slopes += unforeseen * taken.transpose() / taken.squaredNorm();
      here = std::move(next);
    } else if (of_before) {
      known = false;
    } else {
      break;
    }
  }
  if (here && here->open <= enough) return here;
  return std::nullopt;
}

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
  arc.nodes = nodes;
  if (towards) arc.towards = *towards;
  arc_ = arc;
  begin_border();
  begin_contact_of_arc();
}

void Statics::begin_along(const VecX& mode, double amplitude) {
  begin(now_.t);
  arc_ = Arc{amplitude, 0, mode, amplitude * mode};
  begin_border();
  begin_contact_of_arc();
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
  begin_contact_of_arc();
}

// How far each indenter goes from t0 to t1 [mm].
std::vector<Vec3> Statics::moves_of_indenters(double t0, double travel0, double t1,
                                              double travel1) const {
  std::vector<Vec3> moves = indenters(t1, travel1);
  const std::vector<Vec3> from = indenters(t0, travel0);
  for (std::size_t k = 0; k < moves.size(); ++k) moves[k] -= from[k];
  return moves;
}

// The scalar product of two movements of the nodes and the indenters.
double Statics::arc_product(const VecX& u, const std::vector<Vec3>& c, const VecX& du,
                            const std::vector<Vec3>& dc) const {
  double product = u.dot(du);
  for (std::size_t k = 0; k < c.size(); ++k) product += arc_->nodes * c[k].dot(dc[k]);
  return product;
}

// Whether s times the last increment takes an open candidate through an indenter. Between
// deformable surfaces that is not looked at.
bool Statics::contact_closes(double s) const {
  if (!bodies_.empty()) return true;
  const std::vector<Vec3> c = indenters(now_.t + s * (now_.t - before_.t),
                                        now_.travel + s * (now_.travel - before_.travel));
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    for (std::size_t i = 0; i < contacts_[k].nodes.size(); ++i) {
      if (!now_.r[k][i].isZero(0)) continue;
      const int node = contacts_[k].nodes[i];
      const Vec3 u = now_.u.segment<3>(3 * node);
      const Vec3 moved = u + s * (u - before_.u.segment<3>(3 * node));
      const Vec3 x = equilibrium_.mesh().X[node] + moved - c[k];
      if (shape_at(contacts_[k].shape, x).gap < 0) return true;
    }
  }
  return false;
}

// How far the indenter goes is not known before, so any candidate may close.
void Statics::begin_contact_of_arc() {
  if (contacts_.empty() && bodies_.empty()) return;
  expected_ = u_;
  for (std::size_t k = 0; k < contacts_.size(); ++k)
    if (contacts_[k].mu > 0) slip_from_touch(k, expected_);
  if (!bodies_.empty())
    bodies_.turn(equilibrium_.mesh().X, now_.u, u_ - now_.u, r_, contacts_.size());
  factor_.take_level(equilibrium_, factor_.levels().all());
  factor_serves_ = false;
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
  const std::vector<Vec3> last_c =
      moves_of_indenters(before_.t, before_.travel, now_.t, now_.travel);
  const double last_size = std::sqrt(arc_product(last, last_c, last, last_c));
  if (!(last_size > 0) || arc_->normal.size() > 0) return;
  const double s = arc_->size / last_size;
  if (contact_closes(s)) {
    // The first correction goes in the direction of the last increment, and knows the contact.
    arc_->last = last / last_size;
    arc_->last_c = last_c;
    for (Vec3& c : arc_->last_c) c /= last_size;
    return;
  }
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

// The unknowns of the border are the change of t and, under force control, that of the travel.
// Their equations are the length of the arc and the given force. For given unknowns the contact
// problem is that of an indenter that is moved, which stays regular where the force has an
// extremum.
std::optional<VecX> Statics::solve_arc_with_contact(const VecX& rhs) {
  const double t = t_;
  const double travel = travel_;
  const double size = arc_->size;
  const bool pushed = controlled_ >= 0;
  const Eigen::Index n = pushed ? 2 : 1;
  const VecX moved = u_ - now_.u;
  const std::vector<Vec3> moved_c = moves_of_indenters(now_.t, now_.travel, t_, travel_);
  const double squared = arc_product(moved, moved_c, moved, moved_c);
  // The linearised equation of the arc, relative to its squared length. The first correction goes
  // as far as the arc in the direction of the last increment, and at the beginning of the path in
  // any direction.
  const auto miss_of_arc = [&](const VecX& du, const std::vector<Vec3>& dc) {
    if (arc_->normal.size() > 0) return arc_->normal.dot(moved + du) / size - 1;
    if (squared == 0 && arc_->last.size() > 0)
      return arc_product(arc_->last, arc_->last_c, du, dc) / size - 1;
    if (squared == 0) return std::sqrt(arc_product(du, dc, du, dc)) / size - 1;
    return (arc_product(moved, moved_c, du, dc) - 0.5 * (size * size - squared)) / (size * size);
  };
  VecX probe(n);
  const double last = std::abs(now_.t - before_.t);
  probe[0] = last > 0 ? 0.1 * last : 1e-3;
  if (pushed) probe[1] = 0.01 * size / std::sqrt(arc_->nodes);
  double least_force = 0;  // to which the miss of the force is compared at least [N]
  if (pushed)
    least_force = std::abs(controlled()->control->force.value) * std::max(std::abs(t), probe[0]);
  if (least_force == 0) least_force = 1;
  const auto add_miss_of_force = [&](BorderPoint& point) {
    const ForceControl& control = *controlled()->control;
    double borne = 0;
    for (const Vec3& r : r_next_[static_cast<std::size_t>(controlled_)])
      borne += r.dot(control.along);
    const double given = control.force.at(t_);
    point.miss[1] = (borne - given) / least_force;
    const double largest = std::max({std::abs(borne), std::abs(given), 1e-300});
    point.open = std::max(point.open, std::abs(borne - given) / largest);
  };
  const auto at = [&](const VecX& x) -> std::optional<BorderPoint> {
    t_ = t + x[0];
    if (pushed) travel_ = travel + x[1];
    t_next_ = 0;
    std::optional<BorderPoint> point;
    if (const std::optional<VecX> move = move_with_contact(rhs + x[0] * columns_.front())) {
      point = BorderPoint{x, VecX(n), 0, with_prescribed_dofs(*move), r_next_};
      point->miss[0] = miss_of_arc(point->du, moves_of_indenters(t, travel, t_, travel_));
      point->open = std::abs(point->miss[0]);
      if (pushed) add_miss_of_force(*point);
    }
    t_ = t;
    travel_ = travel;
    return point;
  };

  const std::optional<BorderPoint> here = root_of(at, probe);
  if (!here) return std::nullopt;
  t_next_ = here->x[0];
  travel_next_ = pushed ? here->x[1] : 0;
  r_next_ = here->r;
  return here->du;
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
    const std::vector<Vec3> moved_c = moves_of_indenters(now_.t, now_.travel, t_, travel_);
    double size = std::sqrt(arc_product(moved, moved_c, moved, moved_c));
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
