// Scenes as candidates of the advice: what is foretold of a test is what a fit with it achieves.
#include "identification/inverse/scene_candidates.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/base/random.hpp"
#include "identification/inverse/inverse_fit.hpp"
#include "identification/setup/fit_config_io.hpp"
#include "identification/setup/fit_report.hpp"
#include "identification/statistics/study.hpp"
#include "scene/model/solve_config_io.hpp"

using namespace langer;
namespace fs = std::filesystem;

namespace {

struct Folder {
  ~Folder() { fs::remove_all(path); }
  const std::string path =
      (fs::temp_directory_path() / ("langer_candidates_" + std::to_string(getpid()))).string();
} const own;

void write(const std::string& name, const std::string& text) {
  fs::create_directories(own.path);
  std::ofstream(own.path + "/" + name) << text;
}

// forty cells under a sphere, on a section
constexpr const char* solve_yaml =
    "mesh: {geometry: {section: {of: axisymmetric, size: [6, 3], divisions: [10, 4], centre: {edge: 0.3, within: 1.5}}}, points: {beside: [3, 3, 0]}}\n"
    "supports: [{on: bottom, hold: [x, y]}]\n"
    "contacts:\n  sphere:\n    on: top\n    rigid: {sphere: {radius: 2.5, centre: [0, 5.5, 0]}}\n    motion: [{t: 1, to: [0, -1, 0]}]\n"
    "material: {matrix: {yeoh: {a1: 0.012, a2: 0.03, a3: 0.01}}, volume: {quadratic: {d: 1.0e-2}}}\n"
    "stability: off\npath: {steps: 10}\n";
constexpr const char* two_numbers =
    "parameters: [{key: matrix.yeoh.a1, lower: 0.001, upper: 1}, {key: matrix.yeoh.a2, lower: 0, upper: 1}]\n";
constexpr const char* law =
    "law: {matrix: {yeoh: {a1: 0.02, a2: 0.02, a3: 0.01}}, volume: {quadratic: {d: 1.0e-2}}}\n";

// Yeoh's law in tension to 1.2, 2 % noise of the largest stress
void write_tension() {
  std::string text = "stretch,nominal_stress_MPa\n";
  const auto nominal = [](double l) {
    const double x = l * l + 2 / l - 3;
    return 2 * (0.012 + 0.06 * x + 0.03 * x * x) * (l - 1 / (l * l));
  };
  for (int i = 1; i <= 20; ++i) {
    Random random(11, static_cast<std::uint64_t>(i));
    text += fmt::format("{},{}\n", 1 + 0.01 * i,
                        nominal(1 + 0.01 * i) + 0.02 * nominal(1.2) * random.normal());
  }
  write("tension.csv", text);
}

void write_force(double deviation) {
  auto loaded = read_config<SolveConfig>(load_yaml(own.path + "/solve.yaml"));
  ForwardRun run(loaded.config, loaded.where, 0);
  run.observe({Observation{}}, {});
  const ForwardPath path = run.solve({*loaded.config.material});
  std::string text = "travel_mm,force_N\n";
  for (std::size_t i = 0; i < path.t.size(); ++i) {
    Random random(5, i);
    text += fmt::format("{},{}\n", path.t[i],
                        path.values(static_cast<Eigen::Index>(i), 0) + deviation * random.normal());
  }
  write("force.csv", text);
}

struct Fitted {
  FitResult fit;
  StudyRecord study;
};

Fitted fitted(const std::string& yaml) {
  const auto loaded = read_config<FitConfig>(parse_yaml(yaml, "fit.yaml", own.path));
  FitProblem problem = fit_problem(loaded.config);
  std::optional<InverseFit> scenes;
  if (loaded.config.has_scenes())
    scenes.emplace(Voice{"fit", true, false}, loaded.config, loaded.where, problem,
                   std::vector<std::string>{}, "");
  Fitted found{scenes ? scenes->search() : fit(problem, {.starts = 3}), {}};
  const SceneCandidates next = scene_candidates(loaded.config, problem, found.fit, loaded.where);
  CHECK(next.without.empty());
  found.study = study(problem, found.fit, *loaded.config.study, {}, next.candidates);
  return found;
}

const AdviceRecord& named(const StudyRecord& study, const char* part) {
  for (const AdviceRecord& one : study.identifiability->advice)
    if (one.test.find(part) != std::string::npos) return one;
  FAIL("no advice on ", part);
  return study.identifiability->advice.front();
}

}  // namespace

