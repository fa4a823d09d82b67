#include "mechanics/solve/border.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/tensor/dense.hpp"

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

void Border::take_pressures_of(const BodyState& state) {
  const int n = body_.loads().n_volumes();
  if (n == 0) return;
  if (state.pressures.size() == n) {
    trial_.pressures = state.pressures;
  } else {
    trial_.pressures = VecX::Zero(n);
  }
  body_.set_load_pressures(trial_.pressures);
}

// The scalar product of two movements of the nodes and the indenters.
double Border::product(const VecX& u, const std::vector<Vec3>& c, const VecX& du,
                       const std::vector<Vec3>& dc) const {
  double product = u.dot(du);
  for (std::size_t k = 0; k < c.size(); ++k) product += arc_->nodes * c[k].dot(dc[k]);
  return product;
}

// Whether s times the last increment takes an open candidate through an indenter. Between
// deformable surfaces that is not looked at.
bool Border::contact_closes(double s) const {
  if (!state_.surfaces.empty()) return true;
  const std::vector<Vec3> c = state_.indenters(now_.t + s * (now_.t - before_.t),
                                               now_.travel + s * (now_.travel - before_.travel));
  for (std::size_t k = 0; k < state_.contacts.size(); ++k) {
    for (std::size_t i = 0; i < state_.contacts[k].nodes.size(); ++i) {
      if (!now_.r[k][i].isZero(0)) continue;
      const int node = state_.contacts[k].nodes[i];
      const Vec3 u = now_.u.segment<3>(3 * node);
      const Vec3 moved = u + s * (u - before_.u.segment<3>(3 * node));
      const Vec3 x = body_.mesh().X[node] + moved - c[k];
      if (shape_at(state_.contacts[k].shape, x).gap < 0) return true;
    }
  }
  return false;
}

// The trial state of an arc: towards a given direction, else along the last increment. The first
// one of a path has neither: its first correction takes the direction of the loads.
void Border::begin(const Arc& arc) {
  arc_ = arc;
  rates_ = VecX::Zero(trial_.u.size());
  for (const Prescribed& p : body_.dofs().prescribed) rates_[p.dof] = p.rate(1);
  if (arc_->towards.size() > 0) {
    const VecX step = std::abs(arc_->size) / arc_->towards.norm() * arc_->towards;
    body_.assemble(now_.u, true);
    if (!state_.admissible(now_.u + step)) return;
    body_.predict_pressures(step, 1);
    trial_.u = now_.u + step;
    return;
  }
  const VecX last = now_.u - before_.u;
  const std::vector<Vec3> last_c =
      state_.moves_of_indenters(before_.t, before_.travel, now_.t, now_.travel);
  const double last_size = std::sqrt(product(last, last_c, last, last_c));
  if (!(last_size > 0) || arc_->normal.size() > 0) return;
  const double s = arc_->size / last_size;
  if (contact_closes(s)) {
    // The first correction goes in the direction of the last increment, and knows the contact.
    arc_->last = last / last_size;
    arc_->last_c = last_c;
    for (Vec3& c : arc_->last_c) c /= last_size;
    return;
  }
  if (!state_.options.extrapolate || !state_.admissible(now_.u + s * last)) return;
  body_.extrapolate_pressures(before_.u, s);
  trial_.u = now_.u + s * last;
  trial_.t = now_.t + s * (now_.t - before_.t);
  trial_.travel = now_.travel + s * (now_.travel - before_.travel);
  body_.load_to(trial_.t);
}

VecX Border::imposed_direction(const VecX& u) const {
  if (arc_) return rates_;
  return state_.remaining_prescribed(u);
}

std::vector<VecX> Border::volume_gradients() const {
  std::vector<VecX> rows;
  for (int i = 0; i < body_.loads().n_volumes(); ++i)
    rows.push_back(state_.on_free_rows(body_.unit_pressure(i, trial_.u)));
  return rows;
}

// Forces per unit of each unknown, at the trial. Loads are in proportion to t where t is unknown.
void Border::update() {
  if (!arc_) return;
  VecX column = -body_.K_du();
  if (!body_.loads().empty()) column += body_.load_forces(1, trial_.u);
  column_ = state_.on_free_rows(column);
}

// What the equation of an arc adds to t, where du = a + x b.
double Border::arc_step(const VecX& a, const VecX& b) const {
  const VecX moved = trial_.u - now_.u;
  if (arc_->normal.size() > 0)
    return (arc_->size - arc_->normal.dot(moved + a)) / arc_->normal.dot(b);
  const double squared = moved.squaredNorm();
  if (squared == 0) return arc_->size / b.norm();
  return (0.5 * (arc_->size * arc_->size - squared) - moved.dot(a)) / moved.dot(b);
}

void Border::solve(VecX& move, const LinearAnswers& body) {
  if (arc_) {
    const VecX b = body.movement(column_);
    next_.t = 0;
    const VecX a_all = body.all_dofs(move);
    VecX b_all = rates_;
    for (Eigen::Index row = 0; row < b.size(); ++row) b_all[body_.dofs().free[row]] = b[row];
    next_.t = arc_step(a_all, b_all);
    move += next_.t * b;
    return;
  }
  const auto m = trial_.pressures.size();
  std::vector<VecX> gradients;  // (3 n) of each given volume
  std::vector<VecX> moves;
  MatX M(m, m);
  VecX lacking(m);
  const VecX a_all = body.all_dofs(move);
  for (int i = 0; i < m; ++i) {
    gradients.push_back(body_.unit_pressure(i, trial_.u));
    moves.push_back(body.movement(state_.on_free_rows(gradients.back())));
    lacking[i] = body_.loads().given_volume(i, trial_.t) - body_.swept_volume(i, trial_.u) -
                 gradients.back().dot(a_all);
  }
  for (int i = 0; i < m; ++i) {
    const VecX row = state_.on_free_rows(gradients[static_cast<std::size_t>(i)]);
    for (int j = 0; j < m; ++j) M(i, j) = row.dot(moves[static_cast<std::size_t>(j)]);
  }
  Lu factors;
  factors.compute(M);
  next_.pressures = factors.solve(lacking);
  for (int j = 0; j < m; ++j) move += next_.pressures[j] * moves[static_cast<std::size_t>(j)];
}

