// Impact of two deformable bodies against closed forms, and against one body on a rigid wall.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mortar/bodies.hpp"
#include "support/near.hpp"

using namespace langer;
using namespace langer::test;

namespace {

// Columns in one-dimensional strain, of length 10 mm, with waves of 30 000 mm/s: modulus
// K + 4 G / 3 = 0.9 MPa and density 1e-9 t/mm3.
constexpr double wave_speed = 30000;
constexpr double length = 10;
constexpr double there_and_back = 2 * length / wave_speed;
const std::string law = "{matrix: {neo_hooke: {a1: 0.15}}, volume: {quadratic: {d: 4}}}";

struct Bar {
  std::string name;
  double bottom;    // [mm]
  double velocity;  // along y [mm/s]
  int cells;
};

std::string bar_text(const Bar& bar) {
  const double edge = length / bar.cells;
  return fmt::format(
      "  {}:\n"
      "    mesh: {{geometry: {{block: {{origin: [0, {}, 0], size: [{}, 10, {}], divisions: [1, {}, "
      "1]}}}}}}\n"
      "    material: {}\n"
      "    velocity: [0, {}, 0]\n"
      "    supports:\n"
      "      - {{on: x_min, hold: [x]}}\n"
      "      - {{on: x_max, hold: [x]}}\n"
      "      - {{on: z_min, hold: [z]}}\n"
      "      - {{on: z_max, hold: [z]}}\n",
      bar.name, bar.bottom, edge, edge, bar.cells, law, bar.velocity);
}

std::string bars_text(const std::vector<Bar>& bars, const std::string& contact, double step,
                      double seconds) {
  std::string text = "bodies:\n";
  for (const Bar& bar : bars) text += bar_text(bar);
  return text + "supports: []\ncontacts: {" + contact + "}\n" +
         fmt::format(
             "dynamics: {{density_kg_m3: 1000, step: {:.17g}}}\n"
             "path: {{seconds: {:.17g}}}\n",
             step, seconds);
}

const std::string of_pair = "hit: {on: b_bottom, against: a_top}";

// Two bars with a gap, as long apart as a wave takes for 0.3 of its way there and back, and
// followed for 1.8 of it.
BodiesScene two_bars(int cells, double velocity_a, double velocity_b) {
  const double closing = velocity_a - velocity_b;
  const double gap = 0.3 * there_and_back * closing;
  const double step = length / cells / wave_speed;
  return bodies_scene(bars_text({{"a", -length, velocity_a, cells}, {"b", gap, velocity_b, cells}},
                                of_pair, step, 1.8 * there_and_back));
}

double along_y(const StepRecord& step, const std::string& name) {
  return step.scalars.at("momentum_" + name + "y");
}

}  // namespace

TEST_CASE("two equal bars meet as each would meet a rigid wall, with the pressure of the wave") {
  const int cells = 40;
  const double v = 30;
  const BodiesScene two = two_bars(cells, v, -v);
  const BodiesSolution solution = solved(two);
  const double step = length / cells / wave_speed;
  // the wall stands in the middle of the gap
  const double gap = 0.3 * there_and_back * 2 * v;
  const BodiesScene one = bodies_scene(bars_text(
      {{"b", gap, -v, cells}},
      fmt::format("hit: {{on: b_bottom, rigid: {{plane: {{point: [0, {:.17g}, 0], normal: [0, 1, "
                  "0]}}}}, motion: [{{t: 1, to: [0, 0, 0]}}]}}",
                  0.5 * gap),
      step, 1.8 * there_and_back));
  const BodiesSolution of_wall = solved(one);
  REQUIRE(of_wall.steps.size() == solution.steps.size());
  const double edge = length / cells;
  const double expected = 1e-9 * wave_speed * v * edge * edge;
  double mean = 0;
  int counted = 0;
  double touch = 0;
  double leave = 0;
  for (std::size_t i = 0; i < solution.steps.size(); ++i) {
    const StepRecord& state = solution.steps[i];
    const double force = state.scalars.at("force_hit");
    CHECK(std::abs(force - of_wall.steps[i].force_ind.norm()) < 1e-8 * expected);
    const double t = state.scalars.at("time");
    if (force > 0 && touch == 0) touch = t;
    if (force > 0) leave = t;
    const double share = t / there_and_back - 0.3;
    if (share < 0.075 || share > 0.93) continue;
    mean += force / expected;
    ++counted;
  }
  CHECK(mean / counted == near(1, 5e-3));
  CHECK(std::abs(touch - 0.3 * there_and_back) < 2 * step);
  CHECK(leave - touch == near(there_and_back, 0.03));
}