TEST_CASE(
    "what the advice foretells of an indentation is what a fit with it achieves, within a factor of 1.5") {
  write("solve.yaml", solve_yaml);
  write_tension();
  write_force(1e-3);
  const std::string study =
      "study: {profiles: false, bootstrap: 0, stability: false, candidates: [";
  const Fitted alone = fitted(
      std::string("data: [{file: tension.csv}]\n") + law + two_numbers + study +
      "{kind: uniaxial, fibre_angle: 0}, {kind: scene, name: sphere, solve: solve.yaml, points: 10, standard_deviation: 1.0e-3,"
      " vary: [{key: \"contacts.sphere.motion[0].to[1]\", values: [-0.5, -1]}]}]}\n");
  const AdviceRecord &deep = named(alone.study, "to[1] -1"),
                     &shallow = named(alone.study, "to[1] -0.5");
  CHECK(alone.study.identifiability->advice.size() == 3);
  CHECK(deep.worst < shallow.worst);
  CHECK(alone.study.identifiability->advice.front().test == deep.test);
  // with it: the tension weighs what its residuals show
  const double noise = alone.fit.noise.total();
  const Fitted both = fitted(
      fmt::format(
          "data: [{{file: tension.csv, standard_deviation: {}}}, {{kind: scene, solve: solve.yaml, file: force.csv, "
          "columns: {{u_ind: travel_mm, force: force_N}}, standard_deviation: 1.0e-3}}]\n",
          noise) +
      law + two_numbers + study + "]}\ndraft: false\n");
  for (Eigen::Index i = 0; i < 2; ++i) {
    const double achieved = std::sqrt(both.fit.covariance(i, i)) / both.fit.best.p[i];
    const double before = std::sqrt(alone.fit.covariance(i, i)) / alone.fit.best.p[i];
    CAPTURE(i);
    CAPTURE(before);
    CAPTURE(achieved);
    CAPTURE(deep.relative[static_cast<std::size_t>(i)]);
    CHECK(achieved < 0.7 * before);  // the indentation tells more
    CHECK(deep.relative[static_cast<std::size_t>(i)] < 1.5 * achieved);
    CHECK(deep.relative[static_cast<std::size_t>(i)] > achieved / 1.5);
  }
}

TEST_CASE(
    "tests that are made together tell at least what each tells, and observed places add to a force") {
  write("solve.yaml", solve_yaml);
  write_tension();
  const std::string begin =
      std::string("data: [{file: tension.csv}]\n") + law + two_numbers +
      "study: {profiles: false, bootstrap: 0, stability: false, candidates: [";
  const std::string scene = "{kind: scene, solve: solve.yaml, points: 10, ";
  const Fitted found = fitted(
      begin + scene +
      "name: one, vary: [{key: \"contacts.sphere.motion[0].to[1]\", values: [-0.6, -1]}]}, " +
      scene +
      "name: two, together: true, vary: [{key: \"contacts.sphere.motion[0].to[1]\", values: [-0.6, -1]}]}, " +
      scene +
      "name: places, measured: [u_x, u_y], places: [[2, 0], [3, 0], [4, 0]], standard_deviation: 0.01}, " +
      scene + "name: point, measured: [u_y], on: beside, standard_deviation: 0.01}]}\n");
  const double
      small = named(found.study, "one, contacts.sphere.motion[0].to[1] -0.6").worst,
      large = named(found.study, "one, contacts.sphere.motion[0].to[1] -1").worst,
      both =
          named(found.study,
                "two, contacts.sphere.motion[0].to[1] -0.6 and contacts.sphere.motion[0].to[1] -1")
              .worst;
  CHECK(both < std::min(small, large));
  CHECK(named(found.study, "places").worst < named(found.study, "point").worst);
  CHECK(named(found.study, "point").gain > 0);
}

TEST_CASE("candidates that do not fit their scene are named at their key") {
  write("solve.yaml", solve_yaml);
  write_tension();
  const auto refusal = [](const std::string& candidate) {
    try {
      fitted(std::string("data: [{file: tension.csv}]\n") + law + two_numbers +
             "study: {profiles: false, bootstrap: 0, stability: false, candidates: [" + candidate +
             "]}\n");
    } catch (const Failure& failure) {
      return std::string(failure.what());
    }
    return std::string("accepted");
  };
  const auto holds = [](const std::string& said, const std::string& part) {
    CAPTURE(said);
    CHECK(said.find(part) != std::string::npos);
  };
  holds(refusal("{kind: scene, solve: solve.yaml, measured: [reaction_x], on: nowhere}"),
        "the scene has no set \"nowhere\"");
  holds(refusal("{kind: scene, solve: solve.yaml, measured: [u_y], places: [[9, 0]]}"),
        "no top of the scene at (9, 0)");
  holds(
      refusal(
          "{kind: scene, solve: solve.yaml, vary: [{key: contacts.sphere.rigid.sphere.radios, values: [1]}]}"),
      "radios");
  holds(
      refusal(
          "{kind: scene, solve: solve.yaml, vary: [{key: contacts.sphere.rigid.sphere.radius, values: [-1]}]}"),
      "radius");
}
