// How often 95 % intervals hold the true parameters: sets of three biaxial protocols with noise of
// several kinds, of laws whose parameters are hard to find.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "identification/fit/identifiability.hpp"
#include "identification/fit/periodic.hpp"
#include "identification/setup/fit_report.hpp"
#include "material/catalogue.hpp"
#include "support/correlated.hpp"

using namespace langer;

namespace {

constexpr double limit = 3.841458820694124;  // of chi-square, 95 %

// how many of the intervals that a fit gives hold the true value, of one parameter
struct Count {
  int held = 0, given = 0;
  void add(bool holds) {
    held += holds ? 1 : 0;
    ++given;
  }
  double percent() const { return given > 0 ? 100. * held / given : 0; }
};

struct Coverage {
  explicit Coverage(std::size_t parameters)
      : file(parameters), profile(parameters), bootstrap(parameters) {}
  std::vector<Count> file, profile, bootstrap;  // file: parameters.csv
  std::array<int, 5> kinds{};                   // of noise that was chosen, as NoiseKind
  int failed = 0;
};

// an angle means the same after half a turn
bool holds(double low, double high, double truth, bool angle) {
  for (int turns = -2; turns <= 2; ++turns) {
    const double value = truth + 180 * turns;
    if (low <= value && value <= high) return true;
    if (!angle) return low <= truth && truth <= high;
  }
  return false;
}

// samples: of the bootstrap; 0: none
void add(Coverage& coverage, const FitProblem& problem, const VecX& truth, int samples) {
  const FitResult f = fit(problem, {.starts = 2});
  if (!f.best.converged) {
    ++coverage.failed;
    return;
  }
  ++coverage.kinds[static_cast<std::size_t>(f.noise_model.kind)];
  const LeastSquares q = likelihood_problem(problem, f);
  const VecX factor = interval_factors(f.columns, f.left_out, f.noise);
  const VecX growth = growth_of_intervals(f.columns, f.left_out, f.noise);
  const FitRecord record = fit_record(problem, f);
  BootstrapOptions options;
  options.growth = growth.mean();
  options.spread = growth / options.growth;
  options.samples = samples;
  Bootstrap b;
  if (samples > 0)
    b = bootstrap([&] { return likelihood_problem(problem, f); }, f.best.p, f.noise, options);
  for (Eigen::Index i = 0; i < truth.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const bool angle = problem.free[k].key.ends_with("alpha");
    const auto [low, high] = interval_95(record.parameters[k]);
    if (std::isfinite(low) && std::isfinite(high))
      coverage.file[k].add(holds(low, high, truth[i], angle));
    const double value = f.best.p[i] + difference(q, i, f.best.p[i], truth[i]);
    const double rise = profile_rise(q, i, value, f.best.p, f.noise.total() * factor[i]);
    coverage.profile[k].add(rise <= limit);
    if (samples > 0) coverage.bootstrap[k].add(holds(b.low[i], b.high[i], truth[i], angle));
  }
}

std::string range(const std::vector<Count>& counts) {
  if (counts.front().given == 0) return "-";
  double low = 100;
  double high = 0;
  Count all;
  for (const Count& one : counts) {
    low = std::min(low, one.percent());
    high = std::max(high, one.percent());
    all.held += one.held;
    all.given += one.given;
  }
  return fmt::format("{:.0f} to {:.0f}, mean {:.1f}", low, high, all.percent());
}

enum class Noise { white, correlated, proportional, gain, strain };

// the tests of a problem with errors of 1 % of the largest stress, or what compares with it
FitProblem with_error(FitProblem q, Noise error, std::uint64_t seed) {
  const double deviation = 0.01 * test::largest_of(q);
  if (error == Noise::white) return test::noisy(q, deviation, 0, seed);
  if (error == Noise::correlated) return test::noisy(q, deviation, 0.9, seed);
  Random random(321, seed);
  for (Test& t : q.tests) {
    const double gain = 0.05 * random.normal();
    for (auto* list : {&t.stress_x, &t.stress_z})
      for (double& s : *list) {
        if (error == Noise::proportional) s *= 1 + 0.05 * random.normal();
        if (error == Noise::gain) s = s * (1 + gain) + 0.2 * deviation * random.normal();
        if (error == Noise::strain) s += 0.2 * deviation * random.normal();
      }
    if (error != Noise::strain) continue;
    for (auto* list : {&t.first, &t.second})
      for (double& x : *list) x += 0.002 * random.normal();
  }
  return q;
}

// three biaxial protocols of dispersed fibres in a neo-Hookean matrix
FitProblem dispersed(double c2, double kappa, double alpha, double largest_strain) {
  FitProblem q = test::protocols(20);
  q.law = {{NeoHooke{0.01}}, {hgo_fibre(0.3, c2, alpha, FibreSwitch::I4_bar, kappa)}, q.law.volume};
  q.free = {{"matrix.neo_hooke.a1", 0.01, 0, 1},
            {"fibres[0].hgo.c1", 0.3, 0, 10},
            {"fibres[0].hgo.c2", c2, 0, 100},
            {"fibres[0].alpha", alpha, -90, 90}};
  if (kappa > 0) q.free.push_back({"fibres[0].kappa", kappa, 0, 1. / 3});
  for (Test& t : q.tests) {
    for (double& x : t.first) x = 1 + (x - 1) * largest_strain / 0.35;
    for (double& x : t.second) x = 1 + (x - 1) * largest_strain / 0.35;
    std::vector<double> s(t.values());
    if (!model_stress(q.law, t, Dilatation::incompressible, s.data())) continue;
    const auto middle = s.begin() + static_cast<std::ptrdiff_t>(t.points());
    t.stress_x.assign(s.begin(), middle);
    t.stress_z.assign(middle, s.end());
  }
  return q;
}

void measure(const std::string& name, const FitProblem& exact, Noise error, int seeds,
             int samples) {
  const char* only = std::getenv("ROWS");
  if (only && name.find(only) == std::string::npos) return;
  VecX truth(static_cast<Eigen::Index>(exact.free.size()));
  for (std::size_t i = 0; i < exact.free.size(); ++i)
    truth[static_cast<Eigen::Index>(i)] = exact.free[i].start;
  Coverage coverage(exact.free.size());
  for (int seed = 0; seed < seeds; ++seed) {
    FitProblem problem = with_error(exact, error, static_cast<std::uint64_t>(seed));
    problem.noise = NoiseKind::automatic;
    add(coverage, problem, truth, samples);
  }
  const auto& k = coverage.kinds;
  fmt::print("| {} | {} | {} | {} | {}, {}, {}, {} | {} |\n", name, range(coverage.file),
             range(coverage.profile), range(coverage.bootstrap), k[1], k[2], k[3], k[4],
             coverage.failed);
  std::fflush(stdout);
}

}  // namespace

