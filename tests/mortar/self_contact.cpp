// A surface that folds and touches itself, against two surfaces, and against half of it on a plane.
#include <doctest/doctest.h>

#include <cmath>

#include "mechanics/mesh/select.hpp"
#include "mortar/bodies.hpp"
#include "scene/model/make_mesh.hpp"
#include "support/block.hpp"
#include "support/near.hpp"

using namespace langer;
using namespace langer::test;

namespace {

// An arch in plane strain whose legs are pinched until its inside touches itself.
BodiesScene pinched(const std::string& contact) {
  std::string text =
      "mesh:\n"
      "  geometry: {block: {origin: [-7.853981633974483, 0, 0], size: [15.707963267948966, 1, 0.5], "
      "divisions: [32, 2, 1]}}\n"
      "  bend: 5\n"
      "  sets:\n"
      "    pad_left: {of: top, within: {box: {from: [-6, 0.9, -1], to: [-4.5, 1.1, 1]}}}\n"
      "    pad_right: {of: top, within: {box: {from: [4.5, 0.9, -1], to: [6, 1.1, 1]}}}\n"
      "    inside_left: {of: bottom, within: {box: {from: [-8, -0.1, -1], to: [-1, 0.1, 1]}}}\n"
      "    inside_right: {of: bottom, within: {box: {from: [1, -0.1, -1], to: [8, 0.1, 1]}}}\n"
      "material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 0.5}}}\n"
      "supports:\n"
      "  - {on: x_min, hold: [x, y]}\n"
      "  - {on: x_max, hold: [x, y]}\n"
      "  - {on: z_min, hold: [z]}\n"
      "  - {on: z_max, hold: [z]}\n"
      "loads:\n"
      "  - {on: pad_left, displacement: {x: 4.1, y: 0}}\n"
      "  - {on: pad_right, displacement: {x: -4.1, y: 0}}\n"
      "path: {first: 0.02, largest: 0.05}\n";
  text += "contacts: {" + contact + "}\n";
  auto loaded = read_config<SolveConfig>(parse_yaml(text, "scene.yaml"));
  BodiesScene scene{std::move(loaded.config), std::move(loaded.where), {}};
  expand_bodies(scene.config, scene.where.tree);
  scene.mesh = make_mesh(*scene.config.mesh, scene.where).mesh;
  return scene;
}

double largest_difference(const StepRecord& a, const StepRecord& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.u.size(); ++i) most = std::max(most, (a.u[i] - b.u[i]).norm());
  return most;
}

}  // namespace

TEST_CASE("a fold that touches itself is two surfaces that touch, with friction") {
  const BodiesScene fold = pinched("fold: {on: bottom, against: bottom, friction: 0.3}");
  const BodiesScene pair = pinched("fold: {on: inside_left, against: inside_right, friction: 0.3}");
  const BodiesSolution of_fold = solved(fold);
  const BodiesSolution of_pair = solved(pair);
  const StepRecord& last = of_fold.last();
  CHECK(last.scalars.at("force_fold") > 1e-3);
  // not along z, where all nodes are held: what sticks there has any friction inside its cone
  for (const char* component : {"force_fold_x", "force_fold_y"}) {
    const double expected = of_pair.last().scalars.at(component);
    CHECK(last.scalars.at(component) == near(expected, 1e-8, 1e-10));
  }
  CHECK(largest_difference(last, of_pair.last()) < 1e-8);
  std::vector<int> inside;  // without those that are held
  for (int node : fold.mesh.node_sets.at("bottom"))
    if (fold.mesh.X[static_cast<std::size_t>(node)][1] > -4.9) inside.push_back(node);
  const auto [force, moment] = imbalance(fold, last, inside);
  CHECK(force < 1e-10);
  CHECK(moment < 1e-10);
  CHECK(last.scalars.at("penetration_fold") < 0.02);
  // nothing touches before the legs meet
  CHECK(of_fold.steps.front().scalars.at("force_fold") == 0);
  CHECK(of_fold.steps.front().scalars.at("penetration_fold") == 0);
}

TEST_CASE(
    "without friction the two flanks of a fold are mirror images, with a law on one of them") {
  const BodiesScene fold = pinched("fold: {on: bottom, against: bottom}");
  const StepRecord last = solved(fold).last();
  CHECK(last.scalars.at("force_fold") > 1e-3);
  double most = 0;
  for (int a = 0; a < fold.mesh.n_nodes(); ++a) {
    for (int b = 0; b < fold.mesh.n_nodes(); ++b) {
      const Vec3 mirrored = fold.mesh.X[static_cast<std::size_t>(b)].cwiseProduct(Vec3(-1, 1, 1));
      if ((fold.mesh.X[static_cast<std::size_t>(a)] - mirrored).norm() > 1e-9) continue;
      const Vec3 u = last.u[static_cast<std::size_t>(b)].cwiseProduct(Vec3(-1, 1, 1));
      most = std::max(most, (last.u[static_cast<std::size_t>(a)] - u).norm());
    }
  }
  CHECK(most < 0.1);  // of 4.1 mm
}

