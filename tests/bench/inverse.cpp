// What fits of scenes cost and whether their intervals can be believed.
//   inverse            runs of their scenes that the fits of pipelines/inverse_yeoh, inverse_indentation and invivo_extension take, with the
//                      derivatives of the runs and with difference quotients of whole runs
//   price              CPU seconds of a run with derivatives by none, one and more numbers, and its tangents
//   inverse_coverage   how often 95 % intervals hold the true values, over fresh noise
//   thickness_prior    the same where the thickness is measured with an error of 10 %: held at what was measured, and as a parameter with
//                      that prior
#include "identification/inverse/inverse_fit.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <random>

#include "core/base/stopwatch.hpp"
#include "identification/inverse/sensitivity.hpp"
#include "identification/setup/fit_config_io.hpp"
#include "identification/setup/fit_report.hpp"
#include "identification/setup/priors.hpp"
#include "identification/statistics/study.hpp"
#include "scene/model/solve_config_io.hpp"
#include "scene/run/body_mesh.hpp"

using namespace langer;

namespace {

const std::string folder =
    (std::filesystem::temp_directory_path() / "langer_bench_inverse").string();

constexpr const char* solve_yaml =
    "mesh: {geometry: {indented_disc: {size: [16, 4], radius: 2.5, depth: 1.5, edge: 0.25}}}\n"
    "supports: [{on: bottom, hold: [x, y]}]\n"
    "contacts:\n  sphere:\n    on: top\n    rigid: {sphere: {radius: 2.5, centre: [0, 6.5, 0]}}\n    motion: [{t: 1, to: [0, -1.5, 0]}]\n"
    "material: {matrix: {yeoh: {a1: 0.012, a2: 0.03, a3: 0.01}}, volume: {quadratic: {d: 1.0e-3}}}\n"
    "stability: off\npath: {first: 0.1, largest: 0.1}\n";
constexpr const char* fit_yaml =
    "data: [{kind: scene, solve: solve.yaml, file: force.csv, columns: {u_ind: travel_mm, force: force_N}, standard_deviation: 2.0e-3}]\n"
    "law: {matrix: {yeoh: {a1: 0.05, a2: 0.01, a3: 0.05}}, volume: {quadratic: {d: 1.0e-3}}}\n"
    "parameters: [{key: matrix.yeoh.a1, lower: 0.001, upper: 1}, {key: matrix.yeoh.a2, lower: 0, upper: 1}, {key: matrix.yeoh.a3, lower: 0, upper: 1}]\n"
    "draft: false\n";
constexpr std::array true_values{0.012, 0.03, 0.01};

void write(const std::string& name, const std::string& text) {
  std::filesystem::create_directories(folder);
  std::ofstream(folder + "/" + name) << text;
}

ForwardPath true_path() {
  write("solve.yaml", solve_yaml);
  auto loaded = read_config<SolveConfig>(load_yaml(folder + "/solve.yaml"));
  ForwardRun run(loaded.config, loaded.where, 0);
  run.observe({Observation{}}, {});
  return run.solve({*loaded.config.material});
}

void write_noisy(const ForwardPath& path, double deviation, unsigned seed) {
  std::mt19937_64 rng(seed);
  std::normal_distribution<double> noise(0, deviation);
  std::string text = "travel_mm,force_N\n";
  for (std::size_t i = 0; i < path.t.size(); ++i)
    text += fmt::format(
        "{},{}\n", 1.5 * path.t[i],
        path.values(static_cast<Eigen::Index>(i), 0) + (deviation > 0 ? noise(rng) : 0));
  write("force.csv", text);
}

FitRecord fitted(const std::string& yaml, int& runs) {
  const auto loaded = read_config<FitConfig>(parse_yaml(yaml, "fit.yaml", folder));
  FitProblem problem = fit_problem(loaded.config);
  InverseFit inverse({"bench", true, false}, loaded.config, loaded.where, problem, {}, "");
  const FitResult found = inverse.search();
  runs = inverse.runs();
  return fit_record(problem, found);
}

}  // namespace

