// What contact costs over its candidates: a plane pressed on a block, all of whose upper nodes
// touch.
#include <fmt/format.h>

#include <cstdio>

#include "support/indentation.hpp"
#include "support/laws.hpp"

using namespace langer;

namespace {

struct Pressing {
  double candidates = 0, factor = 0, contact = 0, corrections = 0, factorizations = 0, force = 0;
  bool complete = false;
};

Pressing pressed(int n, int layers, double mu, ContactBy by) {
  test::Indentation scene;
  scene.nx = scene.nz = n, scene.ny = layers, scene.h = 0, scene.depth = 0.1, scene.step = 0.05,
  scene.mu = mu;
  scene.shape = Plane{{0, 4, 0}, {0, -1, 0}}, scene.reach = 30, scene.contact_by = by;
  const auto result = scene.run(test::neo_hooke(0.3, 1e-4));
  const double corrections = result.path.iterations + result.path.again,
               factors = static_cast<double>(result.cost.factorizations);
  return {static_cast<double>((n + 1) * (n + 1)),
          result.cost.factor / factors,
          result.cost.contact / corrections,
          corrections,
          factors,
          result.steps.empty() ? 0 : result.steps.back().force,
          result.path.complete};
}

void print_both(int n, int layers, double mu) {
  for (ContactBy by : {ContactBy::compliance, ContactBy::tangent}) {
    if (by == ContactBy::compliance && n > 32) continue;  // minutes
    const Pressing row = pressed(n, layers, mu, by);
    fmt::print(
        "  {:>10}  {:>6}  {:>8}  {:<10}  {:>13.3f}  {:>20.3f}  {:>14}  {:>11}  {:>31.2f}  {:.9g}{}\n",
        row.candidates, layers, mu, by == ContactBy::compliance ? "condensed" : "in tangent",
        row.factor, row.contact, row.factorizations, row.corrections,
        row.factor * row.factorizations + row.contact * row.corrections, row.force,
        row.complete ? "" : " (stopped)");
    std::fflush(stdout);
  }
}

}  // namespace

void measure_wide() {
  fmt::print(
      "wide contact: a plane on all upper nodes of n x layers x n hexahedra, two steps; CPU seconds on one thread\n"
      "  candidates  layers  friction  by          factorization  contact a correction  factorizations  corrections  factorization and "
      "contact, all  force N\n");
  for (double mu : {0.0, 0.3}) {
    for (int n : {9, 16, 19, 23, 32, 44, 54, 70}) print_both(n, 2, mu);
    for (int layers : {4, 8, 16, 24}) print_both(20, layers, mu);
  }
}
