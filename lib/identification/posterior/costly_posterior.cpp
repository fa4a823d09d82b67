#include "identification/posterior/costly_posterior.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "core/base/error.hpp"
#include "core/base/random.hpp"
#include "core/tensor/dense.hpp"
#include "identification/posterior/fit_density.hpp"

namespace langer {

namespace {

constexpr int highest_degree = 5;
constexpr double first_width = 1.5;  // of the first points, in deviations of the estimate
constexpr std::size_t checks_each = 30;
// Fewer runs make samples whose quantiles are known worse than those of polynomials.
constexpr std::size_t fewest_proposals = 500;

// Runs the costly tests at sets of parameters, and keeps what they give.
class Runs {
 public:
  Runs(const CostlyTests& costly, const FitResult& fit)
      : costly_(costly), truth_(costly.problem_with(costly.tests), fit) {}

  // Points whose run has no end are left out.
  std::vector<ModelPoint> at(const std::vector<VecX>& numbers) {
    if (costly_.run_ahead) costly_.run_ahead(numbers);
    std::vector<ModelPoint> points;
    for (const VecX& p : numbers) {
      ModelPoint point{p, {}, {}};
      ++made;
      if (costly_.tests->model(p, point.values) && costly_.tests->slope(p, point.slope)) {
        points.push_back(std::move(point));
      } else {
        ++without;
      }
    }
    return points;
  }

  // ln of the density of each set of parameters by the tests themselves
  VecX log_densities(std::span<const VecX> points) {
    VecX all(static_cast<Eigen::Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i)
      all[static_cast<Eigen::Index>(i)] = truth_.of_parameters(points[i]);
    return all;
  }
  FitDensity& truth() { return truth_; }

  int made = 0, without = 0;