TEST_CASE("a bar gives its velocity to an equal one at rest, and no momentum is lost") {
  const BodiesScene scene = two_bars(40, 0, -60);
  const BodiesSolution solution = solved(scene);
  const double mass = 1e-9 * length * std::pow(length / 40, 2);
  const double thrown = -60 * mass;
  const StepRecord& first = solution.steps.front();
  CHECK(along_y(first, "b_") == near(thrown, 1e-12));
  const double energy = first.scalars.at("kinetic_energy");
  CHECK(energy == near(0.5 * mass * 60 * 60, 1e-10));
  double most = 0;
  for (const StepRecord& step : solution.steps) {
    CHECK(along_y(step, "") == near(thrown, 1e-10));
    most = std::max(most, step.scalars.at("energy_balance") / energy);
  }
  CHECK(most < 1e-3);
  const StepRecord& last = solution.last();
  CHECK(last.scalars.at("force_hit") == 0);
  CHECK(along_y(last, "a_") == near(thrown, 0.01));
  CHECK(std::abs(along_y(last, "b_")) < 0.01 * std::abs(thrown));
  CHECK(last.scalars.at("mechanical_energy") == near(energy, 1e-3));
}

namespace {

// Two blocks of other sizes and cells that meet askew, one of them spinning.
std::string askew(const std::string& friction) {
  return "bodies:\n"
         "  a:\n"
         "    mesh: {geometry: {block: {origin: [0, 0, 0], size: [6, 3, 3], divisions: [4, 4, 2]}}}\n"
         "    material: " +
         law +
         "\n    velocity: [200, 900, 0]\n"
         "  b:\n"
         "    mesh: {geometry: {block: {origin: [2, 3.1, 0.4], size: [4, 4, 2], divisions: [3, 5, "
         "2]}}}\n"
         "    material: " +
         law +
         "\n    velocity: [-300, -600, 100]\n"
         "    spin: [0, 0, 20]\n"
         "supports: []\n"
         "contacts: {hit: {on: b_bottom, against: a_top, friction: " +
         friction +
         "}}\n"
         "dynamics: {density_kg_m3: 1000, step: 1.0e-5}\n"
         "path: {seconds: 7.0e-4}\n";
}

VecX velocities(const StepRecord& step) {
  const std::vector<Vec3>& v = step.point_fields.at("velocity");
  VecX out(3 * static_cast<Eigen::Index>(v.size()));
  for (std::size_t i = 0; i < v.size(); ++i)
    out.segment<3>(3 * static_cast<Eigen::Index>(i)) = v[i];
  return out;
}

// sum of x times M v over all nodes [N mm s]
Vec3 angular_momentum(const Run& run, const StepRecord& step) {
  const VecX p = run.inertia->mass().M * velocities(step);
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < step.u.size(); ++i) {
    const Vec3 x = run.mesh.X[i] + step.u[i];
    sum += cross(x, p.segment<3>(3 * static_cast<Eigen::Index>(i)));
  }
  return sum;
}

}  // namespace

