#include "report/report_symmetry.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace langer::report {

namespace {

// Fibre directions are equal modulo 180 degrees.
bool same_direction(double a, double b) { return std::abs(std::remainder(a - b, 180)) < 1e-9; }

// Compares a(α) with b(partner − α) for all pairs of angles. If a and b are the same column, each
// pair is compared once (both_ways = false).
std::optional<SymmetryResidual> compared(std::string says, const std::vector<double>& angle,
                                         const std::vector<double>& a, const std::vector<double>& b,
                                         double partner, bool both_ways) {
  // The residual is relative to the largest value, because single values may pass through 0.
  SymmetryResidual residual{std::move(says), 0, 0};
  double largest = 0;
  double scale = 0;
  for (std::size_t i = 0; i < angle.size(); ++i)
    for (std::size_t j = 0; j < angle.size(); ++j) {
      if (!both_ways && j <= i) continue;
      if (!same_direction(angle[i], partner - angle[j])) continue;
      largest = std::max(largest, std::abs(a[i] - b[j]));
      scale = std::max({scale, std::abs(a[i]), std::abs(b[j])});
      ++residual.pairs;
    }
  if (residual.pairs == 0) return {};
  if (scale > 0) residual.value = largest / scale;
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
