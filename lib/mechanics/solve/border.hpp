// Unknowns that are no displacements, each with an equation of its own: the border of the tangent.
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
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mechanics/solve/increment_state.hpp"

namespace langer {

// Of an increment of which t is an unknown: sphere |u - u_n| = size around the accepted state, or
// plane  normal . (u - u_n) = size.
struct Arc {
  double size = 0;                // [mm], of the vector of all dofs
  double nodes = 0;               // the weight of the squared movement of an indenter
  VecX normal = {};               // of a plane; empty for a sphere
  VecX towards = {};              // of the beginning; may be empty
  VecX last = {};                 // where contact closes: the movement of the last increment
  std::vector<Vec3> last_c = {};  // and of the indenters in it
};

// What the linearised body answers to the border.
struct LinearAnswers {
  std::function<VecX(const VecX& forces)> movement;  // of the free rows, without contact
  std::function<std::optional<VecX>(const VecX& forces)> movement_with_contact;
  std::function<VecX(const VecX& free)> all_dofs;  // (3 n), with the prescribed ones
};

class Border {
 public:
  explicit Border(IncrementState& state)
      : state_(state),
        body_(state.body),
        now_(state.now),
        before_(state.before),
        trial_(state.trial),
        next_(state.next) {}

  bool active() const { return arc_.has_value() || trial_.pressures.size() > 0; }
  const std::optional<Arc>& arc() const { return arc_; }
  void leave_arc() { arc_.reset(); }
  // Starts an increment along an arc: its trial state.
  void begin(const Arc& arc);
  void take_pressures_of(const BodyState& state);

  VecX imposed_direction(const VecX& u) const;  // what K_du() of the next assembly is of
  const VecX& rates() const { return rates_; }  // (3 n) of imposed displacements, per t
  // Forces of 1 MPa on each surface of a given volume, on the free rows.
  std::vector<VecX> volume_gradients() const;

  void update();  // at the trial, after its assembly
  // Completes the movement of the free rows, where no contact is near.
  void solve(VecX& move, const LinearAnswers& body);
  // The movement of all dofs with contact on an arc.
  std::optional<VecX> solve_with_contact(const VecX& rhs, const LinearAnswers& body);
  void move(double step);
  // The equation of the border that does not hold yet; empty if all do.
  std::string defect(const VecX& u) const;

 private:
  double product(const VecX& u, const std::vector<Vec3>& c, const VecX& du,
                 const std::vector<Vec3>& dc) const;
  bool contact_closes(double s) const;
  double arc_step(const VecX& a, const VecX& b) const;

  IncrementState& state_;
  Assembler& body_;
  const BodyState &now_, &before_;
  TrialState& trial_;
  Correction& next_;
  std::optional<Arc> arc_;
  VecX rates_;
  VecX column_;  // (free) forces per unit of t
};

}  // namespace langer