void measure_inverse_coverage() {
  const char* asked = std::getenv("SEEDS");
  const int seeds = asked ? std::max(1, std::atoi(asked)) : 100;
  const ForwardPath path = true_path();
  std::array<int, 3> held{};
  int runs = 0, all_runs = 0;
  const double begun = cpu_seconds();
  for (int seed = 1; seed <= seeds; ++seed) {
    write_noisy(path, 2e-3, static_cast<unsigned>(seed));
    // from near the truth: the optimum is the same, and the runs are fewer
    std::string yaml = fit_yaml;
    yaml.replace(yaml.find("{a1: 0.05, a2: 0.01, a3: 0.05}"), 30,
                 "{a1: 0.013, a2: 0.03, a3: 0.01}");
    const FitRecord record = fitted(yaml, runs);
    all_runs += runs;
    for (std::size_t i = 0; i < 3; ++i) {
      const FittedParameter& p = record.parameters[i];
      const auto [low, high] = interval_95(p);
      held[i] += low <= true_values[i] && true_values[i] <= high;
    }
  }
  fmt::print(
      "indentation with a noise of 2 mN, {} seeds: 95 % intervals hold a1 {:.0f} %, a2 {:.0f} %, a3 {:.0f} % of the time; {} runs, {:.0f} s CPU\n",
      seeds, 100.0 * held[0] / seeds, 100.0 * held[1] / seeds, 100.0 * held[2] / seeds, all_runs,
      cpu_seconds() - begun);
}

namespace {

// How many of the intervals of a1, a2 and a3 hold the truth in one fit; nothing without an optimum.
enum class IntervalsBy { standard_errors, profiles, posterior };
std::optional<std::array<bool, 3>> held_by(const std::string& yaml, IntervalsBy by) {
  const auto loaded = read_config<FitConfig>(parse_yaml(yaml, "fit.yaml", folder));
  FitProblem problem = fit_problem(loaded.config);
  InverseFit inverse({"bench", true, false}, loaded.config, loaded.where, problem, {}, "");
  inverse.set_priors(priors_of(loaded.config, problem, loaded.where));
  FitResult found;
  try {
    found = inverse.search();
  } catch (const Failure&) {
    return std::nullopt;
  }
  const FitRecord record = fit_record(problem, found);
  RecordTable samples;
  StudyRecord studied;
  if (by != IntervalsBy::standard_errors) {
    const CostlyPosterior sampled = costly_posterior(inverse.costly(), found, PosteriorConfig{}, 1);
    samples = sampled.posterior.table;
    // profiles of the polynomials: those of the scenes take a minute for each seed
    StudyConfig config;
    config.profiles = true;
    config.bootstrap = 0;
    if (by == IntervalsBy::profiles)
      studied = study(inverse.costly().problem_with(sampled.polynomials), found, config);
  }
  std::array<bool, 3> held{};
  for (std::size_t i = 0; i < 3; ++i) {
    auto [low, high] = interval_95(record.parameters[i]);
    if (by == IntervalsBy::profiles) {
      const auto& profile = studied.identifiability->profiles[i];
      low = profile.low_open ? -1 : profile.low;
      high = profile.high_open ? 1e9 : profile.high;
    }
    if (by == IntervalsBy::posterior) {
      low = samples.column("lower_95").values[i];
      high = samples.column("upper_95").values[i];
    }
    held[i] = low <= true_values[i] && true_values[i] <= high;
  }
  return held;
}

}  // namespace

