#include "results/store/vtk_grid.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/text.hpp"
#include "core/hdf5/unit_attribute.hpp"
#include "mechanics/mesh/hanging.hpp"
#include "mechanics/mesh/reference.hpp"
#include "mechanics/mesh/section.hpp"

namespace langer {

namespace {

using Integers = std::vector<std::int64_t>;
constexpr const char* axes[3] = {"e_x", "e_y", "e_z"};

void write_integers(const h5::Group& group, const std::string& name, const h5::Shape& shape,
                    const Integers& values) {
  group.write<std::int64_t>(name, shape, values);
}

// The frame of element e, from the columns of all frames.
Mat3 orthonormal(const h5::Group& group, const std::vector<double>* columns, int e) {
  Mat3 frame;
  for (int i = 0; i < 3; ++i) frame.col(i) = Vec3(columns[i].data() + std::size_t{3} * e);
  // Files keep all digits of a double. 1e-9 allows for frames made by other tools.
  if (!((frame.transpose() * frame - Mat3::Identity()).norm() < 1e-9 && frame.determinant() > 0))
    group.refuse("e_x", fmt::format("the frame of cell {} is not orthonormal and right-handed", e));
  return frame;
}

// Whole numbers from 0 to below a bound.
std::vector<int> indices(const h5::Group& group, const std::string& name, const h5::Shape& shape,
                         std::int64_t below) {
  const auto array = group.read<std::int64_t>(name, shape);
  for (std::int64_t value : array.values)
    if (value < 0 || value >= below)
      group.refuse(name, fmt::format("index {}", value), fmt::format("0 to {}", below - 1));
  return {array.values.begin(), array.values.end()};
}

// A number of points or elements. The bound keeps products with 8 nodes within int.
std::int64_t count(const h5::Group& group, const std::string& name) {
  const std::int64_t n = group.read<std::int64_t>(name, {1}).values[0];
  if (n < 1 || n > std::numeric_limits<int>::max() / 8)
    group.refuse(name, fmt::format("{}", n), "a count of at least 1");
  return n;
}

}  // namespace

std::vector<double> flat(const std::vector<Vec3>& vectors) {
  std::vector<double> values;
  values.reserve(3 * vectors.size());
  for (const Vec3& v : vectors) values.insert(values.end(), v.data(), v.data() + 3);
  return values;
}

std::vector<Vec3> vectors(const std::vector<double>& flat) {
  std::vector<Vec3> vectors(flat.size() / 3);
  for (std::size_t i = 0; i < vectors.size(); ++i) vectors[i] = Vec3(flat.data() + 3 * i);
  return vectors;
}

// The arrays that VTK asks for, then body and frame of each element as fields of elements.
h5::Group write_grid(const h5::Group& root, const Mesh& mesh, const Integers& version,
                     bool with_frames) {
  const h5::Group grid = root.make_group("VTKHDF");
  grid.attribute("Version", version);
  grid.attribute("Type", std::string("UnstructuredGrid"));
  const std::size_t n = mesh.X.size();
  const std::size_t e = static_cast<std::size_t>(mesh.n_cells());
  const std::size_t per_cell = nodes_per_cell(mesh.type);
  write_integers(grid, "NumberOfPoints", {1}, {static_cast<std::int64_t>(n)});
  write_integers(grid, "NumberOfCells", {1}, {static_cast<std::int64_t>(e)});
  write_integers(grid, "NumberOfConnectivityIds", {1}, {static_cast<std::int64_t>(e * per_cell)});
  grid.write<double>("Points", {n, 3}, flat(mesh.X), "mm");
  write_integers(grid, "Connectivity", {e * per_cell},
                 {mesh.connectivity.begin(), mesh.connectivity.end()});
  Integers offsets(e + 1);
  for (std::size_t i = 0; i <= e; ++i) offsets[i] = static_cast<std::int64_t>(i * per_cell);
  write_integers(grid, "Offsets", {e + 1}, offsets);
  grid.write<std::uint8_t>(
      "Types", {e}, std::vector<std::uint8_t>(e, static_cast<std::uint8_t>(mesh.cell().names.vtk)));

  const h5::Group cells = grid.make_group("CellData");
  write_integers(cells, "body", {e}, {mesh.body.begin(), mesh.body.end()});
  std::string names;
  for (const std::string& body : mesh.bodies) append(names, " ", body);
  cells.annotate("body", "names", names);
  for (int i = 0; i < 3 && with_frames; ++i) {
    std::vector<Vec3> column;
    for (const Mat3& frame : mesh.frames) column.push_back(frame.col(i));
    cells.write<double>(axes[i], {e, 3}, flat(column), "-");
  }
  return grid;
}

bool has_frames(const Mesh& mesh) {
  return std::any_of(mesh.frames.begin(), mesh.frames.end(),
                     [](const Mat3& frame) { return frame != Mat3::Identity(); });
}

// Node sets as numbers of nodes, facet sets as pairs of element and local facet.
void write_sets(const h5::Group& root, const Mesh& mesh) {
  const h5::Group sets = root.make_group("sets");
  const h5::Group nodes = sets.make_group("nodes");
  const h5::Group facets = sets.make_group("facets");
  for (const auto& [name, set] : mesh.node_sets)
    write_integers(nodes, name, {set.size()}, {set.begin(), set.end()});
  for (const auto& [name, set] : mesh.facet_sets) {
    Integers pairs;
    for (const Facet& facet : set) pairs.insert(pairs.end(), {facet.cell, facet.local});
    write_integers(facets, name, {set.size(), 2}, pairs);
  }
}

void write_section(const h5::Group& root, const Mesh& mesh) {
  if (!mesh.section) return;
  const h5::Group group = root.make_group("section");
  group.attribute("of", std::string(names(mesh.section->of)[static_cast<int>(mesh.section->of)]));
  const bool axisymmetric = mesh.section->of == SectionOf::axisymmetric;
  group.write_scalar("depth", mesh.section->depth, axisymmetric ? "-" : "mm");
}

// Each hanging node with the four nodes that it depends on. Two of them are repeated if it is on
// an edge.
void write_hanging(const h5::Group& root, const Mesh& mesh) {
  if (mesh.hanging.empty()) return;
  const h5::Group group = root.make_group("hanging");
  Integers nodes, of;
  for (const HangingNode& h : mesh.hanging) {
    nodes.push_back(h.node);
    of.insert(of.end(), h.of.begin(), h.of.end());
  }
  write_integers(group, "node", {nodes.size()}, nodes);
  write_integers(group, "of", {nodes.size(), 4}, of);
}

Schema schema_of(const Schema& schema, const Mesh& mesh) {
  if (!mesh.hanging.empty()) return {schema.name, 3};
  if (mesh.section) return Schema{schema.name, 2};
  return schema;
}

namespace {

// A section must be one layer of elements, as its mesher makes it.
void read_section(const h5::Group& root, Mesh& mesh) {
  if (!root.has("section")) return;
  const h5::Group group = root.group("section");
  const std::string of = group.text_attribute("of");
  const auto known = names(SectionOf{});
  const auto kind = std::find(known.begin(), known.end(), of);
  if (kind == known.end())
    group.refuse("of", "\"" + of + "\"", fmt::format("one of {}", fmt::join(known, ", ")));
  mesh.section = Section{static_cast<SectionOf>(kind - known.begin()), group.read_scalar("depth")};
  if (const std::string fault = section_fault(mesh); !fault.empty())
    group.refuse("", fault, "one layer of cells behind z = 0");
}

// The nodes must be between those of larger elements.
void read_hanging(const h5::Group& root, Mesh& mesh) {
  if (!root.has("hanging")) return;
  const h5::Group group = root.group("hanging");
  const auto below = static_cast<std::int64_t>(mesh.X.size());
  const std::vector<int> nodes = indices(group, "node", {h5::any}, below);
  const std::vector<int> of = indices(group, "of", {nodes.size(), 4}, below);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    mesh.hanging.push_back({nodes[i], {of[4 * i], of[4 * i + 1], of[4 * i + 2], of[4 * i + 3]}});
  if (const std::string fault = hanging_fault(mesh); !fault.empty())
    group.refuse("node", fault, "nodes between those of larger hexahedra");
}

// The type of all elements; refuses types that are unknown or mixed.
CellType type_of(const h5::Group& grid, const std::vector<std::uint8_t>& types) {
  std::string known;
  for (const ReferenceCell& cell : reference_cells()) {
    if (std::ranges::count(types, cell.names.vtk) == std::ssize(types)) return cell.type;
    append(known, ", ", fmt::format("{} ({})", cell.names.vtk, cell.names.vtk_word));
  }
  // The message names the first type that differs from the others, or the type of all.
  std::uint8_t found = types[0];
  for (std::uint8_t type : types) {
    if (found == types[0]) found = type;
  }
  grid.refuse("Types", fmt::format("VTK cell type {}", found), "one of " + known + "; one for all");
}

}  // namespace

// Every index is checked before it is used, so that a damaged file cannot crash a stage.
Mesh read_grid(const h5::Group& root) {
  const h5::Group grid = root.group("VTKHDF");
  const h5::Group cells = grid.group("CellData");
  Mesh mesh;
  const std::size_t n = static_cast<std::size_t>(count(grid, "NumberOfPoints"));
  const std::size_t e = static_cast<std::size_t>(count(grid, "NumberOfCells"));
  const auto types = grid.read<std::uint8_t>("Types", {e}).values;
  mesh.type = type_of(grid, types);
  const std::int64_t per_cell = nodes_per_cell(mesh.type);
  require_unit(grid, "Points", "mm");
  mesh.X = vectors(grid.read_finite("Points", {n, 3}));
  mesh.connectivity = indices(grid, "Connectivity", {e * per_cell}, static_cast<std::int64_t>(n));
  // All elements have the same number of nodes, so the offsets must be its multiples.
  const auto offsets = grid.read<std::int64_t>("Offsets", {e + 1});
  for (std::size_t i = 0; i <= e; ++i)
    if (offsets.values[i] != static_cast<std::int64_t>(i) * per_cell)
      grid.refuse("Offsets", fmt::format("cells that do not have {} nodes each", per_cell));

  // The body and the frame of each element.
  std::istringstream names(cells.annotation("body", "names"));
  for (std::string name; names >> name;) mesh.bodies.push_back(name);
  mesh.body = indices(cells, "body", {e}, static_cast<std::int64_t>(mesh.bodies.size()));
  // Without frames all are the global axes.
  mesh.frames.assign(e, Mat3::Identity());
  const bool framed = std::any_of(std::begin(axes), std::end(axes),
                                  [&](const auto& axis) { return cells.has(axis); });
  std::vector<double> columns[3];
  for (int i = 0; i < 3 && framed; ++i) columns[i] = cells.read_finite(axes[i], {e, 3});
  for (std::size_t i = 0; i < e && framed; ++i)
    mesh.frames[i] = orthonormal(cells, columns, static_cast<int>(i));

  // Sets of nodes, and of facets as pairs of element and local facet.
  const h5::Group sets = root.group("sets");
  const h5::Group nodes = sets.group("nodes");
  const h5::Group facets = sets.group("facets");
  for (const std::string& name : nodes.datasets())
    mesh.node_sets[name] = indices(nodes, name, {h5::any}, static_cast<std::int64_t>(n));
  for (const std::string& name : facets.datasets()) {
    const std::vector<int> pairs =
        indices(facets, name, {h5::any, 2},
                std::max(static_cast<std::int64_t>(e), std::int64_t{mesh.cell().n_facets()}));
    auto& set = mesh.facet_sets[name];
    for (std::size_t i = 0; i < pairs.size(); i += 2) {
      if (pairs[i] >= static_cast<int>(e) || pairs[i + 1] >= mesh.cell().n_facets())
        facets.refuse(name, fmt::format("cell {}, local facet {}", pairs[i], pairs[i + 1]),
                      "a facet of this mesh");
      set.push_back({pairs[i], pairs[i + 1]});
    }
  }
  read_section(root, mesh);
  read_hanging(root, mesh);
  return mesh;
}

// The surface of an indenter: points and the corners of its triangles.
void write_triangles(const h5::Group& group, const Triangles& triangles) {
  group.write<double>("points", {triangles.points.size(), 3}, flat(triangles.points), "mm");
  Integers corners;
  for (const auto& triangle : triangles.corners)
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  write_integers(group, "triangles", {triangles.corners.size(), 3}, corners);
}

Triangles read_triangles(const h5::Group& group) {
  Triangles triangles;
  require_unit(group, "points", "mm");
  triangles.points = vectors(group.read_finite("points", {h5::any, 3}));
  const std::vector<int> corners =
      indices(group, "triangles", {h5::any, 3}, static_cast<std::int64_t>(triangles.points.size()));
  if (corners.empty()) group.refuse("triangles", "none", "the triangles of a surface");
  for (std::size_t i = 0; i < corners.size(); i += 3)
    triangles.corners.push_back({corners[i], corners[i + 1], corners[i + 2]});
  return triangles;
}

}  // namespace langer
