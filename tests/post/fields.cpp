// From Gauss points to elements and nodes.
#include "results/post/nodal_fields.hpp"

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <random>

#include "core/tensor/stress.hpp"
#include "mechanics/material/uniaxial.hpp"
#include "support/block.hpp"
#include "support/directions.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

// 27 distorted cells; inner nodes belong to eight of them
Mesh distorted() {
  Mesh mesh = test::cube(3);
  test::distort(mesh, 0.08);
  return mesh;
}

std::vector<Vec3> homogeneous(const Mesh& mesh, const Mat3& F) {
  std::vector<Vec3> u;
  for (const Vec3& X : mesh.X) u.push_back((F - Mat3::Identity()) * X);
  return u;
}

const Mat3 some_F = (Mat3() << 1.2, 0.1, 0.05, -0.08, 0.95, 0.02, 0.03, -0.06, 0.9).finished();

// a field given by a function of the reference position, with as many values as the body has
GaussValues filled(const Body& body, const auto& value) {
  GaussValues gauss(body.mesh().n_cells());
  for (int e = 0; e < body.mesh().n_cells(); ++e) {
    gauss[e].resize(body.geometry(e).n_gauss(), body.n_values());
    for (int g = 0; g < gauss[e].rows(); ++g)
      for (int c = 0; c < body.n_values(); ++c)
        gauss[e](g, c) = value(gauss_position(body.mesh(), e, g), c);
  }
  return gauss;
}

constexpr double rounding = 1e-12;  // of numbers of order one, after a few hundred operations

}  // namespace

TEST_CASE(
    "a homogeneous deformation has the same values at every Gauss point, in every element, at every node") {
  const Mesh mesh = distorted();
  for (Formulation formulation : {Formulation::displacement, Formulation::mean_dilatation}) {
    const Body body = test::body(mesh, {test::table1(30, 0.5)}, formulation);
    const GaussValues gauss = gauss_values(body, homogeneous(mesh, some_F));
    const VecX expected = gauss[0].row(0).transpose();
    CHECK(expected.head<6>().norm() > 0.1);
    for (int e = 0; e < mesh.n_cells(); ++e)
      CHECK((element_mean(body, e, gauss[e]) - expected).norm() < rounding);
    for (int node = 0; node < mesh.n_nodes(); ++node)
      for (StressAt at : {StressAt::nodal_average, StressAt::nearest_gauss})
        CHECK((node_values(body, node, gauss, at) - expected).norm() < rounding);
    for (int e = 0; e < mesh.n_cells(); ++e)
      CHECK((mean_deformation_gradient(body, homogeneous(mesh, some_F), e) - some_F).norm() <
            rounding);
  }
}

TEST_CASE(
    "values of a homogeneous deformation are those of the law: stress, J, fibre stretch sqrt(I4_bar)") {
  const Mesh mesh = distorted();
  const Material material = test::table1(30, 0.5);
  const Body body = test::body(mesh, {material}, Formulation::displacement);
  const VecX row = gauss_values(body, homogeneous(mesh, some_F))[5].row(2).transpose();
  const auto a = fibre_directions(material);
  const Mat3 sigma = cauchy(some_F, response(material, some_F.transpose() * some_F, a).S);
  CHECK((sigma_of(row) - sigma).norm() < rounding);
  CHECK(J_of(row) == near(some_F.determinant(), rounding));
  const double I4 = (some_F * a[0]).squaredNorm();
  CHECK(fibre_stretch_of(row, 0) ==
        near(std::sqrt(I4 * std::pow(some_F.determinant(), -2.0 / 3)), rounding));
}

