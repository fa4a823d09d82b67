#include "mechanics/mesh/quality.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "mechanics/mesh/reference.hpp"
#include "mechanics/mesh/section.hpp"

namespace langer {

namespace {

// The isoparametric map at rest: X = sum of N_a(xi) X_a.
Vec3 position(const Mesh& mesh, int cell, const Vec3& xi) {
  Vec3 x = Vec3::Zero();
  const auto nodes = mesh.cell(cell);
  const VecX N = mesh.cell().shape(xi);
  for (int a = 0; a < N.size(); ++a) x += N[a] * mesh.X[nodes[a]];
  return x;
}

}  // namespace

// J = dX / dxi [mm]. Its determinant is the volume per reference volume, and a value that is not
// positive means that the cell is folded there.
Mat3 jacobian(const Mesh& mesh, int cell, const Vec3& xi) {
  const auto nodes = mesh.cell(cell);
  const Gradients dN = mesh.cell().gradient(xi);
  Mat3 J = Mat3::Zero();
  for (int a = 0; a < dN.rows(); ++a) J += mesh.X[nodes[a]] * dN.row(a);
  return J;
}

namespace {

// By the quadrature of the cells, exact as far as their stiffness needs it.
double volume(const Mesh& mesh) {
  const ReferenceCell& cell = mesh.cell();
  double volume = 0;
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (int g = 0; g < cell.n_gauss; ++g)
      volume += cell.weight[g] * jacobian(mesh, e, cell.gauss[g]).determinant();
  return volume;
}

// Extremes over all cells. The Jacobian is examined at the nodes and at the Gauss points: a curved
// cell may be folded at a node only. In a section (a plane or axisymmetric body, one cell deep) the
// edges along the depth are left out, as their length is a convention.
Quality shapes(const Mesh& mesh, bool of_section) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Quality q;
  q.least_jacobian = q.least_scaled_jacobian = q.shortest_edge = infinity;
  Vec3 least_at = Vec3::Zero();  // in the reference cell
  const auto notice = [&](double det, int e, const Vec3& xi) {
    if (det < q.least_jacobian) {
      q.least_jacobian = det;
      q.at_cell = e;
      least_at = xi;
    }
  };
  const ReferenceCell& cell = mesh.cell();
  // The gradients of all places stand side by side: one product gives all Jacobians of a cell.
  MatX gradients(cell.n_nodes, 3 * (cell.n_nodes + cell.n_gauss));
  for (int a = 0; a < cell.n_nodes; ++a)
    gradients.middleCols<3>(3 * a) = cell.gradient(cell.node[a]);
  for (int g = 0; g < cell.n_gauss; ++g)
    gradients.middleCols<3>(3 * (cell.n_nodes + g)) = cell.dN[static_cast<std::size_t>(g)];
  using ThreeRows = Eigen::Matrix<double, 3, Eigen::Dynamic>;
  ThreeRows X(3, cell.n_nodes);  // of the nodes of one cell
  ThreeRows jacobians(3, gradients.cols());
  for (int e = 0; e < mesh.n_cells(); ++e) {
    for (int a = 0; a < cell.n_nodes; ++a)
      X.col(a) = mesh.X[static_cast<std::size_t>(mesh.cell(e)[a])];
    jacobians.noalias() = X * gradients;
    for (int a = 0; a < cell.n_nodes; ++a) {
      const Mat3 J = jacobians.middleCols<3>(3 * a);
      notice(J.determinant(), e, cell.node[a]);
      // The scaled Jacobian is det J over the product of its column lengths: 1 in a box, 0 in a
      // flat corner. It is defined at corners; nodes on edges have no angle.
      if (a >= cell.n_corners) continue;
      const double lengths = J.colwise().norm().prod();  // 0 where two nodes are at one place
      q.least_scaled_jacobian =
          std::min(q.least_scaled_jacobian, lengths > 0 ? J.determinant() / lengths : 0);
    }
    for (int g = 0; g < cell.n_gauss; ++g) {
      const Mat3 J = jacobians.middleCols<3>(3 * (cell.n_nodes + g));
      const double det = J.determinant();
      notice(det, e, cell.gauss[g]);
      q.volume += cell.weight[g] * det;
    }
    double shortest = infinity;
    double longest = 0;
    for (const auto& [a, b] : cell.edge) {
      if (of_section && cell.node[a][2] != cell.node[b][2]) continue;
      const double length = (mesh.X[mesh.cell(e)[b]] - mesh.X[mesh.cell(e)[a]]).norm();
      shortest = std::min(shortest, length);
      longest = std::max(longest, length);
    }
    q.largest_aspect = std::max(q.largest_aspect, shortest > 0 ? longest / shortest : infinity);
    q.shortest_edge = std::min(q.shortest_edge, shortest);
    q.longest_edge = std::max(q.longest_edge, longest);
  }
  if (q.at_cell >= 0) q.at = position(mesh, q.at_cell, least_at);
  return q;
}

}  // namespace

