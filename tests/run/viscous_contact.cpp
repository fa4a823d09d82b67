// Indenters in viscous bodies: creep of a half space under a force, and where the work of a cycle
// with friction goes.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "results/post/energy_columns.hpp"
#include "scene/run/post_files.hpp"
#include "support/near.hpp"
#include "support/section.hpp"

using namespace langer;

namespace viscous_contact_tests {

namespace {

constexpr double R = 10, mu = 1, end = 30;  // [mm], [MPa] left after all has relaxed, [s]

// a sphere on a body some 300 times as deep and wide as the contact; nearly incompressible, strains
// of some percent
std::string half_space(const std::string& branches, const std::string& moved) {
  return "mesh:\n  geometry: {indented_disc: {size: [150, 150], radius: 10, depth: 0.02, edge: 0.125}}\n  cells: hex27\n"
         "  sets: {contact: {of: top, within: {cylinder: {axis: y, radius: 1.2}}}}\n"
         "material: {matrix: {neo_hooke: {a1: 0.5}}, volume: {quadratic: {d: 1.0e-4}}, viscous: " +
         branches + "}\nsupports: [{on: bottom, hold: [x, y]}]\ncontacts: {ball: {on: contact, " +
         moved +
         ", rigid: {sphere: {radius: 10, centre: [0, 160, 0]}}}}\npath: {seconds: 30, first: 0.05, largest: 0.1}\n";
}

// ∫ f(s) ds from 0 to `until`; Simpson's rule
template <class F>
double integral(F f, double until) {
  constexpr int n = 2000;
  double sum = 0;
  for (int i = 0; i <= n; ++i) sum += (i == 0 || i == n ? 1 : i % 2 ? 4 : 2) * f(until * i / n);
  return sum * until / (3 * n);
}

}  // namespace

// [LR60] for a given force, with the creep compliance J: δ^3/2 = 3 / (16 sqrt(R)) ∫ J(t - s) dF/ds
// ds
TEST_CASE(
    "viscous: a sphere under a constant force creeps into a half space as Lee and Radok say") {
  constexpr double tau = 3, gamma = 0.8, force = 0.08, ramp = 2;
  const test::Ended found = test::run(half_space(
      "[{tau: 3, gamma: 0.8}]", "control: {force: [{s: 2, to: 0.08}, {s: 30, to: 0.08}]}"));
  const auto J = [](double t) {
    return (1 - gamma / (1 + gamma) * std::exp(-t / (tau * (1 + gamma)))) / mu;
  };
  const auto depth = [&](double t) {
    return std::pow(3 / (16 * std::sqrt(R)) * force / ramp *
                        integral([&](double s) { return J(t - s); }, std::min(t, ramp)),
                    2.0 / 3);
  };
  int held = 0;
  for (const StepRecord& step : found.steps) {
    const double t = end * step.t;
    if (t < 1) continue;
    CAPTURE(t);
    CHECK(step.u_ind.norm() == near(depth(t), 0.01));
    held += t > ramp;
  }
  CHECK(held >= 8);
  CHECK(found.last().u_ind.norm() > 1.2 * depth(ramp));
}

TEST_CASE(
    "viscous: with friction work is stored, dissipated by the branches or by friction, error of second order") {
  std::vector<double> worst;
  for (const char* increments : {"0.05", "0.025"}) {
    const test::Ended found = test::run(
        "mesh:\n  geometry: {indented_disc: {size: [16.93, 4], radius: 2.5, depth: 1, edge: 0.177}}\n"
        "  sets: {contact: {of: top, within: {cylinder: {axis: y, radius: 2.8}}}}\n"
        "material: {matrix: {yeoh: {a1: 0.269, a2: 0.376, a3: 0.415}}, volume: {quadratic: {d: 1.0e-4}}, "
        "viscous: [{tau: 0.5, gamma: 0.4}, {tau: 20, gamma: 0.3}]}\nsupports: [{on: bottom, hold: [x, y]}]\n"
        "contacts: {ball: {on: contact, friction: 0.34, rigid: {sphere: {radius: 2.5, centre: [0, 6.5, 0]}}, "
        "motion: [{s: 1, to: [0, -1, 0]}, {s: 21, to: [0, -1, 0]}, {s: 22, to: [0, 0, 0]}]}}\npath: {seconds: 22, first: " +
        std::string(increments) + ", largest: " + increments + "}\n");
    EnergyPath path(found.mesh, found.scene.contacts);
    StepRecord rest;
    rest.u.assign(found.mesh.X.size(), Vec3::Zero()), rest.reaction = rest.u;
    path.add(energy_state(rest, found.scene.contacts, {}));
    for (const StepRecord& step : found.steps)
      path.add(energy_state(step, found.scene.contacts, {}));
    const std::vector<PathSums> sums = path.sums();
    CHECK(sums.back().dissipated > 0.02);
    CHECK(found.last().scalars.at("viscous_work") > 2.5);
    worst.push_back(std::abs(sums.back().balance));
  }
  CHECK(worst[0] < 1e-3);
  CHECK(worst[1] < 0.4 * worst[0]);
}

}  // namespace viscous_contact_tests
