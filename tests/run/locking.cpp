// What is said of a formulation that does not suit, beside what the usual one gives on the same
// cells.
#include "accuracy/checks/locking.hpp"

#include <doctest/doctest.h>

#include <string>

#include "support/directions.hpp"
#include "support/indentation.hpp"
#include "support/laws.hpp"

using namespace langer;

namespace {

struct LoadCase {
  std::string name;
  Vec3 move;      // of the upper face, the lower one held
  double turn;    // of it about its middle, bent besides
  double sphere;  // radius of one that is pressed into a larger block instead
  Material material;
};

struct Found {
  double force = 0;  // work of the reactions for the whole movement, or the sphere's force
  double said = 0;
};

Found sphere(const LoadCase& scene, CellType cells, std::optional<Formulation> formulation) {
  test::Indentation indentation;
  const int q = cells == CellType::hex8 ? 1 : 2;
  indentation.cells = cells, indentation.formulation = formulation, indentation.quarter = true,
  indentation.mu = 0;
  indentation.nx = indentation.nz = 12 / q, indentation.ny = 4 / q, indentation.h = 0.5 * q;
  indentation.radius = scene.sphere, indentation.depth = 0.4, indentation.step = 0.2;
  Found out;
  indentation.after = [&](const Increment& increment, const Assembler& body) {
    out.said = locking(body, increment.accepted().u).share;
  };
  const auto result = indentation.run(scene.material);
  REQUIRE(result.path.complete);
  out.force = result.steps.back().force;
  return out;
}

Found block(const LoadCase& scene, CellType cells, std::optional<Formulation> formulation) {
  const int n = cells == CellType::hex8 ? 6 : 3;
  Mesh mesh =
      test::block(test::even(0, 4, n), test::even(0, 2, n / 2 + n % 2), test::even(0, 4, n));
  test::distort(mesh, 0.08);
  if (cells != CellType::hex8) mesh = test::raised_block(mesh, cells);
  std::vector<Prescribed> held;
  for (int i : mesh.node_sets["y_min"])
    for (int k = 0; k < 3; ++k) held.push_back({3 * i + k, 0});
  for (int i : mesh.node_sets["y_max"]) {
    const Vec3 from = mesh.X[i] - Vec3(2, 2, 2),
               u = scene.move + scene.turn * Vec3(from[2], from[0], -from[0]);
    for (int k = 0; k < 3; ++k) held.push_back({3 * i + k, u[k]});
  }
  Assembler body =
      test::equilibrium(mesh, {scene.material}, formulation.value_or(usual_formulation(cells)),
                        number_dofs(mesh.n_nodes(), held).dofs);
  Increment increment(body, {}, {});
  LoadPathOptions path;
  path.first = path.largest = 0.5;
  const PathReport report = load_path(
      path, 0, {}, {},
      [&](double t) {
        increment.begin(t);
        return newton(increment.problem(), increment.trial(), {});
      },
      [&](double, double, double, const SolveReport&) {
        increment.accept();
        return true;
      });
  REQUIRE(report.complete);
  Found out;
  const VecX reactions = increment.reactions();
  for (const Prescribed& p : body.dofs().prescribed) out.force += reactions[p.dof] * p.value;
  out.said = locking(body, increment.accepted().u).share;
  return out;
}

std::vector<LoadCase> scenes(double d) {
  const Vec3 none = Vec3::Zero();
  return {{"tension", {0, 0.3, 0}, 0, 0, test::neo_hooke(0.5, d)},
          {"compression along fibres", {0, -0.3, 0}, 0, 0, test::table1(30, d, 0.3)},
          {"shear", {0.8, 0, 0}, 0, 0, test::stable(0, d)},
          {"turned and bent", none, 0.12, 0, test::neo_hooke(0.5, d)},
          {"sphere", none, 0, 2.5, test::table1(30, d, 0.3)},
          {"large sphere", none, 0, 8, test::neo_hooke(0.5, d)}};
}

}  // namespace

TEST_CASE(
    "locking: what is said of displacement and of mean_dilatation on quadratic cells is what the usual formulation shows") {
  struct Choice {
    CellType cells;
    Formulation formulation;
    std::vector<double> d;
  };
  int wrong_by_3 = 0, right_to_1 = 0;
  for (const Choice& c : {Choice{CellType::hex8, Formulation::displacement, {10, 1, 0.1, 1e-3}},
                          {CellType::hex27, Formulation::displacement, {10, 1e-1}},
                          {CellType::tet15, Formulation::displacement, {1}},
                          {CellType::hex27, Formulation::mean_dilatation, {1, 1e-4}},
                          {CellType::tet15, Formulation::mean_dilatation, {1e-2}}})
    for (double d : c.d)
      for (const LoadCase& scene : scenes(d)) {
        const auto run = [&](std::optional<Formulation> f) {
          return scene.sphere > 0 ? sphere(scene, c.cells, f) : block(scene, c.cells, f);
        };
        const Found right = run(std::nullopt), other = run(c.formulation);
        const double off = other.force / right.force - 1;
        CAPTURE(scene.name);
        CAPTURE(static_cast<int>(c.cells));
        CAPTURE(d);
        CAPTURE(off);
        CAPTURE(other.said);
        if (std::abs(off) < 0.01) {
          CHECK(std::abs(other.said) < 0.02);
          ++right_to_1;
          continue;
        }
        CHECK(off * other.said > 0);
        if (std::abs(off) > 0.03) {
          CHECK(std::abs(other.said) > 0.02);
          ++wrong_by_3;
        }
        if (std::abs(other.said) < 0.3) {
          CHECK(std::abs(other.said) < 3 * std::abs(off));
          CHECK(std::abs(other.said) > std::abs(off) / 3);
        } else {
          CHECK(std::abs(off) > 0.05);
        }
      }
  CHECK(wrong_by_3 > 20);
  CHECK(right_to_1 > 5);
}

TEST_CASE("locking: the usual formulations are not looked at") {
  for (CellType type : {CellType::hex8, CellType::hex27, CellType::tet15}) {
    CHECK_FALSE(may_lock(usual_formulation(type), type));
    CHECK(may_lock(Formulation::displacement, type));
    CHECK(may_lock(Formulation::mean_dilatation, type) == (type != CellType::hex8));
  }
}
