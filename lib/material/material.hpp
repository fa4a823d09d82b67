// A material: the sum of energy terms.                                                [A23] eqs 12-20, 30, 44
//   W(C) = sum matrix_i(I1_bar, I2_bar or stretches) + sum fibre_k(I_k) + volume(J)
//   I_k = kappa I1_bar + (1 - 3 kappa) I4_bar_k = I3^(-1/3) M:C,  M = kappa I + (1 - 3 kappa) a a^T       [GOH06]
//   S = 2 dW/dC,  D = 4 d2W/dC2
//   C   right Cauchy-Green tensor (3,3);  a  unit fibre direction of each family in the reference state
//   S   second Piola-Kirchhoff stress [MPa], components;  D  (6,6) [MPa], S = D E with engineering shear in E
// The fibre acts where I_k >= 1 (default, W is C1) or where M:C >= 1 (the paper's eq. 16; S jumps when J != 1).
#pragma once

#include <span>
#include <variant>
#include <vector>

#include "base/fields.hpp"
#include "material/arruda_boyce.hpp"
#include "material/gent.hpp"
#include "material/hgo_fibre.hpp"
#include "material/mooney_rivlin.hpp"
#include "material/neo_hooke.hpp"
#include "material/ogden.hpp"
#include "material/quadratic_volume.hpp"
#include "material/yeoh.hpp"
#include "tensor/invariants.hpp"
#include "tensor/types.hpp"

namespace langer {

// Each alternative has `static constexpr Invariant of`; those of one invariant are an EnergyTerm.
using MatrixTerm = std::variant<NeoHooke, Yeoh, YeohI2, MooneyRivlin, Signorini, Ogden, ArrudaBoyce, Gent>;

double shear_modulus(const MatrixTerm& term);  // at rest [MPa]

enum class FibreSwitch { I4_bar, I4, off };  // off: the fibre also acts in compression
constexpr auto names(FibreSwitch) { return std::array{"I4_bar", "I4", "off"}; }

struct Fibre {
  HgoFibre hgo;
  double alpha_deg = 0;
  FibreSwitch tension_switch = FibreSwitch::I4_bar;
  double kappa = 0;
  static void fields(auto& v) {
    v(&Fibre::hgo, "hgo", unit::none, "exponential fibre energy, eq. 14", required);
    v(&Fibre::alpha_deg, "alpha", unit::deg, "angle between the fibres and the frame's x axis, in the x-z plane, eq. 1",
      between(-360, 360));
    v(&Fibre::tension_switch, "switch", unit::none,
      "which invariant decides that the fibre is stretched; the paper prints I4, eq. 16");
    v(&Fibre::kappa, "kappa", unit::none, "dispersion: 0 all fibres along the direction, 1/3 no direction at all",
      between(0, 1. / 3));
  }
};

struct Volume {
  QuadraticVolume quadratic;
  static void fields(auto& v) { v(&Volume::quadratic, "quadratic", unit::none, "(J-1)^2/d, eq. 15", required); }
};

struct Material {
  std::vector<MatrixTerm> matrix;
  std::vector<Fibre> fibres;
  Volume volume;
  static void fields(auto& v) {
    v(&Material::matrix, "matrix", unit::none, "isotropic terms; several are summed", required);
    v(&Material::fibres, "fibres", unit::none, "fibre families; none means an isotropic material");
    v(&Material::volume, "volume", unit::none, "how volume change is resisted", required);
  }
};

double shear_modulus(const Material& material);  // of its matrix at rest [MPa]

struct Response {
  double W = 0;
  Vec6 S = Vec6::Zero();
  Mat6 D = Mat6::Zero();
};

// M of a family with the direction a, components
inline Vec6 fibre_tensor(const Fibre& fibre, const Vec3& a) {
  return fibre.kappa * identity6() + (1 - 3 * fibre.kappa) * structural_tensor(a);
}

// reference direction of each family in a frame: a = cos(alpha) e_x + sin(alpha) e_z        [A23] eq. 1
std::vector<Vec3> fibre_directions(const Material& material, const Mat3& frame = Mat3::Identity());

// isochoric part: matrix and fibres, no volume term; without tangent D stays zero
Response isochoric(const Material& material, const Mat3& C, std::span<const Vec3> a, bool with_tangent = true);

// all terms; J_minus_1 where it is known without cancellation (tensor/kinematics.hpp)
Response response(const Material& material, const Mat3& C, std::span<const Vec3> a);
Response response(const Material& material, const Mat3& C, double J_minus_1, std::span<const Vec3> a);

}  // namespace langer
