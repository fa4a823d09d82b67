#include "mechanics/mesh/mirror_image.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "mechanics/mesh/bounding_box.hpp"

namespace langer {

namespace {

// By node, the first of the bodies that have it; -1 of a node without cells. Bodies that touch have
// nodes of their own at the same place.
std::vector<int> first_bodies(const Mesh& mesh) {
  std::vector<int> first(mesh.X.size(), -1);
  for (int e = 0; e < mesh.n_cells(); ++e) {
    const int body = mesh.body.empty() ? 0 : mesh.body[static_cast<std::size_t>(e)];
    for (int node : mesh.cell(e)) {
      int& known = first[static_cast<std::size_t>(node)];
      if (known < 0 || body < known) known = body;
    }
  }
  return first;
}

// Nodes by place, in boxes of a given width.
class Places {
 public:
  Places(const std::vector<Vec3>& X, std::vector<int> body, double width)
      : X_(X), body_(std::move(body)), width_(width) {
    for (std::size_t i = 0; i < X.size(); ++i)
      boxes_[key(box(X[i], 0), box(X[i], 1), box(X[i], 2))].push_back(static_cast<int>(i));
  }
  // the image of a node at x
  int image_of(std::size_t of, const Vec3& x, double tolerance) const {
    const Vec3 r = Vec3::Constant(tolerance);
    for (long i = box(x - r, 0); i <= box(x + r, 0); ++i)
      for (long j = box(x - r, 1); j <= box(x + r, 1); ++j)
        for (long k = box(x - r, 2); k <= box(x + r, 2); ++k)
          if (const auto found = boxes_.find(key(i, j, k)); found != boxes_.end())
            for (int node : found->second)
              if ((X_[node] - x).norm() <= tolerance && body_[node] == body_[of]) return node;
    return -1;
  }

 private:
  long box(const Vec3& x, int k) const { return std::lround(std::floor(x[k] / width_)); }
  static std::size_t key(long i, long j, long k) {
    return static_cast<std::size_t>(i) * 73856093u ^ static_cast<std::size_t>(j) * 19349663u ^
           static_cast<std::size_t>(k) * 83492791u;
  }
  const std::vector<Vec3>& X_;
  const std::vector<int> body_;  // by node
  double width_;
  std::unordered_map<std::size_t, std::vector<int>> boxes_;
};

// Cells are compared by their sets of nodes: an image may begin at another corner.
std::vector<int> sorted(std::vector<int> nodes) {
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

}  // namespace

// For each node and each cell, the one to which a rotation or a reflection about a centre moves it.
// No result where one of them has no image, so that the mesh does not have this symmetry. Bodies
// must be mapped onto themselves: two bodies of the same shape may have different materials.
std::optional<MeshImage> find_image(const Mesh& mesh, const Mat3& turn, const Vec3& centre) {
  MeshImage s{turn, centre, {}, {}};
  const double size = bounding_box(mesh.X).size().norm();
  const double tolerance = 1e-9 * size;
  // About one node in each box, as many boxes as nodes in a filled cube.
  const Places places(mesh.X, first_bodies(mesh),
                      size / std::cbrt(static_cast<double>(mesh.X.size())));
  for (std::size_t i = 0; i < mesh.X.size(); ++i) {
    const int image = places.image_of(i, centre + turn * (mesh.X[i] - centre), tolerance);
    if (image < 0) return std::nullopt;
    s.node.push_back(image);
  }
  std::vector<std::vector<int>> cells_of(mesh.X.size()), nodes_of;
  for (int e = 0; e < mesh.n_cells(); ++e) {
    nodes_of.push_back(sorted({mesh.cell(e).begin(), mesh.cell(e).end()}));
    // Each cell is entered under its smallest node, which is enough to find it quickly.
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

}  // namespace langer
