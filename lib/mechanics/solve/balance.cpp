// Whether the trial state of an increment is in equilibrium: its residual on the free rows, the
// forces it is compared with, the law of contact and the prescribed displacements. And how a
// correction moves it.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/stopwatch.hpp"
#include "mechanics/solve/statics.hpp"

namespace langer {

VecX Statics::remaining_prescribed(const VecX& u) const {
  VecX du = VecX::Zero(u.size());
  for (const Prescribed& p : equilibrium_.dofs().prescribed) du[p.dof] = p.at(t_) - u[p.dof];
  return du;
}

bool Statics::prescribed_reached(const VecX& u, const VecX& remaining) const {
  const double size = 0.1 * scale_.length + u.lpNorm<Eigen::Infinity>();
  return remaining.lpNorm<Eigen::Infinity>() <= 1e-14 * size;
}

VecX Statics::on_free_rows(const VecX& all) const {
  const Dofs& dofs = equilibrium_.dofs();
  VecX free(dofs.n_free());
  for (int row = 0; row < dofs.n_free(); ++row) free[row] = all[dofs.free[row]];
  return free;
}

VecX Statics::free_residual() const {
  VecX f = -equilibrium_.f_int();
  if (!equilibrium_.loads().empty()) f += equilibrium_.f_ext();
  if (!bonds_.none()) bonds_.add_forces(f);
  for (std::size_t k = 0; k < contacts_.size(); ++k)
    for (std::size_t i = 0; i < contacts_[k].nodes.size(); ++i)
      f.segment<3>(3 * contacts_[k].nodes[i]) += r_[k][i];
  if (!bodies_.empty()) bodies_.add_forces(equilibrium_.mesh().X, u_, r_, contacts_.size(), f);
  return on_free_rows(f);
}

// Norm of reactions, contact forces and loads: the size to which a residual is compared.
double Statics::force_scale() const {
  double sum = 0;
  for (const Prescribed& p : equilibrium_.dofs().prescribed)
    sum += std::pow(equilibrium_.f_int()[p.dof], 2);
  for (const auto& r : r_)
    for (const Vec3& r_i : r) sum += r_i.squaredNorm();
  if (!equilibrium_.loads().empty()) sum += equilibrium_.f_ext().squaredNorm();
  if (!bonds_.none()) sum += bonds_.squared_norm();
  if (options_.inertia) sum += std::pow(options_.inertia->force_scale(), 2);
  return std::sqrt(sum);
}

// Penetration, complementarity and Coulomb's cone at every candidate, to the tolerances.
bool Statics::contact_law_holds(const VecX& u) const {
  const auto is_broken = [&](const ContactDefect& d) {
    return d.penetration > gap_tolerance_ || d.complementarity > options_.law_tolerance ||
           d.cone > options_.law_tolerance;
  };
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const ContactDefect d = contact_defect(contacts_[k], equilibrium_.mesh().X, u, u_start_[k],
                                           indenter_displacement(contacts_[k], t_, travel_),
                                           indenter_displacement(contacts_[k], now_.t, now_.travel),
                                           r_[k], motion(now_.t));
    if (is_broken(d)) return false;
  }
  if (bodies_.empty()) return true;
  for (const ContactDefect& d :
       bodies_.defects(equilibrium_.mesh().X, u, now_.u, r_, contacts_.size(), motion(now_.t)))
    if (is_broken(d)) return false;
  return true;
}

// Whether the reactions of the indenter under force control sum up to the prescribed force.
bool Statics::force_is_given() const {
  const ForceControl& control = *controlled()->control;
  Vec3 sum = Vec3::Zero();
  const double given = required_force();
  double size = std::abs(given);
  for (const Vec3& r : r_[static_cast<std::size_t>(controlled_)]) {
    sum += r;
    size = std::max(size, r.norm());
  }
  // Rounding of the travel of an indenter with mass.
  const double rounding = 32 * std::numeric_limits<double>::epsilon() * force_falls() *
                          (std::abs(travel_) + std::abs(now_.travel));
  return std::abs(sum.dot(control.along) - given) <= options_.law_tolerance * size + rounding;
}

