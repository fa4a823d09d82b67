// The tests that stability and sensitivity look along: states of material/states.hpp with one
// amount each, shear held.
//   uniaxial, equibiaxial, pure_shear   amount = engineering strain l - 1;   simple_shear   amount = g
//   stresses in MPa
// A fibre at 0 degrees lies along x; `turned` gives the same sheet cut at another angle.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mechanics/material/material.hpp"
#include "mechanics/material/uniaxial.hpp"

namespace langer {

enum class Path { uniaxial, equibiaxial, pure_shear, simple_shear };
constexpr auto names(Path) {
  return std::array{"uniaxial", "equibiaxial", "pure_shear", "simple_shear"};
}
inline constexpr std::array all_paths{Path::uniaxial, Path::equibiaxial, Path::pure_shear,
                                      Path::simple_shear};

struct PathState {
  bool exists = false;
  Mat3 F = Mat3::Identity();
  double W = 0;
  double cauchy = 0;   // sigma_xx with sigma_yy = 0; sigma_xz in simple shear
  double nominal = 0;  // force per reference area of the same component
  double work = 0;     // dW/d amount, shared by the axes that are pulled: the mean nominal stress
};

PathState on_path(const Material& material, Path path, double amount);

Material turned(Material material, double degrees);  // every fibre further from x by `degrees`

// stress at each amount; nothing if one of the states does not exist
std::optional<std::vector<double>> path_curve(const Material& material, Path path,
                                              std::span<const double> amount,
                                              StressMeasure measure);

}  // namespace langer
