// The cross-check by another library agrees with an optimum, and says so where there is none.
#include "identification/fit/cross_check.hpp"

#include <doctest/doctest.h>

#include "material/catalogue.hpp"
#include "support/near.hpp"

using namespace langer;

TEST_CASE(
    "NLopt agrees with an optimum, on a bound or not, and finds what a stopped search has missed") {
  Test test;
  test.kind = TestKind::biaxial;
  for (int i = 1; i <= 10; ++i)
    test.first.push_back(1 + 0.03 * i), test.second.push_back(1 + 0.02 * i);
  test.stress_x.resize(10), test.stress_z.resize(10);
  std::vector<double> stress(20);
  REQUIRE(model_stress(positive_hgo_yeoh(20), test, Dilatation::incompressible, stress.data()));
  test.stress_x.assign(stress.begin(), stress.begin() + 10),
      test.stress_z.assign(stress.begin() + 10, stress.end());
  // neo-Hooke and fibres cannot follow Yeoh's matrix; the exponent ends on its bound
  for (double most : {0.5, 20.}) {
    const FitProblem problem{{{NeoHooke{0.1}}, {hgo_fibre(0.1, 0.1, 20)}, {QuadraticVolume{1}}},
                             {{"matrix.neo_hooke.a1", 0.1, 0, 5},
                              {"fibres[0].hgo.c1", 0.1, 0, 5},
                              {"fibres[0].hgo.c2", 0.1, 0, most}},
                             {test}};
    const FitResult f = fit(problem, {.starts = 3});
    REQUIRE(f.best.converged);
    const Comparison same = cross_check(problem, f.best, 1);
    CAPTURE(same.text);
    CHECK(same.agrees);
    CHECK(same.cost == near(f.best.cost, 1e-4));
    LeastSquaresResult stopped = f.best;
    stopped.cost *= 1.01;
    const Comparison lower = cross_check(problem, stopped, 1);
    CHECK(!lower.agrees);
    CHECK(lower.text.starts_with("NLopt finds a lower cost"));
  }
}
