// Structured blocks made in memory, so that mechanics can be tested without gmsh or files.
#pragma once

#include <functional>
#include <random>

#include "mechanics/mesh/mesh.hpp"
#include "mechanics/mesh/raise.hpp"

namespace langer::test {

// grid lines x, y, z -> hexahedra with faces x_min ... z_max as node sets; frames global
inline Mesh block(const std::vector<double>& x, const std::vector<double>& y,
                  const std::vector<double>& z) {
  Mesh mesh;
  const int nx = static_cast<int>(x.size()), ny = static_cast<int>(y.size()),
            nz = static_cast<int>(z.size());
  const auto id = [&](int i, int j, int k) {
    return (k * ny + j) * nx + i;
  };
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const int n = id(i, j, k);
        mesh.X.emplace_back(x[i], y[j], z[k]);
        if (i == 0) mesh.node_sets["x_min"].push_back(n);
        if (i == nx - 1) mesh.node_sets["x_max"].push_back(n);
        if (j == 0) mesh.node_sets["y_min"].push_back(n);
        if (j == ny - 1) mesh.node_sets["y_max"].push_back(n);
        if (k == 0) mesh.node_sets["z_min"].push_back(n);
        if (k == nz - 1) mesh.node_sets["z_max"].push_back(n);
      }
  for (int k = 0; k + 1 < nz; ++k)
    for (int j = 0; j + 1 < ny; ++j)
      for (int i = 0; i + 1 < nx; ++i)
        for (int n :
             {id(i, j, k), id(i + 1, j, k), id(i + 1, j + 1, k), id(i, j + 1, k), id(i, j, k + 1),
              id(i + 1, j, k + 1), id(i + 1, j + 1, k + 1), id(i, j + 1, k + 1)})
          mesh.connectivity.push_back(n);
  mesh.bodies = {"block"};
  mesh.body.assign(mesh.n_cells(), 0);
  mesh.frames.assign(mesh.n_cells(), Mat3::Identity());
  return mesh;
}

// six tetrahedra around the diagonal of each hexahedron
inline Mesh tetrahedra(const Mesh& hexahedra) {
  constexpr int through[6][2] = {{1, 2}, {2, 3}, {3, 7}, {7, 4}, {4, 5}, {5, 1}};
  std::vector<int> corners;
  for (int e = 0; e < hexahedra.n_cells(); ++e)
    for (const auto& [a, b] : through)
      for (int local : {0, a, b, 6})
        corners.push_back(hexahedra.cell(e)[static_cast<std::size_t>(local)]);
  Mesh mesh = raised(hexahedra.X, corners, CellType::tet15);
  mesh.bodies = hexahedra.bodies, mesh.body.assign(static_cast<std::size_t>(mesh.n_cells()), 0);
  mesh.frames.assign(mesh.body.size(), Mat3::Identity());
  return mesh;
}

// of quadratic cells, with the same faces
inline Mesh raised_block(const Mesh& linear, CellType to = CellType::hex27) {
  Mesh mesh = to == CellType::tet15 ? tetrahedra(linear) : raised(linear, to);
  if (to != CellType::tet15)
    mesh.bodies = linear.bodies, mesh.body = linear.body, mesh.frames = linear.frames;
  for (const auto& [name, nodes] : linear.node_sets) {
    const int axis = name[0] - 'x';
    for (int i = 0; i < mesh.n_nodes(); ++i)
      if (std::abs(mesh.X[i][axis] - linear.X[nodes[0]][axis]) < 1e-12)
        mesh.node_sets[name].push_back(i);
  }
  return mesh;
}

inline std::vector<double> even(double from, double to, int n) {
  std::vector<double> x(n + 1);
  for (int i = 0; i <= n; ++i) x[i] = from + (to - from) * i / n;
  return x;
}

// lines from -half to half, n even, first spacing h at the centre, growing geometrically; mirrored
// exactly
inline std::vector<double> graded(double half, int n, double h) {
  double low = 1, high = 5;
  const auto length = [&](double q) {
    double sum = 0, term = h;
    for (int i = 0; i < n / 2; ++i) sum += term, term *= q;
    return sum;
  };
  for (int i = 0; i < 200; ++i)
    (length(0.5 * (low + high)) > half ? high : low) = 0.5 * (low + high);
  std::vector<double> x(n + 1, 0.0);
  double sum = 0, term = h, scale = half / length(low);
  for (int i = 1; i <= n / 2; ++i) {
    sum += term * scale, term *= low;
    x[n / 2 + i] = i == n / 2 ? half : sum, x[n / 2 - i] = -x[n / 2 + i];
  }
  return x;
}

inline Mesh cube(int n, double size = 1) {
  return block(even(0, size, n), even(0, size, n), even(0, size, n));
}

// inner nodes moved at random, by a fraction of the spacing
inline void distort(Mesh& mesh, double amount, unsigned seed = 3) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-amount, amount);
  std::vector<char> outer(mesh.n_nodes(), 0);
  for (const auto& [name, nodes] : mesh.node_sets)
    for (int i : nodes) outer[i] = 1;
  for (int i = 0; i < mesh.n_nodes(); ++i)
    if (!outer[i]) mesh.X[i] += Vec3(u(random), u(random), u(random));
}

}  // namespace langer::test
