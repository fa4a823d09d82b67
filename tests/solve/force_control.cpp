// An indenter that is pushed with a force goes where one that is moved needs this force.
#include <doctest/doctest.h>

#include <cmath>

#include "mechanics/nonlinear/kinsol.hpp"
#include "mechanics/nonlinear/load_path.hpp"
#include "mechanics/nonlinear/newton.hpp"
#include "mechanics/solve/increment.hpp"
#include "support/block.hpp"
#include "support/directions.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

struct Pressed {
  double mu = 0, above = 0;  // friction; gap at the start [mm]
  Vec3 along = -Vec3::UnitY();
  bool loose = false;  // the bottom may glide: only contact holds the body along x
  std::optional<KinsolOptions> kinsol = {};
  Material law = test::table1(60, 1e-3, 0.05);
  bool papers = false;  // the paper's block under the paper's sphere
};

struct State {
  double t, travel;
  Vec3 force;  // on the body
  VecX u;
  int iterations;
};

struct Path {
  std::vector<Waypoint> motion;
  std::optional<ForceControl> control;
  std::vector<double> stops;
  double largest = 0.1;
};

std::vector<State> run(const Pressed& scene, const Path& way, PathReport* report = nullptr) {
  const std::vector<double> sides =
      scene.papers ? test::graded(15, 18, 0.35) : test::graded(6, 10, 0.6);
  const double height = scene.papers ? 4 : 3;
  const Mesh mesh =
      test::block(sides, scene.papers ? test::even(0, 4, 5) : test::even(0, 3, 3), sides);
  std::vector<Prescribed> held;
  for (int i : mesh.node_sets.at("y_min"))
    for (int k = 0; k < 3; ++k)
      if (k > 0 || !scene.loose) held.push_back({3 * i + k, 0});
  const Vec3 aside = scene.papers ? Vec3(0, 0, 0) : Vec3(0.1, 0, -0.05);
  RigidContact contact{"ball",     Sphere{2.5, {aside[0], height + 2.5 + scene.above, aside[2]}},
                       scene.mu,   {},
                       way.motion, way.control};
  for (int i : mesh.node_sets.at("y_max"))
    if (std::hypot(mesh.X[i][0], mesh.X[i][2]) < 3.2) contact.nodes.push_back(i);
  Assembler body = test::equilibrium(mesh, {scene.law}, Formulation::mean_dilatation,
                                     number_dofs(mesh.n_nodes(), held).dofs);
  Increment increment(body, {contact}, {});
  LoadPathOptions path;
  path.first = path.largest = way.largest;
  NewtonOptions tight;
  tight.relative = 1e-11;
  std::vector<State> states;
  const PathReport end = load_path(
      path, 0, {}, way.stops,
      [&](double t) {
        increment.begin(t);
        return scene.kinsol ? kinsol(increment.problem(), increment.free_balance(),
                                     increment.trial(), *scene.kinsol)
                            : newton(increment.problem(), increment.trial(), tight);
      },
      [&](double t, double, double, const SolveReport& step) {
        increment.accept();
        for (const ContactDefect& d : increment.defects()) {
          CHECK(d.penetration <= 1e-9);
          CHECK(d.cone <= 1e-8);
          CHECK(d.complementarity <= 1e-8);
        }
        states.push_back({t, increment.accepted().travel, increment.defects()[0].force,
                          increment.accepted().u, step.iterations + step.again});
        return true;
      });
  CAPTURE(end.why);
  if (report) *report = end;
  if (!report) REQUIRE(end.complete);
  return states;
}

Path moved(double depth, const Vec3& along, double largest = 0.1) {
  return {{{1, depth * along}}, {}, {}, largest};
}

// with the forces that those states have
Path pushed(const std::vector<State>& states, const Vec3& along, double largest = 0.1) {
  HistoryConfig force;
  std::vector<double> stops;
  for (const State& s : states)
    force.points.push_back({s.t, s.force.dot(along)}), stops.push_back(s.t);
  return {{}, ForceControl{along, history_of(force, {})}, stops, largest};
}

int iterations(const std::vector<State>& states) {
  int sum = 0;
  for (const State& s : states) sum += s.iterations;
  return sum;
}

}  // namespace

