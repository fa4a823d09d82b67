// A sphere pressed into a viscoelastic half space and held, small strains, a contact that grows.
// [LR60]
//   F(t) = 16 sqrt(R)/3 integral of G(t - s) d(d^1.5)/ds ds,   d the depth, G the relaxing shear modulus
#include <doctest/doctest.h>

#include "support/near.hpp"
#include "support/solved_scene.hpp"

using namespace langer;

namespace {

struct Branch {
  double tau, gamma;
};

constexpr double R = 50, depth = 0.02, size = 100, mu = 0.2, ramp = 2;
constexpr Branch branches[] = {{0.3, 0.5}, {3, 0.4}, {40, 0.3}};

double half_space(double t) {
  // integral over the ramp in u = sqrt(s): d(d^1.5) = 3 d0^1.5 u^2 / ramp^1.5 du
  const int n = 2000;
  const double end = std::sqrt(std::min(t, ramp));
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double u = end * (i + 0.5) / n, s = u * u;
    double G = mu;
    for (const Branch& b : branches) G += mu * b.gamma * std::exp(-(t - s) / b.tau);
    sum += G * 3 * u * u * end / n;
  }
  // a layer of a finite thickness, bonded, is stiffer: Dimitriadis et al.'s first term, sqrt(R d)
  // beside the thickness
  const double chi = std::sqrt(R * depth * std::min(t, ramp) / ramp) / size;
  return 16 * std::sqrt(R) / 3 * std::pow(depth / ramp, 1.5) * sum * (1 + 1.133 * chi);
}

}  // namespace

TEST_CASE("viscous: a sphere on a half space relaxes as Lee and Radok say, within 1 %") {
  const std::string scene =
      "mesh: {geometry: {indented_disc: {size: [100, 100], radius: 50, depth: 0.02, edge: 0.05}}, cells: hex8}\n"
      "supports: [{on: bottom, hold: [x, y, z]}]\n"
      "contacts: {ball: {rigid: {sphere: {radius: 50, centre: [0, 150, 0]}}, motion: [{t: 0.05, to: [0, -0.02, 0]}, {t: 1, to: [0, -0.02, 0]}]}}\n"
      "material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 1.0e-4}}, viscous: [{tau: 0.3, gamma: 0.5}, {tau: 3, gamma: 0.4}, "
      "{tau: 40, gamma: 0.3}]}\n"
      "path: {seconds: 40, first: 0.05, largest: 0.05}\nstability: off\n";
  const SolveConfig config = test::config_of(scene);
  Run run(test::mesh_in(config), config, config.material, test::nowhere);
  RunListener each;
  int compared = 0;
  each.of_whole = [&](const StepRecord& step, const SolveReport&) {
    const double t = step.scalars.at("time"), force = step.force_ind.norm();
    if (t < 0.5 * ramp) return;  // few nodes touch
    CAPTURE(t);
    CHECK(force == near(half_space(t), 0.01));
    ++compared;
  };
  CHECK(run.follow(each).path.complete);
  CHECK(compared > 20);
}
