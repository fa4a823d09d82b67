// Homogeneous states that tests impose on a thin incompressible sheet in the plane of its fibres, x
// and z; y is the thickness, free of stress.
//   F = [lambda_x 0 g; 0 1/(lambda_x lambda_z) 0; 0 0 lambda_z]    a line along x stays along x
//   uniaxial      lambda_x; lambda_z such that sigma_zz = 0          equibiaxial  lambda_x = lambda_z
//   pure_shear    lambda_x; lambda_z = 1                             biaxial      lambda_x and lambda_z
//   simple_shear  g, lambda_x = lambda_z = 1
// Fibres off the axes tend to shear the sheet: g = 0 if the shear is held, sigma_xz = 0 if it is
// free. Unknown stretches are those of the minimum of the energy that is reached downhill from the
// isotropic answer. Nothing is thrown.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mechanics/material/material.hpp"
#include "mechanics/material/uniaxial.hpp"
#include "mechanics/material/viscous_point.hpp"

namespace langer {

enum class TestKind { uniaxial, equibiaxial, biaxial, pure_shear, simple_shear };
constexpr auto names(TestKind) {
  return std::array{"uniaxial", "equibiaxial", "biaxial", "pure_shear", "simple_shear"};
}

enum class OffAxisShear { held, free };
constexpr auto names(OffAxisShear) { return std::array{"held", "free"}; }

struct PlaneState {
  Mat3 F = Mat3::Identity();
  Mat3 sigma = Mat3::Zero();  // [MPa], sigma_yy = 0
  double W = 0;
  bool converged = false;
};

// first: lambda_x, or g in simple shear; second: lambda_z of a biaxial test, else unused. memory:
// of an increment of a viscous point, whose W is then the potential of the increment
PlaneState plane_state(const Material& material, std::span<const Vec3> a, TestKind kind,
                       double first, double second = 1, OffAxisShear shear = OffAxisShear::held,
                       const PointMemory* memory = nullptr);

// what a test measures [MPa]: the x component and the z component (simple shear: the xz component
// and 0)
std::array<double, 2> measured_stress(const PlaneState& state, TestKind kind,
                                      StressMeasure measure);

// fibre directions of a specimen cut at an angle: added to every family's own
std::vector<Vec3> specimen_fibres(const Material& material, double angle_deg);

}  // namespace langer
