// Uniaxial tension or compression along x of a homogeneous state: F diagonal, sigma_yy = sigma_zz =
// 0. Stands for eq. 34 of [A23], whose signs and missing pressure make it negative at every strain.
//   lambda  stretch along x, > 0;  sigma  Cauchy stress along x [MPa]
// With fibres off the axes the shear strains are held at zero ("F diagonal"), as in the one-element
// test of [A23]. Unknowns: ln J and ln lambda_z, found as the lowest energy downhill from the
// isotropic answer, so that J - 1 keeps its digits for any d and a soft (c1 < 0) material does not
// end on a maximum. Reports converged = false where no state is found: nothing is thrown.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mechanics/material/material.hpp"

namespace langer {

struct Uniaxial {
  Vec3 stretch = Vec3::Ones();  // lambda_x, lambda_y, lambda_z
  double J_minus_1 = 0;
  double sigma = 0;  // [MPa]
  bool converged = false;
};

// the volume term counts
Uniaxial uniaxial(const Material& material, double lambda);

// d -> 0: the volume term is left out
Uniaxial uniaxial_incompressible(const Material& material, double lambda);

enum class Dilatation { incompressible, compressible };
constexpr auto names(Dilatation) { return std::array{"incompressible", "compressible"}; }

// force over the deformed area, over the reference area:  nominal = cauchy J/lambda,  second
// Piola-Kirchhoff = nominal/lambda
enum class StressMeasure { cauchy, nominal, second_piola };
constexpr auto names(StressMeasure) { return std::array{"cauchy", "nominal", "second_piola"}; }

// Stresses [MPa] at engineering strains lambda - 1; nothing if one of the states does not exist.
std::optional<std::vector<double>> uniaxial_curve(const Material& material,
                                                  std::span<const double> strain,
                                                  StressMeasure measure, Dilatation dilatation);

}  // namespace langer
