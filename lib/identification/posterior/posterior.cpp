#include "identification/posterior/posterior.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/in_order.hpp"
#include "core/base/quantile.hpp"
#include "core/base/random.hpp"
#include "core/tensor/dense.hpp"
#include "identification/posterior/fit_density.hpp"
#include "identification/posterior/nuts.hpp"
#include "identification/statistics/study.hpp"
#include "results/store/curves_file.hpp"

namespace langer {

namespace {

void set_table(Posterior& result) {
  RecordTable& table = result.table;
  table.name = "posterior";
  table.row = "parameter";
  table.rows = result.names;
  for (const char* name : {"mean", "standard_deviation", "lower_95", "quartile_1", "median",
                           "quartile_3", "upper_95", "r_hat", "effective_samples"})
    table.column(name);
  for (std::size_t j = 0; j < result.names.size(); ++j) {
    const VecX column = result.samples.col(static_cast<Eigen::Index>(j));
    std::vector<double> sorted(column.data(), column.data() + column.size());
    std::sort(sorted.begin(), sorted.end());
    const double mean = column.mean();
    const auto n = static_cast<double>(column.size());
    table.column("mean").values.push_back(mean);
    const double square = (column.array() - mean).matrix().squaredNorm();
    table.column("standard_deviation").values.push_back(std::sqrt(square / (n - 1)));
    table.column("lower_95").values.push_back(quantile(sorted, 0.025));
    table.column("quartile_1").values.push_back(quantile(sorted, 0.25));
    table.column("median").values.push_back(quantile(sorted, 0.5));
    table.column("quartile_3").values.push_back(quantile(sorted, 0.75));
    table.column("upper_95").values.push_back(quantile(sorted, 0.975));
    table.column("r_hat").values.push_back(result.r_hat[j]);
    table.column("effective_samples").values.push_back(result.effective[j]);
  }
}

}  // namespace

Posterior posterior(const FitProblem& problem, const FitResult& fit, const PosteriorConfig& config,
                    int threads, const std::function<void(double)>& progress) {
  const int each = (config.samples + config.chains - 1) / config.chains;
  std::vector<NutsChain> chains(static_cast<std::size_t>(config.chains));
  const auto p = static_cast<Eigen::Index>(problem.free.size());
  const FitDensity first(problem, fit);
  in_order(
      std::min(threads, config.chains), config.chains,
      [&](int, int chain) {
        FitDensity density(problem, fit);
        VecX start = density.place(fit.best.p);
        const MatX scale = density.scale(start);
        // chains begin at different places, twice as far apart as the posterior is wide
        Random random(static_cast<std::uint64_t>(config.seed) + 77,
                      static_cast<std::uint64_t>(chain));
        VecX z(p);
        for (double& one : z) one = random.normal();
        const MatX root = Cholesky(scale).L();
        NutsOptions options;
        options.lower = density.lower_walls();
        options.upper = density.upper_walls();
        VecX begin = density.between_walls(start + 2 * (root * z));
        VecX gradient;
        for (int i = 0; i < 20 && !std::isfinite(density(begin, gradient)); ++i)
          begin = 0.5 * (begin + start);
        options.samples = each;
        options.warmup = config.warmup;
        options.seed = static_cast<std::uint64_t>(config.seed);
        options.chain = static_cast<std::uint64_t>(chain);
        options.acceptance = config.acceptance;
        const LogDensity of_fit = [&](const VecX& x, VecX& g) {
          return density(x, g);
        };
        chains[static_cast<std::size_t>(chain)] = sample_chain(of_fit, begin, scale, options);
      },
      [&](int, int chain) {
        if (progress) progress((chain + 1.) / config.chains);
      });
  Posterior result;
  result.names = parameter_names(problem);
  result.chains = config.chains;
  result.samples.resize(static_cast<Eigen::Index>(each) * config.chains, p);
  result.log_density.resize(result.samples.rows());
  Eigen::Index row = 0;
  for (const NutsChain& chain : chains) {
    for (Eigen::Index i = 0; i < chain.draws.rows(); ++i, ++row) {
      VecX numbers = first.numbers(chain.draws.row(i).transpose());
      first.turn_to_estimate(numbers);
      result.samples.row(row) = numbers.transpose();
      result.log_density[row] = chain.log_density[i];
    }
    result.divergences += chain.divergences;
    result.acceptance += chain.acceptance / config.chains;
  }
  summarise(result);
  return result;
}

void summarise(Posterior& posterior) {
  const Eigen::Index each = posterior.samples.rows() / posterior.chains;
  for (Eigen::Index j = 0; j < posterior.samples.cols(); ++j) {
    std::vector<VecX> chains;
    for (int chain = 0; chain < posterior.chains; ++chain)
      chains.emplace_back(posterior.samples.col(j).segment(chain * each, each));
    const Convergence c = convergence(chains);
    posterior.r_hat.push_back(c.r_hat);
    posterior.effective.push_back(c.effective);
  }
  set_table(posterior);
}

std::string posterior_csv(const Posterior& posterior) {
  std::string text = "chain";
  for (const std::string& name : posterior.names) text += "," + csv_cell(name);
  text += ",log_density\n";
  const Eigen::Index each = posterior.samples.rows() / posterior.chains;
  for (Eigen::Index i = 0; i < posterior.samples.rows(); ++i) {
    text += fmt::format("{}", i / each + 1);
    for (const double x : posterior.samples.row(i)) text += fmt::format(",{:.9g}", x);
    text += fmt::format(",{:.9g}\n", posterior.log_density[i]);
  }
  return text;
}

std::vector<std::string> posterior_lines(const Posterior& posterior) {
  std::vector<std::string> lines;
  lines.push_back(fmt::format(
      "posterior: {} samples of {} chains, acceptance {:.2f}, {} divergences",
      posterior.samples.rows(), posterior.chains, posterior.acceptance, posterior.divergences));
  RecordTable table = posterior.table;
  for (std::size_t j = 0; j < posterior.names.size(); ++j)
    lines.push_back(fmt::format(
        "{:>10}  median {:.5g}, 95 %: {:.5g} to {:.5g}; R-hat {:.4f}, {:.0f} effective samples",
        posterior.names[j], table.column("median").values[j], table.column("lower_95").values[j],
        table.column("upper_95").values[j], posterior.r_hat[j], posterior.effective[j]));
  return lines;
}

std::vector<std::string> posterior_warnings(const Posterior& posterior, const std::string& advice) {
  std::vector<std::string> lines;
  for (std::size_t j = 0; j < posterior.names.size(); ++j) {
    if (!(posterior.r_hat[j] < 1.01) || posterior.effective[j] < 400)
      lines.push_back(fmt::format(
          "the posterior of {} is not known well: R-hat {:.3f} (should be below 1.01), {:.0f} "
          "effective samples (400); {}",
          posterior.names[j], posterior.r_hat[j], posterior.effective[j], advice));
  }
  if (posterior.divergences > 0)
    lines.push_back(
        fmt::format("{} paths of the posterior diverged: acceptance: 0.95 takes smaller "
                    "steps; a number that rests on its bound makes such places",
                    posterior.divergences));
  return lines;
}

}  // namespace langer
