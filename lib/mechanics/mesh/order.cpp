#include "mechanics/mesh/order.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "mechanics/mesh/quality.hpp"
#include "mechanics/mesh/reference.hpp"
#include "mechanics/mesh/select.hpp"

namespace langer {

namespace {

// the 24 rotations of a cube: signed permutations with determinant 1
std::vector<Mat3> cube_rotations() {
  std::vector<Mat3> rotations;
  std::array<int, 3> axes{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Mat3 R = Mat3::Zero();
      for (int i = 0; i < 3; ++i) R(axes[i], i) = signs >> i & 1 ? -1 : 1;
      if (R.determinant() > 0) rotations.push_back(R);
    }
  } while (std::next_permutation(axes.begin(), axes.end()));
  return rotations;
}

// Nodes of the reference cell are at coordinates -1, 0 and 1: 0.5 separates them all.
int node_near(const ReferenceCell& cell, const Vec3& xi) {
  for (int a = 0; a < cell.n_nodes; ++a)
    if ((cell.node[a] - xi).norm() < 0.5) return a;
  return -1;
}

using Cell = std::array<long long, 3>;  // position in units of 1e-9 of the mesh's size

Cell rounded(const Vec3& x, double unit) {
  return {std::llround(x[0] / unit), std::llround(x[1] / unit), std::llround(x[2] / unit)};
}

// Layer by layer in y, then z, then x. Rounded places are compared, so that noise in the last
// digits does not change the order.
std::vector<int> sorted_by_place(const std::vector<Vec3>& places, double unit) {
  std::vector<std::array<long long, 3>> keys;
  for (const Vec3& x : places) {
    const Cell c = rounded(x, unit);
    keys.push_back({c[1], c[2], c[0]});
  }
  std::vector<int> order(places.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return keys[a] < keys[b]; });
  return order;
}

}  // namespace

namespace {

// Renumbers the nodes of a cell as if its reference cube were turned by R. Its shape is unchanged.
void turn_cell(Mesh& mesh, int e, const Mat3& R) {
  const ReferenceCell& cell = mesh.cell();
  std::vector<int> nodes;
  for (const Vec3& xi : cell.node) nodes.push_back(mesh.cell(e)[node_near(cell, R * xi)]);
  std::copy(nodes.begin(), nodes.end(), mesh.connectivity.begin() + cell.n_nodes * e);
}

}  // namespace

// Turns each cell so that its reference axes follow x, y and z as closely as possible. Of equal
// rotations the first is kept. Results by cell then have the same orientation on all machines.
void turn_cells(Mesh& mesh) {
  const std::vector<Mat3> rotations = cube_rotations();
  for (int e = 0; e < mesh.n_cells(); ++e) {
    const Mat3 edges = jacobian(mesh, e, Vec3::Zero()).colwise().normalized();
    double best = -4;
    Mat3 turn;
    for (const Mat3& R : rotations)
      if (const double along = (edges * R).trace(); along > best + 1e-9) {
        best = along;
        turn = R;
      }
    turn_cell(mesh, e, turn);
  }
}

// In meshes made of blocks around an axis along y, the first reference axis shall point away from
// the axis. The core in the middle keeps its orientation. Mirrored blocks also agree on the
// direction around the axis, so that the mesh is its own mirror image, with cells and all.
void turn_outwards(Mesh& mesh, const Vec3& axis, double core, Blocks blocks) {
  const Mat3 quarter{{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}};  // of a turn about eta
  const Mat3 over{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}};    // half a turn about xi
  for (int e = 0; e < mesh.n_cells(); ++e) {
    Vec3 out = Vec3::Zero();
    for (int node : mesh.cell(e)) out += (mesh.X[node] - axis) / nodes_per_cell(mesh.type);
    out[1] = 0;
    if (out.lpNorm<Eigen::Infinity>() < core) continue;
    const Mat3 edges = jacobian(mesh, e, Vec3::Zero()).colwise().normalized();
    Mat3 turn = Mat3::Identity();
    for (Mat3 R = quarter; !R.isIdentity(); R = quarter * R)
      if ((edges * R).col(0).dot(out) > (edges * turn).col(0).dot(out)) turn = R;
    if (blocks == Blocks::mirrored) {
      const Vec3 around =
          (edges * turn)
              .col(2);  // nearer to z in the blocks at +x and -x, nearer to x in the others
      if ((std::abs(around[2]) > std::abs(around[0]) ? around[2] : around[0]) < 0)
        turn = turn * over;
    }
    turn_cell(mesh, e, turn);
  }
}