// The thin wedge of an axisymmetric section would give tiny Jacobians and long aspects. Its shape
// is judged on a plate of constant depth, its volume on the wedge times the number of wedges in the
// circle.
Quality quality(const Mesh& mesh) {
  if (!mesh.section) return shapes(mesh, false);
  Quality q = shapes(as_plate(mesh), true);
  q.volume = volume(mesh) * cell_share(*mesh.section);
  return q;
}

// The first pair of nodes that are closer than a distance, in linear time: nodes are entered in a
// grid, and each is compared with the nodes of the boxes that its surroundings touch.
std::optional<std::array<int, 2>> coincident_nodes(const Mesh& mesh, double closer_than) {
  if (mesh.section) return coincident_nodes(as_plate(mesh), closer_than);
  const double edge =
      16 * closer_than;  // of the cells of a grid; a node near a border belongs to both sides of it
  using Cell = std::array<std::int64_t, 3>;
  // Products with large primes spread neighbouring boxes. A collision only adds a comparison.
  const auto hash = [](const Cell& c) {
    return static_cast<std::size_t>(c[0] * 73856093 ^ c[1] * 19349663 ^ c[2] * 83492791);
  };
  std::unordered_multimap<std::size_t, int> nodes_of;
  nodes_of.reserve(static_cast<std::size_t>(mesh.n_nodes()));
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    const Vec3& X = mesh.X[static_cast<std::size_t>(i)];
    Cell low, high;
    for (int k = 0; k < 3; ++k) {
      low[k] = static_cast<std::int64_t>(std::floor((X[k] - closer_than) / edge));
      high[k] = static_cast<std::int64_t>(std::floor((X[k] + closer_than) / edge));
    }
    for (std::int64_t a = low[0]; a <= high[0]; ++a)
      for (std::int64_t b = low[1]; b <= high[1]; ++b)
        for (std::int64_t c = low[2]; c <= high[2]; ++c) {
          const auto [from, to] = nodes_of.equal_range(hash({a, b, c}));
          for (auto it = from; it != to; ++it)
            if ((mesh.X[static_cast<std::size_t>(it->second)] - X).norm() <= closer_than)
              return std::array{it->second, i};
        }
    Cell own;
    for (int k = 0; k < 3; ++k) own[k] = static_cast<std::int64_t>(std::floor(X[k] / edge));
    nodes_of.emplace(hash(own), i);
  }
  return std::nullopt;
}

// A folded cell has no valid deformation: the message names the key of the scene that made it.
void refuse_folded(const Quality& q, const std::string& key) {
  if (q.least_jacobian > 0) return;
  throw Failure(
      Exit::config,
      Error{{},
            key,
            fmt::format("cell {} is folded: Jacobian {:.3g} mm^3 at ({:.4g}, {:.4g}, {:.4g})",
                        q.at_cell, q.least_jacobian, q.at[0], q.at[1], q.at[2]),
            "a positive Jacobian everywhere",
            "check sizes and radii; more divisions may help"});
}

}  // namespace langer
