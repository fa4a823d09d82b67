// The shear modulus at rest of fits to tests that hardly feel it.
#include "identification/fit/stiffness_at_rest.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "core/base/random.hpp"
#include "mechanics/material/at_rest.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

Test pulled(const Material& truth, double angle, double reach, int points, double noise,
            std::uint64_t stream) {
  Test t;
  t.name = angle == 0 ? "along" : "across", t.fibre_angle_deg = angle;
  for (int i = 1; i <= points; ++i) t.first.push_back(1 + reach * i / points);
  t.stress_x.resize(t.first.size());
  REQUIRE(model_stress(truth, t, Dilatation::incompressible, t.stress_x.data()));
  Random random(3, stream);
  const double size = noise * largest_stress(t);
  for (double& s : t.stress_x) s += size * random.normal();
  return t;
}

FitProblem problem_of(const Material& truth, const Material& law, std::vector<FreeParameter> free,
                      double noise, std::uint64_t stream = 0) {
  FitProblem problem;
  problem.law = law, problem.free = std::move(free);
  problem.tests = {pulled(truth, 0, 0.4, 15, noise, stream),
                   pulled(truth, 90, 0.5, 15, noise, stream + 1)};
  return problem;
}

Material yeoh_and_fibre(double a1) {
  return {{Yeoh{a1, 0.05, 0}}, {Fibre{HgoFibre{0.05, 1}, 0}}, {QuadraticVolume{1e-3}}};
}
std::vector<FreeParameter> yeoh_parameters() {
  return {{"matrix.yeoh.a1", 0.01, 0, 10, true},
          {"matrix.yeoh.a2", 0.01, 0, 10, true},
          {"fibres[0].hgo.c1", 0.01, 0, 10, true},
          {"fibres[0].hgo.c2", 0.1, 0, 10}};
}
const FitOptions few{3, 1, {}};

}  // namespace

TEST_CASE(
    "tests of a law without stiffness at rest: the least that they can tell is taken, and costs them nothing") {
  int raised = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    CAPTURE(seed);
    FitProblem problem =
        problem_of(yeoh_and_fibre(0), yeoh_and_fibre(0.01), yeoh_parameters(), 0.02, 2 * seed);
    FitResult found = fit(problem, few);
    REQUIRE(found.best.converged);
    const double before = 2 * found.best.cost;
    const auto s = stiffen_at_rest(problem, found, few, 0.01);
    if (!s) {  // noise has put it above
      CHECK(shear_modulus(found.material) >=
            least_shear_modulus(problem, residual_noise(problem, found, 0.01)));
      continue;
    }
    ++raised;
    CHECK(s->key == "matrix.yeoh.a1");
    CHECK(s->taken == near(s->least, 1e-9));
    CHECK(problem.free[0].lower == near(s->least / 2));
    CHECK(shear_modulus(found.material) == s->taken);
    CHECK(s->fitted < s->taken);
    CHECK((2 * found.best.cost - before) / (s->noise * s->noise) < 3.84);
    CHECK(s->allowed > s->fitted);
  }
  CHECK(raised >= 6);
}

TEST_CASE(
    "tests that tell the stiffness at rest are left alone, and so is a bound that was given") {
  FitProblem problem =
      problem_of(yeoh_and_fibre(0.05), yeoh_and_fibre(0.01), yeoh_parameters(), 0.01);
  FitResult found = fit(problem, few);
  const VecX p = found.best.p;
  CHECK_FALSE(stiffen_at_rest(problem, found, few, 0.01));
  CHECK(found.best.p == p);

  problem = problem_of(yeoh_and_fibre(0), yeoh_and_fibre(0.01), yeoh_parameters(), 0);
  for (FreeParameter& f : problem.free) f.preset = false;
  found = fit(problem, few);
  CHECK_FALSE(stiffen_at_rest(problem, found, few, 0.01));
  CHECK(problem.free[0].lower == 0);
  CHECK(found.best.p[0] < 1e-6);
}

TEST_CASE("the least modulus is the standard error of a neo-Hookean modulus alone") {
  const FitProblem problem =
      problem_of(yeoh_and_fibre(0), {{NeoHooke{1}}, {}, {QuadraticVolume{1e-3}}},
                 {{"matrix.neo_hooke.a1", 1, 0, 10, true}}, 0);
  const FitResult found = fit(problem, few);
  // covariance = s^2 (J^T J)^-1, and mu = 2 a1
  const double s = std::sqrt(2 * found.best.cost / static_cast<double>(found.best.r.size() - 1));
  CHECK(least_shear_modulus(problem, s) == near(2 * std::sqrt(covariance(found.best)(0, 0)), 1e-5));
}

TEST_CASE("every law of the matrix gets stiffness at rest by one of its numbers") {
  const Material truth{
      {Yeoh{0, 0.02, 0.05}}, {Fibre{HgoFibre{0.03, 1}, 0}}, {QuadraticVolume{1e-3}}};
  const auto law = [](MatrixTerm term) {
    return Material{{std::move(term)}, {Fibre{HgoFibre{0.01, 0.5}, 0}}, {QuadraticVolume{1e-3}}};
  };
  const FreeParameter c1{"fibres[0].hgo.c1", 0.01, 0, 10, true}, c2{"fibres[0].hgo.c2", 0.5, 0, 10};
  struct Case {
    Material law;
    std::vector<FreeParameter> free;
  };
  const Case cases[] = {
      {law(MooneyRivlin{0.01, 0.01}),
       {{"matrix.mooney_rivlin.c10", 0.01, 0, 10, true},
        {"matrix.mooney_rivlin.c01", 0.01, 0, 10, true},
        c1,
        c2}},
      {law(Ogden{.mu1 = 0.01, .alpha1 = 8}),
       {{"matrix.ogden.mu1", 0.01, 0, 10, true}, {"matrix.ogden.alpha1", 8, 1, 20}, c1, c2}},
      {law(Ogden{.mu1 = -0.01, .alpha1 = -8}),
       {{"matrix.ogden.mu1", -0.01, -10, 0, true}, {"matrix.ogden.alpha1", -8, -20, -1}, c1, c2}},
      {law(Gent{0.01, 2}),
       {{"matrix.gent.mu", 0.01, 0, 10, true}, {"matrix.gent.Jm", 2, 1.2, 200}, c1, c2}},
      {law(ArrudaBoyce{0.01, 2}),
       {{"matrix.arruda_boyce.mu", 0.01, 0, 10, true},
        {"matrix.arruda_boyce.locking_stretch", 2, 1, 20},
        c1,
        c2}},
  };
  for (const Case& one : cases) {
    CAPTURE(one.free[0].key);
    FitProblem problem = problem_of(truth, one.law, one.free, 0.01);
    FitResult found = fit(problem, few);
    REQUIRE(found.best.converged);
    const double least = least_shear_modulus(problem, residual_noise(problem, found, 0.01));
    const auto s = stiffen_at_rest(problem, found, few, 0.01);
    CHECK(shear_modulus(found.material) >= least * (1 - 1e-9));
    CHECK(at_rest(found.material) == AtRest::stiff);
    if (s) CHECK(s->taken >= s->least * (1 - 1e-9));
  }
}
