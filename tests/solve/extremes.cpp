// Extreme cases: each gives the right answer within a tolerance, or a refusal that says why.
// The long ones are in pipelines/extremes.yaml; what meshes refuse is in
// tests/stages/extremes.cmake.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/tensor/stress.hpp"
#include "mechanics/material/uniaxial.hpp"
#include "mechanics/mesh/quality.hpp"
#include "support/directions.hpp"
#include "support/indentation.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

test::Indentation small_scene() {
  test::Indentation scene;
  scene.nx = scene.nz = 8, scene.ny = 3, scene.h = 0.7, scene.depth = 0.4, scene.step = 0.2;
  return scene;
}

double final_force(const test::Indentation& scene, const Material& material) {
  const auto result = scene.run(material);
  REQUIRE_MESSAGE(result.path.complete, result.path.why);
  CHECK(result.steps.back().defect.penetration <= 1e-9);
  return result.steps.back().force;
}

Material yeoh(double d) {
  Material m;
  m.matrix = {Yeoh{0.05, 0.02, 0.002}};
  m.volume = QuadraticVolume{d};
  return m;
}

// A body pulled along x between smooth faces; everything else follows from the free sides.
struct Pull {
  Mesh mesh;
  VecX u;
  PathReport path;
  std::vector<Mat3> sigma;  // of every Gauss point
  double reaction = 0;
  int steps_of = 10;
  NewtonOptions newton;

  explicit Pull(Mesh m) : mesh(std::move(m)) {}
  void run(const std::vector<Material>& materials, double stretch, double smallest = 1e-4) {
    double length = 0;
    std::vector<Prescribed> held;
    for (const auto& [face, axis] : {std::pair{"x_min", 0}, {"y_min", 1}, {"z_min", 2}})
      for (int i : mesh.node_sets[face]) held.push_back({3 * i + axis, 0});
    for (int i : mesh.node_sets["x_max"]) length = mesh.X[i][0];
    for (int i : mesh.node_sets["x_max"]) held.push_back({3 * i, (stretch - 1) * length});
    Assembler body = test::equilibrium(mesh, materials, Formulation::mean_dilatation,
                                       number_dofs(mesh.n_nodes(), held).dofs);
    Increment increment(body, {}, {});
    LoadPathOptions options;
    options.steps = steps_of, options.smallest = smallest;
    path = load_path(
        options, 0, {}, {},
        [&](double t) {
          increment.begin(t);
          return langer::newton(increment.problem(), increment.trial(), newton);
        },
        [&](double, double, double, const SolveReport&) {
          increment.accept();
          return true;
        });
    u = increment.accepted().u;
    sigma.clear();
    for (int e = 0; e < mesh.n_cells(); ++e)
      for (const GaussState& g :
           gauss_states(Formulation::mean_dilatation, body.material(e), body.geometry(e),
                        body.fibres(e), body.element_displacements(u, e)))
        sigma.push_back(g.sigma);
    reaction = 0;
    const VecX r = increment.reactions();
    for (int i : mesh.node_sets["x_max"]) reaction += r[3 * i];
  }
};

}  // namespace

TEST_CASE("extremes: d from 1e-1 to 1e-10, the force goes to its limit and stays there") {
  const auto force = [](double d) {
    return final_force(small_scene(), test::stable(30, d));
  };
  const double limit = force(1e-7);
  double before = 0;
  for (double d : {1e-1, 1e-2, 1e-3, 1e-4}) {
    const double f = force(d);
    CHECK(f > before);
    before = f;
  }
  for (double d : {1e-5, 1e-6, 1e-8, 1e-9, 1e-10}) {
    CAPTURE(d);
    CHECK(force(d) == near(limit, 2e-5));
  }
}

