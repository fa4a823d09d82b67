// Vibrations as a config asks for them: reduced bodies against whole ones, refusals, files.
#include "scene/run/vibration.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>

#include "core/hdf5/h5.hpp"
#include "support/near.hpp"
#include "support/solved_scene.hpp"

using namespace langer;

namespace {

// A block that is pressed in its middle: it has two mirror planes.
std::string pressed(const std::string& more) {
  return "mesh:\n"
         "  geometry: {block: {origin: [-3, 0, -2], size: [6, 2, 4], divisions: [6, 2, 4]}}\n"
         "material: {matrix: {neo_hooke: {a1: 0.01}}, volume: {quadratic: {d: 1.0e-2}}}\n"
         "supports: [{on: bottom, hold: [x, y, z]}]\n"
         "contacts: {ball: {on: top, rigid: {sphere: {radius: 3, centre: [0, 5, 0]}}, "
         "motion: [{t: 1, to: [0, -0.4, 0]}]}}\n"
         "path: {first: 0.5, largest: 0.5}\n"
         "solver: {newton: {relative: 1.0e-11}}\n"
         "dynamics: {density_kg_m3: 1100}\n" +
         more;
}

VibrationRecord vibration(const std::string& text) {
  const SolveConfig config = test::config_of(text);
  Run run(test::mesh_in(config), config, config.material, test::nowhere);
  REQUIRE(run.follow().path.complete);
  return *vibration_of(config, run, test::nowhere);
}

std::string refused(const std::string& text) {
  try {
    const SolveConfig config = test::config_of(text);
    const Run run(test::mesh_in(config), config, config.material, test::nowhere);
    check_vibration(config, run, test::nowhere);  // what it misses is found behind the path
    vibration(text);
  } catch (const Failure& failure) {
    CHECK(failure.code() == Exit::config);
    return failure.what();
  }
  return "accepted";
}

std::string test_folder() {
  const std::string folder = std::string(BINARY_DIR) + "/test_files/vibration";
  std::filesystem::create_directories(folder);
  return folder;
}

// of two shapes, whatever their sign
double shape_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  std::vector<Vec3> turned = b;
  for (Vec3& u : turned) u = -u;
  return std::min(test::largest_difference(a, b), test::largest_difference(a, turned));
}

}  // namespace

TEST_CASE("a body reduced by symmetry has the modes and the stiffness of the whole one") {
  const std::string asked =
      "modes: {count: 8}\n"
      "harmonic: {frequencies: [10, 300]}\n";
  const VibrationRecord whole = vibration(pressed(asked + "symmetry: none\n"));
  for (const char* symmetry : {"quarter", "mirror_x", "half_turn"}) {
    CAPTURE(symmetry);
    const VibrationRecord reduced =
        vibration(pressed(asked + "symmetry: " + std::string(symmetry) + "\n"));
    CHECK(reduced.modes->counted);
    int breaking = 0;
    for (std::size_t i = 0; i < 8; ++i) {
      CHECK(reduced.modes->frequency[i] == near(whole.modes->frequency[i], 1e-8));
      CHECK(shape_difference(reduced.modes->shape[i], whole.modes->shape[i]) < 1e-5);
      breaking += reduced.modes->breaks_symmetry[i];
    }
    CHECK(breaking > 2);
    for (std::size_t i = 0; i < 2; ++i)
      CHECK(reduced.harmonic->storage[i] == near(whole.harmonic->storage[i], 1e-8));
  }
}

