// Measurements printed by `make bench`: CPU seconds of this process, so that a busy machine
// disturbs them little.
//   langer-bench [case ...]     cases: assembly, solvers, indentation, fit, sobol;
//                               only when named: coverage, inverse, price, inverse_coverage, thickness_prior, relaxation, paper, depths, grading, growth, ranks,
//                               wide, control, motion, instabilities
#include <fmt/format.h>

#include <array>
#include <chrono>
#include <set>
#include <string>

#include "bench/growth.hpp"
#include "bench/solvers.hpp"
#include "core/base/memory.hpp"
#include "core/base/stopwatch.hpp"
#include "identification/sensitivity/sobol.hpp"
#include "mechanics/material/path.hpp"
#include "mechanics/solve/forecast.hpp"
#include "support/directions.hpp"
#include "support/indentation.hpp"
#include "support/laws.hpp"

using namespace langer;

void measure_fit();       // fit.cpp
void measure_coverage();  // coverage.cpp
void measure_relaxation_coverage();
void measure_candidates();
void measure_wide();           // wide.cpp
void measure_control();        // control.cpp
void measure_instabilities();  // instabilities.cpp
void measure_inverse();        // inverse.cpp
void measure_motion();         // motion.cpp
void measure_price();
void measure_inverse_coverage();
void measure_thickness_prior();