// The unknowns of the border are the change of t and, under force control, that of the travel.
// Their equations are the length of the arc and the given force. For given unknowns the contact
// problem is that of an indenter that is moved, which stays regular where the force has an
// extremum.
std::optional<VecX> Border::solve_with_contact(const VecX& rhs, const LinearAnswers& body) {
  const double t = trial_.t;
  const double travel = trial_.travel;
  const double size = arc_->size;
  const bool pushed = state_.controlled_index >= 0;
  const Eigen::Index n = pushed ? 2 : 1;
  const VecX moved = trial_.u - now_.u;
  const std::vector<Vec3> moved_c =
      state_.moves_of_indenters(now_.t, now_.travel, trial_.t, trial_.travel);
  const double squared = product(moved, moved_c, moved, moved_c);
  // The linearised equation of the arc, relative to its squared length. The first correction goes
  // as far as the arc in the direction of the last increment, and at the beginning of the path in
  // any direction.
  const auto miss_of_arc = [&](const VecX& du, const std::vector<Vec3>& dc) {
    if (arc_->normal.size() > 0) return arc_->normal.dot(moved + du) / size - 1;
    if (squared == 0 && arc_->last.size() > 0)
      return product(arc_->last, arc_->last_c, du, dc) / size - 1;
    if (squared == 0) return std::sqrt(product(du, dc, du, dc)) / size - 1;
    return (product(moved, moved_c, du, dc) - 0.5 * (size * size - squared)) / (size * size);
  };
  VecX probe(n);
  const double last = std::abs(now_.t - before_.t);
  probe[0] = last > 0 ? 0.1 * last : 1e-3;
  if (pushed) probe[1] = 0.01 * size / std::sqrt(arc_->nodes);
  double least_force = 0;  // to which the miss of the force is compared at least [N]
  if (pushed)
    least_force =
        std::abs(state_.controlled()->control->force.value) * std::max(std::abs(t), probe[0]);
  if (least_force == 0) least_force = 1;
  const auto add_miss_of_force = [&](BorderPoint& point) {
    const ForceControl& control = *state_.controlled()->control;
    double borne = 0;
    for (const Vec3& r : next_.r[static_cast<std::size_t>(state_.controlled_index)])
      borne += r.dot(control.along);
    const double given = control.force.at(trial_.t);
    point.miss[1] = (borne - given) / least_force;
    const double largest = std::max({std::abs(borne), std::abs(given), 1e-300});
    point.open = std::max(point.open, std::abs(borne - given) / largest);
  };
  const auto at = [&](const VecX& x) -> std::optional<BorderPoint> {
    trial_.t = t + x[0];
    if (pushed) trial_.travel = travel + x[1];
    next_.t = 0;
    std::optional<BorderPoint> point;
    if (const std::optional<VecX> move = body.movement_with_contact(rhs + x[0] * column_)) {
      point = BorderPoint{x, VecX(n), 0, body.all_dofs(*move), next_.r};
      point->miss[0] =
          miss_of_arc(point->du, state_.moves_of_indenters(t, travel, trial_.t, trial_.travel));
      point->open = std::abs(point->miss[0]);
      if (pushed) add_miss_of_force(*point);
    }
    trial_.t = t;
    trial_.travel = travel;
    return point;
  };

  const std::optional<BorderPoint> here = root_of(at, probe);
  if (!here) return std::nullopt;
  next_.t = here->x[0];
  next_.travel = pushed ? here->x[1] : 0;
  next_.r = here->r;
  return here->du;
}

void Border::move(double step) {
  if (arc_) {
    trial_.t += step * next_.t;
    body_.load_to(trial_.t);
    return;
  }
  trial_.pressures += step * next_.pressures;
  body_.set_load_pressures(trial_.pressures);
}

// The equation of the border that does not hold yet; empty if all do.
std::string Border::defect(const VecX& u) const {
  if (arc_) {
    const VecX moved = u - now_.u;
    const std::vector<Vec3> moved_c =
        state_.moves_of_indenters(now_.t, now_.travel, trial_.t, trial_.travel);
    double size = std::sqrt(product(moved, moved_c, moved, moved_c));
    if (arc_->normal.size() > 0) size = arc_->normal.dot(moved);
    if (std::abs(size - arc_->size) > arc_reached * std::abs(arc_->size))
      return "the length of the arc is not the given one";
    return "";
  }
  for (int i = 0; i < trial_.pressures.size(); ++i) {
    const double given = body_.loads().given_volume(i, trial_.t);
    const double largest = std::abs(*body_.loads().volume_load(i).volume);
    if (std::abs(body_.swept_volume(i, u) - given) > volume_reached * largest)
      return "a volume is not the given one";
  }
  return "";
}

}  // namespace langer
