// A run that is killed and continued is the run, whatever features meet in its scene: all
// combinations of a viscous material, adhesion, a pressure, a section, hex27 and a pushed indenter.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "support/solved_scene.hpp"

using namespace langer;

namespace {

struct Features {
  bool viscous, adhesion, pressure, section, hex27, pushed;
};

std::string words(const Features& f) {
  return fmt::format("viscous {}, adhesion {}, pressure {}, section {}, hex27 {}, pushed {}",
                     f.viscous, f.adhesion, f.pressure, f.section, f.hex27, f.pushed);
}

std::string scene_with(const Features& f) {
  const char* cells = f.hex27 ? "hex27" : "hex8";
  std::string geometry =
      f.hex27 ? "block: {origin: [-3, 0, -3], size: [6, 2, 6], divisions: [4, 2, 4]}"
              : "block: {origin: [-3, 0, -3], size: [6, 2, 6], divisions: [6, 3, 6]}";
  if (f.section) geometry = "section: {of: axisymmetric, size: [3, 2], divisions: [6, 4]}";
  std::string text = fmt::format("mesh: {{geometry: {{{}}}, cells: {}}}\n", geometry, cells);
  const char* branches = f.viscous ? ", viscous: [{tau: 0.5, gamma: 0.6}]" : "";
  text += fmt::format(
      "material: {{matrix: {{yeoh: {{a1: 0.012, a2: 0.03, a3: 0.01}}}}, volume: {{quadratic: {{d: "
      "1.0e-2}}}}{}}}\n",
      branches);
  text += "supports: [{on: bottom, hold: [x, y, z]}]\n";
  if (f.pressure) text += fmt::format("loads: [{{on: {}, pressure: 0.002}}]\n", "x_max");
  text += "contacts:\n  s:\n    on: top\n    rigid: {sphere: {radius: 2.5, centre: [0, 4.5, 0]}}\n";
  if (f.adhesion) text += "    adhesion: {work: 2.0e-3, stiffness: 0.5}\n";
  if (f.pushed)
    text += "    control: {force: [{s: 1, to: 0.02}, {s: 2, to: 0.01}]}\n";
  else
    text += "    motion: [{s: 1, to: [0, -0.3, 0]}, {s: 2, to: [0, -0.1, 0]}]\n";
  return text + "path: {seconds: 2, first: 0.25, largest: 0.25}\n";
}

std::vector<StepRecord> follow(Run& run) {
  std::vector<StepRecord> steps;
  RunListener listener;
  listener.of_whole = [&](StepRecord& step, const SolveReport&) {
    steps.push_back(step);
  };
  const RunEnd end = run.follow(listener);
  CAPTURE(end.path.why);
  CHECK(end.path.complete);
  return steps;
}

void check_same(const StepRecord& a, const StepRecord& b) {
  REQUIRE(a.t == b.t);
  REQUIRE(a.iterations == b.iterations);
  REQUIRE(a.u == b.u);
  REQUIRE(a.reaction == b.reaction);
  REQUIRE(a.scalars == b.scalars);
  REQUIRE(a.cell_fields == b.cell_fields);
  for (const auto& [name, contact] : a.contacts) {
    REQUIRE(contact.r == b.contacts.at(name).r);
    REQUIRE(contact.beta == b.contacts.at(name).beta);
  }
}

// As langer-solve continues a run: the steps that are kept in order, then the rest.
void check_continued(const Features& features) {
  CAPTURE(words(features));
  const SolveConfig config = test::config_of(scene_with(features));
  const auto run = [&] {
    return std::make_unique<Run>(test::mesh_in(config), config, config.material, test::nowhere);
  };
  const std::vector<StepRecord> whole = follow(*run());
  REQUIRE(whole.size() >= 8);
  for (const std::size_t kept : {std::size_t{1}, whole.size() / 2, whole.size() - 1}) {
    CAPTURE(kept);
    const auto continued = run();
    for (std::size_t i = 0; i < kept; ++i) continued->replay(whole[i]);
    std::optional<StepRecord> before;
    if (kept > 1) before = whole[kept - 2];
    continued->resume(whole[kept - 1], before);
    const std::vector<StepRecord> rest = follow(*continued);
    REQUIRE(rest.size() + kept == whole.size());
    for (std::size_t i = 0; i < rest.size(); ++i) check_same(whole[kept + i], rest[i]);
  }
}

}  // namespace

TEST_CASE("a continued run is the run, for all combinations of six features") {
  for (int bits = 0; bits < 64; ++bits) {
    const auto has = [bits](int k) {
      return (bits >> k & 1) != 0;
    };
    if (has(1) && has(5)) continue;  // refused: adhesion of a pushed indenter
    check_continued({has(0), has(1), has(2), has(3), has(4), has(5)});
  }
}
