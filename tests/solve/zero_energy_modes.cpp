// Bodies that their supports do not hold.
#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include "mechanics/assembly/dofs.hpp"
#include "mechanics/assembly/zero_energy_modes.hpp"
#include "support/directions.hpp"
#include "support/exact_run.hpp"
#include "support/indentation.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"

using namespace langer;

TEST_CASE("extremes: motions that supports leave free are counted, and the last one is named") {
  Mesh mesh = test::block(test::even(-2, 2, 4), test::even(0, 2, 2), test::even(-2, 2, 4));
  std::vector<Prescribed> held;
  for (int i : mesh.node_sets["y_min"]) held.push_back({3 * i + 1, 0});
  const auto words = [&] {
    return zero_energy_modes(mesh, number_dofs(mesh.n_nodes(), held).dofs);
  };
  CHECK(words() == "the supports leave the body 3 rigid motions (2 along, 1 about an axis)");
  int middle = -1;
  for (int i : mesh.node_sets["y_min"])
    if (mesh.X[i].norm() < 1e-9) middle = i;
  REQUIRE(middle >= 0);
  held.push_back({3 * middle, 0}), held.push_back({3 * middle + 2, 0});
  CHECK(words() ==
        "the supports leave the body free to turn about the axis (0, 1, 0) through (0, 1, 0) mm");
  held.push_back({3 * (middle + 1) + 2, 0});
  CHECK(words() == "");
  held.clear();
  CHECK(words() == "the supports leave the body 6 rigid motions (3 along, 3 about an axis)");
}

TEST_CASE("the halves of a body that a half turn ties leave its axis free alone") {
  Mesh mesh = test::block(test::even(0, 2, 2), test::even(0, 2, 2), test::even(-2, 2, 4));
  for (Vec3& X : mesh.X) X[1] -= 1;
  // Nodes of the plane x = 0 move as their images by half a turn about y.
  std::vector<Image> ties;
  for (int i = 0; i < mesh.n_nodes(); ++i) ties.push_back({i});
  for (int i : mesh.node_sets["x_min"])
    for (int j : mesh.node_sets["x_min"]) {
      const Vec3 image(0, mesh.X[i][1], -mesh.X[i][2]);
      if (i <= j && (mesh.X[j] - image).norm() < 1e-9)
        ties[static_cast<std::size_t>(j)] = {i, Vec3(-1, 1, -1).asDiagonal()};
    }
  std::vector<Prescribed> held;
  const auto words = [&] {
    return zero_energy_modes(mesh, number_dofs(mesh.n_nodes(), held, ties).dofs);
  };
  CHECK(words() == "the supports leave the body 2 rigid motions (1 along, 1 about an axis)");
  held.push_back({3 * mesh.node_sets["x_max"].front() + 1, 0});
  CHECK(words() ==
        "the supports leave the body free to turn about the axis (0, 1, 0) through (0, 0, 0) mm");
}

TEST_CASE(
    "extremes: a block free to glide and spin on its base is pressed by a smooth sphere as one that is held is") {
  for (double d : {1e-3, 1e-6})
    for (int n : {6, 7}) {  // a node under the sphere first, or four
      CAPTURE(d);
      CAPTURE(n);
      const auto press = [&](bool isostatic) {
        const Mesh mesh =
            test::block(test::even(-2, 2, n), test::even(0, 2, 3), test::even(-2, 2, n));
        std::vector<Prescribed> held;
        for (int i : mesh.node_sets.at("y_min")) held.push_back({3 * i + 1, 0});
        for (int i : mesh.node_sets.at(
                 "y_min")) {  // the middles of two opposite edges: what symmetry leaves where it is
          if (!isostatic) break;
          const Vec3& X = mesh.X[static_cast<std::size_t>(i)];
          if (std::abs(X[2]) < 1e-9 && std::abs(std::abs(X[0]) - 2) < 1e-9)
            held.push_back({3 * i + 2, 0});
          if (X.norm() < 1e-9) held.push_back({3 * i, 0});
        }
        const RigidContact sphere{
            "sphere", Sphere{2, {0, 4, 0}}, 0, mesh.node_sets.at("y_max"), {{1, Vec3(0, -0.4, 0)}}};
        Assembler body =
            test::equilibrium(mesh, {test::neo_hooke(0.1, d)}, Formulation::mean_dilatation,
                              number_dofs(mesh.n_nodes(), held).dofs);
        Increment increment(body, {sphere}, {});
        const test::ExactPath followed = test::run(increment, 0.1);
        const PathReport& path = followed.path;
        REQUIRE_MESSAGE(path.complete, path.why);
        CHECK(path.cut_backs == 0);
        // what rounding turns a free block by costs now and then an iteration: 10 once in some 200
        // runs
        for (int n_iterations : followed.iterations) CHECK(n_iterations <= (isostatic ? 9 : 12));
        Vec3 turn = Vec3::Zero(), glide = Vec3::Zero();
        double inertia = 0;
        for (int i = 0; i < mesh.n_nodes(); ++i) {
          const Vec3 u = increment.accepted().u.segment<3>(3 * i),
                     X = mesh.X[static_cast<std::size_t>(i)];
          turn += X.cross(u), glide += u / mesh.n_nodes(), inertia += X[0] * X[0] + X[2] * X[2];
        }
        // nothing resists a turn, so its size is no result: rounding alone makes up to 0.002 of it
        // on Debian 12 and once made 0.023 on 13
        CHECK(std::abs(turn[1]) / inertia < 0.1);
        CHECK(std::hypot(glide[0], glide[2]) < 1e-6);
        return increment.defects()[0].force.norm();
      };
      const double loose = press(false);
      if (n == 6) CHECK(loose == near(press(true), 1e-7));
      CHECK(loose > 0.3);
    }
}
