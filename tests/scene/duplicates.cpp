// Loads that act twice, supports that are named twice, families of fibres that are there twice:
// what adds up must have as many images as there are of it. Random scenes, solved with symmetry:
// auto and with symmetry: none.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <random>

#include "support/solved_scene.hpp"

using namespace langer;
using test::largest_difference;

namespace {

using Random = std::mt19937;

template <class T>
T one_of(Random& random, const std::vector<T>& all) {
  return all[std::uniform_int_distribution<std::size_t>(0, all.size() - 1)(random)];
}

// A traction or a pressure on a face, of a few values only, so that many are each other's images.
std::string random_load(Random& random) {
  const std::string face =
      one_of<std::string>(random, {"x_max", "x_min", "x_max", "x_min", "z_max", "z_min", "top"});
  const std::string kind = one_of<std::string>(random, {"x", "y", "z", "pressure"});
  const double size = one_of<double>(random, {0.002, 0.002, -0.002, 0.001});
  if (kind == "pressure") return fmt::format("  - {{on: {}, pressure: {}}}\n", face, size);
  return fmt::format("  - {{on: {}, traction: {{{}: {}}}}}\n", face, kind, size);
}

// The image of a load in the mirror x or z, as text.
std::string mirrored(std::string load, char axis) {
  const std::string high = fmt::format("{}_max", axis), low = fmt::format("{}_min", axis);
  if (const auto at = load.find(high); at != std::string::npos)
    load.replace(at, high.size(), low);
  else if (const auto other = load.find(low); other != std::string::npos)
    load.replace(other, low.size(), high);
  const std::string along = fmt::format("{{{}: ", axis);
  if (const auto at = load.find(along); at != std::string::npos) {
    const std::size_t value = at + along.size();
    if (load[value] == '-')
      load.erase(value, 1);
    else
      load.insert(value, "-");
  }
  return load;
}

std::string random_scene(Random& random) {
  std::vector<std::string> loads;
  const int n = one_of<int>(random, {1, 2});
  for (int i = 0; i < n; ++i) {
    const std::string load = random_load(random);
    const int times = one_of<int>(random, {1, 2, 3}), images = one_of<int>(random, {0, 1, 2, 3});
    const char axis = one_of<char>(random, {'x', 'z'});
    for (int k = 0; k < times; ++k) loads.push_back(load);
    for (int k = 0; k < images; ++k) loads.push_back(mirrored(load, axis));
  }
  std::shuffle(loads.begin(), loads.end(), random);
  std::string text =
      "mesh: {geometry: {block: {origin: [-3, 0, -3], size: [6, 2, 6], divisions: [4, 2, 4]}}}\n";
  const std::string fibre = "{hgo: {c1: 0.02, c2: 1.5}, alpha: ";
  const std::string fibres = one_of<std::string>(
      random,
      {"", "", fibre + "30}, " + fibre + "-30}", fibre + "30}, " + fibre + "30}",
       fibre + "30}, " + fibre + "30}, " + fibre + "-30}", fibre + "90}, " + fibre + "90}"});
  text += "material: {matrix: {neo_hooke: {a1: 0.05}}, fibres: [" + fibres +
          "], volume: {quadratic: {d: 1.0e-2}}}\n";
  const std::string held = "{on: bottom, hold: [x, y, z]}";
  text += "supports: [" + held + one_of<std::string>(random, {"", ", " + held}) + "]\nloads:\n";
  for (const std::string& load : loads) text += load;
  const std::string pulled = "  - {on: top, displacement: {y: 0.1}}\n";
  text += one_of<std::string>(random, {"", "", pulled, pulled + pulled});
  return text + "path: {steps: 2}\n";
}

Vec3 sum(const std::vector<Vec3>& forces) {
  Vec3 all = Vec3::Zero();
  for (const Vec3& force : forces) all += force;
  return all;
}

// solved with symmetry: auto and none; whether the first was a part of the body
bool compare(const std::string& text) {
  CAPTURE(text);
  const SolveConfig config = test::config_of(text);
  const Mesh mesh = test::mesh_in(config);
  const Scene scene = make_scene(config, mesh, config.material, test::nowhere);
  const auto part = ReducedScene::find(SymmetryChoice::automatic, mesh, scene, test::nowhere);
  if (!part) return false;
  const test::HowToSolve how{config.path, NewtonOptions{.relative = 1e-11}};
  const test::Solved whole = test::solved(mesh, scene, std::nullopt, how),
                     few = test::solved(mesh, scene, part, how);
  double size = 0;
  for (const Vec3& reaction : whole.last().reaction) size += reaction.norm();
  CHECK((sum(whole.last().reaction) - sum(few.last().reaction)).norm() <= 1e-9 * size);
  CHECK(largest_difference(whole.last().reaction, few.last().reaction) <= 1e-9 * size);
  CHECK(largest_difference(whole.last().u, few.last().u) < 1e-9);
  return true;
}

}  // namespace

TEST_CASE("random scenes with entries that are there twice: symmetry auto gives what none gives") {
  int reduced = 0, whole = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    if (compare(random_scene(random)))
      ++reduced;
    else
      ++whole;
  }
  CHECK(reduced >= 12);
  CHECK(whole >= 12);
}

TEST_CASE("two equal loads on one face and one on the opposite face are no images") {
  const std::string scene =
      "mesh: {geometry: {block: {origin: [-3, 0, -3], size: [6, 2, 6], divisions: [8, 3, 8]}}}\n"
      "material: {matrix: {neo_hooke: {a1: 0.012}}, volume: {quadratic: {d: 1.0e-2}}}\n"
      "supports: [{on: bottom, hold: [x, y, z]}]\npath: {steps: 2}\nloads:\n";
  const std::string right = "  - {on: x_max, traction: {x: 0.004}}\n",
                    left = "  - {on: x_min, traction: {x: -0.004}}\n";
  const auto symmetry = [&](const std::string& loads) -> std::string {
    const SolveConfig config = test::config_of(scene + loads);
    const Mesh mesh = test::mesh_in(config);
    const Scene all = make_scene(config, mesh, config.material, test::nowhere);
    const auto part = ReducedScene::find(SymmetryChoice::automatic, mesh, all, test::nowhere);
    if (!part) return "none";
    const test::Solved few = test::solved(mesh, all, part, {config.path, config.solver});
    const double total = sum(few.last().reaction)[0];
    return fmt::format("{}, {:.4f} N", part->words().substr(0, part->words().find(" through")),
                       std::abs(total) < 1e-6 ? 0 : total);
  };
  // 12 mm2 of 0.004 MPa that nothing balances
  CHECK(symmetry(right + right + left) == "mirror z, -0.0480 N");
  CHECK(symmetry(right + left + right) == "mirror z, -0.0480 N");
  CHECK(symmetry(left + right + right) == "mirror z, -0.0480 N");
  CHECK(symmetry(left + left + right) == "mirror z, 0.0480 N");
  CHECK(symmetry(right + left) == "mirror x and mirror z, 0.0000 N");
  CHECK(symmetry(right + left + right + left) == "mirror x and mirror z, 0.0000 N");
}