void measure_thickness_prior() {
  const char* asked = std::getenv("SEEDS");
  const int seeds = asked ? std::max(1, std::atoi(asked)) : 100;
  const ForwardPath path = true_path();
  const double begun = cpu_seconds();
  fmt::print(
      "indentation of a disc of 4 mm, noise of 2 mN, thickness measured with an error of 10 %, {} seeds:\n"
      "95 % intervals that hold a1, a2, a3\n| thickness | a1 | a2 | a3 | no optimum |\n| --- | --- | --- | --- | --- |\n",
      seeds);
  const std::tuple<const char*, bool, IntervalsBy> rows[] = {
      {"held at what was measured", false, IntervalsBy::standard_errors},
      {"a parameter with its prior", true, IntervalsBy::standard_errors},
      {"the same, by profiles", true, IntervalsBy::profiles},
      {"the same, by samples of the posterior", true, IntervalsBy::posterior}};
  for (const auto& [row, is_free, by] : rows) {
    const bool free = is_free;
    std::array<int, 3> held{};
    int failed = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
      write_noisy(path, 2e-3, static_cast<unsigned>(seed));
      std::mt19937_64 rng(static_cast<unsigned>(seed) + 5000);
      const double measured = 4 + 0.4 * std::normal_distribution<double>(0, 1)(rng);
      // on the mesh of the truth, so that cells make no difference
      std::string yaml = fit_yaml;
      yaml.replace(yaml.find("{a1: 0.05, a2: 0.01, a3: 0.05}"), 30,
                   "{a1: 0.013, a2: 0.03, a3: 0.01}");
      const double deviation = free ? 0.4 : 4e-4;
      yaml.insert(yaml.find("]\ndraft"),
                  fmt::format(", {{key: \"mesh.geometry.indented_disc.size[1]\", lower: 1.5, "
                              "upper: 8, prior: {{normal: [{}, {}]}}}}",
                              measured, deviation));
      const auto one = held_by(yaml, by);
      if (!one) {
        ++failed;
        continue;
      }
      for (std::size_t i = 0; i < 3; ++i) held[i] += (*one)[i] ? 1 : 0;
    }
    const double all = std::max(1, seeds - failed);
    fmt::print("| {} | {:.0f} % | {:.0f} % | {:.0f} % | {} |\n", row, 100 * held[0] / all,
               100 * held[1] / all, 100 * held[2] / all, failed);
    std::fflush(stdout);
  }
  fmt::print("{:.0f} s CPU\n", cpu_seconds() - begun);
}

namespace {

using Loaded = decltype(read_config<FitConfig>(load_yaml("")));

// what the scenes of a fit say at the law and the friction of their configs, into the files that
// the pipeline would give the fit
std::vector<std::string> made_up(const Loaded& fit) {
  std::vector<std::string> files;
  for (const FitData& data : fit.config.data) {
    if (data.solve.path.empty() || !data.file.path.empty()) continue;
    const auto scene = read_config<SolveConfig>(load_yaml(data.solve.path));
    ForwardRun run(scene.config, scene.where, data.fibre_angle);
    run.observe({Observation{}}, {});
    const ForwardPath path = run.solve({*scene.config.material});
    const double depth = -scene.config.contacts.begin()->second.motion.back().to[1];
    std::string text = data.columns->u_ind + "," + data.columns->force + "\n";
    for (std::size_t i = 0; i < path.t.size(); ++i)
      text +=
          fmt::format("{},{}\n", depth * path.t[i], path.values(static_cast<Eigen::Index>(i), 0));
    const std::string name = fmt::format("made_{}.csv", files.size());
    write(name, text);
    files.push_back(folder + "/" + name);
  }
  return files;
}

// CPU seconds of one run of each scene without derivatives, at the law that was found
double forward_seconds(const Loaded& fit, const Material& law) {
  std::map<std::pair<std::string, double>, int> scenes;
  for (const FitData& data : fit.config.data)
    if (!data.solve.path.empty()) scenes[{data.solve.path, data.fibre_angle}] = 1;
  double seconds = 0;
  for (const auto& [scene, once] : scenes) {
    const auto loaded = read_config<SolveConfig>(load_yaml(scene.first));
    const ForwardRun run(loaded.config, loaded.where, scene.second);
    const double begun = cpu_seconds();
    int runs = 0;
    do run.solve({law}), ++runs;
    while (cpu_seconds() - begun < 1);
    seconds += (cpu_seconds() - begun) / runs;
  }
  return seconds;
}

void measure_fit(const std::string& name, const std::string& yaml) {
  const Loaded loaded = read_config<FitConfig>(load_yaml(SOURCE_DIR "/configs/fit/" + yaml));
  const std::vector<std::string> files = made_up(loaded);
  double forward = 0;
  for (bool quotients : {false, true}) {
    FitProblem problem = fit_problem(loaded.config);
    const double begun = cpu_seconds();
    InverseFit inverse({"bench", true, false}, loaded.config, loaded.where, problem, files, "",
                       quotients);
    const FitResult found = inverse.search();
    const double seconds = cpu_seconds() - begun;
    if (forward == 0) forward = forward_seconds(loaded, found.material);
    fmt::print("| {} | {} | {} | {} | {:.2f} | {:.1f} | {:.6g} |\n", name, problem.free.size(),
               quotients ? "differences of runs" : "derivatives", inverse.runs(), seconds,
               seconds / forward, 2 * found.best.cost);
  }
}

}  // namespace