namespace {

void measure(const std::string& name, const test::Indentation& scene, const Material& material) {
  const double cpu = cpu_seconds();
  const auto start = std::chrono::steady_clock::now();
  const auto result = scene.run(material);
  const double seconds = cpu_seconds() - cpu;
  const double wall =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const auto& cost = result.cost;
  const double n = static_cast<double>(cost.factorizations);
  fmt::print("{}: {} hexahedra, {} threads: {} to {:.3g} mm, force {:.5g} N\n", name,
             result.mesh.n_cells(), scene.threads,
             result.path.complete ? "complete" : "stopped (" + result.path.why + ")",
             result.steps.empty() ? 0 : result.steps.back().depth,
             result.steps.empty() ? 0 : result.steps.back().force);
  fmt::print(
      "  {} steps, {} Newton iterations ({:.2f} per step), {} modified ({:.2f}), {:.1f} s CPU, {:.1f} s wall, {:.0f} MB\n",
      result.path.steps, result.path.iterations,
      double(result.path.iterations) / std::max(1, result.path.steps), result.path.again,
      double(result.path.again) / std::max(1, result.path.steps), seconds, wall,
      1e-6 * peak_bytes());
  const double rate = multiplication_rate();
  fmt::print(
      "  CPU s: assembly {:.2f}, factor {:.2f} ({:.3f} each), solve {:.2f}, contact {:.2f}, analysis {:.2f}\n",
      cost.assembly, cost.factor, cost.factor / n, cost.solve, cost.contact, cost.analysis);
  fmt::print(
      "  factor {:.1f} GFLOP/s ({:.2f} GFLOP each), beside {:.1f} of a matrix product (DGEMM)\n",
      1e-9 * result.size.flops * n / cost.factor, 1e-9 * result.size.flops, 1e-9 * rate);
  std::fflush(stdout);
}

test::Indentation paper_block() {  // 56 x 4 x 55: 12 320 hexahedra; the paper has 12 336
  test::Indentation scene;
  scene.nx = 56, scene.ny = 4, scene.nz = 55, scene.h = 0, scene.step = 0.01;
  return scene;
}

// 1e6 curves of the uniaxial law at ten strains each, on two threads
void measure_sobol(const Material& skin) {
  const std::vector<double> strain{0.06, 0.12, 0.18, 0.24, 0.3, 0.36, 0.42, 0.48, 0.54, 0.6};
  const CurveMaker maker = [&] {
    return ParametricCurve([&, m = skin](const VecX& p, VecX& y) mutable {
      m.matrix = {Yeoh{p[0], p[1], p[2]}};
      std::get<HgoFibre>(m.fibres[0].law) = {p[3], p[4]};
      const auto sigma = path_curve(m, Path::uniaxial, strain, StressMeasure::cauchy);
      if (sigma)
        y = Eigen::Map<const VecX>(sigma->data(), static_cast<Eigen::Index>(sigma->size()));
      return sigma.has_value();
    });
  };
  VecX value(5), range(5);
  value << 0.269, 0.376, 0.415, -0.317, 0.319;
  range = 0.5 * value.cwiseAbs();
  SamplingOptions options;
  options.threads = 2;
  const double cpu = cpu_seconds();
  const auto start = std::chrono::steady_clock::now();
  const Sobol s = sobol(maker, value - range, value + range, 1000000 / 7 + 1, options);
  fmt::print(
      "Sobol: {} curves of {} strains: {:.1f} s CPU, {:.1f} s wall on 2 threads; total share of c1 at 60 %: {:.3f} +- {:.3f}\n",
      s.curves, strain.size(), cpu_seconds() - cpu,
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
      s.total.value(3, 9), 0.5 * (s.total.high(3, 9) - s.total.low(3, 9)));
}

// Isotropic and frictionless: the force at six depths against a reference made with other elements
// (axisymmetric Q2P1).
struct Grid {
  CellType cells;
  int n;
  double h;
  int ny;
};
const std::vector<Grid> fine{
    {CellType::hex8, 20, 0.13, 9}, {CellType::hex8, 32, 0.075, 14}, {CellType::hex8, 44, 0.05, 18}};
const std::vector<Grid> both{{CellType::hex8, 10, 0.3, 5},   {CellType::hex8, 14, 0.2, 6},
                             {CellType::hex8, 20, 0.13, 9},  {CellType::hex8, 28, 0.1, 12},
                             {CellType::hex27, 6, 0.5, 3},   {CellType::hex27, 8, 0.35, 4},
                             {CellType::hex27, 10, 0.25, 5}, {CellType::hex27, 14, 0.2, 6}};

void measure_depths(const std::vector<Grid>& grids) {
  constexpr std::array depths{0.1, 0.2, 0.3, 0.5, 0.7, 1.0},
      reference{0.1668, 0.511, 1.0095, 2.507, 4.842, 10.76};
  fmt::print(
      "isotropic, frictionless, quarter model: force [N] at six depths, deviation from the reference\n");
  for (const auto& [cells, n, h, ny] : grids) {
    test::Indentation scene;
    scene.cells = cells;
    scene.quarter = true, scene.nx = scene.nz = 2 * n, scene.h = h, scene.ny = ny, scene.mu = 0,
    scene.reach = 2.3;
    const double cpu = cpu_seconds();
    const auto result = scene.run(test::table1(0, 1e-6, 0));
    fmt::print("  {} x {} x {} {}, finest {} mm, {} nodes, {:.1f} s CPU:", n, ny, n,
               names(cells)[static_cast<int>(cells)], h, result.mesh.n_nodes(),
               cpu_seconds() - cpu);
    for (const auto& step : result.steps)
      for (std::size_t i = 0; i < depths.size(); ++i)
        if (std::abs(step.depth - depths[i]) < 1e-9)
          fmt::print("  {:.4g} ({:+.2f} %)", 4 * step.force,
                     100 * (4 * step.force / reference[i] - 1));
    fmt::print("\n");
    std::fflush(stdout);
  }
}

// elements per second, one thread, with the tangent
void measure_assembly(const Material& skin) {
  const Mesh linear =
      test::block(test::even(-15, 15, 56), test::even(0, 4, 4), test::even(-15, 15, 55));
  const Mesh quadratic = test::raised_block(
      test::block(test::even(-15, 15, 28), test::even(0, 4, 2), test::even(-15, 15, 27)));
  for (const auto& [cells, kernel] : {std::pair{&linear, Kernel::packets},
                                      {&linear, Kernel::one_by_one},
                                      {&quadratic, Kernel::packets},
                                      {&quadratic, Kernel::one_by_one}}) {
    const Mesh& mesh = *cells;
    Assembler body = test::equilibrium(mesh, {skin}, usual_formulation(mesh.type),
                                       number_dofs(mesh.n_nodes(), {}).dofs, 1, kernel);
    VecX u(3 * mesh.n_nodes());
    for (int i = 0; i < mesh.n_nodes(); ++i)
      u.segment<3>(3 * i) = 0.01 * mesh.X[i].cwiseProduct(Vec3(1, -1, 0.5));
    body.assemble(u, true);
    const double start = cpu_seconds();
    const int rounds = kernel == Kernel::packets ? 20 : 5;
    for (int k = 0; k < rounds; ++k) body.assemble(u, true);
    const double seconds = (cpu_seconds() - start) / rounds;
    fmt::print(
        "assembly, {}: {:.4f} s CPU for {} {} with {} nodes, {:.3f} million elements per second\n",
        kernel == Kernel::packets ? "eight at a time" : "one by one", seconds, mesh.n_cells(),
        names(mesh.type)[static_cast<int>(mesh.type)], mesh.n_nodes(),
        1e-6 * mesh.n_cells() / seconds);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::set<std::string> asked(argv + 1, argv + argc);
  const auto wanted = [&](const char* name) {
    return asked.empty() || asked.count(name) > 0;
  };
  const Material skin = test::table1(60, 1e-6);
  if (wanted("assembly")) measure_assembly(skin);
  if (wanted("solvers")) measure_solvers();
  if (wanted("indentation")) {  // what an iteration costs at the paper's size
    auto scene = paper_block();
    scene.depth = 0.2;
    measure("indentation of the paper's block, first 20 steps of 0.01 mm", scene, skin);
    scene.step = 0.1, scene.depth = 1;
    measure("the same to 1 mm in steps of 0.1 mm", scene, skin);
  }
  if (wanted("fit")) measure_fit();
  if (asked.count("coverage")) measure_coverage();
  if (asked.count("relaxation")) measure_relaxation_coverage();
  if (asked.count("inverse")) measure_inverse();
  if (asked.count("price")) measure_price();
  if (asked.count("inverse_coverage")) measure_inverse_coverage();
  if (asked.count("thickness_prior")) measure_thickness_prior();
  if (wanted("sobol")) measure_sobol(test::table1(0, 1e-6));
  if (asked.count("paper"))
    for (int threads : {1, 2}) {
      auto scene = paper_block();
      scene.threads = threads;
      measure("the paper's 100 steps of 0.01 mm", scene, skin);
    }
  if (asked.count("depths")) measure_depths(fine);
  if (asked.count("cells")) measure_depths(both);
  if (asked.count("growth")) measure_growth(skin);
  if (asked.count("ranks")) measure_ranks(skin);
  if (asked.count("wide")) measure_wide();
  if (asked.count("control")) measure_control();
  if (asked.count("motion")) measure_motion();
  if (asked.count("instabilities")) measure_instabilities();
  if (asked.count("candidates")) measure_candidates();
  if (asked.count("grading")) {
    test::Indentation scene;
    scene.nx = scene.nz = 36, scene.ny = 12, scene.h = 0.2;
    measure("graded block 36 x 12 x 36", scene, skin);
  }
}
