// A material: the sum of energy terms.                                                [A23] eqs
// 12-20, 30, 44
//   W(C) = sum matrix_i(I1_bar, I2_bar or stretches) + sum fibre_k(I_k) + volume(J)
//   I_k = kappa I1_bar + (1 - 3 kappa) I4_bar_k = I3^(-1/3) M:C,  M = kappa I + (1 - 3 kappa) a a^T       [GOH06]
//   S = 2 dW/dC,  D = 4 d2W/dC2
//   C   right Cauchy-Green tensor (3,3);  a  unit fibre direction of each family in the reference
//       state
//   S   second Piola-Kirchhoff stress [MPa], components;  D  (6,6) [MPa], S = D E with engineering
//       shear in E
// The fibre acts where I_k >= 1 (default, W is C1) or where M:C >= 1 (the paper's eq. 16; S jumps
// when J != 1).
#pragma once

#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "core/base/fields.hpp"
#include "core/tensor/types.hpp"
#include "mechanics/material/arruda_boyce.hpp"
#include "mechanics/material/fibre.hpp"
#include "mechanics/material/gent.hpp"
#include "mechanics/material/mooney_rivlin.hpp"
#include "mechanics/material/neo_hooke.hpp"
#include "mechanics/material/ogden.hpp"
#include "mechanics/material/viscous.hpp"
#include "mechanics/material/volume.hpp"
#include "mechanics/material/yeoh.hpp"

namespace langer {

// Each alternative has `static constexpr Invariant of`; those of one invariant are an EnergyTerm.
using MatrixTerm =
    std::variant<NeoHooke, Yeoh, YeohI2, MooneyRivlin, Signorini, Ogden, ArrudaBoyce, Gent>;

double shear_modulus(const MatrixTerm& term);  // at rest [MPa]

struct Material {
  std::vector<MatrixTerm> matrix;
  std::vector<Fibre> fibres;
  Volume volume;
  std::optional<std::vector<ViscousBranch>> viscous = {};
  std::optional<Spectrum> spectrum = {};
  static void fields(auto& v) {
    v(&Material::matrix, "matrix", unit::none, "isotropic terms; several are summed", required);
    v(&Material::fibres, "fibres", unit::none, "fibre families; none means an isotropic material");
    v(&Material::volume, "volume", unit::none, "how volume change is resisted", required);
    v(&Material::viscous, "viscous", unit::none,
      "branches that relax; matrix and fibres then describe the material after all have relaxed. A scene with a branch needs path.seconds");
    v(&Material::spectrum, "spectrum", unit::none,
      "instead of viscous, or in addition: one branch for each decade from tau1 to tau2");
  }
  std::vector<Complaint> complaints() const;
};

// those of viscous and of spectrum; none: an elastic law
std::vector<ViscousBranch> branches_of(const Material& material);
inline bool is_viscous(const Material& material) { return material.viscous || material.spectrum; }

double shear_modulus(const Material& material);  // of its matrix at rest [MPa]
inline double bulk_modulus(const Material& material) { return bulk_modulus(material.volume); }

struct Response {
  double W = 0;
  Vec6 S = Vec6::Zero();
  Mat6 D = Mat6::Zero();
};

// M of a family with the direction a, components
Vec6 fibre_tensor(const Fibre& fibre, const Vec3& a);

// of each family [deg], from which mesh/directions.hpp makes the directions in the cells
std::vector<double> fibre_angles(const Material& material);
std::vector<std::vector<double>> fibre_angles(const std::vector<Material>& materials);
// of a specimen of this material alone: unit direction of each family in a frame
std::vector<Vec3> fibre_directions(const Material& material, const Mat3& frame = Mat3::Identity());

// isochoric part: matrix and fibres, no volume term; without tangent D stays zero
Response isochoric(const Material& material, const Mat3& C, std::span<const Vec3> a,
                   bool with_tangent = true);
// S and D with each kind of terms times its factor, as in an increment of viscous branches; W
// without
Response isochoric(const Material& material, const Mat3& C, std::span<const Vec3> a,
                   const Amplified& amplified, bool with_tangent = true);

// all terms; J_minus_1 where it is known without cancellation (tensor/kinematics.hpp)
Response response(const Material& material, const Mat3& C, std::span<const Vec3> a);
Response response(const Material& material, const Mat3& C, double J_minus_1,
                  std::span<const Vec3> a);

}  // namespace langer
