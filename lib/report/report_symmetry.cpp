#include "report/report_symmetry.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace langer::report {

namespace {

bool same_direction(double a, double b) { return std::abs(std::remainder(a - b, 180)) < 1e-9; }

// a(α) against b(partner - α)
std::optional<SymmetryResidual> compared(std::string says, const std::vector<double>& angle,
                                         const std::vector<double>& a, const std::vector<double>& b,
                                         double partner, bool both_ways) {
  SymmetryResidual residual{std::move(says), 0, 0};
  double largest = 0, scale = 0;
  for (std::size_t i = 0; i < angle.size(); ++i)
    for (std::size_t j = both_ways ? 0 : i + 1; j < angle.size(); ++j) {
      if (!same_direction(angle[i], partner - angle[j])) continue;
      largest = std::max(largest, std::abs(a[i] - b[j]));
      scale = std::max({scale, std::abs(a[i]), std::abs(b[j])});
      ++residual.pairs;
    }
  if (residual.pairs == 0) return {};
  if (scale > 0) {
    residual.value = largest / scale;
  } else {
    residual.value = 0;
  }
  return residual;
}

}  // namespace

std::optional<SymmetryResidual> mirror_residual(const std::string& name,
                                                const std::vector<double>& angle,
                                                const std::vector<double>& f) {
  return compared(fmt::format("{0}(α) = {0}(180° − α)", name), angle, f, f, 180, false);
}

std::optional<SymmetryResidual> swap_residual(const std::string& name_a, const std::string& name_b,
                                              const std::vector<double>& angle,
                                              const std::vector<double>& a,
                                              const std::vector<double>& b) {
  return compared(fmt::format("{}(α) = {}(90° − α)", name_a, name_b), angle, a, b, 90, true);
}

}  // namespace langer::report
