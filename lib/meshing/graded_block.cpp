// The O-grid in the x-z plane: the core's square, circles around it, the sides of the block
// outside.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "mechanics/mesh/order.hpp"
#include "meshing/block.hpp"
#include "meshing/grading.hpp"
#include "meshing/grid.hpp"

namespace langer {

std::vector<Complaint> GradedBlock::complaints() const {
  std::vector<Complaint> found;
  long long across = outer_cells;
  for (const Ring& ring : rings) across += ring.cells;
  if (const long long cells = layers * (1LL * core.cells * core.cells + 4LL * core.cells * across);
      cells > most_cells)
    found.push_back({"layers", fmt::format("found {} cells in all", cells),
                     fmt::format("at most {}", most_cells), ""});
  if (core.cells % 2 != 0)
    found.push_back({"core.cells", fmt::format("found {}", core.cells), "an even number", ""});
  if (rings.empty()) found.push_back({"rings", "found an empty list", "at least one ring", ""});
  double inside = core.half_width * std::numbers::sqrt2;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    const std::string_view inner = i == 0 ? "core's corner" : "ring inside it";
    if (rings[i].radius <= inside)
      found.push_back({fmt::format("rings[{}].radius", i), fmt::format("found {}", rings[i].radius),
                       fmt::format("more than {:.6g}, the {}", inside, inner), ""});
    inside = rings[i].radius;
  }
  if (const double half = 0.5 * std::min(size[0], size[2]); inside >= half)
    found.push_back({fmt::format("rings[{}].radius", std::max<std::size_t>(rings.size(), 1) - 1),
                     fmt::format("found {}", inside),
                     fmt::format("less than {}, half the block's width", half), ""});
  return found;
}

