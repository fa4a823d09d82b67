// How often 95 % intervals hold the true parameters: 200 sets of three biaxial protocols with noise
// that is correlated along curves.
#include <fmt/format.h>

#include <cstdio>

#include "identification/fit/identifiability.hpp"
#include "support/correlated.hpp"

using namespace langer;

namespace {

struct Held {
  explicit Held(Eigen::Index n)
      : white(VecX::Zero(n)), error(white), profile(white), bootstrap(white) {}
  VecX white, error, profile, bootstrap;
  double rho = 0, effective = 0;
};

void add(Held& held, const FitProblem& q, const VecX& truth, double part) {
  const FitResult f = fit(q, {.starts = 1});
  const LeastSquares problem = least_squares_problem(q);
  const VecX factor = interval_factors(f.columns, f.left_out, f.noise);
  const VecX growth = growth_of_intervals(f.columns, f.left_out, f.noise);
  BootstrapOptions options;
  options.growth = growth.mean(), options.spread = growth / options.growth;
  options.samples = 100;
  const Bootstrap b =
      bootstrap([&] { return least_squares_problem(q); }, f.best.p, f.noise, options);
  const MatX before = covariance(f.best),
             white =
                 covariance(f.best.J, f.left_out, white_noise(f.noise.deviation, f.best.r.size()));
  for (int i = 0; i < truth.size(); ++i) {
    const double off = std::abs(f.best.p[i] - truth[i]);
    held.white[i] += part * (off <= 1.96 * std::sqrt(before(i, i)));
    held.error[i] +=
        part * (off <= 1.96 * factor[i] * std::sqrt(white(i, i)));  // none on its bound: not held
    held.profile[i] += part * (profile_rise(problem, i, truth[i], f.best.p,
                                            f.noise.deviation * factor[i]) <= 3.8415);
    held.bootstrap[i] += part * (b.low[i] <= truth[i] && truth[i] <= b.high[i]);
  }
  held.rho += 0.01 * part * f.noise.rho, held.effective += 0.01 * part * f.noise.effective;
}

std::string range(const VecX& v) {
  return fmt::format("{:.0f} to {:.0f}", v.minCoeff(), v.maxCoeff());
}

}  // namespace

void measure_coverage() {
  constexpr int seeds = 200;
  fmt::print(
      "intervals of 95 %, held of 100 (lowest and highest of the parameters), {} sets\n"
      "| points a curve | rho | found | values count as | as if independent | standard errors | profiles | bootstrap |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- |\n",
      seeds);
  for (int n : {20, 60})
    for (double rho : {0., 0.5, 0.9, 0.95}) {
      const FitProblem exact = test::protocols(n);
      VecX truth(5);
      for (int i = 0; i < 5; ++i) truth[i] = exact.free[static_cast<std::size_t>(i)].start;
      Held held(5);
      for (int seed = 0; seed < seeds; ++seed)
        add(held,
            test::noisy(exact, 0.005 * test::largest_of(exact), rho,
                        static_cast<std::uint64_t>(seed)),
            truth, 100. / seeds);
      fmt::print("| {} | {:g} | {:.2f} | {:.0f} of {} | {} | {} | {} | {} |\n", n, rho, held.rho,
                 held.effective, 6 * n, range(held.white), range(held.error), range(held.profile),
                 range(held.bootstrap));
      std::fflush(stdout);
    }
  // a law that cannot follow the curves: neo-Hooke and a fibre; true are the numbers nearest to the
  // exact curves
  FitProblem exact = test::protocols(30);
  exact.free.erase(exact.free.begin() + 1);
  std::get<Yeoh>(exact.law.matrix[0]).a2 = 0;
  std::get<Yeoh>(exact.law.matrix[0]).a3 = 0;
  const VecX truth = fit(exact, {.starts = 3}).best.p;
  Held held(4);
  for (int seed = 0; seed < seeds; ++seed)
    add(held,
        test::noisy(exact, 0.005 * test::largest_of(exact), 0, static_cast<std::uint64_t>(seed)),
        truth, 100. / seeds);
  fmt::print(
      "| 30, law misses by more than the noise | 0 | {:.2f} | {:.0f} of 180 | {} | {} | {} | {} |\n",
      held.rho, held.effective, range(held.white), range(held.error), range(held.profile),
      range(held.bootstrap));
}

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
