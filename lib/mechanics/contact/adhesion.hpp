// Adhesion of a contact with an intensity beta of its bonds, 1 bonded and 0 free.       [RCC99]
//
// Per reference area of the surface, with the gap g >= 0 and the slip v_t since the node bonded:
//   s = C_N g^2 + C_T |v_t|^2
//   stored  1/2 beta^2 s [N/mm],     force on the body  -d(1/2 beta^2 s)/dx [MPa]
//   -b dbeta/dt = beta s - w  where beta s > w, else 0;    b = 0:  beta = min(beta, w/s)
// With healing, beta also rises to min(1, w/s). Signorini's and Coulomb's laws hold for the rest of
// the contact force. A bond pulled along the normal bears at most sqrt(w C_N), at the gap
// sqrt(w/C_N), and dissipates w in all. A node bonds when it touches, without a force.
// b = 0, and where a jump is damped: the law holds at the end of an increment, beta minimises
//   1/2 beta^2 s - w beta + 1/2 B (beta - beta_0)^2,     B = b/dt
// b > 0: of second order in dt, by two implicit stages with s on a straight line from s_0 to s_1
// (SDIRK of Alexander, SIAM J. Numer. Anal. 14, 1977), gamma = 1 - 1/sqrt 2, K = dt/b:
//   s_g = s_0 + gamma (s_1 - s_0),     beta_g = (beta_0 + gamma K w)/(1 + gamma K s_g)
//   beta = (beta_0 + (1 - gamma) K (w - beta_g s_g) + gamma K w)/(1 + gamma K s_1)
// for the part of the increment in which the bond comes loose, and at least w/s, where that ends.
// In both cases beta follows from s_1 alone, so that the force has a potential and its tangent is
// symmetric.
#pragma once

#include <limits>

#include "core/base/fields.hpp"
#include "mechanics/contact/shape.hpp"

namespace langer {

struct Adhesion {
  double work = 0, stiffness = 0, tangential = 0, viscosity = 0;
  bool healing = false;
  static void fields(auto& v) {
    v(&Adhesion::work, "work", "N/mm",
      "w, taken by a unit of bonded area that comes loose; 0: no adhesion", required, at_least(0));
    v(&Adhesion::stiffness, "stiffness", "MPa/mm",
      "C_N of the bonds against opening; they bear at most sqrt(work stiffness), at the gap sqrt(work/stiffness)",
      required, positive);
    v(&Adhesion::tangential, "tangential", "MPa/mm", "C_T of the bonds against sliding; 0: none",
      at_least(0));
    v(&Adhesion::healing, "healing", unit::none,
      "bonds come back where the surfaces come back; false: what came loose stays so");
    v(&Adhesion::viscosity, "viscosity", "N s/mm",
      "b: bonds above their threshold come loose at the rate (beta s - w)/b; 0: at once. Above 0 with path.seconds",
      at_least(0));
  }
  bool operator==(const Adhesion&) const = default;
};

// A candidate's state.
struct Bond {
  double beta = 0;
  Vec3 at =
      Vec3::Zero();   // where it bonded: displacement of the node less that of the indenter [mm]
  bool made = false;  // has touched
  // s at the beginning of the increment [N/mm]; below 0: not known, and backward Euler is taken
  double opening = -1;
};

struct Adhesive {
  double beta = 0;
  Vec3 force = Vec3::Zero();    // on the body [MPa]
  Mat3 tangent = Mat3::Zero();  // d force/dx, symmetric [MPa/mm]
  double stored = 0;            // [N/mm]
  double dissipated = 0;        // since `bond`: w (beta_0 - beta), and what viscosity takes [N/mm]
  double error = 0;  // of beta by the length of the increment, about; only of second order
};

// s of the law at a place: v as below [N/mm]
double opening(const Adhesion& law, const ShapePoint& shape, const Vec3& v, const Bond& bond);

// v: displacement of the node less that of the indenter; viscous: B [N/mm], infinite: the bond
// stays as it is
Adhesive adhesive(const Adhesion& law, const ShapePoint& shape, const Vec3& v, const Bond& bond,
                  double viscous);

// What a number of the scene changes at a bond, per unit of the number.
struct BondChange {
  double beta = 0;  // at the beginning of the increment
  Vec3 at = Vec3::Zero();
  Vec3 v = Vec3::Zero();
  Adhesion law = {};  // of its numbers
  double viscous = 0;
  // of gap, normal and curvature at the place of the node, which moves by v
  ShapePoint shape = {0, Vec3::Zero(), Mat3::Zero()};
  double opening = 0;  // at the beginning of the increment
};

// What follows from it, exactly.
struct AdhesiveChange {
  double beta = 0;
  double opening = 0;  // s at the end
  Vec3 force = Vec3::Zero();
};
AdhesiveChange adhesive_change(const Adhesion& law, const ShapePoint& shape, const Vec3& v,
                               const Bond& bond, double viscous, const BondChange& change);

}  // namespace langer
