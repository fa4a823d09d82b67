// KINSOL and newton() give the same answers; KINSOL's traps are guarded.
#include "mechanics/nonlinear/kinsol.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "support/indentation.hpp"
#include "support/laws.hpp"

using namespace langer;

namespace {

// x^3 = 8 for each of n unknowns, as a problem whose residual can be spoilt
struct Cubes {
  int n = 3, calls = 0, spoil_from = 1 << 30;
  VecX at;
  Problem problem() {
    Problem p;
    p.assess = [this](const VecX& x, bool) {
      VecX f(n);
      at = x;
      balance().residual(x, f);
      Assessment a;
      a.residual = f.norm(), a.reference = 8;
      return a;
    };
    p.correction = [this]() -> std::optional<VecX> {
      return VecX((8 - at.array().cube()) / (3 * at.array().square()));
    };
    p.admissible = [](const VecX&) {
      return true;
    };
    p.moved = [](const VecX&, double) {
    };
    return p;
  }
  FreeBalance balance() {
    FreeBalance b;
    for (int i = 0; i < n; ++i) b.free.push_back(i);
    b.residual = [this](const VecX& x, VecX& f) {
      if ((x.array().abs() > 1e100).any())
        return f.setConstant(1e100), false;  // its cube is no number
      f = x.array().cube() - 8;
      if (++calls >= spoil_from) f[0] = std::nan("");
      return true;
    };
    b.tangent = [this](const VecX& x) {
      return at = x, true;
    };
    b.solve = [this](const VecX& rhs, bool) {
      return VecX(rhs.array() / (3 * at.array().square()));
    };
    return b;
  }
};

const KinsolStrategy strategies[] = {KinsolStrategy::newton, KinsolStrategy::linesearch,
                                     KinsolStrategy::picard, KinsolStrategy::fixed_point};

}  // namespace

TEST_CASE("every strategy finds the root that newton finds") {
  for (KinsolStrategy strategy : strategies) {
    Cubes cubes;
    KinsolOptions options;
    options.strategy = strategy, options.relative = 1e-10;
    VecX x = VecX::Constant(3, 3.0);
    const SolveReport report = kinsol(cubes.problem(), cubes.balance(), x, options);
    CAPTURE(static_cast<int>(strategy));
    CHECK(report.converged());
    CHECK((x - VecX::Constant(3, 2)).norm() < 1e-9);
  }
}

TEST_CASE("a residual that becomes NaN is never a success and never hangs, whenever it happens") {
  for (KinsolStrategy strategy : strategies)
    for (int from : {1, 2, 3, 4, 6}) {
      Cubes cubes;
      cubes.spoil_from = from;
      KinsolOptions options;
      options.strategy = strategy, options.iterations = 20, options.rounds = 3;
      VecX x = VecX::Constant(3, 30.0);
      CAPTURE(static_cast<int>(strategy));
      CAPTURE(from);
      CHECK_FALSE(kinsol(cubes.problem(), cubes.balance(), x, options).converged());
      CHECK(cubes.calls < 2000);
    }
}

// f(x) = log x has no value left of 0, where Newton's first step from x = 5 leads: x - x log x =
// -3. KINSOL must be told, so that it halves the step; a residual that is no number would stand in
// its vectors for good.
TEST_CASE(
    "a step to where the residual is no number, or is too large to be squared, is shortened and the root is found") {
  for (bool too_large : {false, true})
    for (KinsolStrategy strategy : {KinsolStrategy::newton, KinsolStrategy::linesearch}) {
      CAPTURE(too_large);
      CAPTURE(static_cast<int>(strategy));
      VecX at;
      int outside = 0;
      FreeBalance b;
      b.free = {0};
      b.residual = [&](const VecX& x, VecX& f) {
        f[0] = x[0] > 0 ? std::log(x[0]) : too_large ? -1e200 : std::nan("");
        outside += !(x[0] > 0);
        return true;  // as if it were a number
      };
      b.tangent = [&](const VecX& x) {
        return at = x, true;
      };
      b.solve = [&](const VecX& rhs, bool) {
        return VecX(rhs.cwiseProduct(at));
      };
      Problem p;
      p.assess = [&](const VecX& x, bool) {
        Assessment a;
        a.residual = std::abs(std::log(x[0])), a.reference = 1;
        return a;
      };
      p.correction = []() -> std::optional<VecX> {
        return VecX::Zero(1);
      };  // nothing is imposed: KINSOL does it all
      p.admissible = [](const VecX&) {
        return true;
      };
      p.moved = [](const VecX&, double) {
      };
      KinsolOptions options;
      options.strategy = strategy, options.relative = 1e-10, options.rounds = 3,
      options.largest_move = 100;
      VecX x = VecX::Constant(1, 5.0);
      CHECK(kinsol(p, b, x, options).converged());
      CHECK(std::abs(x[0] - 1) < 1e-9);
      CHECK(outside > 0);
    }
}

TEST_CASE("indentation with friction: every strategy agrees with newton to 1e-8 mm") {
  test::Indentation scene;
  scene.nx = scene.nz = 10, scene.ny = 3, scene.h = 0.6, scene.depth = 0.4,
  scene.newton.relative = 1e-9;
  const Material skin = test::table1(60, 1e-6);
  const auto reference = scene.run(skin);
  REQUIRE(reference.path.complete);
  for (KinsolStrategy strategy : strategies) {
    KinsolOptions options;
    options.strategy = strategy, options.relative = 1e-9;
    scene.kinsol = options;
    const auto result = scene.run(skin);
    CAPTURE(static_cast<int>(strategy));
    REQUIRE(result.path.complete);
    MESSAGE("strategy " << static_cast<int>(strategy) << ": " << result.path.iterations
                        << " iterations, " << result.cost.factorizations << " factorizations, "
                        << result.path.cut_backs << " cuts; newton " << reference.path.iterations);
    CHECK((result.u - reference.u).lpNorm<Eigen::Infinity>() < 1e-8);
    for (const auto& step : result.steps) {
      CHECK(step.defect.penetration <= 1e-9);
      CHECK(step.defect.complementarity <= 1e-8);
    }
  }
}