namespace {

// A block in plane strain with a small groove in its top, shortened along x.
BodiesScene grooved() {
  const double half = 2;
  const double finest = 0.02;
  // lines from the groove outwards: even, then growing
  const auto lines_until = [&](double even_part) {
    std::vector<double> lines{0};
    double step = finest;
    while (lines.back() < half) {
      lines.push_back(lines.back() + step);
      if (lines.back() > even_part) step *= 1.35;
    }
    lines.back() = half;
    return lines;
  };
  const std::vector<double> outwards = lines_until(0.2);
  std::vector<double> x;
  for (auto line = outwards.rbegin(); line != outwards.rend(); ++line) x.push_back(-*line);
  x.insert(x.end(), outwards.begin() + 1, outwards.end());
  const std::vector<double> downwards = lines_until(0.12);
  std::vector<double> y;
  for (auto line = downwards.rbegin(); line != downwards.rend(); ++line) y.push_back(half - *line);
  BodiesScene scene;
  scene.mesh = block(x, y, {0, finest});
  Mesh& mesh = scene.mesh;
  for (int node : mesh.node_sets.at("y_max")) {
    const double here = mesh.X[static_cast<std::size_t>(node)][0];
    if (std::abs(here) < 1) mesh.node_sets["fold"].push_back(node);
  }
  mesh.facet_sets["fold"] = facets_within(mesh, boundary(mesh), mesh.node_sets.at("fold"));
  const double groove = 0.04;  // its depth and half width
  for (Vec3& X : mesh.X) {
    const double share = std::exp(-std::pow(X[0] / groove, 2));
    X[1] -= groove * share * std::exp(-(half - X[1]) / (3 * groove));
  }
  auto loaded = read_config<SolveConfig>(
      parse_yaml("mesh: {geometry: {block: {size: [1, 1, 1], divisions: [1, 1, 1]}}}\n"
                 "material: {matrix: {neo_hooke: {a1: 0.5}}, volume: {quadratic: {d: 0.02}}}\n"
                 "supports:\n"
                 "  - {on: y_min, hold: [y]}\n"
                 "  - {on: z_min, hold: [z]}\n"
                 "  - {on: z_max, hold: [z]}\n"
                 "loads:\n"
                 "  - {on: x_min, displacement: {x: 0.74}}\n"
                 "  - {on: x_max, displacement: {x: -0.74}}\n"
                 "contacts: {fold: {on: fold, against: fold}}\n"
                 "path: {first: 0.05, largest: 0.05}\n",
                 "scene.yaml"));
  scene.config = std::move(loaded.config);
  scene.where = std::move(loaded.where);
  expand_bodies(scene.config, scene.where.tree);
  return scene;
}

struct ForceLine {
  double at = 0, value = 0, slope = 0;
};

}  // namespace

// The flanks of a groove touch early. They hardly press on each other until the block is shortened
// by 0.354, where a smooth surface would crease [Hong, Zhao, Suo 2009], and then more with every
// increment: the lines through the force before and after cross there.
TEST_CASE("a groove that has folded grows into a crease where a smooth surface would") {
  const BodiesSolution solution = solved(grooved());
  const auto line_through = [&](double from, double to) {
    const StepRecord* first = nullptr;
    const StepRecord* last = nullptr;
    for (const StepRecord& step : solution.steps) {
      const double shortened = 0.37 * step.t;
      if (shortened < from || shortened > to) continue;
      if (!first) first = &step;
      last = &step;
    }
    REQUIRE(first != last);
    const double x = 0.37 * first->t;
    const double f = first->scalars.at("force_fold");
    return ForceLine{x, f, (last->scalars.at("force_fold") - f) / (0.37 * last->t - x)};
  };
  const ForceLine before = line_through(0.25, 0.31);
  const ForceLine after = line_through(0.354, 0.3701);
  const double crossing =
      (before.value - after.value + after.slope * after.at - before.slope * before.at) /
      (after.slope - before.slope);
  CHECK(after.slope > 5 * before.slope);
  CHECK(crossing == near(0.354, 0, 0.02));
}
