// A stretch in the plane of skin, as configs name it.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/base/fields.hpp"
#include "core/tensor/types.hpp"

namespace langer {

// A stretch in the plane of the skin: along x (Langer's lines) and across, or a whole gradient.
struct PrestretchConfig {
  double along = 1, across = 1;
  std::optional<std::array<std::array<double, 2>, 2>> tensor;
  static void fields(auto& v) {
    v(&PrestretchConfig::along, "along", unit::none, "stretch along x, the fibres' 0 degrees",
      positive);
    v(&PrestretchConfig::across, "across", unit::none, "stretch along z", positive);
    v(&PrestretchConfig::tensor, "tensor", unit::none,
      "instead: the deformation gradient in the plane, [[xx, xz], [zx, zz]]");
  }
  std::vector<Complaint> complaints() const;
  Eigen::Matrix2d deformation() const;  // rows and columns x, z
};

constexpr double density_in_t_mm3(double kg_m3) { return kg_m3 * 1e-12; }

}  // namespace langer
