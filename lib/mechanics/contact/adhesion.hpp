// Adhesion of a contact with an intensity beta of its bonds, 1 bonded and 0 free.       [RCC99]
//
// Per reference area of the surface, with the gap g >= 0 and the slip v_t since the node bonded:
//   s = C_N g^2 + C_T |v_t|^2
//   stored  1/2 beta^2 s [N/mm],     force on the body  -d(1/2 beta^2 s)/dx [MPa]
//   -b dbeta/dt = beta s - w  where beta s > w, else 0;    b = 0:  beta = min(beta, w/s)
// With healing, beta also rises to min(1, w/s). Signorini's and Coulomb's laws hold for the rest of
// the contact force. A bond pulled along the normal bears at most sqrt(w C_N), at the gap
// sqrt(w/C_N), and dissipates w in all. A node bonds when it touches, without a force.
// The law holds at the end of an increment (backward Euler): beta minimises
//   1/2 beta^2 s - w beta + 1/2 B (beta - beta_0)^2,     B = b/dt
// so that the force has a potential and its tangent is symmetric.
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
};

struct Adhesive {
  double beta = 0;
  Vec3 force = Vec3::Zero();    // on the body [MPa]
  Mat3 tangent = Mat3::Zero();  // d force/dx, symmetric [MPa/mm]
  double stored = 0;            // [N/mm]
  double dissipated = 0;        // since `bond`: w (beta_0 - beta), and what viscosity takes [N/mm]
};

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
};

// What follows from it, exactly.
struct AdhesiveChange {
  double beta = 0;
  Vec3 force = Vec3::Zero();
};
AdhesiveChange adhesive_change(const Adhesion& law, const ShapePoint& shape, const Vec3& v,
                               const Bond& bond, double viscous, const BondChange& change);

}  // namespace langer
