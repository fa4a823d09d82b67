#include "bench/growth.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <optional>

#include "core/base/ranks.hpp"
#include "core/base/stopwatch.hpp"
#include "mechanics/linear/petsc/petsc_load.hpp"
#include "mechanics/solve/forecast.hpp"
#include "results/plot/figure_style.hpp"
#include "results/plot/gnuplot.hpp"
#include "support/indentation.hpp"

namespace langer {

namespace {

struct Row {
  double dofs = 0, cells = 0, analysis = 0, assembly = 0, factor = 0, solve = 0, contact = 0,
         flops = 0, nonzeros = 0, rate = 0;
  double iterations = 0, forecast_bytes = 0, forecast_seconds = 0;
  double wall = 0;  // of an iteration
};

Row indentation(const Material& skin, int nx, int ny, LinearBy linear) {
  test::Indentation scene;
  scene.ranks = ranks();
  scene.nx = scene.nz = nx, scene.ny = ny, scene.h = 0, scene.depth = 0.04, scene.step = 0.02;
  scene.newton.linear = linear;
  scene.newton.reuse_tangent = false;  // each iteration with all its parts
  Forecast told;
  scene.before = [&](Assembler& body, const Increment& increment, const LoadPathOptions& path) {
    told = forecast(body, increment.size(), increment.contacts(), path, {},
                    {false, increment.contact_in_tangent(), increment.mixed()});
  };
  double begun = 0;
  scene.before = [told_of = scene.before, &begun](Assembler& body, const Increment& increment,
                                                  const LoadPathOptions& path) {
    told_of(body, increment, path);
    begun = wall_seconds();
  };
  const auto result = scene.run(skin);
  const double ended = wall_seconds();
  const double n = static_cast<double>(linear == LinearBy::direct ? result.cost.factorizations
                                                                  : result.path.iterations);
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
          told.per_iteration(),
          (ended - begun) / n};
}

// in a process of its own, whose largest memory the system tells
std::optional<Row> measured(const Material& skin, int nx, int ny, LinearBy linear,
                            double& megabytes) {
  int ends[2];
  if (pipe(ends) != 0) return std::nullopt;
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    const Row row = indentation(skin, nx, ny, linear);
    _exit(write(ends[1], &row, sizeof row) == sizeof row ? 0 : 1);
  }
  close(ends[1]);
  Row r;
  const bool whole = read(ends[0], &r, sizeof r) == sizeof r;
  close(ends[0]);
  rusage usage{};
  int status = 0;
  wait4(child, &status, 0, &usage);
  megabytes = usage.ru_maxrss / 1024.0;
  return whole ? std::optional(r) : std::nullopt;
}

// growth_<how>.csv and what it says on the way
void measure(const Material& skin, LinearBy linear, const std::vector<std::pair<int, int>>& sizes) {
  const std::string how = names(linear)[static_cast<std::size_t>(linear)];
  std::ofstream csv("growth_" + how + ".csv");
  csv << "dofs,hexahedra,memory_MB,forecast_MB,iteration_s,forecast_s,assembly_s,factor_s,solve_s,contact_s,analysis_s,"
         "factor_GFLOPs\n";
  for (const auto& [nx, ny] : sizes) {
    double megabytes = 0;
    const std::optional<Row> row = measured(skin, nx, ny, linear, megabytes);
    if (!row) {
      fmt::print("  {} x {} x {}: did not end\n", nx, ny, nx);
      continue;
    }
    const Row& r = *row;
    const double iteration = r.assembly + r.factor + r.solve + r.contact,
                 gflops = r.factor > 0 ? 1e-9 * r.flops / r.factor : 0;
    fmt::print(
        "  {:9}  {:7.0f}  {:9.0f}  {:7.0f} ({:7.0f})        {:8.3f} ({:8.3f})      {:8.3f}{:8.3f}{:8.3f}{:9.3f}{:10.2f}  {:7.1f} "
        "({:.1f})\n",
        how, r.dofs, r.cells, megabytes, r.forecast_bytes / 1048576, iteration, r.forecast_seconds,
        r.assembly, r.factor, r.solve, r.contact, r.analysis, gflops, 1e-9 * r.rate);
    std::fflush(stdout);
    csv << fmt::format(
        "{},{},{:.1f},{:.1f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.3f},{:.2f}\n", r.dofs,
        r.cells, megabytes, r.forecast_bytes / 1048576, iteration, r.forecast_seconds, r.assembly,
        r.factor, r.solve, r.contact, r.analysis, gflops);
  }
}