TEST_CASE("extremes: c2 from 0 to 1000, the limit without a division by zero") {
  for (double c2 : {0.0, 1e-300, 1e-12, 0.99e-6, 1.01e-6, 1e-3, 1.0, 1000.0}) {
    CAPTURE(c2);
    const Energy<double> e = HgoFibre{0.1, c2}(1.21);
    // W = c1/2 x^2 phi(c2 x^2),  phi(y) = (exp(y) - 1)/y
    const double x = 0.21, y = c2 * x * x, phi = y > 0 ? std::expm1(y) / y : 1;
    CHECK(e.W == near(0.05 * x * x * phi, 1e-8));
    CHECK(e.dW == near(0.1 * x * std::exp(y), 1e-12));
    CHECK(e.ddW == near(0.1 * std::exp(y) * (1 + 2 * y), 1e-12));
  }
  for (double c2 : {0.0, 1.0, 30.0}) {
    CAPTURE(c2);
    Pull pull(test::cube(1));
    Material m = test::stable(0, 1e-9);
    std::get<HgoFibre>(m.fibres[0].law).c2 = c2;
    pull.run({m}, 1.2);
    REQUIRE(pull.path.complete);
    const Uniaxial exact = uniaxial(m, 1.2);
    REQUIRE(exact.converged);
    CHECK(pull.sigma[0](0, 0) == near(exact.sigma, 1e-6));
  }
}

TEST_CASE("extremes: an exponent that overflows is refused by name, never inf") {
  Pull pull(test::cube(1));
  Material m = test::stable(0, 1e-6);
  std::get<HgoFibre>(m.fibres[0].law).c2 = 1000;
  pull.steps_of = 1;
  pull.run({m}, 3, 0.9);
  CHECK_FALSE(pull.path.complete);
  CHECK(pull.path.why.find("exponential of a fibre overflows") != std::string::npos);
  CHECK(pull.u.allFinite());
}

TEST_CASE("extremes: I4 = 1 crossed from both sides, in small and in large strides") {
  for (double alpha : {0.0, 35.0})
    for (double stride : {0.01, 0.3}) {
      CAPTURE(alpha);
      CAPTURE(stride);
      Mesh mesh = test::block(test::even(0, 3, 3), {0, 1}, {0, 1});
      std::vector<Prescribed> held;
      for (const auto& [face, axis] : {std::pair{"x_min", 0}, {"y_min", 1}, {"z_min", 2}})
        for (int i : mesh.node_sets[face]) held.push_back({3 * i + axis, 0});
      for (int i : mesh.node_sets["x_max"]) held.push_back({3 * i, 3});
      Assembler body =
          test::equilibrium(mesh, {test::stable(alpha, 1e-6)}, Formulation::mean_dilatation,
                            number_dofs(mesh.n_nodes(), held).dofs);
      Increment increment(body, {}, {});
      std::vector<double> way;  // up, down through rest, up again
      for (double turn : {1.0, -1.0, 1.0})
        for (double s = stride; s < 2.001 * 0.3; s += stride)
          way.push_back(turn * (s <= 0.3001 ? s : 0.6 - s));
      VecX at_top, at_bottom;
      for (double t : way) {
        increment.begin(t);
        const SolveReport report =
            newton(increment.problem(), increment.trial(), {.relative = 1e-9});
        CAPTURE(t);
        REQUIRE_MESSAGE(report.converged(), report.why);
        CHECK(report.iterations <= 9);
        increment.accept();
        if (std::abs(t) < 1e-9) CHECK(increment.accepted().u.lpNorm<Eigen::Infinity>() < 1e-8);
        if (std::abs(t - 0.3) < 1e-9) {
          if (at_top.size() > 0)
            CHECK((increment.accepted().u - at_top).lpNorm<Eigen::Infinity>() < 1e-7);
          at_top = increment.accepted().u;
        }
      }
      CHECK(at_top.size() > 0);
    }
}

TEST_CASE("extremes: pulled to 3 and pressed to 0.2, the closed form") {
  for (double stretch : {3.0, 0.2}) {
    CAPTURE(stretch);
    Pull pull(test::cube(2));
    pull.steps_of = 20;
    pull.run({yeoh(1e-9)}, stretch);
    REQUIRE_MESSAGE(pull.path.complete, pull.path.why);
    const Uniaxial exact = uniaxial(yeoh(1e-9), stretch);
    for (const Mat3& s : pull.sigma) {
      CHECK(s(0, 0) == near(exact.sigma, 1e-6));
      CHECK(std::abs(s(1, 1)) < 1e-5 * std::abs(exact.sigma));
    }
  }
}

