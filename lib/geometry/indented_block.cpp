#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "geometry/block.hpp"

namespace langer {

namespace {
constexpr double covered = 1.1;  // contact radii of even cells

int bounded(double count) { return count < 1e6 ? static_cast<int>(count) : 1000000; }  // most_cells refuses such a block

// cells in which a length grows out of cells of `edge`, evenly spread over its logarithm; measured in pipelines/trade.yaml
int growing_cells(double per_edge, double edge, double span, double usual) {
  return bounded(std::ceil(per_edge / edge * std::log(span) / std::log(usual) - 1e-9));
}

// the fewest cells, each at most twice and a half its neighbour, that reach `rest` beyond a cell of `cell`
int needed_cells(double rest, double cell) {
  int n = 0;
  for (double step = 2.5 * cell; rest > 1e-9 * cell && n < 1000; step *= 2.5) rest -= step, ++n;
  return n;
}

// n[i] / factor for a factor near `wanted` by which all three can be divided best; fewer than n of at least one
std::array<int, 3> divided(const std::array<int, 3>& n, double wanted) {
  std::array<int, 3> best = n;
  double least = std::numeric_limits<double>::infinity();
  for (int k : n)
    for (double to : {std::floor(k / wanted), std::ceil(k / wanted)}) {
      if (to < 1) continue;
      const double factor = k / to;
      double off = 0.7 * std::abs(std::log(factor / wanted));
      std::array<int, 3> counts{};
      for (int i = 0; i < 3; ++i) {
        counts[i] = std::max(1, bounded(std::round(n[i] / factor)));
        off = std::max(off, std::abs(std::log(n[i] / (counts[i] * factor))));
      }
      if (counts != n && off < least) least = off, best = counts;
    }
  return best;
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
    const int fine = std::max(1, bounded(std::round(even / cell)));
    const int coarse =
        half > even ? std::max(growing_cells(0.65, edge, half / even, 6.8), needed_cells(half - fine * cell, cell)) : 0;
    b.divisions[i] = 2 * std::min(fine + coarse, bounded(std::ceil(half / cell - 1e-9)));  // no more than even cells would be
  }
  b.centre = TowardsCentre{std::min(cell, std::min(size[0] / b.divisions[0], size[2] / b.divisions[2])), covered * a};
  b.divisions[1] =
      std::max({2, growing_cells(0.875, edge, 1 + size[1] / a, 3), 1 + needed_cells(size[1] - 1.6 * cell, 1.6 * cell)});
  b.top = TowardsTop{std::min(1.6 * cell, size[1] / b.divisions[1])};
  if (longer != 1) {
    const std::array<int, 3> n = divided({b.divisions[0] / 2, b.divisions[1], b.divisions[2] / 2}, longer);
    b.instead = {2 * n[0], n[1], 2 * n[2]};
  }
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

std::vector<Complaint> contradictions(const IndentedBlock& block, const Points& points) {
  return contradictions(block.block(), points);
}

}  // namespace langer