namespace {

// The ratio of neighbouring elements with which the outer elements continue the last ring: the
// first of them is about as long as its elements.
double growth_of(const GradedBlock& b, double from, double to) {
  const std::size_t last = b.rings.size() - 1;
  double inside = b.core.half_width;
  if (last > 0) inside = b.rings[last - 1].radius;
  const double edge = (b.rings[last].radius - inside) / b.rings[last].cells;
  if (edge * b.outer_cells >= to - from) return 1;
  const std::vector<double> lines =
      refined(to - from, b.outer_cells, edge, 0, "geometry.graded_block.outer_cells");
  if (lines.size() < 3) return 1;
  return (lines[2] - lines[1]) / (lines[1] - lines[0]);
}

// Loops of 4 n points around the core: n from each of its corners, at 45 degrees before +x, +z, -x,
// -z, to the next; points of neighbouring loops are joined by straight lines.
using Loop = std::vector<std::array<double, 2>>;  // from the centre

Loop rectangle(int n, double dx, double dz) {
  const std::array<std::array<double, 2>, 4> corner{{{dx, -dz}, {dx, dz}, {-dx, dz}, {-dx, -dz}}};
  Loop loop;
  for (int s = 0; s < 4; ++s) {
    const auto &from = corner[s], &to = corner[(s + 1) % 4];
    for (int i = 0; i < n; ++i)
      loop.push_back({from[0] + (to[0] - from[0]) * i / n, from[1] + (to[1] - from[1]) * i / n});
  }
  return loop;
}

Loop circle(int n, double radius) {
  Loop loop;
  for (int s = 0; s < 4; ++s)
    for (int i = 0; i < n; ++i) {
      const double angle = 0.5 * std::numbers::pi * (s + (i - 0.5 * n) / n);
      loop.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
  return loop;
}

// The elements of one horizontal layer, from the core outwards. inner_ holds the points of the last
// loop, to which the next one is joined.
class PlanMaker {
 public:
  explicit PlanMaker(const GradedBlock& b)
      : x_(b.origin[0] + 0.5 * b.size[0]),
        z_(b.origin[2] + 0.5 * b.size[2]),
        inner_(static_cast<std::size_t>(4 * b.core.cells)) {}

  void core(int n, double h) {
    for (int k = 0; k <= n; ++k)
      for (int i = 0; i <= n; ++i) {
        const int at = add_point(h * (2 * i - n) / n, h * (2 * k - n) / n);
        if (i < n && k < n) plan.cells.push_back({at, at + 1, at + n + 2, at + n + 1});
        if (i == n && k < n) inner_[k] = at;
        if (k == n && i > 0) inner_[2 * n - i] = at;
        if (i == 0 && k > 0) inner_[3 * n - k] = at;
        if (k == 0 && i < n) inner_[3 * n + i] = at;
      }
  }

  // `cells` loops of elements between two loops of points. Each is longer by the factor `growth`
  // than the one inside it.
  void surround(const Loop& from, const Loop& to, int cells, double growth) {
    double step = 1, whole = 0, part = 0;
    for (int c = 0; c < cells; ++c) {
      whole += step;
      step *= growth;
    }
    step = 1;
    for (int c = 0; c < cells; ++c) {
      part += step;
      step *= growth;
      double v = 1;  // exactly on the outer loop at the end
      if (c + 1 < cells) v = part / whole;
      std::vector<int> outer;
      for (std::size_t p = 0; p < from.size(); ++p)
        outer.push_back(
            add_point((1 - v) * from[p][0] + v * to[p][0], (1 - v) * from[p][1] + v * to[p][1]));
      for (std::size_t p = 0; p < outer.size(); ++p) {
        const std::size_t q = (p + 1) % outer.size();
        plan.cells.push_back({inner_[p], outer[p], outer[q], inner_[q]});
      }
      inner_ = outer;
    }
  }

  Plan plan;

 private:
  int add_point(double x, double z) {
    plan.points.push_back({x_ + x, z_ + z});
    return static_cast<int>(plan.points.size()) - 1;
  }

  double x_, z_;            // of the centre
  std::vector<int> inner_;  // the last loop's points in the plan
};

Plan plan_of(const GradedBlock& b) {
  const double half_x = 0.5 * b.size[0];
  const double half_z = 0.5 * b.size[2];
  const double h = b.core.half_width;
  const int n = b.core.cells;
  PlanMaker maker(b);
  maker.core(n, h);
  Loop last = rectangle(n, h, h);
  for (const Ring& ring : b.rings) {
    const Loop next = circle(n, ring.radius);
    maker.surround(last, next, ring.cells, 1);
    last = next;
  }
  maker.surround(last, rectangle(n, half_x, half_z), b.outer_cells,
                 growth_of(b, b.rings.back().radius, std::min(half_x, half_z)));
  return std::move(maker.plan);
}

std::vector<double> layer_heights(const GradedBlock& b) {
  const double low = b.origin[1];
  const double high = low + b.size[1];
  if (b.top) {
    return lines_to_top(low, high, b.layers, b.top->edge, "geometry.graded_block.top.edge");
  }
  return even_lines(low, high, b.layers);
}

}  // namespace

std::vector<Complaint> contradictions(const GradedBlock& b, const Points& points) {
  std::vector<Complaint> found = complaints_of([&] { layer_heights(b); });
  const auto growth = [&] {
    growth_of(b, b.rings.back().radius, 0.5 * std::min(b.size[0], b.size[2]));
  };
  for (Complaint& c : complaints_of(growth)) found.push_back(std::move(c));
  for (const auto& [name, x] : points)
    for (int i = 0; i < 3; ++i)
      if (const double low = b.origin[i], high = low + b.size[i]; x[i] < low || x[i] > high)
        found.push_back({"points." + name,
                         fmt::format("{} = {} is outside the block", "xyz"[i], x[i]),
                         fmt::format("{} to {}", low, high), ""});
  return found;
}

Mesh mesh_of(const GradedBlock& b, const Points&, std::vector<std::string>&) {
  Mesh mesh = extruded(plan_of(b), layer_heights(b));
  turn_cells(mesh);
  const Vec3 axis(b.origin[0] + 0.5 * b.size[0], 0, b.origin[2] + 0.5 * b.size[2]);
  make_symmetric(mesh, axis);
  turn_outwards(mesh, axis, b.core.half_width, b.blocks);
  number_in_order(mesh);
  return mesh;
}

}  // namespace langer