TEST_CASE("extremes: spheres from 0.1 mm to 1e5 mm, the largest is a plane") {
  test::Indentation scene = small_scene();
  scene.depth = 0.05, scene.step = 0.025;
  double before = 0;
  for (double radius : {0.1, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5}) {
    CAPTURE(radius);
    scene.radius = radius;
    const double force = final_force(scene, test::stable(30, 1e-6));
    CHECK(force >= before * (1 - 1e-6));
    before = force;
  }
  scene.shape = Plane{{0, 4, 0}, {0, -1, 0}};
  CHECK(before == near(final_force(scene, test::stable(30, 1e-6)), 1e-3));
}

TEST_CASE("extremes: friction from 0 to 10, more of it never makes it softer") {
  test::Indentation scene = small_scene();
  double before = 0;
  for (double mu : {0.0, 1e-6, 0.1, 0.34, 1.0, 3.0, 10.0}) {
    CAPTURE(mu);
    scene.mu = mu;
    const auto result = scene.run(test::stable(30, 1e-6));
    REQUIRE_MESSAGE(result.path.complete, result.path.why);
    for (const auto& step : result.steps) CHECK(step.defect.cone <= 1e-8);
    CHECK(result.steps.back().force > before * (1 - 1e-6));
    before = result.steps.back().force;
  }
}

TEST_CASE(
    "extremes: elements of aspect 1 to 1000, skewed and nearly inverted, pass the patch test") {
  const double exact = uniaxial(yeoh(1e-6), 1.3).sigma;
  for (double aspect : {1.0, 10.0, 100.0, 1000.0}) {
    CAPTURE(aspect);
    Pull pull(test::block(test::even(0, aspect, 2), test::even(0, 1, 2), test::even(0, 1, 2)));
    pull.newton.largest_move = aspect;
    pull.run({yeoh(1e-6)}, 1.3);
    REQUIRE_MESSAGE(pull.path.complete, pull.path.why);
    for (const Mat3& s : pull.sigma) CHECK(s(0, 0) == near(exact, 1e-5));
  }
  for (double amount : {0.1, 0.2, 0.27}) {
    CAPTURE(amount);
    Pull pull(test::cube(3, 3));
    test::distort(pull.mesh, amount * 1.5);
    const Quality q = quality(pull.mesh);
    MESSAGE("scaled Jacobian " << q.least_scaled_jacobian);
    REQUIRE(q.least_jacobian > 0);
    pull.run({yeoh(1e-6)}, 1.3);
    REQUIRE_MESSAGE(pull.path.complete, pull.path.why);
    for (const Mat3& s : pull.sigma) CHECK(s(0, 0) == near(exact, 1e-5));
  }
}

TEST_CASE("extremes: one load step or 1000, the same answer") {
  VecX one;
  for (int steps : {1, 10, 1000}) {
    CAPTURE(steps);
    Pull pull(test::cube(2));
    pull.steps_of = steps, pull.newton.relative = 1e-9;
    pull.run({test::stable(30, 1e-6)}, 1.4);
    REQUIRE_MESSAGE(pull.path.complete, pull.path.why);
    if (one.size() == 0) one = pull.u;
    CHECK((pull.u - one).lpNorm<Eigen::Infinity>() < 1e-8);
  }
}

TEST_CASE("extremes: metres and pascals give what millimetres and megapascals give, to 1e-9") {
  const auto run = [](double length, double pressure) {
    Mesh mesh = test::cube(3);
    for (Vec3& X : mesh.X) X *= length;
    Pull pull(std::move(mesh));
    Material m;
    m.matrix = {Yeoh{0.05 * pressure, 0.05 * pressure, 0.02 * pressure}};
    m.fibres = {Fibre{HgoFibre{0.1 * pressure, 0.3}, 30, FibreSwitch::I4_bar}};
    m.volume = QuadraticVolume{1e-4 / pressure};
    pull.newton.relative = 1e-11, pull.newton.largest_move = length;
    pull.run({m}, 1.4);
    REQUIRE_MESSAGE(pull.path.complete, pull.path.why);
    pull.u /= length, pull.reaction /= length * length * pressure;
    return pull;
  };
  const Pull mm = run(1, 1), m = run(1e-3, 1e6);
  CHECK((mm.u - m.u).lpNorm<Eigen::Infinity>() < 1e-9);
  CHECK(m.reaction == near(mm.reaction, 1e-9));
}

