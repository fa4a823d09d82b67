// Error bars along the path, and what a body leaves out that stands for a larger one.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "accuracy/estimate/error_estimate.hpp"
#include "accuracy/estimate/refinements.hpp"
#include "accuracy/estimate/truncation.hpp"
#include "core/config/tree.hpp"
#include "scene/model/solve_config_io.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

const auto nowhere = [](const std::string&) {
  return Place{};
};

SolveConfig disc(double edge, double friction, double increment = 0.125) {
  const std::string folder = std::string(SOURCE_DIR) + "/configs/solve";
  SolveConfig config = read_config<SolveConfig>(load_yaml(folder + "/axisymmetric.yaml")).config;
  std::get<IndentedDisc>(config.mesh->geometry).edge = edge;
  config.contacts.at("sphere").friction = friction;
  config.path.use_increment(increment);
  config.estimate = EstimateBy::refinement;
  return config;
}

PathErrors estimate_of(const SolveConfig& config) {
  return estimate_along(config, config.material, nowhere,
                        solved_path(config, config.material, nowhere), 1e-9);
}

}  // namespace

TEST_CASE(
    "a force between two steps lies on the line between theirs, before the first on that from rest") {
  const std::vector<StepForces> path{{0.25, {{"force", 1}}}, {1, {{"force", 4}}}};
  CHECK(force_at(path, "force", 0) == 0);
  CHECK(force_at(path, "force", 0.125) == 0.5);
  CHECK(force_at(path, "force", 0.25) == 1);
  CHECK(force_at(path, "force", 0.5) == 2);
  CHECK(force_at(path, "force", 1) == 4);
  CHECK(force_at(path, "reaction_top", 1) == 0);
}

TEST_CASE("nodes that touch are counted, of the whole body, and those of a section once") {
  const SolveConfig config = disc(0.1, 0);
  const auto counted = [](const SolveConfig& scene) {
    const std::vector<StepForces> path = solved_path(scene, scene.material, nowhere).path;
    return std::pair{touching_at(path, "force", 0.25), touching_at(path, "force", 1)};
  };
  const auto [early, late] = counted(config);
  CHECK(early > 3);
  CHECK(late > early);
  CHECK(late < 2.2 / 0.1);  // from the axis to the edge of the contact, two for each of the hex27
  SolveConfig block =
      read_config<SolveConfig>(
          parse_yaml(
              "mesh: {geometry: {block: {origin: [-4, 0, -4], size: [8, 3, 8], divisions: [16, 4, 16]}}}\n"
              "material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 0.01}}}\nsupports: [{on: bottom, hold: [x, y, z]}]\n"
              "contacts: {ball: {rigid: {sphere: {radius: 3, centre: [0, 6, 0]}}, motion: [{t: 1, to: [0, -0.5, 0]}]}}\npath: {steps: 2}\n",
              "scene.yaml"))
          .config;
  block.symmetry = SymmetryChoice::none;
  const auto whole = counted(block);
  block.symmetry = SymmetryChoice::quarter;
  CHECK(counted(block) == whole);
  CHECK(whole.second >= 9);
  block.contacts.at("ball").rigid = Plane{{0, 3, 0}, {0, -1, 0}};
  CHECK(counted(block).second == 17 * 17);
}

TEST_CASE(
    "every step has an error bar, the last one that of the end, and bars hold the forces of much finer cells") {
  for (double friction : {0.0, 0.4}) {
    CAPTURE(friction);
    const SolveConfig config = disc(0.25, friction);
    const std::vector<StepForces> path = solved_path(config, config.material, nowhere).path;
    const PathErrors estimate = estimate_of(config);
    const std::vector<double>& bars = estimate.along.at("force");
    REQUIRE(bars.size() == path.size());
    REQUIRE(path.size() == 8);
    CHECK(bars.back() == near(estimate.at_end[0].total(), 1e-12));
    const SolveConfig finer = disc(0.05, friction, friction > 0 ? 0.03125 : 0.125);
    const std::vector<StepForces> right = solved_path(finer, finer.material, nowhere).path;
    int held = 0;
    for (std::size_t i = 0; i < path.size(); ++i) {
      const double error = path[i].of.at("force") - force_at(right, "force", path[i].t);
      held += std::abs(error) <= bars[i];
      CHECK(bars[i] < 0.5 * path[i].of.at("force"));  // a bar that says nothing holds everything
    }
    CHECK(held >= 7);
  }
}