// Residual (and tangent) at u, and the first condition of equilibrium that does not hold.
Assessment Statics::assess(const VecX& u, bool with_tangent) {
  const Stopwatch watch(cost_.assembly);
  Assessment out;
  const VecX du = remaining_prescribed(u);
  const VecX direction = imposed_direction(u);
  if (std::exchange(unsettled_, false)) equilibrium_.pressures_from(u);
  out.admissible = equilibrium_.assemble(u, with_tangent, &direction);
  K_current_ = with_tangent;
  if (!out.admissible) {
    if (equilibrium_.J_min() > 0) {
      out.missing =
          "a force is not finite: the exponential of a fibre overflows where c2 (I4_bar - 1)^2 > 300, or the start "
          "of the step is too far away";
    } else {
      out.missing = "an element is turned inside out";
    }
    return out;
  }
  if (!bonds_.none()) bonds_.evaluate(equilibrium_.mesh().X, u, indenters(t_, travel_));
  out.residual = free_residual().norm();
  out.reference = force_scale();
  out.floor = 3 * equilibrium_.rounding_floor();
  if (equilibrium_.conserves()) {
    // An increment has the rounding of both of its ends; of a body that turns, displacements are as
    // large as the body, and what rounds is not only the volume, but also 4 M (u_m - u0) / h^2.
    const VecX rounded = std::numeric_limits<double>::epsilon() * u.cwiseAbs();
    out.floor = 2 * (out.floor + scale_.least_force) +
                on_free_rows(options_.inertia->tangent_times(rounded)).norm();
  }
  if (!contact_law_holds(u))
    out.missing = "the contact law does not hold";
  else if (controlled_ >= 0 && !force_is_given())
    out.missing = "the force on the indenter is not the given one";
  else if (!prescribed_reached(u, du))
    out.missing = "prescribed displacements not reached";
  else if (bordered())
    out.missing = border_defect(u);
  if (out.missing.empty() && factor_.held_by_contact() && slips_away())
    out.missing = "the body slips away from under the indenter, and nothing else holds it";
  out.others = out.missing.empty();
  return out;
}

// A body held by contact alone has lost it: no candidate carries a force, but in the state where
// the increment began, one would penetrate.
bool Statics::slips_away() const {
  bool in_the_way = false;
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const Vec3 c = indenter_displacement(contacts_[k], t_, travel_);
    for (std::size_t i = 0; i < r_[k].size(); ++i) {
      if (!r_[k][i].isZero(0)) return false;
      const int node = contacts_[k].nodes[i];
      const Vec3 x = equilibrium_.mesh().X[node] + now_.u.segment<3>(3 * node);
      in_the_way = in_the_way || shape_at(contacts_[k].shape, x - c).gap < -gap_tolerance_;
    }
  }
  return in_the_way;
}

// Whether elements keep their orientation: a cheap test before a state is assembled. Of an
// increment that is solved in its middle, at its end.
bool Statics::admissible(const VecX& u) const {
  if (!u.allFinite()) return false;
  if (equilibrium_.conserves()) return equilibrium_.smallest_J(2 * u - now_.u) > 0.02;
  return equilibrium_.smallest_J(u) > 0.02;
}

// Called before u becomes u + step du: pressures, travel and contact reactions follow. Reactions
// turn with the normal of a curved indenter, which keeps them inside Coulomb's cone.
void Statics::moved(const VecX& du, double step) {
  const Stopwatch watch(cost_.assembly);
  if (dp_.size() > 0)
    equilibrium_.move_pressures(dp_, step);
  else
    equilibrium_.predict_pressures(du, step, again_);
  const std::vector<Vec3>& X = equilibrium_.mesh().X;
  // the law was linearised at the end of an arc, and else where the indenter is
  const double dt = arc_ ? t_next_ : 0;
  const double d_travel = arc_ ? travel_next_ : 0;
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const Vec3 c = indenter_displacement(contacts_[k], t_ + dt, travel_ + d_travel);
    const Vec3 end =
        indenter_displacement(contacts_[k], t_ + step * dt, travel_ + step * travel_next_);
    const Vec3 dc = end - c;
    for (std::size_t i = 0; i < r_[k].size(); ++i) {
      if (r_next_[k][i].isZero(0) && r_[k][i].isZero(0)) continue;
      const int node = contacts_[k].nodes[i];
      const Vec3 x = X[node] + u_.segment<3>(3 * node) - c;
      const Vec3 moved_x = x + step * du.segment<3>(3 * node) - dc;
      Vec3 r = r_next_[k][i];
      if (step != 1) r = r_[k][i] + step * (r_next_[k][i] - r_[k][i]);
      r_[k][i] = turn_with_normal(r, shape_at(contacts_[k].shape, x).normal,
                                  shape_at(contacts_[k].shape, moved_x).normal);
    }
  }
  if (bordered()) move_border(step);
  if (!bodies_.empty()) {
    for (std::size_t k = contacts_.size(); k < r_.size(); ++k)
      for (std::size_t i = 0; i < r_[k].size(); ++i) r_[k][i] += step * (r_next_[k][i] - r_[k][i]);
    bodies_.turn(X, u_, step * du, r_, contacts_.size());
  }
  if (controlled_ >= 0) travel_ += step * travel_next_;
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const bool follows_travel = starts_with_travel() && static_cast<int>(k) == controlled_;
    if (contacts_[k].mu > 0 && (arc_ || follows_travel)) slip_from_touch(k, expected_);
  }
}

}  // namespace langer