TEST_CASE("a linear field is reproduced exactly by nodal averages, on distorted elements too") {
  // the position is trilinear in an element's own coordinates, so a linear function of it is
  // extrapolated without error
  for (const Mesh& mesh : {distorted(), test::raised_block(distorted())}) {
    const Body body = test::body(mesh, {test::table1(30, 1e-3)}, usual_formulation(mesh.type));
    const auto linear = [](const Vec3& X, int c) {
      return (c + 1) * X[0] - 2 * X[1] + 0.5 * c * X[2] - c;
    };
    const GaussValues gauss = filled(body, linear);
    for (int node = 0; node < mesh.n_nodes(); ++node) {
      const VecX row = node_values(body, node, gauss, StressAt::nodal_average);
      for (int c = 0; c < body.n_values(); ++c)
        // Terms of the size of 10 cancel, so the absolute tolerance is their rounding. J: see
        // below.
        if (c != 6) CHECK(row[c] == near(linear(mesh.X[node], c), 1e-11, 1e-14));
    }
  }
}

TEST_CASE("J of a node lies within the values of the points of its cells, however they swing") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> swing(-1, 1);
  for (const Mesh& mesh : {distorted(), test::raised_block(distorted())}) {
    const Body body = test::body(mesh, {test::table1(30, 1e-6)}, usual_formulation(mesh.type));
    const GaussValues gauss = filled(body, [&](const Vec3&, int c) {
      return c == 6 ? 1 + 1e-2 * swing(random) : swing(random);
    });
    int beyond = 0;
    for (int node = 0; node < mesh.n_nodes(); ++node) {
      double least = 2, most = 0, stress = 0;
      for (const auto [e, a] : body.corners(node)) {
        least = std::min(least, gauss[e].col(6).minCoeff()),
        most = std::max(most, gauss[e].col(6).maxCoeff());
        stress = std::max(stress, gauss[e].col(0).cwiseAbs().maxCoeff());
      }
      for (StressAt at : {StressAt::nodal_average, StressAt::nearest_gauss}) {
        const VecX row = node_values(body, node, gauss, at);
        CHECK(J_of(row) >= least * (1 - rounding));
        CHECK(J_of(row) <= most * (1 + rounding));
        beyond += std::abs(row[0]) > stress;
      }
    }
    CHECK(beyond > 0);  // what is not J is extrapolated
  }
}

TEST_CASE("an element's mean of a linear field is its value at the centre of a brick") {
  const Mesh mesh = test::block({0, 1, 3}, {0, 0.5}, {-1, 2});
  const Body body = test::body(mesh, {test::neo_hooke(1, 1)}, Formulation::displacement);
  const auto linear = [](const Vec3& X, int c) {
    return X[0] + 2 * X[1] - c * X[2];
  };
  const GaussValues gauss = filled(body, linear);
  for (int e = 0; e < 2; ++e) {
    const Vec3 centre = element_nodes(mesh, e).colwise().mean();
    for (int c = 0; c < 7; ++c)
      CHECK(element_mean(body, e, gauss[e])[c] == near(linear(centre, c), 1e-12, 1e-15));  // 0 too
  }
}

TEST_CASE("averages over the elements at a node are weighted with their reference volumes") {
  const Mesh mesh = test::block({0, 1, 4}, {0, 1}, {0, 1});  // volumes 1 and 3
  const Body body = test::body(mesh, {test::neo_hooke(1, 1)}, Formulation::displacement);
  const GaussValues gauss = filled(body, [](const Vec3& X, int) { return X[0] < 1 ? 10.0 : 2.0; });
  for (int node = 0; node < mesh.n_nodes(); ++node)
    for (StressAt at : {StressAt::nodal_average, StressAt::nearest_gauss}) {
      const double x = mesh.X[node][0], expected = x == 0   ? 10
                                                   : x == 4 ? 2
                                                            : (10 * 1 + 2 * 3) / 4.0;
      CHECK(node_values(body, node, gauss, at)[0] == near(expected));
    }
}