TEST_CASE("two blocks that meet askew keep their momentum, and friction takes energy") {
  double kinetic_without = 0;
  for (const char* friction : {"0", "0.4"}) {
    CAPTURE(friction);
    const BodiesScene scene = bodies_scene(askew(friction));
    Vec3 start = Vec3::Zero();
    Vec3 end = Vec3::Zero();
    double most = 0;
    const auto each = [&](const Run& run, const StepRecord& step) {
      end = angular_momentum(run, step);
      if (start.isZero(0)) start = end;
      most = std::max(most, step.scalars.at("energy_balance"));
    };
    const BodiesSolution solution = solved(scene, each);
    const StepRecord& first = solution.steps.front();
    const StepRecord& last = solution.last();
    double peak = 0;
    for (const StepRecord& step : solution.steps) {
      peak = std::max(peak, step.scalars.at("force_hit"));
      double momentum = 0;
      double moved = 0;
      for (char axis : {'x', 'y', 'z'}) {
        const std::string of_axis = std::string("momentum_") + axis;
        const double change = step.scalars.at(of_axis) - first.scalars.at(of_axis);
        momentum = std::max(momentum, std::abs(first.scalars.at(of_axis)));
        moved = std::max(moved, std::abs(change));
      }
      CHECK(moved < 1e-10 * momentum);
    }
    CHECK(peak > 0.1);
    CHECK(last.scalars.at("force_hit") == 0);
    const double energy = first.scalars.at("kinetic_energy_at_start");
    // masses 54e-9 and 32e-9 t; of the second also its moment of inertia about z
    const double speeds_a = 200. * 200 + 900. * 900;
    const double speeds_b = 300. * 300 + 600. * 600 + 100. * 100 + 20. * 20 * (16 + 16) / 12;
    CHECK(energy == near(0.5 * (54e-9 * speeds_a + 32e-9 * speeds_b), 1e-10));
    CHECK((end - start).norm() < 1e-4 * start.norm());
    CHECK(std::abs(last.scalars.at("energy_balance")) < 1e-2 * energy);
    CHECK(most < 1e-8 * energy);
    const double left = last.scalars.at("mechanical_energy");
    if (kinetic_without == 0) {
      kinetic_without = left;
    } else {
      CHECK(left < 0.99 * kinetic_without);
    }
  }
}

TEST_CASE("an impact that was killed in contact goes on with the same digits") {
  const BodiesScene scene = bodies_scene(askew("0.4"));
  const BodiesSolution whole = solved(scene);
  std::size_t at = 0;
  for (std::size_t i = 0; i < whole.steps.size(); ++i)
    if (whole.steps[i].scalars.at("force_hit") > 0 && at == 0) at = i + 3;
  REQUIRE(at + 5 < whole.steps.size());
  REQUIRE(whole.steps[at].scalars.at("force_hit") > 0);
  const BodiesSolution rest = solved(scene, {}, &whole.steps[at], &whole.steps[at - 1]);
  REQUIRE(rest.steps.size() == whole.steps.size() - at - 1);
  CHECK((velocities(rest.last()) - velocities(whole.last())).isZero(0));
  CHECK(rest.last().scalars.at("energy_balance") == whole.last().scalars.at("energy_balance"));
}

namespace {

std::string refusal_of_motion(const std::string& text) {
  try {
    const BodiesScene scene = bodies_scene(text);
    Run run(scene.mesh, scene.config, scene.config.material, scene.where);
  } catch (const Failure& failure) {
    CHECK(failure.code() == Exit::config);
    return failure.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("velocities without dynamics, and bodies too thin to move their mass, are refused") {
  std::string still = askew("0");
  still.resize(still.find("dynamics:"));
  const std::string velocity = refusal_of_motion(still);
  CHECK(velocity.find("bodies.a.velocity: found without dynamics") != velocity.npos);
  std::string coarse = askew("0");
  for (const char* divisions : {"[4, 3, 2]", "[4, 1, 2]"}) {
    coarse.replace(coarse.find("divisions: [") + 11, 9, divisions);
    const std::string few = refusal_of_motion(coarse);
    CHECK(few.find("dynamics.contact_mass: the body at (0, 0, 0) has too few cells") != few.npos);
  }
  const std::string thin = refusal_of_motion(bars_text(
      {{"a", -length, 0, 1}, {"b", 0, -1, 1}},
      "hit: {on: b_bottom, against: a_top}, end: {on: b_top, against: a_bottom}", 1e-5, 1e-4));
  CHECK(thin.find("dynamics.contact_mass: every node may touch another body") != thin.npos);
}
