// What fits of scenes cost and whether their intervals can be believed.
//   inverse            runs of the scene that the fit of pipelines/inverse_yeoh.yaml takes, with the derivatives of the runs and with
//                      difference quotients of whole runs
//   inverse_coverage   how often 95 % intervals hold the true values, over fresh noise
#include "inverse/inverse_fit.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>

#include "base/stopwatch.hpp"
#include "config/reader.hpp"
#include "study/fit_report.hpp"

using namespace langer;

namespace {

const std::string folder = (std::filesystem::temp_directory_path() / "langer_bench_inverse").string();

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
    text +=
        fmt::format("{},{}\n", 1.5 * path.t[i], path.values(static_cast<Eigen::Index>(i), 0) + (deviation > 0 ? noise(rng) : 0));
  write("force.csv", text);
}

FitRecord fitted(const std::string& yaml, int& runs, bool quotients = false) {
  const auto loaded = read_config<FitConfig>(parse_yaml(yaml, "fit.yaml", folder));
  FitProblem problem = fit_problem(loaded.config);
  InverseFit inverse({"bench", true, false}, loaded.config, loaded.where, problem, {}, "", quotients);
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
    yaml.replace(yaml.find("{a1: 0.05, a2: 0.01, a3: 0.05}"), 30, "{a1: 0.013, a2: 0.03, a3: 0.01}");
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
      seeds, 100.0 * held[0] / seeds, 100.0 * held[1] / seeds, 100.0 * held[2] / seeds, all_runs, cpu_seconds() - begun);
}

namespace {
// of one run without derivatives, the scene as the fit solves it
double forward_seconds() {
  constexpr int runs = 10;
  const double begun = cpu_seconds();
  for (int i = 0; i < runs; ++i) true_path();
  return (cpu_seconds() - begun) / runs;
}

void measure_with(bool quotients, double forward) {
  int runs = 0;
  const double begun = cpu_seconds();
  const FitRecord record = fitted(fit_yaml, runs, quotients);
  double worst = 0;
  for (std::size_t i = 0; i < 3; ++i) worst = std::max(worst, std::abs(record.parameters[i].value / true_values[i] - 1));
  const double seconds = cpu_seconds() - begun;
  fmt::print(
      "Yeoh from an indentation of a section, {}: {} runs, {:.2f} s CPU, as much as {:.1f} forward runs; off by {:.1e} at most\n",
      quotients ? "differences of whole runs" : "derivatives of the runs", runs, seconds, seconds / forward, worst);
}
}  // namespace

void measure_inverse() {
  write_noisy(true_path(), 0, 1);
  const double forward = forward_seconds();
  for (bool quotients : {false, true}) measure_with(quotients, forward);
}