// SEEDS: sets of each row; ROWS: a part of the name of the rows that are wanted.
void measure_coverage() {
  const char* asked = std::getenv("SEEDS");
  const int seeds = asked ? std::max(1, std::atoi(asked)) : 60;
  fmt::print(
      "intervals of 95 % that hold the truth, percent (lowest and highest of the parameters, mean), {} sets each;\n"
      "a proportion of 95 % has a standard error of {:.1f} % in one parameter\n"
      "| noise, law | parameters.csv | profiles | bootstrap | chosen: white, proportional, autoregressive, both | no optimum |\n"
      "| --- | --- | --- | --- | --- | --- |\n",
      seeds, 100 * std::sqrt(0.95 * 0.05 / seeds));
  const FitProblem yeoh = test::protocols(20);
  constexpr int samples = 60;
  measure("proportional 5 %, HGO-Yeoh", yeoh, Noise::proportional, seeds, samples);
  measure("autoregressive 0.9, HGO-Yeoh", yeoh, Noise::correlated, seeds, samples);
  measure("white, HGO-Yeoh", yeoh, Noise::white, seeds, samples);
  for (double angle : {88., 85., 80., 90.})
    measure(fmt::format("white, GOH at {:g} degrees", angle), dispersed(3, 0.1, angle, 0.3),
            Noise::white, seeds, 0);
  measure("white, GOH with kappa 0.31", dispersed(8, 0.31, 60, 0.3), Noise::white, seeds, 0);
  measure("white, HGO with weak c2", dispersed(2, 0, 30, 0.08), Noise::white, seeds, 0);
  measure("strain 0.002, HGO-Yeoh", yeoh, Noise::strain, seeds, 0);
  measure("gain 5 % of each test, HGO-Yeoh", yeoh, Noise::gain, seeds, 0);
}

namespace {

// of relaxation records: as the intervals of least squares
struct Held {
  explicit Held(Eigen::Index n) : error(VecX::Zero(n)), profile(error), bootstrap(error) {}
  VecX error, profile, bootstrap;
  double rho = 0, effective = 0;
};

void add(Held& held, const FitProblem& problem, const VecX& truth, double part) {
  Coverage one(problem.free.size());
  const FitResult f = fit(problem, {.starts = 1});
  add(one, problem, truth, 100);
  for (Eigen::Index i = 0; i < truth.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    held.error[i] += part * one.file[k].held;
    held.profile[i] += part * one.profile[k].held;
    held.bootstrap[i] += part * one.bootstrap[k].held;
  }
  held.rho += 0.01 * part * f.noise.rho;
  held.effective += 0.01 * part * f.noise.effective;
}

}  // namespace

// Relaxation records: ramp, hold and back, a law and three branches on decades; one of them not
// there.
void measure_relaxation_coverage() {
  constexpr int records = 100;
  fmt::print(
      "\nrelaxation records, 95 % intervals held of {} (a1, gamma of 0.1, 1 and 10 s)\n"
      "| rho | branch of 1 s | found | values count as | standard errors | profiles | bootstrap |\n"
      "| --- | --- | --- | --- | --- | --- | --- |\n",
      records);
  const auto each = [](const VecX& v) {
    return fmt::format("{:.0f}, {:.0f}, {:.0f}, {:.0f}", v[0], v[1], v[2], v[3]);
  };
  for (double middle : {0.3, 0.})
    for (double rho : {0., 0.9}) {
      const FitProblem exact = test::relaxation_record(middle);
      VecX truth(4);
      truth << 0.05, 0.4, middle, 0.2;
      Held held(4);
      for (int seed = 0; seed < records; ++seed)
        add(held,
            test::noisy(exact, 0.01 * test::largest_of(exact), rho,
                        static_cast<std::uint64_t>(seed)),
            truth, 100. / records);
      fmt::print("| {:g} | {} | {:.2f} | {:.0f} of {} | {} | {} | {} |\n", rho,
                 middle > 0 ? "there" : "not there", held.rho, held.effective,
                 exact.tests[0].points(), each(held.error), each(held.profile),
                 each(held.bootstrap));
      std::fflush(stdout);
    }
}
