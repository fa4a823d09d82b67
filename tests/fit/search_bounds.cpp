// Bounds of a fit whose config names none: each number of a material model answers its own.
#include <doctest/doctest.h>

#include "core/config/reader.hpp"
#include "core/config/tree.hpp"
#include "identification/setup/fit_config.hpp"

using namespace langer;

namespace search_bounds_tests {

namespace {

// all models with numbers of their own bounds
const std::string law = R"(
law:
  matrix:
    yeoh: {a1: 0.1}
    ogden: {mu1: 0.1, alpha1: 2, mu2: -0.1, alpha2: -2}
    arruda_boyce: {mu: 0.1, locking_stretch: 2}
    gent: {mu: 0.1, Jm: 3}
  fibres:
    - {hgo: {c1: 0.1, c2: 1}, alpha: 10, kappa: 0.1}
    - {exp_pow: {ksi: 0.1, alpha: 1, beta: 3}, alpha: 20}
    - {pow_linear: {E: 10, lam0: 1.1, beta: 3}, alpha: 30}
  volume: {logarithmic: {bulk_modulus: 100}}
  viscous: [{tau: 2, gamma: 0.5}]
)";

FreeParameter free_number(const std::string& key, const std::string& bounds,
                          const std::string& keys = "") {
  const std::string yaml =
      "data: [{file: curve.csv, columns: {time: t_s, strain_x: e, stress_x: s}}]\nbounds: " +
      bounds + "\nparameters: [{key: \"" + key + "\"" + keys + "}]" + law;
  const FitConfig config = read_config<FitConfig>(parse_yaml(yaml, "fit.yaml", ".")).config;
  return free_parameters(config).front();
}

void check_bounds(const std::string& key, const std::string& bounds, double lower, double upper) {
  CAPTURE(key);
  CAPTURE(bounds);
  const FreeParameter found = free_number(key, bounds);
  CHECK(found.lower == lower);
  CHECK(found.upper == upper);
}

}  // namespace

TEST_CASE("moduli may be negative in the paper's bounds but not in admissible ones") {
  for (const char* key : {"matrix.yeoh.a1", "matrix.arruda_boyce.mu", "fibres[0].hgo.c1"}) {
    check_bounds(key, "paper", -10, 10);
    check_bounds(key, "admissible", 0, 10);
  }
}

TEST_CASE("a number answers its own bounds, within the range of its model") {
  for (const char* bounds : {"paper", "admissible"}) {
    check_bounds("matrix.arruda_boyce.locking_stretch", bounds, 1, 20);
    check_bounds("matrix.gent.Jm", bounds, 0.1, 200);
    check_bounds("fibres[0].hgo.c2", bounds, 0, 100);
    check_bounds("fibres[0].kappa", bounds, 0, 1. / 3);
    check_bounds("fibres[1].exp_pow.alpha", bounds, 0, 100);
    check_bounds("fibres[1].exp_pow.beta", bounds, 2, 10);
    check_bounds("fibres[2].pow_linear.E", bounds, 0, 1e4);
    check_bounds("fibres[2].pow_linear.lam0", bounds, 1.001, 2);
    check_bounds("fibres[2].pow_linear.beta", bounds, 2, 10);
    check_bounds("volume.logarithmic.bulk_modulus", bounds, 0.2, 2e8);
    check_bounds("viscous[0].gamma", bounds, 0, 10);
  }
}

TEST_CASE("angles and relaxation times have the bounds of their unit") {
  check_bounds("fibres[1].alpha", "admissible", -90, 90);
  check_bounds("viscous[0].tau", "admissible", 0.02, 200);
  CHECK(free_number("viscous[0].tau", "paper", ", start: 5").upper == 500);
}

TEST_CASE("an admissible power of Ogden keeps its sign, and its modulus has the same") {
  check_bounds("matrix.ogden.alpha1", "paper", -20, 20);
  check_bounds("matrix.ogden.alpha1", "admissible", 1, 20);
  check_bounds("matrix.ogden.alpha2", "admissible", -20, -1);
  check_bounds("matrix.ogden.mu1", "admissible", 0, 10);
  check_bounds("matrix.ogden.mu2", "admissible", -10, 0);
  check_bounds("matrix.ogden.mu2", "paper", -10, 10);
}

TEST_CASE("bounds that the config names replace the ones of the number") {
  const FreeParameter found = free_number("fibres[0].hgo.c2", "admissible", ", upper: 7");
  CHECK(found.lower == 0);
  CHECK(found.upper == 7);
}

}  // namespace search_bounds_tests