double peak_of_all() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  double megabytes = static_cast<double>(usage.ru_maxrss) / 1024.0;
  if (ranks()) ranks()->sum(&megabytes, 1);
  return megabytes;
}

}  // namespace

void measure_ranks(const Material& skin) {
  std::string why;
  if (!begin_ranks(why) && !why.empty()) fmt::print("ranks: {}\n", why);
  const bool first = !ranks() || ranks()->first();
  if (first)
    fmt::print(
        "ranks: {}, two steps of 0.02 mm; seconds by the clock, CPU seconds of rank 0, memory of all\n"
        "       dofs  memory (forecast) MB   iteration by the clock    CPU (forecast)   assembly   solve\n",
        ranks() ? ranks()->n() : 1);
  for (const auto& [nx, ny] : {std::pair{75, 10}, {103, 14}, {143, 20}}) {
    const double begin = wall_seconds();
    const Row r = indentation(skin, nx, ny, LinearBy::iterative);
    const double megabytes = peak_of_all(), seconds = wall_seconds() - begin;
    if (!first) continue;
    fmt::print(
        "  {:9.0f}  {:9.0f} ({:.0f})  {:8.3f}  {:8.3f} ({:.3f})  {:8.3f}  {:8.3f}   whole {:.1f}, {:.0f} iterations\n",
        r.dofs, megabytes, r.forecast_bytes / 1048576, r.wall, r.assembly + r.solve,
        r.forecast_seconds, r.assembly, r.solve, seconds, r.iterations);
    std::fflush(stdout);
  }
  if (ranks())
    ranks()->end(
        0, false, [](const char*) {}, "");
  end_petsc();
}

void measure_growth(const Material& skin) {
  fmt::print(
      "growth: two steps of 0.02 mm; CPU seconds per iteration on one thread\n"
      "  solver        dofs  hexahedra  memory (forecast) MB   iteration (forecast) s   assembly  factor   solve  contact  analysis  "
      "GFLOP/s (product)\n");
  measure(skin, LinearBy::direct,
          {{19, 4}, {28, 5}, {42, 6}, {56, 8}, {75, 10}, {90, 12}, {103, 14}});
  measure(skin, LinearBy::iterative,
          {{28, 5}, {42, 6}, {56, 8}, {75, 10}, {90, 12}, {103, 14}, {143, 20}, {170, 23}});
  const std::string direct = "growth_direct.csv", iterative = "growth_iterative.csv";
  for (const auto& [name, label, lines] :
       {std::tuple{"growth_time", "CPU time of one iteration (s)",
                   std::vector<PlotLine>{{direct, "dofs", "iteration_s", "by a factor"},
                                         {direct, "dofs", "forecast_s", "forecast", true},
                                         {iterative, "dofs", "iteration_s", "iterative"},
                                         {iterative, "dofs", "forecast_s", "forecast", true},
                                         {direct, "dofs", "assembly_s", "assembly"}}},
        {"growth_memory", "memory (MB)",
         std::vector<PlotLine>{{direct, "dofs", "memory_MB", "by a factor"},
                               {direct, "dofs", "forecast_MB", "forecast", true},
                               {iterative, "dofs", "memory_MB", "iterative"},
                               {iterative, "dofs", "forecast_MB", "forecast", true}}}}) {
    Plot plot;
    plot.x_label = "free degrees of freedom", plot.y_label = label, plot.lines = lines;
    plot.scale = AxisScale::log;
    std::ofstream(std::string(name) + ".gp") << gnuplot_script(plot, name, FigureStyle());
    if (const std::string wrong = run_gnuplot(".", std::string(name) + ".gp"); !wrong.empty())
      fmt::print("  {}\n", wrong);
  }
}

}  // namespace langer
