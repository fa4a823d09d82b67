// Strong ellipticity of an incompressible material in a deformed state: whether every shear wave
// has a real speed.
//   A(n, m) = (m n):c:(m n) + n.sigma n  over unit vectors m normal to n, in the deformed state
//   c  push-forward of D, sigma Cauchy stress, both of the isochoric part: the pressure cancels
//      for m normal to n
// The smallest value [MPa] is the shear modulus at rest; where it is negative, bands of intense
// shear may form and solutions of a mesh depend on the mesh. A value below zero by less than 1e-12
// of the terms that make it is rounding: 0.
#pragma once

#include <span>

#include "mechanics/material/material.hpp"

namespace langer {

struct ShearStiffness {
  double value = 0;  // smallest A [MPa]; NaN where F has no response
  Vec3 n, m;         // wave normal and polarisation in the deformed state
  double size = 0;   // of the terms that A is the sum of [MPa]: what rounding is relative to
};

// F with det F > 0; a volume change counts as 1/J in c and sigma
ShearStiffness smallest_shear_stiffness(const Material& material, const Mat3& F,
                                        std::span<const Vec3> a);

// 1, 0 or -1 where the smallest shear stiffness is positive, zero or negative; NaN where F has no
// response. Where a bound or one negative stiffness decides, the smallest is not looked for.
double sign_of_shear_stiffness(const Material& material, const Mat3& F, std::span<const Vec3> a);

// the smallest over n wave normals only: from above [MPa]
double sampled_shear_stiffness(const Material& material, const Mat3& F, std::span<const Vec3> a,
                               int n);

double without_rounding(double value, double size);

// i-th of n normals spread evenly over the half sphere
Vec3 wave_normal(int i, int n);

}  // namespace langer
