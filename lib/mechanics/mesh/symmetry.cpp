#include "mechanics/mesh/symmetry.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "mechanics/mesh/bounding_box.hpp"
#include "mechanics/mesh/mirror_image.hpp"

namespace langer {

namespace {

Vec3 centroid(const Mesh& mesh, int e) {
  Vec3 sum = Vec3::Zero();
  for (int a : mesh.cell(e)) sum += mesh.X[a];
  return sum / static_cast<double>(mesh.cell(e).size());
}

// The place of an orbit that comes first: farthest along x, then z, then y. Ties within rounding go
// on to the next coordinate.
bool before(const Vec3& a, const Vec3& b, double tolerance) {
  for (int k : {0, 2, 1})
    if (std::abs(a[k] - b[k]) > tolerance) return a[k] > b[k];
  return false;
}

}  // namespace

std::optional<Symmetry> find_symmetry(const Mesh& mesh, const Vec3& signs, const Vec3& centre) {
  auto image = find_image(mesh, signs.asDiagonal(), centre);
  if (!image) return std::nullopt;
  return Symmetry{signs, centre, std::move(image->node), std::move(image->cell)};
}

std::vector<Symmetry> group_of(const Mesh& mesh, const std::vector<Symmetry>& generators) {
  std::vector<Symmetry> group(1);
  group[0].node.resize(mesh.X.size()), group[0].cell.resize(mesh.n_cells());
  std::iota(group[0].node.begin(), group[0].node.end(), 0);
  std::iota(group[0].cell.begin(), group[0].cell.end(), 0);
  for (const Symmetry& g : generators)
    for (std::size_t i = 0, n = group.size(); i < n; ++i) {
      Symmetry product = group[i];
      product.signs = product.signs.cwiseProduct(g.signs);
      for (int& node : product.node) node = g.node[node];
      for (int& cell : product.cell) cell = g.cell[cell];
      group.push_back(std::move(product));
    }
  return group;
}

namespace {

// The first cell of each orbit, with its share.
void keep_cells(const Mesh& mesh, const std::vector<Symmetry>& group, double tolerance,
                Quotient& q) {
  std::vector<int> kept_cell(mesh.n_cells(), -1);
  q.cell_image.resize(mesh.n_cells());
  for (int e = 0; e < mesh.n_cells(); ++e) {
    int first = e;
    std::vector<int> orbit;
    for (const Symmetry& g : group) {
      orbit.push_back(g.cell[e]);
      if (before(centroid(mesh, g.cell[e]), centroid(mesh, first), tolerance)) first = g.cell[e];
    }
    q.cell_image[e] = first;
    if (first != e) continue;
    std::sort(orbit.begin(), orbit.end());
    orbit.erase(std::unique(orbit.begin(), orbit.end()), orbit.end());
    kept_cell[e] = static_cast<int>(q.cell.size());
    q.cell.push_back(e);
    q.cell_share.push_back(static_cast<double>(orbit.size()));
  }
  for (int& cell : q.cell_image) cell = kept_cell[cell];
}

// The mesh of the kept cells; returns the kept node of each node of the whole, -1 where no kept
// cell has it.
std::vector<int> make_part(const Mesh& mesh, Quotient& q) {
  q.mesh.type = mesh.type;
  q.mesh.bodies = mesh.bodies;
  std::vector<int> kept_node(mesh.X.size(), -1);
  for (int e : q.cell) {
    if (!mesh.body.empty()) q.mesh.body.push_back(mesh.body[e]);
    if (!mesh.frames.empty()) q.mesh.frames.push_back(mesh.frames[e]);
    for (int a : mesh.cell(e)) kept_node[a] = 0;
  }
  for (const HangingNode& h : mesh.hanging)  // with those that they hang on
    if (kept_node[h.node] == 0)
      for (int n : h.of) kept_node[n] = 0;
  for (std::size_t i = 0; i < kept_node.size(); ++i)
    if (kept_node[i] == 0) {
      kept_node[i] = static_cast<int>(q.node.size());
      q.node.push_back(static_cast<int>(i));
      q.mesh.X.push_back(mesh.X[i]);
    }
  q.mesh.connectivity.reserve(q.cell.size() * static_cast<std::size_t>(nodes_per_cell(mesh.type)));
  for (int e : q.cell)
    for (int a : mesh.cell(e)) q.mesh.connectivity.push_back(kept_node[a]);
  for (const HangingNode& h : mesh.hanging) {
    if (kept_node[h.node] < 0) continue;
    HangingNode kept{kept_node[h.node], {}};
    for (std::size_t k = 0; k < 4; ++k) kept.of[k] = kept_node[h.of[k]];
    q.mesh.hanging.push_back(kept);
  }
  return kept_node;
}

// Sign of each element of the group for fields that change sign under the generators in `changing`,
// one bit for each generator in their order. Element i of group_of is the product of the generators
// whose bits i has.
double sign_of(std::size_t element, unsigned changing) {
  return std::popcount(static_cast<unsigned>(element) & changing) % 2 == 0 ? 1 : -1;
}

// Node n in terms of the kept node of its orbit that comes first, for fields that obey
// u(X') = +-S u(X), minus where the element of the group changes the sign.
Image image_of_node(const Mesh& mesh, const std::vector<Symmetry>& group,
                    const std::vector<int>& kept_node, unsigned changing, std::size_t n,
                    double tolerance) {
  int master = -1;
  int kept = 0;
  Vec3 signs = Vec3::Ones();
  Vec3 allowed = Vec3::Ones();
  for (std::size_t i = 0; i < group.size(); ++i) {
    const Symmetry& g = group[i];
    const Vec3 turned = sign_of(i, changing) * g.signs;
    const int other = g.node[n];
    if (other == static_cast<int>(n)) {
      // what the node maps onto itself with a change of sign vanishes
      for (int k = 0; k < 3; ++k) {
        if (turned[k] < 0) allowed[k] = 0;
      }
    }
    if (kept_node[other] < 0) continue;
    if (master >= 0 && !before(mesh.X[other], mesh.X[master], tolerance)) continue;
    master = other;
    kept = kept_node[other];
    signs = turned;
  }
  // the image of a node that other symmetries leave in place has their zeros too
  return {kept, signs.cwiseProduct(allowed).asDiagonal()};
}

// Each node in terms of the kept node of its orbit that comes first.
void tie_nodes(const Mesh& mesh, const std::vector<Symmetry>& group,
               const std::vector<int>& kept_node, double tolerance, Quotient& q) {
  q.node_share.assign(q.node.size(), 0);
  for (std::size_t n = 0; n < mesh.X.size(); ++n) {
    const Image image = image_of_node(mesh, group, kept_node, 0, n, tolerance);
    q.node_image.push_back(image);
    if (q.node[image.of] != static_cast<int>(n)) continue;
    const auto stays = [&](const Symmetry& g) {
      return g.node[n] == static_cast<int>(n);
    };
    q.node_share[image.of] = static_cast<double>(group.size()) /
                             static_cast<double>(std::count_if(group.begin(), group.end(), stays));
  }
  for (int n : q.node) q.tie.push_back(q.node_image[n]);
}

}  // namespace

Quotient quotient(const Mesh& mesh, const std::vector<Symmetry>& generators) {
  const double tolerance = 1e-7 * bounding_box(mesh.X).size().norm();
  const std::vector<Symmetry> group = group_of(mesh, generators);
  Quotient q;
  keep_cells(mesh, group, tolerance, q);
  const std::vector<int> kept_node = make_part(mesh, q);
  tie_nodes(mesh, group, kept_node, tolerance, q);
  return q;
}

std::vector<std::vector<Image>> symmetry_breaking_ties(const Mesh& mesh,
                                                       const std::vector<Symmetry>& generators,
                                                       const Quotient& q) {
  const double tolerance = 1e-7 * bounding_box(mesh.X).size().norm();
  const std::vector<Symmetry> group = group_of(mesh, generators);
  std::vector<int> kept_node(mesh.X.size(), -1);
  for (std::size_t i = 0; i < q.node.size(); ++i) kept_node[q.node[i]] = static_cast<int>(i);
  std::vector<std::vector<Image>> ties;
  for (unsigned changing = 1; changing < group.size(); ++changing) {
    std::vector<Image>& of_kept = ties.emplace_back();
    for (int n : q.node) {
      of_kept.push_back(
          image_of_node(mesh, group, kept_node, changing, static_cast<std::size_t>(n), tolerance));
    }
  }
  return ties;
}

}  // namespace langer
