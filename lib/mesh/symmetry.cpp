#include "mesh/symmetry.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

namespace langer {

namespace {

// Nodes by place, in boxes of a given width.
class Places {
 public:
  Places(const std::vector<Vec3>& X, double width) : X_(X), width_(width) {
    for (std::size_t i = 0; i < X.size(); ++i) boxes_[key(box(X[i], 0), box(X[i], 1), box(X[i], 2))].push_back(static_cast<int>(i));
  }
  int at(const Vec3& x, double tolerance) const {
    const Vec3 r = Vec3::Constant(tolerance);
    for (long i = box(x - r, 0); i <= box(x + r, 0); ++i)
      for (long j = box(x - r, 1); j <= box(x + r, 1); ++j)
        for (long k = box(x - r, 2); k <= box(x + r, 2); ++k)
          if (const auto found = boxes_.find(key(i, j, k)); found != boxes_.end())
            for (int node : found->second)
              if ((X_[node] - x).norm() <= tolerance) return node;
    return -1;
  }

 private:
  long box(const Vec3& x, int k) const { return std::lround(std::floor(x[k] / width_)); }
  static std::size_t key(long i, long j, long k) {
    return static_cast<std::size_t>(i) * 73856093u ^ static_cast<std::size_t>(j) * 19349663u ^
           static_cast<std::size_t>(k) * 83492791u;
  }
  const std::vector<Vec3>& X_;
  double width_;
  std::unordered_map<std::size_t, std::vector<int>> boxes_;
};

std::vector<int> sorted(std::vector<int> nodes) {
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

Vec3 centroid(const Mesh& mesh, int e) {
  Vec3 sum = Vec3::Zero();
  for (int a : mesh.cell(e)) sum += mesh.X[a];
  return sum / static_cast<double>(mesh.cell(e).size());
}

// The place of an orbit that comes first: farthest along x, then z, then y. Ties within rounding go on to the next coordinate.
bool before(const Vec3& a, const Vec3& b, double tolerance) {
  for (int k : {0, 2, 1})
    if (std::abs(a[k] - b[k]) > tolerance) return a[k] > b[k];
  return false;
}

double size_of(const Mesh& mesh) {
  Vec3 low = mesh.X[0], high = mesh.X[0];
  for (const Vec3& X : mesh.X) low = low.cwiseMin(X), high = high.cwiseMax(X);
  return (high - low).norm();
}

}  // namespace

std::optional<Symmetry> find_symmetry(const Mesh& mesh, const Vec3& signs, const Vec3& centre) {
  Symmetry s{signs, centre, {}, {}};
  const double size = size_of(mesh), tolerance = 1e-9 * size;
  const Places places(mesh.X, size / std::cbrt(static_cast<double>(mesh.X.size())));
  for (const Vec3& X : mesh.X) {
    const int image = places.at(centre + signs.cwiseProduct(X - centre), tolerance);
    if (image < 0) return std::nullopt;
    s.node.push_back(image);
  }
  std::vector<std::vector<int>> cells_of(mesh.X.size()), nodes_of;
  for (int e = 0; e < mesh.n_cells(); ++e) {
    nodes_of.push_back(sorted({mesh.cell(e).begin(), mesh.cell(e).end()}));
    cells_of[nodes_of[e][0]].push_back(e);
  }
  for (int e = 0; e < mesh.n_cells(); ++e) {
    std::vector<int> image;
    for (int a : nodes_of[e]) image.push_back(s.node[a]);
    image = sorted(std::move(image));
    int found = -1;
    for (int c : cells_of[image[0]])
      if (nodes_of[c] == image) found = c;
    if (found < 0 || (!mesh.body.empty() && mesh.body[found] != mesh.body[e])) return std::nullopt;
    s.cell.push_back(found);
  }
  return s;
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
void keep_cells(const Mesh& mesh, const std::vector<Symmetry>& group, double tolerance, Quotient& q) {
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
    orbit = sorted(std::move(orbit));
    orbit.erase(std::unique(orbit.begin(), orbit.end()), orbit.end());
    kept_cell[e] = static_cast<int>(q.cell.size());
    q.cell.push_back(e);
    q.cell_share.push_back(static_cast<double>(orbit.size()));
  }
  for (int& cell : q.cell_image) cell = kept_cell[cell];
}

// The mesh of the kept cells; returns the kept node of each node of the whole, -1 where no kept cell has it.
std::vector<int> make_part(const Mesh& mesh, Quotient& q) {
  q.mesh.type = mesh.type, q.mesh.bodies = mesh.bodies;
  std::vector<int> kept_node(mesh.X.size(), -1);
  for (int e : q.cell) {
    if (!mesh.body.empty()) q.mesh.body.push_back(mesh.body[e]);
    if (!mesh.frames.empty()) q.mesh.frames.push_back(mesh.frames[e]);
    for (int a : mesh.cell(e)) kept_node[a] = 0;
  }
  for (std::size_t i = 0; i < kept_node.size(); ++i)
    if (kept_node[i] == 0) {
      kept_node[i] = static_cast<int>(q.node.size());
      q.node.push_back(static_cast<int>(i));
      q.mesh.X.push_back(mesh.X[i]);
    }
  q.mesh.connectivity.reserve(q.cell.size() * static_cast<std::size_t>(nodes_per_cell(mesh.type)));
  for (int e : q.cell)
    for (int a : mesh.cell(e)) q.mesh.connectivity.push_back(kept_node[a]);
  return kept_node;
}

// Each node in terms of the kept node of its orbit that comes first.
void tie_nodes(const Mesh& mesh, const std::vector<Symmetry>& group, const std::vector<int>& kept_node, double tolerance,
               Quotient& q) {
  q.node_share.assign(q.node.size(), 0);
  for (std::size_t n = 0; n < mesh.X.size(); ++n) {
    int master = -1, orbit = 0;
    int kept = 0;
    Vec3 signs = Vec3::Ones(), allowed = Vec3::Ones();
    for (const Symmetry& g : group) {
      const int other = g.node[n];
      if (other == static_cast<int>(n)) {  // what it maps onto itself with a change of sign vanishes
        ++orbit;
        for (int k = 0; k < 3; ++k)
          if (g.signs[k] < 0) allowed[k] = 0;
      }
      if (kept_node[other] < 0 || (master >= 0 && !before(mesh.X[other], mesh.X[master], tolerance))) continue;
      master = other, kept = kept_node[other], signs = g.signs;
    }
    // the image of a node that other symmetries leave in place has their zeros too
    q.node_image.push_back({kept, signs.cwiseProduct(allowed).asDiagonal()});
    if (q.node[kept] == static_cast<int>(n)) q.node_share[kept] = static_cast<double>(group.size()) / orbit;
  }
  for (int n : q.node) q.tie.push_back(q.node_image[n]);
}

}  // namespace

Quotient quotient(const Mesh& mesh, const std::vector<Symmetry>& generators) {
  const double tolerance = 1e-7 * size_of(mesh);
  const std::vector<Symmetry> group = group_of(mesh, generators);
  Quotient q;
  keep_cells(mesh, group, tolerance, q);
  const std::vector<int> kept_node = make_part(mesh, q);
  tie_nodes(mesh, group, kept_node, tolerance, q);
  return q;
}

}  // namespace langer
