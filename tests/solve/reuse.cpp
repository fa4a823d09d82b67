// Corrections with a tangent that is there already: the same equilibria, with fewer factorizations.
#include <doctest/doctest.h>

#include <cmath>

#include "support/indentation.hpp"
#include "support/laws.hpp"

using namespace langer;

namespace {

// x^2 = 2 and y^3 = 3, with the derivative of the last correction()
struct Roots {
  VecX at, slope;
  int tangents = 0;
  Problem problem(double price) {
    Problem p;
    p.assess = [this](const VecX& x, bool) {
      at = x;
      Assessment a;
      a.residual = f().norm(), a.reference = 1;
      return a;
    };
    p.correction = [this]() -> std::optional<VecX> {
      ++tangents;
      slope = Eigen::Vector2d(2 * at[0], 3 * at[1] * at[1]);
      return VecX(-f().cwiseQuotient(slope));
    };
    p.correction_again = [this]() -> std::optional<VecX> {
      return VecX(-f().cwiseQuotient(slope));
    };
    p.cost_ratio = price;
    p.admissible = [](const VecX&) {
      return true;
    };
    p.moved = [](const VecX&, double) {
    };
    return p;
  }
  VecX f() const { return Eigen::Vector2d(at[0] * at[0] - 2, at[1] * at[1] * at[1] - 3); }
};

}  // namespace

TEST_CASE("old tangents are used where they are cheap and the answer is as good") {
  const Eigen::Vector2d exact(std::sqrt(2.0), std::cbrt(3.0));
  for (const auto& [price, near, dear] : {std::array{1.0, 2.0, 4.0}, {1000.0, 1.0, 1.0}}) {
    Roots roots;
    VecX x = Eigen::Vector2d(1.3, 1.5);
    const SolveReport report = newton(roots.problem(price), x, NewtonOptions{});
    REQUIRE(report.converged());
    CHECK((x - exact).norm() < (price > 1 ? 1e-8 : 1e-6));
    CHECK(report.iterations == roots.tangents);
    CHECK(report.iterations >= near);
    CHECK(report.iterations <= dear);
    CHECK(report.again > 0);
  }
  Roots roots;
  VecX x = Eigen::Vector2d(1.3, 1.5);
  NewtonOptions each_time;
  each_time.reuse_tangent = false;
  const SolveReport report = newton(roots.problem(1000), x, each_time);
  CHECK(report.converged());
  CHECK(report.again == 0);

  // an old tangent that leads nowhere is given up after one attempt
  Problem misled = roots.problem(1000);
  misled.correction_again = []() -> std::optional<VecX> {
    return VecX(Eigen::Vector2d(0.01, -0.02));
  };
  x = Eigen::Vector2d(1.3, 1.5);
  const SolveReport after = newton(misled, x, NewtonOptions{});
  CHECK(after.converged());
  CHECK(after.again == 1);
}

TEST_CASE(
    "a tangent that was made where the step begins serves first, and is left where it leads nowhere") {
  const Eigen::Vector2d exact(std::sqrt(2.0), std::cbrt(3.0));
  for (const double far : {0.02, 0.5}) {
    Roots roots;
    VecX x = exact + VecX(Eigen::Vector2d(far, -far));
    const VecX before = x + VecX(Eigen::Vector2d(far, -far));
    roots.slope = Eigen::Vector2d(2 * before[0], 3 * before[1] * before[1]);
    Problem problem = roots.problem(10);
    problem.begins_again = true;
    const SolveReport report = newton(problem, x, NewtonOptions{});
    REQUIRE(report.converged());
    CHECK((x - exact).norm() < 1e-8);
    CHECK(report.iterations == 1 + roots.tangents);  // it counts as what it is
    CHECK((roots.tangents == 0) == (far < 0.1));
  }
}

TEST_CASE("indentations with old tangents end where those with a new one each time do") {
  struct Case {
    CellType cells;
    bool quarter;
    double mu, alpha, d, step;
  };
  for (const Case& c : {Case{CellType::hex8, false, 0.34, 60, 1e-6, 0.1},
                        Case{CellType::hex8, true, 0, 0, 1e-9, 0.05},
                        Case{CellType::hex27, true, 0.34, 0, 1e-6, 0.1}}) {
    CAPTURE(c.mu);
    CAPTURE(static_cast<int>(c.cells));
    test::Indentation scene;
    scene.cells = c.cells, scene.quarter = c.quarter, scene.mu = c.mu, scene.step = c.step,
    scene.depth = 0.5;
    scene.nx = scene.nz = c.cells == CellType::hex8 ? 14 : 8, scene.ny = 4,
    scene.h = c.cells == CellType::hex8 ? 0.45 : 0.6;
    const Material skin = test::table1(c.alpha, c.d);
    const auto with = scene.run(skin);
    scene.newton.reuse_tangent = false;
    const auto without = scene.run(skin);
    REQUIRE(with.path.complete);
    REQUIRE(without.path.complete);
    CHECK(with.path.again > 0);
    CHECK(without.path.again == 0);
    CHECK(with.cost.factorizations < without.cost.factorizations);
    CHECK((with.u - without.u).lpNorm<Eigen::Infinity>() < 1e-8);
    for (std::size_t i = 0; i < with.steps.size(); ++i)
      CHECK(std::abs(with.steps[i].force - without.steps[i].force) <
            1e-8 * without.steps.back().force);
  }
}