TEST_CASE("the nearest Gauss point is the nearest of all, in each element at the node") {
  const Mesh mesh = distorted();
  const Body body = test::body(mesh, {test::neo_hooke(1, 1)}, Formulation::displacement);
  // the value is the Gauss point's own number
  GaussValues gauss(mesh.n_cells(), ElementValues::Zero(8, 7));
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (int g = 0; g < 8; ++g) gauss[e](g, 0) = 8 * e + g;
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    double sum = 0, V = 0;
    for (int e = 0; e < mesh.n_cells(); ++e) {
      const auto nodes = mesh.cell(e);
      if (std::find(nodes.begin(), nodes.end(), node) == nodes.end()) continue;
      int nearest = 0;
      for (int g = 1; g < 8; ++g)
        if ((gauss_position(mesh, e, g) - mesh.X[node]).norm() <
            (gauss_position(mesh, e, nearest) - mesh.X[node]).norm())
          nearest = g;
      sum += element_geometry(element_nodes(mesh, e)).V * (8 * e + nearest),
          V += element_geometry(element_nodes(mesh, e)).V;
    }
    CHECK(node_values(body, node, gauss, StressAt::nearest_gauss)[0] == near(sum / V));
  }
}

TEST_CASE("bodies of different materials are never averaged, of one material they are") {
  Mesh mesh = test::block({0, 1, 2}, {0, 1}, {0, 1});
  mesh.bodies = {"skin", "fat"};
  mesh.body = {0, 1};
  const auto by_cell = [](const Vec3& X, int) {
    return X[0] < 1 ? 10.0 : 2.0;
  };
  const Body two =
      test::body(mesh, {test::neo_hooke(1, 1), test::table1(0, 1)}, Formulation::displacement);
  const Body one = test::body(mesh, {test::neo_hooke(1, 1)}, Formulation::displacement);
  CHECK(two.n_families() == 1);
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    const double x = mesh.X[node][0];
    CHECK(node_values(two, node, filled(two, by_cell), StressAt::nodal_average)[0] ==
          near(x < 2 ? 10 : 2));
    CHECK(node_values(one, node, filled(one, by_cell), StressAt::nodal_average)[0] ==
          near(x == 0   ? 10
               : x == 1 ? 6
                        : 2));
  }
}

TEST_CASE("von Mises and principal stresses: closed forms") {
  const double s = 3, t = 0.7;
  const auto vm = [](const Mat3& sigma) {
    return von_mises(sigma);
  };
  CHECK(vm(Vec3(s, 0, 0).asDiagonal()) == near(s));
  CHECK(vm(-s * Mat3::Identity()) == near(0));
  Mat3 shear = Mat3::Zero();
  shear(0, 2) = shear(2, 0) = t;
  CHECK(vm(shear) == near(std::sqrt(3.0) * t));
  CHECK((principal_stresses(shear) - Vec3(t, 0, -t)).norm() < 1e-15);
  Mat3 plane =
      Vec3(5, 1, 2)
          .asDiagonal();  // Mohr's circle of x and y: centre 3, radius sqrt(2^2 + 1.5^2) = 2.5
  plane(0, 1) = plane(1, 0) = 1.5;
  CHECK((principal_stresses(plane) - Vec3(5.5, 2, 0.5)).norm() < 1e-14);
  CHECK(mean_stress(plane) == near(8.0 / 3));
}

TEST_CASE("uniaxial tension along the fibre: the law's own stress at every node, nothing across") {
  const Material material = test::stable(0, 1e-4);
  for (double lambda : {0.8, 1.1, 1.4}) {
    const Uniaxial state = uniaxial(material, lambda);
    REQUIRE(state.converged);
    const Mat3 F = state.stretch.asDiagonal();
    const Mesh mesh = distorted();
    const Body body = test::body(mesh, {material}, Formulation::mean_dilatation);
    const GaussValues gauss = gauss_values(body, homogeneous(mesh, F));
    // kappa = 2e4 MPa times the rounding of J - 1 is 1e-11 MPa
    for (int node : {0, 5, 21, 63}) {
      const VecX row = node_values(body, node, gauss, StressAt::nodal_average);
      CHECK(sigma_of(row)(0, 0) == near(state.sigma, 1e-8));
      CHECK(von_mises(sigma_of(row)) == near(std::abs(state.sigma), 1e-8));
      CHECK((sigma_of(row) - state.sigma * Mat3(Vec3(1, 0, 0).asDiagonal())).norm() < 1e-8);
      CHECK(fibre_stretch_of(row, 0) == near(lambda / std::cbrt(J_of(row)), 1e-10));
    }
  }
}
