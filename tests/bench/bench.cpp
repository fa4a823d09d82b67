// Measurements printed by `make bench`: CPU seconds of this process, so that a busy machine disturbs them little.
//   langer-bench [case ...]     cases: indentation, paper, grading
#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <set>
#include <string>

#include "support/indentation.hpp"
#include "support/laws.hpp"

using namespace langer;

namespace {

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) { return t.tv_sec + 1e-6 * t.tv_usec; };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024.0;
}

void measure(const std::string& name, const test::Indentation& scene, const Material& material) {
  const double cpu = cpu_seconds();
  const auto start = std::chrono::steady_clock::now();
  const auto result = scene.run(material);
  const double seconds = cpu_seconds() - cpu;
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const auto& cost = result.cost;
  const double n = static_cast<double>(cost.factorizations);
  fmt::print("{}: {} hexahedra, {} threads: {} to {:.3g} mm, force {:.5g} N\n", name, result.mesh.n_cells(), scene.threads,
             result.path.complete ? "complete" : "stopped (" + result.path.why + ")",
             result.steps.empty() ? 0 : result.steps.back().depth, result.steps.empty() ? 0 : result.steps.back().force);
  fmt::print(
      "  {} steps, {} iterations ({:.2f} per step), {:.1f} s CPU, {:.1f} s wall, {:.3f} s CPU per iteration, {:.0f} MB\n",
      result.path.steps, result.path.iterations, double(result.path.iterations) / std::max(1, result.path.steps), seconds, wall,
      seconds / std::max(1, result.path.iterations), peak_megabytes());
  fmt::print("  CPU s per iteration: assembly {:.3f}, factor {:.3f}, solve {:.3f}, contact {:.3f}\n", cost.assembly / n,
             cost.factor / n, cost.solve / n, cost.contact / n);
  std::fflush(stdout);
}

test::Indentation paper_block() {  // 56 x 4 x 55: 12 320 hexahedra; the paper has 12 336
  test::Indentation scene;
  scene.nx = 56, scene.ny = 4, scene.nz = 55, scene.h = 0, scene.step = 0.01;
  return scene;
}

}  // namespace

int main(int argc, char** argv) {
  const std::set<std::string> asked(argv + 1, argv + argc);
  const auto wanted = [&](const char* name) { return asked.empty() || asked.count(name) > 0; };
  const Material skin = test::table1(60, 1e-6);
  if (wanted("indentation")) {  // what an iteration costs at the paper's size
    auto scene = paper_block();
    scene.depth = 0.2;
    measure("indentation of the paper's block, first 20 steps of 0.01 mm", scene, skin);
    scene.step = 0.1, scene.depth = 1;
    measure("the same to 1 mm in steps of 0.1 mm", scene, skin);
  }
  if (asked.count("paper")) measure("the paper's 100 steps of 0.01 mm", paper_block(), skin);
  if (asked.count("grading")) {
    test::Indentation scene;
    scene.nx = scene.nz = 36, scene.ny = 12, scene.h = 0.2;
    measure("graded block 36 x 12 x 36", scene, skin);
  }
}
