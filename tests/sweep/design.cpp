// Designs of experiments on whole runs: their points are what the methods ask for, and answers give
// the methods' effects.
#include "pipeline/sweep/design.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/sweep/design_tables.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

Design three() {
  Design d;
  d.parameters = {{"material.matrix.yeoh.a1", "", "MPa", 1, 3, {}},
                  {"fibre_angles[0]", "", "deg", 0, 90, {30}},
                  {"contacts.sphere.friction", "mu", "-", 0.1, 0.5, {}}};
  return d;
}

std::vector<double> answers(const Design& d, double (*f)(const VecX&)) {
  std::vector<double> all;
  for (const VecX& p : design_points(d)) all.push_back(f(p));
  return all;
}

double plane(const VecX& p) { return 2 * p[0] - 0.1 * p[1] + 5; }
double product(const VecX& p) { return p[0] * p[2]; }

}  // namespace

TEST_CASE("A design's points lie in its box, each once, the same every time") {
  Design d = three();
  d.morris = MorrisChoice{10, 4}, d.one_at_a_time = OneAtATimeChoice{4};
  const auto points = design_points(d), again = design_points(d);
  REQUIRE(points.size() == again.size());
  CHECK(points.size() <= 10 * 4 + 3 * 5);
  CHECK(points.size() > 30);
  for (std::size_t i = 0; i < points.size(); ++i) {
    CHECK(points[i] == again[i]);
    for (int k = 0; k < 3; ++k) {
      CHECK(points[i][k] >= d.parameters[static_cast<std::size_t>(k)].lower);
      CHECK(points[i][k] <= d.parameters[static_cast<std::size_t>(k)].upper * (1 + 1e-15));
    }
    for (std::size_t j = 0; j < i; ++j) CHECK(points[i] != points[j]);
  }
  d.seed = 2;
  CHECK(design_points(d)[20] != points[20]);
}

TEST_CASE(
    "A linear answer has its slopes times the ranges as effects and no sigma, a product has one") {
  Design d = three();
  d.morris = MorrisChoice{8, 4}, d.one_at_a_time = OneAtATimeChoice{3};
  const QuantityEffects e = effects_of(d, "force", "N", answers(d, plane));
  const double expected[] = {4, 9, 0};
  REQUIRE(e.morris);
  CHECK(e.morris->trajectories == 8);
  for (int i = 0; i < 3; ++i) {
    CHECK(e.morris->mu_star.value(i, 0) == near(expected[i], 1e-12));
    CHECK(e.morris->sigma.value(i, 0) <= 1e-12);
    CHECK(e.one_at_a_time->mu_star(i, 0) == near(expected[i], 1e-12));
    CHECK(e.one_at_a_time->spread(i, 0) <= 1e-11);
  }
  CHECK(e.morris->mu.value(1, 0) == near(-9, 1e-12));
  const QuantityEffects p = effects_of(d, "force", "N", answers(d, product));
  CHECK(p.morris->sigma.value(0, 0) > 0.05);
  CHECK(p.one_at_a_time->spread(0, 0) <= 1e-12);
}

TEST_CASE("Sobol's shares of a product through a design are those of the closed form") {
  Design d = three();
  d.sobol = SobolChoice{4096};
  const auto values = answers(d, product);
  CHECK(values.size() == 4096 * 5 + 1);
  const QuantityEffects e = effects_of(d, "force", "N", values);
  // y = a b, independent: V = Va Vb + Va mb^2 + Vb ma^2 with ma = 2, Va = 1/3, mb = 0.3, Vb =
  // 0.04/3
  const double Va = 1. / 3, Vb = 0.16 / 12, V = Va * Vb + Va * 0.09 + Vb * 4, first = Va * 0.09 / V,
               total = first + Va * Vb / V;
  CHECK(e.sobol->first.low(0, 0) <= first);
  CHECK(e.sobol->first.high(0, 0) >= first);
  CHECK(e.sobol->total.value(0, 0) == near(total, 0.05));
  CHECK(std::abs(e.sobol->total.value(1, 0)) < 1e-12);
}

TEST_CASE("Members without the quantity leave out what needs them, and are counted") {
  Design d = three();
  d.morris = MorrisChoice{10, 4};
  auto values = answers(d, plane);
  values[0] = std::numeric_limits<double>::quiet_NaN();
  const QuantityEffects e = effects_of(d, "force", "N", values);
  CHECK(e.morris->without_curve >= 1);
  CHECK(e.morris->trajectories == 10 - e.morris->without_curve);
  CHECK(e.morris->mu_star.value(0, 0) == near(4, 1e-12));
  const auto lines = effects_lines(d, e);
  REQUIRE(lines.size() == 2);
  CHECK(lines[0].starts_with("force: Morris mu* (95 %; sigma), N: fibre_angles0 9 ("));
  CHECK(lines[1].find("samples without it are left out") != std::string::npos);
  const std::string csv = effects_csv(d, {e});
  CAPTURE(csv);
  const std::string before_mu_star = "\nforce,N,a1,MPa,1,3,,,";
  const auto row = csv.find(before_mu_star);
  REQUIRE(row != std::string::npos);
  CHECK(std::stod(csv.substr(row + before_mu_star.size())) == near(4, 1e-12));
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 4);
  CHECK(effects_bars(d, e).groups == std::vector<std::string>{"a1", "fibre_angles0", "mu"});
}