TEST_CASE(
    "the limit of wider bodies: what falls by one ratio is summed up, what does not is told whole") {
  for (double r : {0.1, 0.3, 0.6, 0.75})  // f = 10 + 0.5 r^n
    CHECK(beyond(10.5, 10 + 0.5 * r, 10 + 0.5 * r * r) == near(0.5, 1e-10));
  for (double power : {1.0, 2.0, 3.0}) {  // f = 10 - 1 / width^power, width 2, 3, 4.5
    const auto f = [&](double width) {
      return 10 - std::pow(width, -power);
    };
    CHECK(beyond(f(2), f(3), f(4.5)) == near(-std::pow(2, -power), 1e-10));
  }
  CHECK(beyond(10, 10, 10) == 0);
  CHECK(beyond(10, 10.1, 10.05) == near(-0.15));  // to and fro
  CHECK(beyond(10, 10.1, 10.25) == near(-0.25));  // grows
}

TEST_CASE("what the sides of a narrow disc change is told, and of a wide one that it is nothing") {
  const auto force = [](SolveConfig config, double radius) {
    std::get<IndentedDisc>(config.mesh->geometry).size[0] = radius;
    return solved_path(config, config.material, nowhere).found[0].value;
  };
  SolveConfig config = disc(0.25, 0);
  config.truncation = {Truncation::sides};
  const double wide =
      force(config, 60);  // few nodes in contact: other widths, other cells, 0.7 % of the force
  for (double radius : {4.0, 6.0, 20.0}) {
    CAPTURE(radius);
    std::get<IndentedDisc>(config.mesh->geometry).size[0] = radius;
    const ErrorEstimate e = estimate_of(config).at_end[0];
    REQUIRE(e.left_out.size() == 1);
    CHECK(e.left_out[0].name == "sides");
    const double right = force(config, radius) - wide;
    CHECK(std::abs(e.left_out[0].value - right) < 0.3 * std::abs(right) + 0.007 * wide);
    const auto summary = summary_of({e});
    CHECK(std::any_of(summary.begin(), summary.end(),
                      [](const Summary& s) { return s.name == "force_error_sides"; }));
  }
}

TEST_CASE("what is left out is that of the force which is judged, also before the end") {
  SolveConfig config = disc(0.25, 0);
  config.truncation = {Truncation::sides};
  std::get<IndentedDisc>(config.mesh->geometry).size[0] = 6;
  auto& motion = config.contacts.begin()->second.motion;
  const double depth = motion.back().to[1];
  const auto left_out = [&](std::vector<WaypointConfig> path) {
    motion = std::move(path);
    const ErrorEstimate e = estimate_of(config).at_end[0];
    REQUIRE(e.left_out.size() == 1);
    return e.in_percent(e.left_out[0].value);
  };
  const double pressed = left_out({{1, {0, depth, 0}}});
  CHECK(std::abs(pressed) > 1);
  CHECK(left_out({{0.5, {0, depth, 0}}, {1, {0, 0.2 * depth, 0}}}) == near(pressed, 1e-3));
  CHECK(left_out({{0.5, {0, depth, 0}}, {1, {0, 0, 0}}}) == near(pressed, 1e-3));
}

TEST_CASE("of an indenter with a given force it is the travel that is changed") {
  SolveConfig config = disc(0.25, 0);
  config.truncation = {Truncation::sides};
  std::get<IndentedDisc>(config.mesh->geometry).size[0] = 6;
  ContactConfig& contact = config.contacts.begin()->second;
  const double force = solved_path(config, config.material, nowhere).found[0].value;
  contact.motion.clear();
  contact.control.emplace();
  contact.control->force = HistoryConfig{force};
  std::map<std::string, double> percent;
  const PathErrors errors = estimate_of(config);
  CHECK(!errors.along.contains("force"));  // a force that is given has no error
  for (const ErrorEstimate& e : errors.at_end) CHECK(e.of.name != "force");
  for (const ErrorEstimate& e : errors.at_end)
    for (const ErrorEstimate::Part& part : e.left_out)
      percent[e.of.name] = e.in_percent(part.value);
  REQUIRE(percent.size() == 1);
  CHECK(percent.begin()->first.starts_with("travel_"));
  CHECK(std::abs(percent.begin()->second) > 0.5);
}

