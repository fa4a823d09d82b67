#include "serve/yaml_edit.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <vector>

#include "core/config/raw_yaml.hpp"
#include "serve/folder.hpp"
#include "serve/run_watcher.hpp"
#include "support/refusal.hpp"

namespace langer {
namespace {

namespace fs = std::filesystem;

const char* const scene = R"(# a scene
supports:                 # what is held
  - {on: bottom, hold: [x, y, z]}  # glued
contacts:
  sphere:                 # its name
    rigid: {sphere: {radius: 2.5, centre: [0, 6.5, 0]}}   # mm
    friction: 0.3         # Coulomb

    motion:
      - {t: 0.5, to: [0, -0.5, 0]}   # down
      - t: 1
        to: [0, 0, 0]     # up
accuracy: "3%"            # of the force
path:
  # comment between
  steps: 10
)";

std::string edited(const std::string& path, const std::optional<std::string>& value) {
  return edit_yaml(scene, "scene.yaml", path, value);
}
// The text with one part replaced.
std::string with(const std::string& from, const std::string& to) {
  std::string text = scene;
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}
std::string refused(const std::string& text, const std::string& path,
                    const std::optional<std::string>& value) {
  try {
    edit_yaml(text, "x.yaml", path, value);
  } catch (const Failure& failure) {
    return failure.what();
  }
  return "";
}

TEST_CASE("an edit changes one value and keeps every other letter of the file") {
  CHECK(edited("contacts.sphere.friction", "0.2") == with("friction: 0.3 ", "friction: 0.2 "));
  CHECK(edited("contacts.sphere.rigid.sphere.radius", "3") == with("radius: 2.5", "radius: 3"));
  CHECK(edited("contacts.sphere.rigid.sphere.centre[1]", "7") == with("6.5", "7"));
  CHECK(edited("contacts.sphere.motion[0].to[1]", "-1e-3") == with("-0.5", "-1e-3"));
  CHECK(edited("contacts.sphere.motion[1].to", "[1, 2, 3]") ==
        with("to: [0, 0, 0] ", "to: [1, 2, 3] "));
  CHECK(edited("supports[0].hold", "[x]") == with("[x, y, z]", "[x]"));
  CHECK(edited("accuracy", "1%") == with("\"3%\"", "1%"));
  CHECK(edited("path.steps", "20") == with("steps: 10", "steps: 20"));
  CHECK(edited("contacts.sphere.rigid", "{plane: {point: [0, 4, 0]}}") ==
        with("{sphere: {radius: 2.5, centre: [0, 6.5, 0]}}", "{plane: {point: [0, 4, 0]}}"));
}

TEST_CASE("a part of several lines is replaced by one on the line of its key") {
  CHECK(edited("path", "{first: 0.1}") ==
        with("path:\n  # comment between\n  steps: 10\n", "path: {first: 0.1}\n"));
  const std::string moved = edited("contacts.sphere.motion", "[{t: 1, to: [0, 1, 0]}]");
  CHECK(example::holds(moved, "    motion: [{t: 1, to: [0, 1, 0]}]\naccuracy:"));
}

TEST_CASE("a key or an item that is new stands behind its siblings") {
  CHECK(edited("estimate", "dual") == std::string(scene) + "estimate: dual\n");
  CHECK(edited("supports[1]", "{on: top, hold: [y]}") ==
        with("# glued\n", "# glued\n  - {on: top, hold: [y]}\n"));
  CHECK(edited("contacts.sphere.rigid.sphere.axis", "1") == with("6.5, 0]}", "6.5, 0], axis: 1}"));
  CHECK(edited("contacts.sphere.on", "top") == with("# up\n", "# up\n    on: top\n"));
  CHECK(edited("contacts.plate", "{friction: 0}") ==
        with("# up\n", "# up\n  plate: {friction: 0}\n"));
  CHECK(edited("contacts.sphere.motion[1].s", "2") == with("# up\n", "# up\n        s: 2\n"));
  CHECK(edited("supports[0].hold[3]", "w") == with("y, z]", "y, z, w]"));
  CHECK(edit_yaml("a: {}\n", "x", "a.b", "1") == "a: {b: 1}\n");
  CHECK(edit_yaml("a: []\n", "x", "a[0]", "1") == "a: [1]\n");
  CHECK(edit_yaml("a:\nb: 2\n", "x", "a", "1") == "a: 1\nb: 2\n");
  CHECK(edit_yaml("a: 1", "x", "b", "2") == "a: 1\nb: 2");
}

// Found by the fuzz target `edit`.
TEST_CASE("an edit that is made twice changes nothing the second time, or is refused") {
  CHECK(edit_yaml("b: 2\n", "x", "a", "1   ") == edit_yaml("b: 2\n", "x", "a", "1"));
  CHECK_THROWS_AS(edit_yaml("a: []\n", "x", "a[1]", "1"), Failure);
  CHECK_THROWS_AS(edit_yaml("a: 1\n", "x", "a", " \r\r"), Failure);
  CHECK_THROWS_AS(edit_yaml("a: 1\n", "x", "a", "&anchor 1"), Failure);
  CHECK_THROWS_AS(edit_yaml("a: 1\n", "x", "a", "|"), Failure);
}

TEST_CASE("what is removed takes its line or its comma with it") {
  CHECK(edited("contacts.sphere.friction", {}) ==
        with("    friction: 0.3         # Coulomb\n", ""));
  CHECK(edited("supports[0].on", {}) == with("on: bottom, ", ""));
  CHECK(edited("contacts.sphere.motion[0].to", {}) == with(", to: [0, -0.5, 0]", ""));
  CHECK(edited("contacts.sphere.motion[0]", {}) ==
        with("      - {t: 0.5, to: [0, -0.5, 0]}   # down\n", ""));
  CHECK(edited("contacts.sphere.motion[1]", {}) ==
        with("      - t: 1\n        to: [0, 0, 0]     # up\n", ""));
  CHECK(edited("contacts.sphere.motion[1].t", {}) == with("t: 1\n        to", "to"));
  CHECK(edited("supports[0]", {}) ==
        with("supports:                 # what is held\n  - {on: bottom, hold: [x, y, z]}  # glued",
             "supports: []                 # what is held"));
}

TEST_CASE("letters of other languages and line ends of Windows keep their place") {
  CHECK(edit_yaml("a: \u00e4 # \u00fc\nb: {c: \u00e9\u00e9, d: 2, e: \u00f1}\n", "x", "b.d", "3") ==
        "a: \u00e4 # \u00fc\nb: {c: \u00e9\u00e9, d: 3, e: \u00f1}\n");
  CHECK(edit_yaml("a: 1\r\nb:\r\n  c: 2 # x\r\nd: 4\r\n", "x", "b.c", "3") ==
        "a: 1\r\nb:\r\n  c: 3 # x\r\nd: 4\r\n");
  CHECK(edit_yaml("a: 1\r\nb: 2\r\n", "x", "a", {}) == "b: 2\r\n");
}

TEST_CASE("what cannot be edited safely is refused, and nothing else is ever changed") {
  CHECK(example::holds(refused("a: &x 1\nb: *x\n", "b", "2"), "anchor"));
  CHECK(example::holds(refused("a: |\n  text\n", "a", "2"), "several lines"));
  CHECK(example::holds(refused("a: 1\n", "a", "2\nb: 3"), "several lines"));
  CHECK(example::holds(refused("a: 1\n", "a", "2, 3"), "a single value"));
  CHECK(refused("a: 1\n", "a", "2] #") != "");
  CHECK(refused("a: {b: 1}\n", "a.b", "2}, c: {d: 3") != "");
  CHECK(refused("a: 1\n", "a", "{x: ") != "");
  CHECK(refused("a: 1\n", "b.c", "2") != "");
  CHECK(refused("a: 1\n", "a.b", "2") != "");
  CHECK(refused("a: 1\n", "", "2") != "");
  CHECK(refused("a: 1\n", "a", {}) != "");
  CHECK(refused("\"a\": 1\n'b c': {d: 'it''s, #1'} # x\n", "a", "2") == "");
  CHECK(edit_yaml("a: {d: 'it''s, }#1', e: \"x\\\"}\"}\n", "x", "a.e", "3") ==
        "a: {d: 'it''s, }#1', e: 3}\n");
}

// Every scalar of every starter is set to another value, removed, and set to its own.
TEST_CASE("every value of the starters can be edited") {
  int n = 0;
  for (const auto& entry : fs::recursive_directory_iterator(SOURCE_DIR "/share/new")) {
    if (entry.path().extension() != ".yaml") continue;
    std::stringstream stream;
    stream << std::ifstream(entry.path()).rdbuf();
    const std::string text = stream.str();
    std::vector<std::pair<std::string, std::string>> scalars;
    const std::function<void(const Tree&, const std::string&)> walk = [&](const Tree& t,
                                                                          const std::string& path) {
      if (t.kind == Tree::Kind::scalar) scalars.emplace_back(path, t.scalar);
      for (std::size_t i = 0; i < t.list.size(); ++i)
        walk(t.list[i], path + "[" + std::to_string(i) + "]");
      for (const Tree::Entry& e : t.map) walk(e.value, path.empty() ? e.key : path + "." + e.key);
    };
    walk(parse_yaml_as_written(text, "x"), "");
    for (const auto& [path, value] : scalars) {
      CAPTURE(entry.path());
      const auto shown = path;
      CAPTURE(shown);
      const std::string changed = edit_yaml(text, "x", path, "0.123");
      CHECK(changed != text);
      CHECK(std::ranges::count(changed, '\n') == std::ranges::count(text, '\n'));
      CHECK(std::ranges::count(changed, '#') == std::ranges::count(text, '#'));
      ++n;
    }
  }
  CHECK(n > 200);
}

TEST_CASE("a served folder gives its plain files and nothing through links or dots") {
  const fs::path at = fs::temp_directory_path() / ("langer_served_" + std::to_string(::getpid()));
  fs::create_directories(at / "in/deep");
  std::ofstream(at / "secret") << "secret";
  std::ofstream(at / "in/deep/a.yaml") << "a: 1\n";
  fs::create_symlink(at / "secret", at / "in/link");
  fs::create_symlink(at, at / "in/up");
  fs::create_directories(at / "in/.hidden");
  std::ofstream(at / "in/.hidden/x") << "x";
  {
    const ServedFolder folder((at / "in").string());
    CHECK(folder.read("deep/a.yaml", 100) == "a: 1\n");
    const auto why = [&](const std::string& path) {
      return example::refusal([&] { folder.read(path, 100); });
    };
    CHECK(example::holds(why("../secret"), "leads out"));
    CHECK(example::holds(why("deep/../../secret"), "leads out"));
    CHECK(example::holds(why((at / "secret").string()), "absolute"));
    CHECK(example::holds(why("link"), "link"));
    CHECK(example::holds(why("up/secret"), "link"));
    CHECK(example::holds(why(".hidden/x"), "hidden"));
    CHECK(example::holds(why("deep"), "no plain file"));
    CHECK(example::holds(why("nothing"), "no such file"));
    CHECK(example::holds(why("deep\n/a.yaml"), "not allowed"));
    CHECK(example::holds(example::refusal([&] { folder.read("deep/a.yaml", 3); }), "larger"));
    CHECK(example::holds(example::refusal([&] { folder.replace("link", "x"); }), "link"));
    CHECK(example::holds(example::refusal([&] { folder.create("up/new", "x"); }), "link"));
    CHECK(example::holds(example::refusal([&] { folder.create("deep/a.yaml", "x"); }), "already"));
    folder.replace("deep/a.yaml", "a: 2\n");
    CHECK(folder.read("deep/a.yaml", 100) == "a: 2\n");
    CHECK(folder.folders("") == std::vector<std::string>{"deep"});
    CHECK(folder.files("").empty());
  }
  std::ifstream file(at / "secret");
  std::string kept;
  file >> kept;
  CHECK(kept == "secret");
  fs::remove_all(at);
}

TEST_CASE("the force of a step without indenters is that on the nodes that are moved") {
  StepRecord step;
  step.t = 0.5;
  step.u = {Vec3(0, 0.1, 0), Vec3(2, 0.2, 0), Vec3(2, 0, 0), Vec3(1, 1, 1)};
  step.reaction = {Vec3(-5, 0, 0), Vec3(3, 0, 0), Vec3(2, 0, 0), Vec3(1e-9, 0, 0)};
  const ProgressPoint point = progress_point(step);
  CHECK(point.force == 5);
  CHECK(point.travel == 2);
  CHECK(point.largest > 2);
  step.scalars = {{"angle_disc", 10}, {"torque_disc", -4}};
  CHECK(progress_point(step).angle == 10);
  CHECK(progress_point(step).torque == -4);
}

}  // namespace
}  // namespace langer
