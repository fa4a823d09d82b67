#include "mechanics/mesh/order.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "mechanics/mesh/quality.hpp"
#include "mesh/cells.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {
// the same mesh with nodes, cells and the corners of cells in another order
Mesh shuffled(const Mesh& mesh, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<int> place(mesh.X.size()), cells(mesh.n_cells());
  std::iota(place.begin(), place.end(), 0);
  std::iota(cells.begin(), cells.end(), 0);
  std::shuffle(place.begin(), place.end(), random);
  std::shuffle(cells.begin(), cells.end(), random);
  Mesh other = mesh;
  for (std::size_t n = 0; n < place.size(); ++n) other.X[place[n]] = mesh.X[n];
  // quarter turns about each axis, as lists of corners
  constexpr int turns[3][8] = {
      {3, 2, 6, 7, 0, 1, 5, 4}, {1, 5, 6, 2, 0, 4, 7, 3}, {1, 2, 3, 0, 5, 6, 7, 4}};
  for (int e = 0; e < mesh.n_cells(); ++e) {
    std::array<int, 8> nodes;
    for (int a = 0; a < 8; ++a) nodes[a] = place[mesh.cell(cells[e])[a]];
    for (int k = 0; k < 4; ++k) {
      const auto before = nodes;
      const int* turn = turns[random() % 3];
      for (int a = 0; a < 8; ++a) nodes[a] = before[turn[a]];
    }
    std::copy(nodes.begin(), nodes.end(), other.connectivity.begin() + 8 * e);
  }
  return other;
}
}  // namespace

TEST_CASE("turning and numbering undo any order of nodes, cells and corners") {
  Mesh mesh = test::block(test::even(-1, 1, 3), test::even(0, 1, 2), test::even(-2, 2, 4));
  test::distort(mesh, 0.1);
  turn_cells(mesh);
  number_in_order(mesh);
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Mesh other = shuffled(mesh, seed);
    CHECK(other.connectivity != mesh.connectivity);
    CHECK(quality(other).least_jacobian > 0);
    turn_cells(other);
    number_in_order(other);
    CHECK(other.X == mesh.X);
    CHECK(other.connectivity == mesh.connectivity);
  }
}

TEST_CASE("turned cells have their edges along the axes, whatever way round they came") {
  Mesh mesh = shuffled(test::cube(2), 9);
  turn_cells(mesh);
  for (int e = 0; e < mesh.n_cells(); ++e) {
    const Mat3 J = jacobian(mesh, e, Vec3::Zero());
    CHECK((J - 0.25 * Mat3::Identity()).norm() < 1e-15);
  }
}

TEST_CASE("a cell keeps its hand however skewed it is: turning never mirrors it") {
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  int checked = 0;
  while (checked < 500) {
    Mat3 A = Mat3::NullaryExpr([&] { return normal(random); });
    if (A.determinant() < 0) A.col(2) *= -1;
    if (A.determinant() < 0.05) continue;
    Mesh mesh = example::one_cell([&](const Vec3& xi) { return Vec3(A * xi); });
    const std::vector<int> corners = mesh.connectivity;
    turn_cells(mesh);
    CHECK(jacobian(mesh, 0, Vec3::Zero()).determinant() == near(A.determinant(), 1e-12));
    CHECK(std::is_permutation(corners.begin(), corners.end(), mesh.connectivity.begin()));
    ++checked;
  }
}

TEST_CASE(
    "a mesh that is symmetric but for rounding becomes symmetric to the last digit, one that is not stays") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> rounding(-1e-10, 1e-10);
  const auto noisy = [&](Mesh mesh) {
    for (Vec3& x : mesh.X) x += Vec3(rounding(random), 0, rounding(random));
    return mesh;
  };
  const auto has = [](const Mesh& mesh, const Vec3& x) {
    return std::find(mesh.X.begin(), mesh.X.end(), x) != mesh.X.end();
  };
  Mesh square =
      noisy(test::block(test::graded(3, 6, 0.4), test::even(0, 1, 2), test::graded(3, 6, 0.4)));
  make_symmetric(square, Vec3::Zero());
  for (const Vec3& x : square.X) {
    CHECK(has(square, {-x[0], x[1], x[2]}));
    CHECK(has(square, {x[0], x[1], -x[2]}));
    CHECK(has(square, {x[2], x[1], x[0]}));
  }
  // unequal divisions: mirrors only
  Mesh oblong =
      noisy(test::block(test::graded(3, 6, 0.4), test::even(0, 1, 2), test::graded(3, 4, 0.5)));
  make_symmetric(oblong, Vec3::Zero());
  int exchanged = 0;
  for (const Vec3& x : oblong.X) {
    CHECK(has(oblong, {-x[0], x[1], x[2]}));
    exchanged += has(oblong, {x[2], x[1], x[0]});
  }
  CHECK(exchanged < oblong.n_nodes());
  Mesh eighth =
      noisy(test::block(test::graded(3, 6, 0.4), test::even(0, 1, 1), test::graded(3, 6, 0.4)));
  eighth.X[5] += Vec3(0.01, 0, 0);
  const auto before = eighth.X;
  make_symmetric(eighth, Vec3::Zero());
  double furthest = 0;
  for (std::size_t n = 0; n < before.size(); ++n)
    furthest = std::max(furthest, (eighth.X[n] - before[n]).norm());
  CHECK(furthest < 1e-9);
}
