// Element numbers of a block under a sphere: even elements over the contact radius, growing ones
// outside, chosen from the depth and the radius of the indenter.
#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "meshing/block.hpp"
#include "meshing/grading.hpp"

namespace langer {

namespace {
// The half width of the region of even elements, in contact radii.
constexpr double covered = 1.1;

// A count that fits an int. A block with more elements than that is refused (most_cells).
int bounded(double count) {
  constexpr int most = 1000000;
  if (count < most) return static_cast<int>(count);
  return most;
}

// The number of elements over which a length grows by the factor `span`, starting from elements of
// `edge` contact radii. Their lengths are evenly spaced on a logarithmic scale; the factors were
// measured by pipelines/refinement_study.yaml.
int growing_cells(double per_edge, double edge, double span, double usual) {
  return bounded(std::ceil(per_edge / edge * std::log(span) / std::log(usual) - 1e-9));
}

// The smallest number of elements that cover the length `rest` next to an element of length `cell`,
// if each is at most 2.5 times as long as its neighbour.
int least_cells(double rest, double cell) {
  int n = 0;
  double step = 2.5 * cell;
  while (rest > 1e-9 * cell && n < 1000) {
    rest -= step;
    step *= 2.5;
    ++n;
  }
  return n;
}

// The smallest number of elements that cover the length `rest` next to an element of length `cell`,
// if they grow by one factor and the last is at most `longest`.
int cells_up_to(double longest, double rest, double cell) {
  if (longest <= cell) return bounded(std::ceil(rest / cell - 1e-9));
  int n = 0;
  double covered_length = 0;
  while (covered_length < rest * (1 - 1e-9)) {
    ++n;
    covered_length = 0;
    for (int i = 1; i <= n; ++i)
      covered_length += cell * std::pow(longest / cell, static_cast<double>(i) / n);
  }
  return n;
}

}  // namespace

double IndentedBlock::contact_radius() const {
  const double d = std::min(depth, radius);
  return std::sqrt(d * (2 * radius - d));
}

Block IndentedBlock::block() const {
  const double a = contact_radius();
  const double cell = edge * a;
  Block b;
  b.origin = origin;
  b.size = size;
  b.borders = borders;
  // from the indenter to a side: even elements within `within`, then growing ones, but no more than
  // even elements all the way would be
  const auto cells_along = [&](double length, double within) {
    const double even_part = std::min(within, length);
    const int fine = std::max(1, bounded(std::round(even_part / cell)));
    int coarse = 0;
    if (length > even_part)
      coarse = std::max(growing_cells(0.65, edge, length / even_part, 6.8),
                        least_cells(length - fine * cell, cell));
    if (longest && length > even_part)
      coarse = std::max(coarse,
                        cells_up_to(*longest * std::sqrt(edge / 0.5), length - fine * cell, cell));
    return std::min(fine + coarse, bounded(std::ceil(length / cell - 1e-9)));
  };
  const bool off_centre = (under && !in_the_middle()) || even;
  if (off_centre) b.around.emplace();
  for (int i : {0, 2}) {
    if (!off_centre) {
      b.divisions[i] = 2 * cells_along(0.5 * size[i], covered * a);
      continue;
    }
    const auto k = static_cast<std::size_t>(i / 2);
    double at = origin[i] + 0.5 * size[i];
    if (under) at = (*under)[k];
    double within = covered * a;
    if (even) within = (*even)[k];
    b.around->at[k] = at;
    b.around->within[k] = within;
    // an indenter at the edge of the block has no elements on that side
    const double least = 1e-6 * size[i];
    for (const auto& [side, length] :
         {std::pair{0, at - origin[i]}, {1, origin[i] + size[i] - at}}) {
      b.around->n[k][side] = 0;
      if (length > least) b.around->n[k][side] = cells_along(length, within);
    }
    b.divisions[i] = b.around->n[k][0] + b.around->n[k][1];
  }
  double shortest = cell;
  if (!off_centre)
    shortest = std::min(cell, std::min(size[0] / b.divisions[0], size[2] / b.divisions[2]));
  b.centre = TowardsCentre{shortest, covered * a};
  b.divisions[1] = std::max({2, growing_cells(0.875, edge, 1 + size[1] / a, 3),
                             1 + least_cells(size[1] - 1.6 * cell, 1.6 * cell)});
  b.top = TowardsTop{std::min(1.6 * cell, size[1] / b.divisions[1])};
  if (family) {
    // grid lines pass through the place under the indenter, or through the middle of the block
    b.family = family;
    for (std::size_t i : {0U, 2U}) {
      const bool at_place = under.has_value();
      const double middle = origin[i] + 0.5 * size[i];
      b.family->breaks[i].push_back(at_place ? (*under)[i / 2] : middle);
    }
    return b;
  }
  if (longer != 1 && off_centre) {
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
  for (int i : {0, 2}) {
    if (!under) continue;
    const double at = (*under)[static_cast<std::size_t>(i / 2)];
    if (at >= origin[i] && at <= origin[i] + size[i]) continue;
    found.push_back(
        {"under", fmt::format("{} = {:g}", "xyz"[i], at),
         fmt::format("{:g} to {:g} mm, a place on the block", origin[i], origin[i] + size[i]), ""});
  }
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
