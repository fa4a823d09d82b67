#include "meshing/section_mesh.hpp"

#include <fmt/format.h>

#include "mechanics/mesh/section.hpp"
#include "meshing/block.hpp"
#include "meshing/grading.hpp"

namespace langer {

namespace {

// of the wedge for each mm of radius: an indentation's force changes by 6e-9 from 2^-12 to 2^-14,
// by less than 1e-9 from there to 2^-20 (tests/scene/section.cpp)
constexpr double wedge = 0x1p-14;

constexpr long long most = 100'000;  // cells; beyond, a number is more likely a slip than a wish

// Complains about a grid with too many cells before it is made.
void limit_cells(const SectionBox& b, const char* key, const std::string& found,
                 std::vector<Complaint>& complaints) {
  if (const long long cells = 1LL * b.divisions[0] * b.divisions[1]; cells > most)
    complaints.push_back(
        {key, fmt::format("{}{} cells", found, cells), fmt::format("at most {} cells", most), ""});
}

// Coordinates of the grid lines along x (0) or y (1), both ends included [mm]. They are graded
// towards the top and towards the indenter where the scene wants it, and then moved so that named
// points and borders of layers are on a line. A family of meshes has its own rule, which inserts
// these places as breaks.
std::vector<double> lines_along(const SectionBox& b, int axis, const Points& points,
                                std::vector<std::string>& notes) {
  const double low = b.origin[axis], high = low + b.size[axis];
  const int n = b.divisions[axis];
  std::vector<double> lines;
  if (axis == 1 && b.top) {
    lines = lines_to_top(low, high, n, b.top->edge, "geometry.section.top.edge");
  } else if (axis == 0 && b.centre && b.of == SectionOf::axisymmetric) {
    lines = refined(b.size[0], n, b.centre->edge, b.centre->within, "geometry.section.centre.edge");
    for (double& x : lines) x += low;
    // The sum of lengths may miss the end by rounding; the side of the body is set exactly.
    lines.back() = high;
  } else if (axis == 0 && b.centre) {
    lines = lines_to_centre(low, high, n, b.centre->edge, b.centre->within,
                            "geometry.section.centre.edge");
  } else {
    lines = even_lines(low, high, n);
  }
  if (b.family) {
    std::vector<double> breaks = b.family->breaks[static_cast<std::size_t>(axis)];
    for (const auto& [name, x] : points) breaks.push_back(x[axis]);
    if (axis == 1) breaks.insert(breaks.end(), b.borders.begin(), b.borders.end());
    return in_family(lines, std::move(breaks), b.family->length, b.family->parts);
  }
  if (b.instead) lines = resampled(lines, (*b.instead)[axis]);
  std::vector<Demand> demands;
  for (const auto& [name, x] : points) demands.push_back({x[axis], "points." + name});
  if (axis == 1)
    for (double y : b.borders) demands.push_back({y, "bodies"});
  const std::string name(1, "xy"[axis]);
  const Moved moved =
      through(lines, demands, name, fmt::format("geometry.section.divisions[{}]", axis));
  // A shift that is more than rounding is reported: cells are no longer those of the divisions.
  if (moved.furthest > 1e-9 * b.size[axis])
    notes.push_back(fmt::format(
        "grid lines of {} moved by up to {:.3g} mm to pass through points and borders of layers",
        name, moved.furthest));
  return moved.lines;
}

// Points of a section have z = 0.
std::vector<Complaint> off_plane(const Points& points) {
  std::vector<Complaint> found;
  for (const auto& [name, x] : points)
    if (x[2] != 0)
      found.push_back({"points." + name, fmt::format("found z = {:g}", x[2]),
                       "z = 0, the plane of the section", ""});
  return found;
}

}  // namespace

// A grid of one cell in depth. Its z is replaced by the depth of the section: a thin wedge for an
// axisymmetric body, the thickness (1 mm where none is given) for a plane one.
Mesh mesh_of(const SectionBox& box, const Points& points, std::vector<std::string>& notes) {
  const auto x = lines_along(box, 0, points, notes), y = lines_along(box, 1, points, notes);
  const int nx = static_cast<int>(x.size()), ny = static_cast<int>(y.size());
  Mesh mesh;
  for (double z : {0.0, 1.0})
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) mesh.X.emplace_back(x[i], y[j], z);
  for (int j = 0; j + 1 < ny; ++j)
    for (int i = 0; i + 1 < nx; ++i)
      for (int k : {0, 1})
        for (const auto& [right, up] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
          mesh.connectivity.push_back((k * ny + j + up) * nx + i + right);
  make_section(mesh,
               {box.of, box.of == SectionOf::axisymmetric ? wedge : box.thickness.value_or(1)});
  return mesh;
}

Mesh mesh_of(const IndentedDisc& disc, const Points& points, std::vector<std::string>& notes) {
  return mesh_of(disc.section(), points, notes);
}

// The numbers of cells along x and y; those of a family are only known once its lines are made.
std::array<int, 2> SectionBox::numbers() const {
  if (!family) return instead.value_or(divisions);
  std::vector<std::string> notes;
  std::array<int, 2> n{};
  for (int axis : {0, 1}) {
    n[static_cast<std::size_t>(axis)] =
        static_cast<int>(lines_along(*this, axis, {}, notes).size()) - 1;
  }
  return n;
}

std::vector<Complaint> SectionBox::complaints() const {
  std::vector<Complaint> found;
  if (of == SectionOf::axisymmetric && origin[0] < 0)
    found.push_back(
        {"origin", fmt::format("found x = {:g}", origin[0]), "a radius, at least 0", ""});
  if (of == SectionOf::axisymmetric && thickness)
    found.push_back({"thickness", fmt::format("found {:g}", *thickness),
                     "none: forces are those of the whole circle", ""});
  limit_cells(*this, "divisions", "found ", found);
  return found;
}

// Half the section through a block whose half width is the radius of the disc. The grading around
// the indenter is that of the block, with half its divisions along x.
SectionBox IndentedDisc::section() const {
  IndentedBlock whole{{-size[0], base, -size[0]},
                      {2 * size[0], size[1], 2 * size[0]},
                      radius,
                      depth,
                      edge,
                      longer,
                      {},
                      {},
                      {}};
  if (even) whole.even = {*even, *even};
  const Block b = whole.block();
  SectionBox half{SectionOf::axisymmetric,
                  {0, base},
                  size,
                  {b.divisions[0] / 2, b.divisions[1]},
                  b.centre,
                  b.top,
                  {},
                  {},
                  {}};
  if (b.instead) half.instead = {(*b.instead)[0] / 2, (*b.instead)[1]};
  half.borders = borders;
  return half;
}

// The contact must be clearly inside the disc, and the indenter must not reach its bottom. Only a
// disc without such faults has its cells counted.
std::vector<Complaint> IndentedDisc::complaints() const {
  std::vector<Complaint> found;
  const double contact = IndentedBlock{{}, {}, radius, depth, edge}.contact_radius();
  if (contact > 0.9 * size[0])
    found.push_back(
        {"size", fmt::format("a disc of radius {:g} mm", size[0]),
         fmt::format("more than {:.3g} mm, the contact with room around it", contact / 0.9), ""});
  if (depth > size[1])
    found.push_back({"depth", fmt::format("found {:g}", depth),
                     fmt::format("less than the thickness, {:g} mm", size[1]), ""});
  if (found.empty()) limit_cells(section(), "edge", fmt::format("found {:g}: ", edge), found);
  return found;
}

// Demands that no grid can satisfy, found by an attempt to make its lines.
std::vector<Complaint> contradictions(const SectionBox& box, const Points& points) {
  std::vector<std::string> notes;
  if (auto found = off_plane(points); !found.empty()) return found;
  return complaints_of(
      [&] { lines_along(box, 0, points, notes), lines_along(box, 1, points, notes); });
}

std::vector<Complaint> contradictions(const IndentedDisc& disc, const Points& points) {
  return contradictions(disc.section(), points);
}

}  // namespace langer