TEST_CASE("wider and thicker bodies keep the surface and the place below the indenter") {
  SolveConfig block;
  block.mesh.emplace();
  block.mesh->geometry = IndentedBlock{{-10, 1, -6}, {20, 4, 12}, 2, 0.5};
  const auto wide = wider(block, Truncation::sides), thick = wider(block, Truncation::bottom);
  const auto& w = std::get<IndentedBlock>(wide[1].mesh->geometry);
  CHECK(w.size[0] == near(45));
  CHECK(w.size[1] == 4);
  CHECK(w.size[2] == near(27));
  CHECK(w.origin[0] == near(-22.5));
  CHECK(w.origin[2] == near(-13.5));
  const auto& t = std::get<IndentedBlock>(thick[0].mesh->geometry);
  CHECK(t.size[1] == near(6));
  CHECK(t.origin[1] + t.size[1] == near(5));
  CHECK(t.size[0] == 20);
}

TEST_CASE(
    "an estimate by itself takes longer cells than one that is asked for, and judges the same mesh") {
  SolveConfig config = disc(0.04, 0);
  config.mesh->cells = CellType::hex8;
  const Refinements asked = refinements(config, nowhere);
  config.estimate = EstimateBy::automatic;
  const Refinements by_itself = refinements(config, nowhere);
  CHECK(asked.own);
  CHECK(by_itself.own);
  REQUIRE(by_itself.length.size() == 3);
  CHECK(asked.length[2] == near(1.5, 0.05));
  CHECK(by_itself.length[2] == near(1.75, 0.05));
  const ErrorEstimate two = estimate_of(config).at_end[0];
  config.estimate = EstimateBy::refinement;
  const ErrorEstimate one = estimate_of(config).at_end[0];
  CHECK(std::abs(two.limit() - one.limit()) < one.total() + two.total());
}

TEST_CASE(
    "under a plate with a hole the height of the dome has an error bar, the displacement of what slips over the edge none") {
  const std::string text =
      "mesh:\n  geometry: {section: {of: axisymmetric, size: [6, 2], divisions: [24, 8]}}\n"
      "  points: {apex: [0, 2, 0], rim: [2, 2, 0], below: [2, 1, 0]}\n"
      "  sets: {hole: {of: top, within: {cylinder: {axis: y, radius: 2}}}}\n"
      "material: {matrix: {neo_hooke: {a1: 0.012}}, volume: {quadratic: {d: 1.0e-2}}}\nsupports: [{on: bottom, hold: [x, y]}]\n"
      "contacts: {plate: {on: top, rigid: {aperture: {radius: 2, edge: 0.5, face: [0, 2, 0]}}, friction: 0, "
      "motion: [{t: 0.2, to: [0, -0.05, 0]}, {t: 1, to: [0, -0.05, 0]}]}}\n"
      "loads: [{on: hole, pressure: [{t: 0.2, to: 0}, {t: 1, to: -0.005}]}]\npath: {first: 0.2, largest: 0.4}\nestimate: refinement\n";
  const PathErrors errors =
      estimate_of(read_config<SolveConfig>(parse_yaml(text, "plate.yaml")).config);
  const auto has = [&](const std::string& name) {
    return std::any_of(errors.at_end.begin(), errors.at_end.end(),
                       [&](const ErrorEstimate& e) { return e.of.name == name; });
  };
  CHECK(has("force"));
  CHECK(has("displacement_apex"));
  CHECK(has("displacement_below"));
  CHECK(!has("displacement_rim"));
  REQUIRE(errors.not_known.size() == 1);
  CHECK(errors.not_known[0].find("displacement_rim") != std::string::npos);
}
