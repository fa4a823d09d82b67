// A layer that is stretched homogeneously in its plane, and how stiff it is against small motions
// on top of that.
//
// Skin lies in the plane x, z; y is the depth. All layers share the in-plane deformation; each
// chooses its own thickness stretch so that its faces carry no normal stress:
//   F = [F11 0 F13; 0 lambda_y 0; F31 0 F33],   sigma_yy = 0
// A small motion u(x) changes the energy per deformed volume by 1/2 A_ipjq u_i,p u_j,q:
//   A_ipjq = c_ipjq + sigma_pq delta_ij + p (delta_iq delta_jp - [compressible] delta_ip delta_jq)
//   c = push-forward of D, sigma = isochoric Cauchy stress, p such that sigma_yy - p = 0
// The volume change is kept by a pressure: div u = 0, or div u + q / (J U'') = 0.
// References: Ogden (1984), Non-linear elastic deformations, ch. 6; Dowaikh and Ogden (1990), IMA
// J. Appl. Math. 44.
#pragma once

#include <string>
#include <vector>

#include "mechanics/material/material.hpp"
#include "mechanics/material/uniaxial.hpp"

namespace langer {

using PlaneDeformation = Eigen::Matrix2d;    // rows and columns x, z
using Moduli = Eigen::Matrix<double, 9, 9>;  // row 3 i + p: of u_i,p [MPa]

struct Layer {
  std::string name;
  Material material;
  std::vector<Vec3> fibres;                             // directions at rest, in the plane
  double thickness = 0;                                 // at rest [mm]; infinite: a half-space
  double density = 0;                                   // at rest [t/mm3]
  PlaneDeformation own = PlaneDeformation::Identity();  // before it was joined to the others
};

// Moduli of a viscous branch that has relaxed: times i w tau / (1 + i w tau).
struct BranchModuli {
  double tau = 0;  // [s]
  Moduli A;
};

struct LayerState {
  double thickness = 0;  // deformed [mm]
  double density = 0;    // deformed [t/mm3]
  Moduli A = Moduli::Zero();
  double bulk = 0;  // J U'' [MPa]; 0: incompressible
  std::vector<BranchModuli> branches;
  Mat3 F = Mat3::Identity();
  Mat3 sigma = Mat3::Zero();  // Cauchy stress [MPa], sigma_yy = 0
  bool exists = false;
};

// F2: of all layers together. Nothing is thrown: exists = false where the law has no state.
LayerState layer_state(const Layer& layer, const PlaneDeformation& F2, Dilatation dilatation);

// rho c^2 [MPa] of plane waves along the unit vector n, ascending: the two shear waves, and the
// pressure wave where the law is compressible. Elastic moduli alone.
std::vector<double> body_waves(const LayerState& state, const Vec3& n);

}  // namespace langer
