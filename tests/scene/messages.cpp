// Messages name the cause, and their advice works: each mistake is made, the advice is followed,
// and the scene is accepted.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "support/solved_scene.hpp"

using namespace langer;

namespace messages_tests {

namespace {

// what the reader says of a config: its errors, or its notices
std::string said_of(const std::string& text) {
  try {
    std::string all;
    for (const std::string& notice :
         read_config<SolveConfig>(parse_yaml(text, "scene.yaml")).notices)
      all += notice + "\n";
    return all;
  } catch (const Failure& failure) {
    return failure.what();
  }
}

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

const std::string body =
    "mesh: {geometry: {block: {origin: [-6, 0, -6], size: [12, 4, 12], divisions: [4, 2, 4]}}}\n"
    "supports: [{on: bottom, hold: [x, y, z]}]\n";
const std::string isotropic =
    "material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 1.0e-2}}}\n";

std::string sphere(const std::string& radius, const std::string& to) {
  return "contacts: {ball: {rigid: {sphere: {radius: " + radius +
         ", centre: [0, 6.5, 0]}}, motion: [{t: 1, to: " + to + "}]}}\n";
}

std::string fibre_at(double alpha) {
  return fmt::format(
      "material: {{matrix: {{neo_hooke: {{a1: 0.1}}}}, fibres: [{{hgo: {{c1: 0.1, c2: 1}}, alpha: "
      "{}}}], volume: {{quadratic: {{d: 1.0e-2}}}}}}\n",
      alpha);
}

}  // namespace

TEST_CASE("a decimal comma is named, in braces and on a line of its own") {
  const std::string rest = body + isotropic;
  const std::string in_braces = said_of(rest + sphere("2,5", "[0, -1, 0]"));
  CHECK(holds(in_braces, "decimal comma"));
  CHECK(holds(in_braces, "2.5"));
  const std::string on_a_line = said_of(
      rest +
      "contacts:\n  ball:\n    rigid:\n      sphere:\n        radius: 2,5\n        centre: [0, "
      "6.5, 0]\n    motion: [{t: 1, to: [0, -1, 0]}]\n");
  CHECK(holds(on_a_line, "decimal comma"));
  CHECK(said_of(rest + sphere("2.5", "[0, -1, 0]")).empty());
}

TEST_CASE("an angle that looks like radians is a warning, with its value in degrees") {
  const std::string load = sphere("2.5", "[0, -1, 0]");
  for (const auto& [radians, degrees] : {std::pair{1.5708, "90"},
                                         {0.7854, "45"},
                                         {1.0472, "60"},
                                         {-0.5236, "-30"},
                                         {3.14159, "180"}}) {
    const auto shown = radians;
    CAPTURE(shown);
    const std::string said = said_of(body + fibre_at(radians) + load);
    CHECK(holds(said, "read as degrees"));
    CHECK(holds(said, degrees));
  }
  for (double degrees : {0.0, 1.0, 1.5, 2.0, 3.0, 5.0, 30.0, 41.99, 45.0, 60.0, 90.0, 123.4}) {
    CAPTURE(degrees);
    CHECK(said_of(body + fibre_at(degrees) + load).empty());
  }
}

TEST_CASE("an indenter sent through the body into what supports hold is refused before the path") {
  const SolveConfig config = test::config_of(body + isotropic + sphere("2.5", "[0, -1, 0]"));
  const Mesh mesh = test::mesh_in(config);
  for (const char* to : {"[0, -12, 0]", "[0, -5, 0]", "[6, -5, 0]"}) {
    CAPTURE(to);
    const std::string said = test::said_of_scene(body + isotropic + sphere("2.5", to), mesh);
    CHECK(holds(said, "contacts.ball.motion[0].to"));
    CHECK(holds(said, "inside nodes that supports hold"));
  }
  // a shorter way, and ways past the body
  for (const char* to : {"[0, -3.5, 0]", "[0, -1, 0]", "[3, -1, 0]", "[0, 5, 0]"}) {
    CAPTURE(to);
    const std::string scene =
        body + isotropic +
        "contacts: {ball: {on: top, rigid: {sphere: {radius: 2.5, centre: [0, "
        "6.5, 0]}}, motion: [{t: 1, to: " +
        to + "}]}}\n";
    CHECK(test::said_of_scene(scene, mesh) == "accepted");
  }
}

TEST_CASE("a folded cell of a file is the file's: no advice about numbers of the config") {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / fmt::format("langer_folded_{}", getpid());
  fs::create_directories(folder);
  const auto mesh_of_file = [&](double height) -> std::string {
    const fs::path path = folder / "one.inp";
    std::ofstream(path)
        << "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n5, 0, 0, 1\n6, 1, 0, "
           "1\n7, 1, 1, "
        << height << "\n8, 0, 1, 1\n*ELEMENT, TYPE=C3D8\n1, 1, 2, 3, 4, 5, 6, 7, 8\n";
    const std::string text = "geometry: {file: {path: " + path.string() + "}}\n";
    try {
      make_mesh(read_config<MeshConfig>(parse_yaml(text, "mesh.yaml")).config, test::nowhere);
    } catch (const Failure& failure) {
      return failure.what();
    }
    return "accepted";
  };
  const std::string folded = mesh_of_file(-0.8);
  CHECK(holds(folded, "folded"));
  CHECK(holds(folded, "the program that meshed it"));
  CHECK_FALSE(holds(folded, "radii"));
  CHECK_FALSE(holds(folded, "divisions"));
  CHECK(mesh_of_file(1) == "accepted");
  fs::remove_all(folder);
}

}  // namespace messages_tests
