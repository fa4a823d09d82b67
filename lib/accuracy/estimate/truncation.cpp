#include "accuracy/estimate/truncation.hpp"

#include <cmath>

namespace langer {

namespace {

void widen(IndentedBlock& block, Truncation truncation, double factor) {
  if (truncation == Truncation::bottom) {
    block.origin[1] -= (factor - 1) * block.size[1];
    block.size[1] *= factor;
    return;
  }
  for (std::size_t k : {0U, 2U}) {
    block.origin[k] -= 0.5 * (factor - 1) * block.size[k];
    block.size[k] *= factor;
  }
}

void widen(IndentedDisc& disc, Truncation truncation, double factor) {
  if (truncation == Truncation::sides) {
    disc.size[0] *= factor;
    return;
  }
  disc.base -= (factor - 1) * disc.size[1];
  disc.size[1] *= factor;
}

}  // namespace

std::array<SolveConfig, 2> wider(const SolveConfig& config, Truncation truncation) {
  std::array<SolveConfig, 2> out{config, config};
  double factor = 1;
  for (SolveConfig& each : out) {
    factor *= 1.5;
    Geometry& geometry = each.mesh->geometry;
    if (auto* block = std::get_if<IndentedBlock>(&geometry))
      widen(*block, truncation, factor);
    else
      widen(std::get<IndentedDisc>(geometry), truncation, factor);
  }
  return out;
}

double beyond(double f1, double f2, double f3) {
  const double d1 = f2 - f1;
  const double d2 = f3 - f2;
  if (const double r = d1 != 0 ? d2 / d1 : 1; r >= 0 && r < 0.8)
    return -(d1 + d2 + d2 * r / (1 - r));
  return -std::copysign(std::abs(d1) + std::abs(d2), d1 + d2);
}

}  // namespace langer