TEST_CASE("extremes: soft beside stiff by 1e6, in a row and around") {
  Mesh mesh = test::block(test::even(0, 2, 4), test::even(0, 1, 2), test::even(0, 1, 2));
  mesh.bodies = {"soft", "stiff"};
  for (int e = 0; e < mesh.n_cells(); ++e) mesh.body[e] = mesh.X[mesh.cell(e)[0]][0] >= 1 - 1e-9;
  Material stiff = test::neo_hooke(1e5, 1e-9);
  Pull pull(mesh);
  pull.newton.iterations = 40;
  pull.run({test::neo_hooke(0.1, 1e-3), stiff}, 1.1);
  REQUIRE_MESSAGE(pull.path.complete, pull.path.why);
  // the stiff half hardly moves: the soft one takes all of it, 0.2 of its length 1
  double stiff_strain = 0;
  for (int i : mesh.node_sets["x_max"])
    for (int k = 0; k < mesh.n_nodes(); ++k)
      if (std::abs(mesh.X[k][0] - 1) < 1e-9 && mesh.X[k][1] == mesh.X[i][1] &&
          mesh.X[k][2] == mesh.X[i][2])
        stiff_strain = std::max(stiff_strain, std::abs(pull.u[3 * i] - pull.u[3 * k]));
  CHECK(stiff_strain < 1e-5);
  // between free contraction and none at the bonded face
  const double area_stress = pull.reaction;
  CHECK(area_stress > 2 * 0.1 * (1.2 - 1 / (1.2 * 1.2)));
  CHECK(area_stress < 2 * 0.1 * (1.2 - 1 / (1.2 * 1.2)) * 4 / 3 * 1.2);
}

TEST_CASE("extremes: turned by 90 degrees while it is pulled, nothing but the pull remains") {
  // both ends of a bar are led from where they are to where the turned and stretched bar has them
  const auto run = [](bool turned, double stretch) {
    Mesh mesh = test::block(test::even(0, 3, 3), test::even(0, 1, 2), test::even(0, 1, 2));
    Mat3 R = Mat3::Identity();
    if (turned) R << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    std::vector<Prescribed> held;
    for (const char* face : {"x_min", "x_max"})
      for (int i : mesh.node_sets[face]) {
        const Vec3& X = mesh.X[i];
        const Vec3 to = R * Vec3(stretch * X[0], X[1], X[2]) - X;
        for (int k = 0; k < 3; ++k) held.push_back({3 * i + k, to[k]});
      }
    Assembler body = test::equilibrium(mesh, {test::stable(20, 1e-6)}, Formulation::mean_dilatation,
                                       number_dofs(mesh.n_nodes(), held).dofs);
    Increment increment(body, {}, {});
    LoadPathOptions options;
    options.first = options.largest = 0.1;
    const PathReport path = load_path(
        options, 0, {}, {},
        [&](double t) {
          increment.begin(t);
          return newton(increment.problem(), increment.trial(), {});
        },
        [&](double, double, double, const SolveReport&) {
          increment.accept();
          return true;
        });
    REQUIRE_MESSAGE(path.complete, path.why);
    return std::pair{body.W(), Vec3(R.transpose() * Vec3([&] {
                                      Vec3 sum = Vec3::Zero();
                                      const VecX r = increment.reactions();
                                      for (int i : mesh.node_sets["x_max"])
                                        sum += r.segment<3>(3 * i);
                                      return sum;
                                    }()))};
  };
  CHECK(run(true, 1).first < 1e-12);  // [N mm]
  const auto straight = run(false, 1.2), round = run(true, 1.2);
  CHECK(round.first == near(straight.first, 1e-7));
  CHECK((round.second - straight.second).norm() < 1e-6 * straight.second.norm());
}
