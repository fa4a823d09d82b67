#include "mechanics/assembly/mass.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "mechanics/mesh/reference.hpp"

namespace langer {

namespace {

struct MassPoint {
  Vec3 xi;
  double weight = 0;
};

struct LinePoint {
  double x = 0;  // in [0, 1]
  double weight = 0;
};

// Gauss points on [0, 1] by the eigenvalues of the Jacobi matrix (Golub, Welsch 1969).
std::vector<LinePoint> line_points(int n) {
  MatX jacobi = MatX::Zero(n, n);
  for (int i = 1; i < n; ++i) {
    const double beside = i / std::sqrt(4.0 * i * i - 1);
    jacobi(i, i - 1) = beside;
    jacobi(i - 1, i) = beside;
  }
  const Eigen::SelfAdjointEigenSolver<MatX> eigen(jacobi);
  std::vector<LinePoint> points;
  for (int i = 0; i < n; ++i) {
    const double first = eigen.eigenvectors()(0, i);
    points.push_back({0.5 * (1 + eigen.eigenvalues()[i]), first * first});
  }
  return points;
}

// A tetrahedron as a cube with one face drawn together to a line and that to a point: exact for
// polynomials of degree 9, while products of two shape functions of tet15 have degree 8. Its 14
// points of stress would leave a cell of 15 nodes with a movement that has no mass.
std::vector<MassPoint> tetrahedron_points() {
  const std::vector<LinePoint> line = line_points(6);
  std::vector<MassPoint> points;
  for (const LinePoint& a : line) {
    for (const LinePoint& b : line) {
      for (const LinePoint& c : line) {
        const double along = 1 - a.x;
        const double across = 1 - b.x;
        MassPoint point;
        point.xi = Vec3(a.x, along * b.x, along * across * c.x);
        point.weight = a.weight * b.weight * c.weight * along * along * across;
        points.push_back(point);
      }
    }
  }
  return points;
}

std::vector<MassPoint> mass_points(const ReferenceCell& cell) {
  if (!cell.hexahedron()) return tetrahedron_points();
  std::vector<MassPoint> points;
  for (int g = 0; g < cell.n_gauss; ++g) points.push_back({cell.gauss[g], cell.weight[g]});
  return points;
}

// Shape functions and gradients at the points of the mass, made once for all cells.
struct MassShapes {
  std::vector<double> weight;
  std::vector<VecX> N;
  std::vector<Gradients> dN;

  explicit MassShapes(const ReferenceCell& cell) {
    for (const MassPoint& point : mass_points(cell)) {
      weight.push_back(point.weight);
      N.push_back(cell.shape(point.xi));
      dN.push_back(cell.gradient(point.xi));
    }
  }

  MatX of(const ElementNodes& X) const {
    MatX m = MatX::Zero(X.rows(), X.rows());
    for (std::size_t g = 0; g < weight.size(); ++g) {
      const Mat3 dX_dxi = X.transpose() * dN[g];
      m += weight[g] * dX_dxi.determinant() * (N[g] * N[g].transpose());
    }
    return m;
  }
};

// How a node moves with the one that has its unknowns.
Mat3 movement(const BodyModel& body, int node) {
  const Dofs& dofs = body.dofs();
  if (dofs.tie.empty()) return Mat3::Identity();
  Mat3 T = dofs.tie[node].T;
  if (body.mesh().section) T.row(2).setZero();
  return T;
}

}  // namespace

MatX cell_mass(const ReferenceCell& cell, const ElementNodes& X) { return MassShapes(cell).of(X); }

Mass make_mass(const BodyModel& body, const std::vector<double>& density, MassKind kind) {
  const Mesh& mesh = body.mesh();
  if (kind == MassKind::lumped && mesh.cell().second_order()) {
    throw std::invalid_argument("a lumped mass is for cells of first order");
  }
  const int n = body.dofs().n;
  Mass mass;
  mass.M.resize(n, n);
  // Triplets are summed in portions: those of all cells of second order would fill the memory.
  constexpr std::size_t portion = 4000000;
  std::vector<Eigen::Triplet<double>> entries;
  const auto add_entries = [&] {
    Eigen::SparseMatrix<double> part(n, n);
    part.setFromTriplets(entries.begin(), entries.end());
    mass.M += part;
    entries.clear();
  };
  const auto add = [&](int a, int b, double m) {
    const Mat3 block = m * movement(body, a).transpose() * movement(body, b);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        if (block(i, j) == 0) continue;
        entries.emplace_back(3 * body.dofs().node(a) + i, 3 * body.dofs().node(b) + j, block(i, j));
      }
    }
  };

  const MassShapes shapes(mesh.cell());
  for (int e = 0; e < mesh.n_cells(); ++e) {
    const ElementNodes X = element_nodes(mesh, e);
    double share = density.at(mesh.body.empty() ? 0 : static_cast<std::size_t>(mesh.body[e]));
    // how many cells of the whole body this one stands for
    if (body.geometry(e).V > 0) share *= body.geometry(e).V / element_geometry(X).V;
    MatX m = share * shapes.of(X);
    mass.total += m.sum();
    if (const MatX* C = body.moving_nodes().weights(e)) m = C->transpose() * m * *C;
    const auto nodes = body.nodes(e);
    for (int a = 0; a < body.n_nodes(); ++a) {
      if (kind == MassKind::lumped) {
        add(nodes[a], nodes[a], m.row(a).sum());
        continue;
      }
      for (int b = 0; b < body.n_nodes(); ++b) add(nodes[a], nodes[b], m(a, b));
    }
    if (entries.size() > portion) add_entries();
  }
  add_entries();
  mass.M.makeCompressed();
  return mass;
}

std::vector<double> Mass::in_pattern(const Pattern& pattern, const Dofs& dofs) const {
  std::vector<double> values(static_cast<std::size_t>(pattern.nnz()), 0);
  for (int column = 0; column < pattern.n; ++column) {
    const auto first = pattern.row.begin() + pattern.column_start[column];
    const auto last = pattern.row.begin() + pattern.column_start[column + 1];
    for (Eigen::SparseMatrix<double>::InnerIterator entry(M, dofs.free[column]); entry; ++entry) {
      const int row = dofs.equation[static_cast<int>(entry.row())];
      if (row < column) continue;  // prescribed, or of the upper triangle
      const auto at = std::lower_bound(first, last, row);
      values[static_cast<std::size_t>(at - pattern.row.begin())] = entry.value();
    }
  }
  return values;
}

}  // namespace langer