TEST_CASE(
    "a pushed indenter goes as far as a moved one that bears the same forces, 1e-8 mm, whatever its direction") {
  const Vec3 aside = Vec3(0.3, -1, 0.1).normalized();
  for (const Pressed& scene :
       {Pressed{}, {0, 0, aside}, {0.34, 0, Vec3(0, -1, 0)}, {1.5, 0, aside}}) {
    CAPTURE(scene.mu);
    const std::vector<State> there = run(scene, moved(1, scene.along)),
                             here = run(scene, pushed(there, scene.along));
    REQUIRE(here.size() == there.size());
    for (std::size_t i = 0; i < here.size(); ++i) {
      CHECK(std::abs(here[i].travel - there[i].t) < 1e-8);
      CHECK((here[i].u - there[i].u).lpNorm<Eigen::Infinity>() < 2e-8);
      CHECK(here[i].force.dot(scene.along) == near(there[i].force.dot(scene.along), 1e-8));
    }
    CHECK(iterations(here) <= 1.3 * iterations(there) + 3);
  }
}

TEST_CASE(
    "on the paper's scene the curve of a pushed sphere is that of a moved one to 1e-8, for no more than 15 % more iterations") {
  for (double mu : {0., 0.34}) {
    CAPTURE(mu);
    Pressed scene;
    scene.mu = mu, scene.papers = true, scene.law = test::table1(60, 1e-6);
    const std::vector<State> there = run(scene, moved(1, scene.along)),
                             here = run(scene, pushed(there, scene.along));
    REQUIRE(here.size() == there.size());
    for (std::size_t i = 0; i < here.size(); ++i) {
      CHECK(std::abs(here[i].travel - there[i].t) < 1e-8);
      CHECK(here[i].force.dot(scene.along) == near(there[i].force.dot(scene.along), 1e-8));
    }
    CHECK(iterations(here) <= 1.15 * iterations(there));
  }
}

TEST_CASE(
    "out of touch it first finds the touch; without a force it stays where it is, and unloaded it just touches") {
  const Pressed above{0, 0.7};
  const std::vector<State> there = run({}, moved(0.5, -Vec3::UnitY()));
  const std::vector<State> here = run(above, pushed(there, -Vec3::UnitY()));
  for (std::size_t i = 0; i < here.size(); ++i)
    CHECK(std::abs(here[i].travel - 0.7 - 0.5 * there[i].t) < 1e-7);
  HistoryConfig force;
  force.points = {{0.5, there.back().force[1] * -1}, {1, 0}};
  const std::vector<State> back =
      run(above, {{}, ForceControl{-Vec3::UnitY(), history_of(force, {})}, {0.5}, 0.1});
  CHECK(back.back().force.norm() == 0);
  CHECK(back.back().u.lpNorm<Eigen::Infinity>() < 1e-9);
  // the surface is flat again: the sphere touches its nearest node
  CHECK(back.back().travel == near(0.7, 0.01));
}

TEST_CASE(
    "a pushed indenter that is drawn sideways with friction keeps its force, and drags by the coefficient when it slips") {
  const Pressed scene{0.3};
  HistoryConfig force;
  force.points = {{0.4, 1.0}, {1, 1.0}};
  const Path way{{{0.4, Vec3::Zero()}, {1, Vec3(1.2, 0, 0)}},
                 ForceControl{-Vec3::UnitY(), history_of(force, {})},
                 {0.4},
                 0.05};
  const std::vector<State> states = run(scene, way);
  for (const State& s : states)
    if (s.t > 0.4) CHECK(s.force[1] == near(-1, 1e-8));
  CHECK(states.back().force[0] ==
        near(0.3, 0.15));  // normals of a sphere are not all along its force
}

TEST_CASE(
    "a pushed indenter may be all that holds the body in a direction, and KINSOL finds the same travel") {
  Pressed loose;
  loose.mu = 0.4, loose.loose = true;
  HistoryConfig force;
  force.value = 1.5;
  const Path way{{}, ForceControl{-Vec3::UnitY(), history_of(force, {})}, {}, 0.2};
  const std::vector<State> held = run(loose, way);
  CHECK(held.back().force[1] == near(-1.5, 1e-8));
  CHECK(std::abs(held.back().force[0]) < 1e-6);
  Pressed by_kinsol;
  by_kinsol.kinsol = KinsolOptions{};
  by_kinsol.kinsol->relative = 1e-10;
  const std::vector<State> ours = run({}, way), theirs = run(by_kinsol, way);
  CHECK(std::abs(ours.back().travel - theirs.back().travel) < 1e-6);
}
