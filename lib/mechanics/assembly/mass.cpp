#include "mechanics/assembly/mass.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "core/tensor/dense.hpp"
#include "mechanics/assembly/separate_bodies.hpp"
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
  const SymmetricEigen eigen = symmetric_eigen(jacobi);
  std::vector<LinePoint> points;
  for (int i = 0; i < n; ++i) {
    const double first = eigen.vectors(0, i);
    points.push_back({0.5 * (1 + eigen.values[i]), first * first});
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

using NodeMass = Eigen::SparseMatrix<double>;  // (nodes, nodes) [t]

// Adds triplets in portions: those of all cells of second order would fill the memory.
class PortionedSum {
 public:
  explicit PortionedSum(int n) : sum_(n, n) {}
  void add(int row, int column, double value) {
    entries_.emplace_back(row, column, value);
    if (entries_.size() > portion) add_portion();
  }
  NodeMass finish() {
    add_portion();
    sum_.makeCompressed();
    return std::move(sum_);
  }

 private:
  static constexpr std::size_t portion = 4000000;
  void add_portion() {
    NodeMass part(sum_.rows(), sum_.cols());
    part.setFromTriplets(entries_.begin(), entries_.end());
    sum_ += part;
    entries_.clear();
  }
  NodeMass sum_;
  std::vector<Eigen::Triplet<double>> entries_;
};

// The mass of a cell on the nodes that keep theirs; all of it vanishes where none does.
MatX without_nodes(MatX m, const std::vector<char>& gone) {
  const double before = m.sum();
  bool all_kept = true;
  for (Eigen::Index a = 0; a < m.rows(); ++a) {
    if (!gone[static_cast<std::size_t>(a)]) continue;
    all_kept = false;
    m.row(a).setZero();
    m.col(a).setZero();
  }
  if (all_kept) return m;
  const double left = m.sum();
  if (left > 0) m *= before / left;
  return m;
}

// phi = (1, x, y, z) at the given nodes, in a box of size 1 about their middle, and 0 at others; of
// a section (1, x, y).
MatX moment_functions(const Mesh& mesh, const std::vector<int>& nodes) {
  Vec3 low = mesh.X[static_cast<std::size_t>(nodes.front())];
  Vec3 high = low;
  for (int node : nodes) {
    const Vec3& X = mesh.X[static_cast<std::size_t>(node)];
    low = low.cwiseMin(X);
    high = high.cwiseMax(X);
  }
  const double size = (high - low).maxCoeff();
  const int n = mesh.section ? 3 : 4;
  MatX phi = MatX::Zero(mesh.n_nodes(), n);
  for (int a : nodes) {
    const Vec3 x = (mesh.X[a] - 0.5 * (low + high)) / size;
    phi(a, 0) = 1;
    for (int k = 1; k < n; ++k) phi(a, k) = x[k - 1];
  }
  return phi;
}

// sum_ab m_ab phi_a phi_b'
MatX moments(const NodeMass& m, const MatX& phi) { return phi.transpose() * (m * phi); }

// Changes the entries of m by small shares, so that it has the given moments.
void restore_moments(NodeMass& m, const MatX& phi, const MatX& wanted) {
  const auto n = phi.cols();
  std::vector<std::pair<Eigen::Index, Eigen::Index>> pairs;
  for (Eigen::Index k = 0; k < n; ++k) {
    for (Eigen::Index l = k; l < n; ++l) pairs.emplace_back(k, l);
  }
  const auto n_pairs = static_cast<Eigen::Index>(pairs.size());
  MatX A = MatX::Zero(n_pairs, n_pairs);
  VecX c(n_pairs);
  const auto of_entry = [&](Eigen::Index a, Eigen::Index b) {
    for (Eigen::Index p = 0; p < n_pairs; ++p) {
      const auto [k, l] = pairs[static_cast<std::size_t>(p)];
      c[p] = 0.5 * (phi(a, k) * phi(b, l) + phi(a, l) * phi(b, k));
    }
  };
  for (int column = 0; column < m.outerSize(); ++column) {
    for (NodeMass::InnerIterator entry(m, column); entry; ++entry) {
      of_entry(entry.row(), entry.col());
      A += entry.value() * c * c.transpose();
    }
  }
  const MatX missing = wanted - moments(m, phi);
  VecX rhs(n_pairs);
  for (Eigen::Index p = 0; p < n_pairs; ++p) {
    const auto [k, l] = pairs[static_cast<std::size_t>(p)];
    rhs[p] = missing(k, l);
  }
  const VecX change = LeastNorm(A).solve(rhs);
  for (int column = 0; column < m.outerSize(); ++column) {
    for (NodeMass::InnerIterator entry(m, column); entry; ++entry) {
      of_entry(entry.row(), entry.col());
      entry.valueRef() *= 1 + change.dot(c);
    }
  }
}

// Whether the mass of a body is positive for every movement of its nodes that have mass. Few layers
// of nodes in front of one centre would need negative ones.
bool is_positive(const NodeMass& m, const std::vector<int>& nodes) {
  std::vector<int> row(static_cast<std::size_t>(m.cols()), -1);
  int n = 0;
  for (int node : nodes) {
    if (m.coeff(node, node) != 0) row[static_cast<std::size_t>(node)] = n++;
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (int node : nodes) {
    for (NodeMass::InnerIterator entry(m, node); entry; ++entry) {
      const int i = row[static_cast<std::size_t>(entry.row())];
      const int j = row[static_cast<std::size_t>(node)];
      if (i >= 0 && j >= 0) entries.emplace_back(i, j, entry.value());
    }
  }
  NodeMass of_body(n, n);
  of_body.setFromTriplets(entries.begin(), entries.end());
  return Eigen::SimplicialLLT<NodeMass>(of_body).info() == Eigen::Success;
}

// Nodes of each body that shares none with the others. Nodes without a cell belong to none, except
// where there is one body only.
std::vector<std::vector<int>> bodies_with_mass(const Mesh& mesh) {
  std::vector<char> in_a_cell(mesh.X.size(), 0);
  for (int node : mesh.connectivity) in_a_cell[static_cast<std::size_t>(node)] = 1;
  std::vector<std::vector<int>> bodies = separate_bodies(mesh);
  std::erase_if(bodies, [&](const std::vector<int>& nodes) {
    return !in_a_cell[static_cast<std::size_t>(nodes.front())];
  });
  if (bodies.size() > 1) return bodies;
  std::vector<int> all(mesh.X.size());
  std::iota(all.begin(), all.end(), 0);
  return {all};
}

// Mass by nodes of the mesh, before they are tied: rows of hanging nodes are empty.
NodeMass node_mass(const BodyModel& body, const std::vector<double>& density, MassKind kind,
                   const std::vector<char>& massless) {
  const Mesh& mesh = body.mesh();
  const MassShapes shapes(mesh.cell());
  PortionedSum sum(mesh.n_nodes());
  PortionedSum all(mesh.n_nodes());
  for (int e = 0; e < mesh.n_cells(); ++e) {
    const ElementNodes X = element_nodes(mesh, e);
    double share = density.at(mesh.body.empty() ? 0 : static_cast<std::size_t>(mesh.body[e]));
    // how many cells of the whole body this one stands for
    if (body.geometry(e).V > 0) share *= body.geometry(e).V / element_geometry(X).V;
    MatX m = share * shapes.of(X);
    if (const MatX* C = body.moving_nodes().weights(e)) m = C->transpose() * m * *C;
    if (kind == MassKind::lumped) m = MatX(m.rowwise().sum().asDiagonal());
    const auto nodes = body.nodes(e);
    const auto add_to = [&](PortionedSum& to) {
      for (int a = 0; a < body.n_nodes(); ++a) {
        for (int b = 0; b < body.n_nodes(); ++b) {
          if (m(a, b) != 0) to.add(nodes[a], nodes[b], m(a, b));
        }
      }
    };
    if (!massless.empty()) {
      add_to(all);
      std::vector<char> gone;
      for (int node : nodes) gone.push_back(massless[body.dofs().node(node)]);
      m = without_nodes(std::move(m), gone);
    }
    add_to(sum);
  }
  NodeMass m = sum.finish();
  if (massless.empty()) return m;
  m.prune(0.0);
  if (m.nonZeros() == 0) throw std::invalid_argument("no node keeps its mass");
  const NodeMass given = all.finish();
  const std::vector<std::vector<int>> bodies = bodies_with_mass(mesh);
  for (const std::vector<int>& nodes : bodies) {
    const MatX phi = moment_functions(mesh, nodes);
    const MatX wanted = moments(given, phi);
    if (wanted(0, 0) > 0 && !(moments(m, phi)(0, 0) > 0)) {
      throw std::invalid_argument("no node of a body keeps its mass");
    }
    restore_moments(m, phi, wanted);
    if (bodies.size() == 1) continue;
    const bool restored = (moments(m, phi) - wanted).norm() <= 1e-8 * wanted.norm();
    if (restored && is_positive(m, nodes)) continue;
    const Vec3& X = mesh.X[static_cast<std::size_t>(nodes.front())];
    throw std::invalid_argument(fmt::format(
        "the body at ({:g}, {:g}, {:g}) has too few cells behind its surface: its other "
        "nodes cannot have its centre and moments with positive masses",
        X[0], X[1], X[2]));
  }
  return m;
}

}  // namespace

MatX cell_mass(const ReferenceCell& cell, const ElementNodes& X) { return MassShapes(cell).of(X); }

Mass make_mass(const BodyModel& body, const std::vector<double>& density, MassKind kind,
               const std::vector<char>& massless) {
  if (kind == MassKind::lumped && body.mesh().cell().second_order()) {
    throw std::invalid_argument("a lumped mass is for cells of first order");
  }
  const NodeMass of_nodes = node_mass(body, density, kind, massless);
  Mass mass;
  PortionedSum sum(body.dofs().n);
  for (int b = 0; b < of_nodes.outerSize(); ++b) {
    const Mat3 T_b = movement(body, b);
    for (NodeMass::InnerIterator entry(of_nodes, b); entry; ++entry) {
      const int a = static_cast<int>(entry.row());
      mass.total += entry.value();
      const Mat3 block = entry.value() * movement(body, a).transpose() * T_b;
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          if (block(i, j) == 0) continue;
          sum.add(3 * body.dofs().node(a) + i, 3 * body.dofs().node(b) + j, block(i, j));
        }
      }
    }
  }
  mass.M = sum.finish();
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