// Numbers nodes, then cells by their centres, in the order of places. A mesh of the same geometry
// has the same numbers in whichever way it was made.
void number_in_order(Mesh& mesh) {
  const double unit = 1e-9 * size(mesh);
  const std::vector<int> nodes = sorted_by_place(mesh.X, unit);
  std::vector<int> number(nodes.size());
  std::vector<Vec3> X;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    number[nodes[i]] = static_cast<int>(i);
    X.push_back(mesh.X[nodes[i]]);
  }
  mesh.X = std::move(X);
  for (int& n : mesh.connectivity) n = number[n];

  std::vector<Vec3> centres;
  for (int e = 0; e < mesh.n_cells(); ++e) {
    Vec3 centre = Vec3::Zero();
    for (int n : mesh.cell(e)) centre += mesh.X[n] / nodes_per_cell(mesh.type);
    centres.push_back(centre);
  }
  std::vector<int> connectivity;
  for (int e : sorted_by_place(centres, unit))
    connectivity.insert(connectivity.end(), mesh.cell(e).begin(), mesh.cell(e).end());
  mesh.connectivity = std::move(connectivity);
}

namespace {

// Finds the node at a place, to within the unit.
class Finder {
 public:
  Finder(const std::vector<Vec3>& X, double unit) : X_(X), unit_(unit) {
    for (std::size_t n = 0; n < X.size(); ++n) nodes_[rounded(X[n], unit)] = static_cast<int>(n);
  }
  std::optional<int> at(const Vec3& x) const {
    const Cell c = rounded(x, unit_);
    for (long long i : {0, -1, 1})
      for (long long j : {0, -1, 1})
        for (long long k : {0, -1, 1})
          if (const auto found = nodes_.find({c[0] + i, c[1] + j, c[2] + k});
              found != nodes_.end() && (X_[found->second] - x).norm() < unit_)
            return found->second;
    return {};
  }

 private:
  const std::vector<Vec3>& X_;
  double unit_;
  std::map<Cell, int> nodes_;
};

}  // namespace

// Removes the rounding errors of a symmetric mesh: each node becomes the exact image of one
// representative. The symmetries x -> -x, z -> -z and the exchange of x and z are found first,
// about a vertical axis through the centre; those the mesh does not have are left out.
void make_symmetric(Mesh& mesh, const Vec3& centre) {
  const double unit = 1e-7 * size(mesh);
  std::vector<Vec3> from_centre;
  for (const Vec3& x : mesh.X) from_centre.push_back(x - centre);
  const Finder finder(from_centre, unit);
  const auto unchanged = [&](auto image) {
    return std::all_of(from_centre.begin(), from_centre.end(),
                       [&](const Vec3& x) { return finder.at(image(x)).has_value(); });
  };
  const bool x_mirror = unchanged([](const Vec3& x) { return Vec3(-x[0], x[1], x[2]); });
  const bool z_mirror = unchanged([](const Vec3& x) { return Vec3(x[0], x[1], -x[2]); });
  const bool exchange =
      x_mirror && z_mirror && unchanged([](const Vec3& x) { return Vec3(x[2], x[1], x[0]); });

  for (std::size_t n = 0; n < mesh.X.size(); ++n) {
    // the image in the sector x >= 0, z >= 0, x >= z: as far as the mesh has these symmetries
    Vec3 x = from_centre[n];
    const bool minus_x = x_mirror && x[0] < 0, minus_z = z_mirror && x[2] < 0;
    if (minus_x) x[0] = -x[0];
    if (minus_z) x[2] = -x[2];
    const bool exchanged = exchange && x[2] > x[0];
    if (exchanged) std::swap(x[0], x[2]);
    x = from_centre[*finder.at(x)];  // one node speaks for all its images
    if (x_mirror && std::abs(x[0]) < unit) x[0] = 0;
    if (z_mirror && std::abs(x[2]) < unit) x[2] = 0;
    if (exchange && std::abs(x[0] - x[2]) < unit) x[2] = x[0];
    if (exchanged) std::swap(x[0], x[2]);
    if (minus_x) x[0] = -x[0];
    if (minus_z) x[2] = -x[2];
    mesh.X[n] = x + centre;
  }
}

}  // namespace langer
