#include "bench/growth.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "base/stopwatch.hpp"
#include "plot/figure_style.hpp"
#include "plot/gnuplot.hpp"
#include "solve/forecast.hpp"
#include "support/indentation.hpp"

namespace langer {

namespace {

struct Row {
  double dofs = 0, cells = 0, analysis = 0, assembly = 0, factor = 0, solve = 0, contact = 0, flops = 0, nonzeros = 0, rate = 0;
  double iterations = 0, forecast_bytes = 0, forecast_seconds = 0;
};

Row indentation(const Material& skin, int nx, int ny) {
  test::Indentation scene;
  scene.nx = scene.nz = nx, scene.ny = ny, scene.h = 0, scene.depth = 0.04, scene.step = 0.02;
  scene.newton.reuse_tangent = false;  // each iteration with all its parts
  Forecast told;
  scene.before = [&](Equilibrium& body, const LinearSolver& linear, const LoadPathOptions& path) {
    told = forecast(body, linear, {}, path, {}, false);
  };
  const auto result = scene.run(skin);
  const double n = static_cast<double>(result.cost.factorizations);
  const auto& cost = result.cost;
  return {static_cast<double>(3 * (nx + 1) * (nx + 1) * ny),
          static_cast<double>(result.mesh.n_cells()),
          cost.analysis,
          cost.assembly / n,
          cost.factor / n,
          cost.solve / n,
          cost.contact / n,
          result.size.flops,
          result.size.factor_nonzeros,
          multiplication_rate(),
          n,
          told.bytes,
          told.per_iteration()};
}

}  // namespace

// Each size in a process of its own, whose largest memory the system tells.
void measure_growth(const Material& skin) {
  std::ofstream csv("growth.csv");
  csv << "dofs,hexahedra,memory_MB,forecast_MB,iteration_s,forecast_s,assembly_s,factor_s,solve_s,contact_s,analysis_s,"
         "factor_GFLOPs\n";
  fmt::print(
      "growth: two steps of 0.02 mm; CPU seconds per iteration on one thread\n"
      "     dofs  hexahedra  memory (forecast) MB   iteration (forecast) s   assembly  factor   solve  contact  analysis  "
      "GFLOP/s (product)\n");
  for (const auto& [nx, ny] : {std::pair{19, 4}, {28, 5}, {42, 6}, {56, 8}, {75, 10}, {90, 12}, {103, 14}}) {
    int ends[2];
    if (pipe(ends) != 0) return;
    std::fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
      const Row row = indentation(skin, nx, ny);
      _exit(write(ends[1], &row, sizeof row) == sizeof row ? 0 : 1);
    }
    close(ends[1]);
    Row r;
    const bool whole = read(ends[0], &r, sizeof r) == sizeof r;
    close(ends[0]);
    rusage usage{};
    int status = 0;
    wait4(child, &status, 0, &usage);
    if (!whole) {
      fmt::print("  {} x {} x {}: did not end\n", nx, ny, nx);
      continue;
    }
    const double megabytes = usage.ru_maxrss / 1024.0, iteration = r.assembly + r.factor + r.solve + r.contact;
    const double gflops = 1e-9 * r.flops / r.factor;
    fmt::print(
        "  {:7.0f}  {:9.0f}  {:7.0f} ({:7.0f})        {:8.3f} ({:8.3f})      {:8.3f}{:8.3f}{:8.3f}{:9.3f}{:10.2f}  {:7.1f} ({:.1f})\n",
        r.dofs, r.cells, megabytes, r.forecast_bytes / 1048576, iteration, r.forecast_seconds, r.assembly, r.factor, r.solve,
        r.contact, r.analysis, gflops, 1e-9 * r.rate);
    std::fflush(stdout);
    csv << fmt::format("{},{},{:.1f},{:.1f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.3f},{:.2f}\n", r.dofs, r.cells, megabytes,
                       r.forecast_bytes / 1048576, iteration, r.forecast_seconds, r.assembly, r.factor, r.solve, r.contact,
                       r.analysis, gflops);
  }
  csv.close();
  for (const auto& [name, label, lines] :
       {std::tuple{"growth_time", "CPU time of one iteration (s)",
                   std::vector<PlotLine>{{"growth.csv", "dofs", "iteration_s", "iteration"},
                                         {"growth.csv", "dofs", "factor_s", "factorization"},
                                         {"growth.csv", "dofs", "assembly_s", "assembly"},
                                         {"growth.csv", "dofs", "solve_s", "solution"},
                                         {"growth.csv", "dofs", "forecast_s", "forecast", true}}},
        {"growth_memory", "memory (MB)",
         std::vector<PlotLine>{{"growth.csv", "dofs", "memory_MB", "largest"},
                               {"growth.csv", "dofs", "forecast_MB", "forecast", true}}}}) {
    Plot plot;
    plot.x_label = "free degrees of freedom", plot.y_label = label, plot.lines = lines;
    plot.scale = AxisScale::log;
    std::ofstream(std::string(name) + ".gp") << gnuplot_script(plot, name, FigureStyle());
    if (const std::string wrong = run_gnuplot(".", std::string(name) + ".gp"); !wrong.empty()) fmt::print("  {}\n", wrong);
  }
}

}  // namespace langer
