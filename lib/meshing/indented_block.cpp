#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "meshing/block.hpp"
#include "meshing/grading.hpp"

namespace langer {

namespace {
constexpr double covered = 1.1;  // contact radii of even cells

int bounded(double count) {
  return count < 1e6 ? static_cast<int>(count) : 1000000;
}  // most_cells refuses such a block

// cells in which a length grows out of cells of `edge`, evenly spread over its logarithm; measured
// in pipelines/refinement_study.yaml
int growing_cells(double per_edge, double edge, double span, double usual) {
  return bounded(std::ceil(per_edge / edge * std::log(span) / std::log(usual) - 1e-9));
}

// the fewest cells, each at most twice and a half its neighbour, that reach `rest` beyond a cell of
// `cell`
int needed_cells(double rest, double cell) {
  int n = 0;
  for (double step = 2.5 * cell; rest > 1e-9 * cell && n < 1000; step *= 2.5) rest -= step, ++n;
  return n;
}

}  // namespace

double IndentedBlock::contact_radius() const {
  const double d = std::min(depth, radius);
  return std::sqrt(d * (2 * radius - d));
}

Block IndentedBlock::block() const {
  const double a = contact_radius(), cell = edge * a;
  Block b;
  b.origin = origin, b.size = size, b.borders = borders;
  const auto cells_along = [&](double length, double within) {
    const double even_part = std::min(within, length);
    const int fine = std::max(1, bounded(std::round(even_part / cell)));
    const int coarse = length > even_part
                           ? std::max(growing_cells(0.65, edge, length / even_part, 6.8),
                                      needed_cells(length - fine * cell, cell))
                           : 0;
    return std::min(fine + coarse,
                    bounded(std::ceil(length / cell - 1e-9)));  // no more than even cells would be
  };
  const bool beside = (under && !in_the_middle()) || even;
  if (beside) b.around.emplace();
  for (int i : {0, 2}) {
    if (!beside) {
      b.divisions[i] = 2 * cells_along(0.5 * size[i], covered * a);
      continue;
    }
    const std::size_t k = i == 0 ? 0 : 1;
    const double at = under ? (*under)[k] : origin[i] + 0.5 * size[i],
                 within = even ? (*even)[k] : covered * a;
    b.around->at[k] = at, b.around->within[k] = within;
    const double least = 1e-6 * size[i];  // from the end of the block
    for (const auto& [side, length] : {std::pair{0, at - origin[i]}, {1, origin[i] + size[i] - at}})
      b.around->n[k][side] = length > least ? cells_along(length, within) : 0;
    b.divisions[i] = b.around->n[k][0] + b.around->n[k][1];
  }
  b.centre = TowardsCentre{
      beside ? cell : std::min(cell, std::min(size[0] / b.divisions[0], size[2] / b.divisions[2])),
      covered * a};
  b.divisions[1] = std::max({2, growing_cells(0.875, edge, 1 + size[1] / a, 3),
                             1 + needed_cells(size[1] - 1.6 * cell, 1.6 * cell)});
  b.top = TowardsTop{std::min(1.6 * cell, size[1] / b.divisions[1])};
  if (family) {
    // lines pass through the middle, or through the place that cells are around
    b.family = family;
    for (std::size_t i : {0U, 2U}) {
      const bool at_place = under.has_value();
      const double middle = origin[i] + 0.5 * size[i];
      b.family->breaks[i].push_back(at_place ? (*under)[i / 2] : middle);
    }
    return b;
  }
  if (longer != 1 && beside) {
    const auto& [x, z] = b.around->n;
    const std::vector<int> n = divided({x[0], x[1], b.divisions[1], z[0], z[1]}, longer);
    b.around->instead = {{{n[0], n[1]}, {n[3], n[4]}}};
    b.instead = {n[0] + n[1], n[2], n[3] + n[4]};
  } else if (longer != 1) {
    const std::vector<int> n =
        divided({b.divisions[0] / 2, b.divisions[1], b.divisions[2] / 2}, longer);
    b.instead = {2 * n[0], n[1], 2 * n[2]};
  }
  return b;
}

bool IndentedBlock::in_the_middle() const {
  const auto is = [&](double at, int i) {
    return std::abs(at - origin[i] - 0.5 * size[i]) <= 1e-9 * size[i];
  };
  return !under || (is((*under)[0], 0) && is((*under)[1], 2));
}

std::vector<Complaint> IndentedBlock::complaints() const {
  std::vector<Complaint> found;
  if (contact_radius() > 0.45 * std::min(size[0], size[2]))
    found.push_back({"size", fmt::format("a block of {:g} x {:g} mm", size[0], size[2]),
                     fmt::format("more than {:.3g} mm, the contact with room around it",
                                 contact_radius() / 0.45),
                     ""});
  for (int i : {0, 2})
    if (const double at = under ? (*under)[i / 2] : origin[i];
        at < origin[i] || at > origin[i] + size[i])
      found.push_back(
          {"under", fmt::format("{} = {:g}", "xyz"[i], at),
           fmt::format("{:g} to {:g} mm, a place on the block", origin[i], origin[i] + size[i]),
           ""});
  if (depth > size[1])
    found.push_back({"depth", fmt::format("found {:g}", depth),
                     fmt::format("less than the thickness, {:g} mm", size[1]), ""});
  if (!found.empty()) return found;
  const Block b = block();
  if (const long long cells = 1LL * b.divisions[0] * b.divisions[1] * b.divisions[2];
      cells > most_cells)
    found.push_back({"edge", fmt::format("found {:g}: {} cells", edge, cells),
                     fmt::format("at most {} cells", most_cells), ""});
  return found;
}

Mesh mesh_of(const IndentedBlock& block, const Points& points, std::vector<std::string>& notes) {
  return mesh_of(block.block(), points, notes);
}

std::vector<Complaint> contradictions(const IndentedBlock& block, const Points& points) {
  return contradictions(block.block(), points);
}

}  // namespace langer
