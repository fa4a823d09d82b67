#include "meshing/block.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "mechanics/mesh/select.hpp"
#include "meshing/grading.hpp"
#include "meshing/grid.hpp"

namespace langer {

namespace {

// Lines that are short around a place and grow towards both sides. Each side is resampled by
// itself, so that a line keeps passing through the place.
std::vector<double> around_place(const Block& b, int axis) {
  const auto k = static_cast<std::size_t>(axis / 2);  // of x and z
  const double at = b.around->at[k];
  const double low = b.origin[axis];
  const double high = low + b.size[axis];
  const auto side = [&](double length, std::size_t which) {
    const int n = b.around->n[k][which];
    const double within = b.around->within[k];
    double edge = 0;
    if (n > 0) edge = length / n;
    if (within < length) edge = std::min(b.centre->edge, edge);
    return GradedSide{length, within, edge, n};
  };
  const GradedSide below = side(at - low, 0);
  const GradedSide above = side(high - at, 1);
  std::vector<double> lines = lines_around(at, below, above, "geometry.block.centre.edge");
  if (b.around->instead) {
    const auto [n_below, n_above] = (*b.around->instead)[k];
    const auto place = lines.begin() + below.n;
    std::vector<double> low_side(lines.begin(), place + 1), high_side(place, lines.end());
    if (below.n > 0) low_side = resampled(low_side, n_below);
    if (above.n > 0) high_side = resampled(high_side, n_above);
    lines = low_side;
    lines.insert(lines.end(), high_side.begin() + 1, high_side.end());
  }
  lines.front() = low;
  lines.back() = high;
  return lines;
}

// Resamples each layer between borders by itself, to `share` of its elements, rounded.
std::vector<double> resampled_between(const std::vector<double>& lines,
                                      const std::vector<double>& borders, double share) {
  std::vector<double> found{lines.front()}, layer{lines.front()};
  const auto is_border = [&](double y) {
    return std::any_of(borders.begin(), borders.end(), [&](double b) {
      return std::abs(b - y) < 1e-9 * (lines.back() - lines.front());
    });
  };
  for (std::size_t i = 1; i < lines.size(); ++i) {
    layer.push_back(lines[i]);
    if (i + 1 < lines.size() && !is_border(lines[i])) continue;
    const std::vector<double> again = resampled(
        layer,
        std::max(1, static_cast<int>(std::lround(share * static_cast<double>(layer.size() - 1)))));
    found.insert(found.end(), again.begin() + 1, again.end());
    layer = {lines[i]};
  }
  return found;
}

// Lines of each axis: first graded as the block asks, then moved onto borders of layers and named
// points. A mesh of a family divides the intervals between these places instead.
GridLines grid_lines(const Block& b, const Points& points, std::vector<std::string>& notes) {
  GridLines lines;
  for (int i = 0; i < 3; ++i) {
    const double low = b.origin[i];
    const double high = b.origin[i] + b.size[i];
    const int n = b.divisions[i];
    if (i != 1 && b.around)
      lines[i] = around_place(b, i);
    else if (i == 1 && b.top)
      lines[i] = lines_to_top(low, high, n, b.top->edge, "geometry.block.top.edge");
    else if (i != 1 && b.centre)
      lines[i] = lines_to_centre(low, high, n, b.centre->edge, b.centre->within,
                                 "geometry.block.centre.edge");
    else
      lines[i] = even_lines(low, high, n);
    std::vector<Demand> demands;
    double moved_furthest = 0;
    const std::string axis(1, "xyz"[i]);
    const std::string divisions = fmt::format("geometry.block.divisions[{}]", i);
    const auto pass = [&] {
      const Moved moved = through(lines[i], demands, axis, divisions);
      moved_furthest = std::max(moved_furthest, moved.furthest);
      lines[i] = moved.lines;
    };
    if (i == 1 && !b.borders.empty() && !b.family) {
      for (double y : b.borders) demands.push_back({y, "bodies"});
      pass();
    }
    if (b.family) {
      std::vector<double> breaks = b.family->breaks[static_cast<std::size_t>(i)];
      for (const auto& [name, x] : points) breaks.push_back(x[i]);
      if (i == 1) breaks.insert(breaks.end(), b.borders.begin(), b.borders.end());
      lines[i] = in_family(lines[i], std::move(breaks), b.family->length, b.family->parts);
      continue;
    }
    if (b.instead && i == 1)
      lines[i] = resampled_between(lines[i], b.borders, 1.0 * (*b.instead)[1] / n);
    if (b.instead && i != 1 && !b.around) lines[i] = resampled(lines[i], (*b.instead)[i]);
    for (const auto& [name, x] : points) demands.push_back({x[i], "points." + name});
    pass();
    if (moved_furthest > 1e-9 * b.size[i])
      notes.push_back(fmt::format(
          "grid lines of {} moved by up to {:.3g} mm to pass through points and borders of layers",
          axis, moved_furthest));
  }
  return lines;
}

}  // namespace

Mesh mesh_of(const Block& block, const Points& points, std::vector<std::string>& notes) {
  return hexahedra_between(grid_lines(block, points, notes));
}

std::array<int, 3> Block::numbers() const {
  if (!family) return instead.value_or(divisions);
  std::vector<std::string> notes;
  const GridLines lines = grid_lines(*this, {}, notes);
  std::array<int, 3> n{};
  for (std::size_t i = 0; i < 3; ++i) n[i] = static_cast<int>(lines[i].size()) - 1;
  return n;
}

std::vector<Complaint> Block::complaints() const {
  const long long cells = 1LL * divisions[0] * divisions[1] * divisions[2];
  if (cells <= most_cells) return {};
  return {{"divisions", fmt::format("found {} cells", cells), fmt::format("at most {}", most_cells),
           ""}};
}

std::vector<Complaint> contradictions(const Block& block, const Points& points) {
  std::vector<std::string> notes;
  return complaints_of([&] { grid_lines(block, points, notes); });
}

void name_points(Mesh& mesh, const Points& points) {
  const std::vector<int> all = all_nodes(mesh);
  const double tolerance = 1e-12 * size(mesh);
  for (const auto& [name, x] : points) {
    const int node = select(mesh, NearestNode{{x[0], x[1], x[2]}}, all).at(0);
    const Vec3 there = mesh.X[node];
    if (!((there - x).norm() <= tolerance))
      throw Failure(
          Exit::config,
          Error{{},
                "points." + name,
                fmt::format(
                    "no node is there; the nearest is {:.3g} mm away, at ({:.6g}, {:.6g}, {:.6g})",
                    (there - x).norm(), there[0], there[1], there[2]),
                "a point that the geometry has a node at",
                "move the point, or a radius or side of the geometry through it"});
    mesh.X[node] = x;
    mesh.node_sets[name] = {node};
  }
}

}  // namespace langer