TEST_CASE("an indenter under force control follows the body and makes its modes softer") {
  const std::string asked = pressed("modes: {count: 1}\nsymmetry: none\n");
  const std::string motion = "motion: [{t: 1, to: [0, -0.4, 0]}]";
  std::string pushed = asked;
  pushed.replace(pushed.find(motion), motion.size(), "control: {force: 0.02}");
  const SolveConfig config = test::config_of(pushed);
  Run run(test::mesh_in(config), config, config.material, test::nowhere);
  REQUIRE(run.follow().path.complete);
  const VibrationRecord free = *vibration_of(config, run, test::nowhere);
  // the same state under an indenter that stands still
  std::string moved = asked;
  moved.replace(
      moved.find(motion), motion.size(),
      fmt::format("motion: [{{t: 1, to: [0, {}, 0]}}]", -run.increment.accepted().travel));
  const VibrationRecord held = vibration(moved);
  CHECK(free.modes->frequency[0] > 0);
  CHECK(free.modes->frequency[0] <= held.modes->frequency[0] * (1 + 1e-9));
  // movements of the indenter along its direction have their share in a higher mode at the latest
  const SolveConfig of_force = test::config_of(pushed + "harmonic: {frequencies: [0.01]}\n");
  Run again(test::mesh_in(of_force), of_force, of_force.material, test::nowhere);
  REQUIRE(again.follow().path.complete);
  const VibrationRecord driven = *vibration_of(of_force, again, test::nowhere);
  const VibrationRecord same = vibration(moved + "harmonic: {frequencies: [0.01]}\n");
  CHECK(driven.harmonic->storage[0] == near(same.harmonic->storage[0], 1e-6));
}

TEST_CASE("what cannot oscillate as asked is refused by name") {
  const std::string sideways = "harmonic: {frequencies: [10], along: [1, 0, 0]}\n";
  CHECK(refused(pressed(sideways)).find("harmonic.indenter") != std::string::npos);
  CHECK(refused(pressed(sideways + "symmetry: none\n")) == "accepted");
  const std::string face = "harmonic: {frequencies: [10], face: ";
  CHECK(refused(pressed(face + "bak, along: [0, 1, 0]}\n")).find("harmonic.face") !=
        std::string::npos);
  CHECK(refused(pressed(face + "x_max, along: [0, 1, 0]}\n")).find("mirror image") !=
        std::string::npos);
  CHECK(refused(pressed(face + "top, along: [0, 1, 0]}\n")).find("touches an indenter") !=
        std::string::npos);
  std::string other = pressed("modes: {count: 1}\n");
  const std::string density = "density_kg_m3: 1100";
  other.replace(other.find(density), density.size(),
                "density_kg_m3: 1100, densities_kg_m3: {dermys: 900}");
  CHECK(refused(other).find("dynamics.densities_kg_m3.dermys") != std::string::npos);
}

TEST_CASE("a body at rest has modes without loads or contacts") {
  const VibrationRecord found = vibration(
      "mesh: {geometry: {block: {size: [1, 4, 1], divisions: [1, 8, 1]}}}\n"
      "material: {matrix: {neo_hooke: {a1: 0.01}}, volume: {quadratic: {d: 1.0e-2}}}\n"
      "supports: [{on: bottom, hold: [x, y, z]}]\n"
      "dynamics: {density_kg_m3: 1100}\n"
      "modes: {count: 3}\n");
  REQUIRE(found.modes->frequency.size() == 3);
  CHECK(found.modes->counted);
  // a square column bends along x and z alike
  CHECK(found.modes->frequency[0] == near(found.modes->frequency[1], 1e-9));
}

TEST_CASE("vibrations are read from a file as they were written") {
  const std::string path = test_folder() + "/record.h5";
  VibrationRecord record;
  record.modes = ModesRecord{{1.5, 2}, {0, 0}, {0, 1}, {{Vec3(1, 2, 3)}, {Vec3(4, 5, 6)}}};
  record.harmonic = HarmonicRecord{"ball", {1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  h5::File file = h5::File::create(path);
  write_vibration(file.root(), record);
  file.commit();
  const h5::File opened = h5::File::open(path);
  const VibrationRecord read = read_vibration(opened.root(), 1);
  CHECK(read.modes->frequency == record.modes->frequency);
  CHECK(read.modes->breaks_symmetry == record.modes->breaks_symmetry);
  CHECK(read.modes->shape == record.modes->shape);
  CHECK(read.harmonic->driver == "ball");
  CHECK(read.harmonic->loss == record.harmonic->loss);
  CHECK_THROWS_AS(read_vibration(opened.root(), 2), Failure);
}
