#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "geometry/block.hpp"

namespace langer {

namespace {
constexpr double covered = 1.1;  // contact radii of even cells

// cells in which a length grows out of cells of `edge`, evenly spread over its logarithm; measured in pipelines/trade.yaml
int growing_cells(double per_edge, double edge, double span, double usual) {
  return static_cast<int>(std::ceil(per_edge / edge * std::log(span) / std::log(usual) - 1e-9));
}
}  // namespace

double IndentedBlock::contact_radius() const {
  const double d = std::min(depth, radius);
  return std::sqrt(d * (2 * radius - d));
}

Block IndentedBlock::block() const {
  const double a = contact_radius(), cell = edge * a;
  Block b;
  b.origin = origin, b.size = size;
  for (int i : {0, 2}) {
    const double half = 0.5 * size[i], even = std::min(covered * a, half);
    const int fine = static_cast<int>(std::lround(even / cell)), coarse = half > even ? growing_cells(0.65, edge, half / even, 6.8) : 0;
    b.divisions[i] = 2 * std::max(1, fine + coarse);
    // growing cells that would not have to grow
    while (b.divisions[i] > 2 && 0.5 * b.divisions[i] * cell > half * (1 + 1e-9)) b.divisions[i] -= 2;
  }
  b.centre = TowardsCentre{std::min(cell, std::min(size[0] / b.divisions[0], size[2] / b.divisions[2])), covered * a};
  b.divisions[1] = std::max(2, growing_cells(0.875, edge, 1 + size[1] / a, 3));
  b.top = TowardsTop{std::min(1.6 * cell, size[1] / b.divisions[1])};
  return b;
}

std::vector<Complaint> IndentedBlock::complaints() const {
  std::vector<Complaint> found;
  if (contact_radius() > 0.45 * std::min(size[0], size[2]))
    found.push_back({"size", fmt::format("a block of {:g} x {:g} mm", size[0], size[2]),
                     fmt::format("more than {:.3g} mm, the contact with room around it", contact_radius() / 0.45), ""});
  if (depth > size[1])
    found.push_back({"depth", fmt::format("found {:g}", depth), fmt::format("less than the thickness, {:g} mm", size[1]), ""});
  if (!found.empty()) return found;
  const Block b = block();
  if (const long long cells = 1LL * b.divisions[0] * b.divisions[1] * b.divisions[2]; cells > most_cells)
    found.push_back({"edge", fmt::format("found {:g}: {} cells", edge, cells), fmt::format("at most {} cells", most_cells), ""});
  return found;
}

Mesh mesh_of(const IndentedBlock& block, const Points& points, std::vector<std::string>& notes) {
  return mesh_of(block.block(), points, notes);
}

std::vector<Complaint> contradictions(const IndentedBlock& block, const Points& points) { return contradictions(block.block(), points); }

}  // namespace langer
