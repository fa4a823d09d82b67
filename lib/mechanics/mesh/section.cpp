#include "mechanics/mesh/section.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/reference.hpp"

namespace langer {

namespace {

// z of a node at a share of the depth. A plane section has a constant depth in mm. An axisymmetric
// one is a wedge: its depth grows with the radius X[0], and it is 0 on the axis.
double depth_at(const Section& section, const Vec3& X, double share) {
  if (section.of == SectionOf::axisymmetric) return share * section.depth * X[0];
  return share * section.depth;
}

// Local nodes of a cell: each with zeta = -1, followed by those behind it.
std::vector<std::vector<int>> columns(const ReferenceCell& cell) {
  const auto& node = cell.node;
  std::vector<std::vector<int>> columns;
  for (std::size_t a = 0; a < node.size(); ++a) {
    if (node[a][2] != -1) continue;
    std::vector<int> behind;
    for (int k = 0; k < cell.layers; ++k) {
      const Vec3 xi(node[a][0], node[a][1], -1 + 2.0 * k / (cell.layers - 1));
      behind.push_back(static_cast<int>(std::find(node.begin(), node.end(), xi) - node.begin()));
    }
    columns.push_back(behind);
  }
  return columns;
}

}  // namespace

// Nodes are numbered layer by layer from z = 0, each layer with the same number of nodes.
int n_front(const Mesh& mesh) { return mesh.n_nodes() / mesh.cell().layers; }

// A wedge has the depth "depth" at the radius 1 mm, so a circle of 2 pi has 2 pi / depth wedges.
// Forces of a plane section are those of its depth, without a factor.
double cell_share(const Section& section) {
  if (section.of == SectionOf::axisymmetric) {
    return 2 * std::numbers::pi / section.depth;
  }
  return 1;
}

// Only nodes in front have unknowns. Those behind repeat them: in a plane section u_x and u_y are
// the same and u_z is 0 (plane strain). In a wedge u_z follows from the rotation about the axis,
// u_z = u_r z / r, which to first order in the small angle keeps the ring a ring. On the axis the
// radial displacement is 0.
std::vector<Image> section_ties(const Mesh& mesh) {
  const int n = n_front(mesh);
  const int layers = mesh.cell().layers;
  const bool round = mesh.section->of == SectionOf::axisymmetric;
  std::vector<Image> ties;
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    Image image{i % n, Vec3(round && mesh.X[i][0] == 0 ? 0 : 1, 1, 0).asDiagonal()};
    if (round && image.T(0, 0) != 0) image.T(2, 0) = mesh.section->depth * (i / n) / (layers - 1);
    ties.push_back(image);
  }
  return ties;
}

// Renumbers a mesh that is one cell deep so that node k n + i is behind node i, and moves its nodes
// to the depths of the section. Nodes without a cell are dropped.
void make_section(Mesh& mesh, const Section& section) {
  const int layers = mesh.cell().layers;
  std::vector<int> front(mesh.X.size(), -1), layer(mesh.X.size(), 0);
  std::vector<Vec3> X;
  const auto in_cell = columns(mesh.cell());
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (const auto& column : in_cell)
      for (int k = 0; k < layers; ++k) {
        const int node = mesh.cell(e)[column[k]];
        const int first = mesh.cell(e)[column[0]];
        if (front[first] < 0) {
          front[first] = static_cast<int>(X.size());
          X.push_back(mesh.X[first]);
        }
        front[node] = front[first];
        layer[node] = k;
      }
  const int n = static_cast<int>(X.size());
  mesh.X.clear();
  for (int k = 0; k < layers; ++k)
    for (const Vec3& x : X)
      mesh.X.emplace_back(x[0], x[1], depth_at(section, x, static_cast<double>(k) / (layers - 1)));
  for (int& node : mesh.connectivity) node = layer[node] * n + front[node];
  mesh.section = section;
}

// Checks a section read from a file against all that make_section promises; an empty text means no
// fault. Other parts rely on the numbering without further checks.
std::string section_fault(const Mesh& mesh) {
  const Section& section = *mesh.section;
  if (!mesh.cell().hexahedron()) return "cells that are no hexahedra";
  const int n = n_front(mesh);
  const int layers = mesh.cell().layers;
  if (!(section.depth > 0 && std::isfinite(section.depth)))
    return fmt::format("a depth of {}", section.depth);
  if (mesh.n_nodes() != n * layers)
    return fmt::format("{} nodes in {} layers", mesh.n_nodes(), layers);
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const Vec3 &X = mesh.X[i], &front = mesh.X[i % n];
    // x and y are copies and agree to the last bit; z was computed and may differ by rounding.
    const double z = depth_at(section, front, static_cast<double>(i / n) / (layers - 1));
    if (X[0] != front[0] || X[1] != front[1] || !(std::abs(X[2] - z) <= 1e-12 * std::abs(z)))
      return fmt::format("node {} is not behind node {}", i, i % n);
    if (section.of == SectionOf::axisymmetric && X[0] < 0)
      return fmt::format("node {} has the radius {} mm", i, X[0]);
  }
  const auto in_cell = columns(mesh.cell());
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (const auto& column : in_cell)
      for (int k = 0; k < layers; ++k)
        if (mesh.cell(e)[column[k]] != k * n + mesh.cell(e)[column[0]])
          return fmt::format("cell {} does not reach from z = 0 to the back", e);
  // Conditions are set on the front, and the ties bring them to the nodes behind.
  for (const auto& [name, nodes] : mesh.node_sets)
    for (int node : nodes)
      if (node >= n) return fmt::format("the set \"{}\" has a node that is not in z = 0", name);
  return "";
}

// A set of nodes of any layer, extended to all nodes in front of them and behind them.
std::vector<int> through_layers(const Mesh& mesh, const std::vector<int>& nodes) {
  std::vector<int> all;
  for (int node : nodes)
    for (int i = node % n_front(mesh); i < mesh.n_nodes(); i += n_front(mesh)) all.push_back(i);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

// The part of a set that has unknowns.
std::vector<int> in_front(const Mesh& mesh, const std::vector<int>& nodes) {
  std::vector<int> front;
  std::copy_if(nodes.begin(), nodes.end(), std::back_inserter(front),
               [n = n_front(mesh)](int node) { return node < n; });
  return front;
}

// The same cells with the same depth everywhere, two units of the reference cell, so that their
// shape in the plane alone decides on their quality.
Mesh as_plate(const Mesh& mesh) {
  Mesh plate = mesh;
  const int n = n_front(mesh);
  const int layers = mesh.cell().layers;
  for (int i = 0; i < mesh.n_nodes(); ++i) plate.X[i][2] = 2.0 * (i / n) / (layers - 1);
  plate.section.reset();
  return plate;
}

// The facets of a set that are part of the surface of the body. The faces z = 0 and z = depth of a
// section are cuts through the body and carry no loads: facets with all their nodes in front or
// none of them are removed.
std::vector<Facet> surface_of(const Mesh& mesh, const std::string& set) {
  const auto found = mesh.facet_sets.find(set);
  std::vector<Facet> facets;
  if (found != mesh.facet_sets.end()) facets = found->second;
  if (mesh.section)
    std::erase_if(facets, [&](const Facet& facet) {
      const std::vector<int> nodes = facet_nodes(mesh, facet);
      const auto in_front =
          std::count_if(nodes.begin(), nodes.end(), [&](int n) { return n < n_front(mesh); });
      return in_front == 0 || in_front == static_cast<std::ptrdiff_t>(nodes.size());
    });
  return facets;
}

}  // namespace langer