 private:
  const CostlyTests& costly_;
  FitDensity truth_;
};

// ln of the density of the scenes, `truth`, over that of polynomials, at each point
VecX log_ratios(const VecX& truth, const FitProblem& approximate, const FitResult& fit,
                std::span<const VecX> points) {
  FitDensity density(approximate, fit);
  VecX ratios = truth;
  for (std::size_t i = 0; i < points.size(); ++i)
    ratios[static_cast<Eigen::Index>(i)] -= density.of_parameters(points[i]);
  return ratios;
}

// The standard deviation of the ratios over their mean. A point without a run's end has ratio 0.
double shift_of(const VecX& log_ratios) {
  const double largest = log_ratios.maxCoeff();
  if (!std::isfinite(largest)) return std::numeric_limits<double>::infinity();
  const VecX w = (log_ratios.array() - largest).exp();
  const double mean = w.mean();
  const auto n = static_cast<double>(w.size());
  return std::sqrt((w.array() - mean).square().sum() / (n - 1)) / mean;
}

// The share of proposals that Metropolis' rule would refuse. Single samples that are far off weigh
// less in it than in the shift.
double refused_of(const VecX& log_ratios) {
  double accepted = 0;
  for (const double now : log_ratios)
    for (const double next : log_ratios)
      if (std::isfinite(next)) accepted += std::exp(std::min(0., next - now));
  return 1 - accepted / static_cast<double>(log_ratios.size() * log_ratios.size());
}

std::vector<VecX> numbers_of(std::span<const ModelPoint> points) {
  std::vector<VecX> all;
  for (const ModelPoint& point : points) all.push_back(point.p);
  return all;
}

// The degree whose polynomials of the first `known` points predict the others best. Polynomials
// have at most half as many coefficients as there are values and slopes.
int best_degree(const CostlyTests& costly, Runs& runs, const FitResult& fit,
                const std::vector<ModelPoint>& points, std::size_t known) {
  const std::vector<ModelPoint> first(points.begin(),
                                      points.begin() + static_cast<std::ptrdiff_t>(known));
  const std::vector<VecX> others = numbers_of(std::span(points).subspan(known));
  const VecX truth = runs.log_densities(others);
  const Eigen::Index n = points.front().p.size();
  int best = 1;
  double least = std::numeric_limits<double>::infinity();
  for (int degree = 1; degree <= highest_degree; ++degree) {
    if (degree > 1 && 2 * coefficients(n, degree) > known * static_cast<std::size_t>(n + 1)) break;
    const auto tests = std::make_shared<PolynomialTests>(*costly.tests, first, degree);
    const VecX ratios = log_ratios(truth, costly.problem_with(tests), fit, others);
    // spread of the ratios; unlike the shift it tells apart what is far off
    const double spread = (ratios.array() - ratios.mean()).matrix().norm();
    // of two that are alike the simpler one
    if (spread < 0.9 * least) {
      least = spread;
      best = degree;
    }
  }
  return best;
}

// Places around the estimate, as wide as the model that is straight there would have its posterior.
std::vector<VecX> first_points(FitDensity& density, const FitResult& fit, std::size_t count,
                               std::uint64_t seed) {
  const VecX centre = density.place(fit.best.p);
  const MatX root = Cholesky(density.scale(centre)).L();
  std::vector<VecX> points{density.numbers(centre)};
  for (std::size_t i = 1; i < count; ++i) {
    Random random(seed + 991, i);
    VecX z(centre.size());
    for (double& one : z) one = random.normal();
    points.push_back(density.numbers(density.between_walls(centre + first_width * (root * z))));
  }
  return points;
}

std::vector<VecX> some_samples(const Posterior& sampled, std::size_t count, std::uint64_t seed,
                               std::uint64_t round) {
  Random random(seed + 443, round);
  std::vector<VecX> points;
  for (std::size_t i = 0; i < count; ++i) {
    const auto row = random.below(static_cast<std::uint64_t>(sampled.samples.rows()));
    points.emplace_back(sampled.samples.row(static_cast<Eigen::Index>(row)).transpose());
  }
  return points;
}

// All samples in a random order.
std::vector<VecX> shuffled(const Posterior& sampled, std::uint64_t seed) {
  std::vector<VecX> all;
  for (Eigen::Index i = 0; i < sampled.samples.rows(); ++i)
    all.emplace_back(sampled.samples.row(i).transpose());
  Random random(seed + 167);
  for (std::size_t i = all.size(); i > 1; --i) std::swap(all[i - 1], all[random.below(i)]);
  return all;
}

// Metropolis' chains whose proposals are independent samples of the polynomials: an accepted one
// replaces the last sample, a refused one repeats it.
void accept_by_runs(const CostlyTests& costly, Runs& runs, const FitProblem& approximate,
                    const FitResult& fit, const PosteriorConfig& config, int threads,
                    std::size_t budget, const std::function<void(double)>& progress,
                    CostlyPosterior& result) {
  constexpr Eigen::Index not_counted = 5;  // of each chain: its start is a proposal
  constexpr int thinning = 4;              // so that neighbours are independent
  const auto seed = static_cast<std::uint64_t>(config.seed);
  const auto chains = static_cast<std::size_t>(config.chains);
  const std::size_t count = std::min(budget, static_cast<std::size_t>(config.samples));
  PosteriorConfig longer = config;
  longer.samples = thinning * static_cast<int>(count);
  result.posterior = posterior(approximate, fit, longer, threads);
  Posterior& sampled = result.posterior;
  std::vector<VecX> proposals = shuffled(sampled, seed);
  proposals.resize(count / chains * chains);
  for (std::size_t done = 0; done < proposals.size(); done += checks_each) {
    const std::size_t end = std::min(done + checks_each, proposals.size());
    if (costly.run_ahead)
      costly.run_ahead({proposals.begin() + static_cast<std::ptrdiff_t>(done),
                        proposals.begin() + static_cast<std::ptrdiff_t>(end)});
    if (progress) progress(static_cast<double>(end) / static_cast<double>(proposals.size()));
  }
  runs.made += static_cast<int>(proposals.size());
  const VecX truth = runs.log_densities(proposals);
  const VecX ratios = log_ratios(truth, approximate, fit, proposals);
  const auto each = static_cast<Eigen::Index>(proposals.size() / chains);
  const Eigen::Index counted = each - not_counted;
  sampled.samples.resize(counted * sampled.chains, fit.best.p.size());
  sampled.log_density.resize(sampled.samples.rows());
  int accepted = 0;
  for (Eigen::Index chain = 0; chain < sampled.chains; ++chain) {
    Random random(seed + 613, static_cast<std::uint64_t>(chain));
    Eigen::Index current = chain * each;
    for (Eigen::Index i = 0; i < each; ++i) {
      const Eigen::Index next = chain * each + i;
      if (!std::isfinite(ratios[next])) ++runs.without;
      const double draw = std::log(1 - random.uniform());
      const bool better = ratios[next] - ratios[current] > draw;
      if (i == 0 || better || !std::isfinite(ratios[current])) {
        current = next;
        ++accepted;
      }
      if (i < not_counted) continue;
      const Eigen::Index row = chain * counted + i - not_counted;
      const VecX& p = proposals[static_cast<std::size_t>(current)];
      sampled.samples.row(row) = p.transpose();
      sampled.log_density[row] = truth[current] + runs.truth().log_slope(runs.truth().place(p));
    }
  }
  result.proposals = static_cast<int>(proposals.size());
  result.accepted = static_cast<double>(accepted) / static_cast<double>(proposals.size());
  sampled.divergences = 0;
  sampled.acceptance = result.accepted;
  sampled.r_hat.clear();
  sampled.effective.clear();
  sampled.table = RecordTable{};
  summarise(sampled);
}

}  // namespace

CostlyPosterior costly_posterior(const CostlyTests& costly, const FitResult& fit,
                                 const PosteriorConfig& config, int threads,
                                 const std::function<void(const std::string&)>& say,
                                 const std::function<void(double)>& progress) {
  constexpr double better = 0.8;       // of what was refused: worth another polynomial
  constexpr int fruitless_rounds = 2;  // in a row, after which polynomials are as good as they get
  const auto seed = static_cast<std::uint64_t>(config.seed);
  const auto budget = static_cast<std::size_t>(config.runs);
  const auto n = fit.best.p.size();
  Runs runs(costly, fit);
  // enough for a polynomial of degree two, and a third of them to judge it
  const std::size_t begin = std::max<std::size_t>(24, 3 * coefficients(n, 2) / 2);
  std::vector<ModelPoint> points =
      runs.at(first_points(runs.truth(), fit, std::min(begin, budget - checks_each), seed));
  std::size_t known = 2 * points.size() / 3;
  if (known < static_cast<std::size_t>(n) + 1)
    throw Failure(
        Exit::not_converged,
        Error{{},
              "study.posterior",
              fmt::format("{} of {} runs around the estimate have no end", runs.without, runs.made),
              "runs with an end",
              "shorter increments of the scenes, narrower bounds or priors, or more "
              "study.posterior.runs"});
  CostlyPosterior best;
  FitProblem best_problem;
  double least_refused = std::numeric_limits<double>::infinity();
  int fruitless = 0;
  for (std::uint64_t round = 0;; ++round) {
    CostlyPosterior now;
    now.degree = best_degree(costly, runs, fit, points, known);
    const auto tests = std::make_shared<PolynomialTests>(*costly.tests, points, now.degree);
    const FitProblem approximate = costly.problem_with(tests);
    now.polynomials = tests;
    now.posterior = posterior(approximate, fit, config, threads);
    const std::vector<VecX> samples = some_samples(now.posterior, checks_each, seed, round);
    const std::vector<ModelPoint> checked = runs.at(samples);
    const VecX ratios = log_ratios(runs.log_densities(samples), approximate, fit, samples);
    const double refused = refused_of(ratios);
    now.shift = shift_of(ratios);
    now.checks = static_cast<int>(samples.size());
    now.reached = now.shift <= config.shift;
    if (say)
      say(
          fmt::format("posterior: polynomials of degree {} of {} runs: means off by at most {:.2g} "
                      "deviations, {:.0f} % of the samples refused",
                      now.degree, points.size(), now.shift, 100 * refused));
    ++fruitless;
    if (refused < better * least_refused) fruitless = 0;
    if (refused < least_refused) {
      least_refused = refused;
      best = std::move(now);
      best_problem = approximate;
    }
    const bool spent = static_cast<std::size_t>(runs.made) + checks_each > budget;
    if (best.reached || spent || checked.empty() || fruitless == fruitless_rounds) break;
    known = points.size();
    points.insert(points.end(), checked.begin(), checked.end());
  }
  const std::size_t left = budget - std::min(budget, static_cast<std::size_t>(runs.made));
  if (!best.reached && left >= fewest_proposals)
    accept_by_runs(costly, runs, best_problem, fit, config, threads, left, progress, best);
  best.runs = runs.made;
  best.without = runs.without;
  return best;
}

std::vector<std::string> costly_posterior_lines(const CostlyPosterior& sampled) {
  std::vector<std::string> lines = posterior_lines(sampled.posterior);
  if (sampled.proposals > 0) {
    lines.push_back(
        fmt::format("posterior: {} samples were proposed by polynomials of degree {} and judged by "
                    "runs, {:.0f} % accepted; {} runs in all",
                    sampled.proposals, sampled.degree, 100 * sampled.accepted, sampled.runs));
  } else {
    lines.push_back(
        fmt::format("posterior: of polynomials of degree {} to {} runs; by {} of these at samples "
                    "means are off by at most {:.2g} standard deviations",
                    sampled.degree, sampled.runs, sampled.checks, sampled.shift));
  }
  return lines;
}

std::vector<std::string> costly_posterior_warnings(const CostlyPosterior& sampled,
                                                   const PosteriorConfig& config) {
  const bool of_polynomials = sampled.proposals == 0;
  std::vector<std::string> lines;
  if (of_polynomials) {
    lines = posterior_warnings(sampled.posterior);
  } else {
    lines = posterior_warnings(sampled.posterior, "allow more runs (study.posterior.runs)");
  }
  if (!sampled.reached && of_polynomials)
    lines.push_back(fmt::format(
        "means of the posterior may be off by {:.2g} standard deviations (asked: {:g}) after {} "
        "runs: allow more of them (study.posterior.runs), or narrower bounds or priors where a "
        "parameter is hardly known",
        sampled.shift, config.shift, sampled.runs));
  if (sampled.without > 0)
    lines.push_back(fmt::format(
        "{} of {} runs of the posterior have no end: what they would measure is not known there",
        sampled.without, sampled.runs));
  return lines;
}

}  // namespace langer
