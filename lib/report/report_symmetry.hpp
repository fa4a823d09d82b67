// Symmetries of a sweep over the fibre angle, and how far the results are from them.
//   mirror   a square body under a sphere in its middle: f(α) = f(180 - α)
//   swap     a quarter turn carries A to B: f_A(α) = f_B(90 - α)
// Angles count modulo 180 degrees. A residual is the largest difference over the largest |f| of the
// columns compared.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace langer::report {

// How far a result is from one symmetry.
struct SymmetryResidual {
  std::string says;  // the equation
  int pairs = 0;     // of angles compared
  double value = 0;  // -
};

// Empty if no two angles of the sweep are partners. An angle that is its own partner does not
// count.
std::optional<SymmetryResidual> mirror_residual(const std::string& name,
                                                const std::vector<double>& angle,
                                                const std::vector<double>& f);
std::optional<SymmetryResidual> swap_residual(const std::string& name_a, const std::string& name_b,
                                              const std::vector<double>& angle,
                                              const std::vector<double>& a,
                                              const std::vector<double>& b);

}  // namespace langer::report