void measure_inverse() {
  fmt::print(
      "| fit | parameters | slopes by | runs | CPU s | forward runs of its scenes | chi-square |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- | --- |\n");
  measure_fit("Yeoh, indentation of a section", "inverse_yeoh.yaml");
  measure_fit("HGO-Yeoh, tensile curve and two indentations with friction",
              "inverse_indentation.yaml");
  measure_fit("HGO-Yeoh, force and field between two pads", "invivo_hgo_yeoh.yaml");
}

namespace {

void measure_price_of(const std::string& yaml, const std::vector<std::string>& keys,
                      const std::string& edge = "") {
  Tree tree = load_yaml(SOURCE_DIR "/configs/solve/" + yaml);
  if (!edge.empty())
    set_value(tree, "mesh.geometry." + tree.find("mesh")->find("geometry")->map[0].key + ".edge",
              parse_yaml(edge, "edge"));
  const auto loaded = read_config<SolveConfig>(tree);
  const Mesh mesh = body_mesh(loaded.config, "", loaded.where);
  double none = 0, last = 0;
  for (std::size_t n = 0; n <= keys.size(); ++n) {
    SolveConfig config = loaded.config;
    config.sensitivity.assign(keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(n));
    double least = std::numeric_limits<double>::infinity();
    long factorizations = 0;
    PathReport path;
    for (int round = 0; round < 5; ++round) {
      const double begun = cpu_seconds();
      Run run(mesh, config, config.material, loaded.where);
      Sensitivity sensitivity(run, config, loaded.where);
      RunListener each;
      each.of_whole = [](StepRecord&, const SolveReport&) {
      };
      path = run.follow(sensitivity.along(each)).path;
      least = std::min(least, cpu_seconds() - begun),
      factorizations = run.increment.cost().factorizations;
    }
    if (n == 0) none = least;
    fmt::print(
        "{}, {} cells, by {}: {:.3f} s CPU ({:+.1f} %, {:+.1f} % for the last), {} increments, {} factorizations, {} corrections more\n",
        yaml, mesh.n_cells(),
        n == 0   ? "nothing"
        : n == 1 ? keys[0]
                 : fmt::format("{} numbers", n),
        least, 100 * (least / none - 1), n == 0 ? 0 : 100 * (least - last) / none, path.steps,
        factorizations, path.again);
    last = least;
  }
}

}  // namespace

void measure_price() {
  const std::vector<std::string> yeoh{"matrix.yeoh.a1", "matrix.yeoh.a2", "matrix.yeoh.a3"};
  std::vector<std::string> hgo = yeoh;
  hgo.insert(hgo.end(), {"fibres[0].hgo.c1", "fibres[0].hgo.c2"});
  measure_price_of("inverse_yeoh.yaml", yeoh);
  measure_price_of("inverse_yeoh.yaml", yeoh, "0.04");
  measure_price_of("inverse_block.yaml", hgo);
  measure_price_of("inverse_block.yaml", hgo, "0.12");
}
