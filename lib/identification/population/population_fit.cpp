#include "identification/population/population_fit.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "core/base/error.hpp"
#include "core/base/in_order.hpp"
#include "core/base/quantile.hpp"
#include "core/base/random.hpp"
#include "core/base/student.hpp"
#include "core/base/text.hpp"
#include "core/tensor/dense.hpp"
#include "identification/fit/noise_model.hpp"
#include "identification/fit/periodic.hpp"
#include "identification/fit/residual_noise.hpp"
#include "identification/population/chi_square.hpp"
#include "identification/population/link.hpp"
#include "identification/population/mean_curves.hpp"
#include "identification/population/mixed_model.hpp"
#include "identification/posterior/posterior.hpp"
#include "identification/setup/specimen_table.hpp"
#include "results/store/curves_file.hpp"

namespace langer {

namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

// One specimen: its tests, and its residuals with the weights of the noise model.
struct Individual {
  std::string id;
  FitProblem problem;
  LeastSquares model;
  VecX measured;  // weighted
  std::vector<Eigen::Index> curves;
  std::vector<bool> rest;
  VecX scale;      // 1/s of each value
  double rho = 0;  // along each curve
};

// Stresses of 0 in the undeformed state. They are exact, so they say nothing of the noise.
std::vector<bool> zeros_at_rest(const std::vector<Test>& tests) {
  std::vector<bool> all;
  for (const Test& test : tests) {
    const double rest = deformation_at(test.kind, 0);
    for (const auto* list : {&test.stress_x, &test.stress_z}) {
      for (std::size_t i = 0; i < list->size(); ++i) {
        all.push_back((*list)[i] == 0 && test.first[i] == rest && test.second_at(i) == 1);
      }
    }
  }
  return all;
}

// How each parameter varies between specimens.
std::vector<Link> links_of(const FitProblem& problem) {
  Material law = problem.law;
  const std::vector<MaterialParameter> known = parameters(law);
  std::vector<Link> links;
  for (const FreeParameter& p : problem.free) {
    const auto number = std::ranges::find(known, p.key, &MaterialParameter::key);
    Link link;
    const bool angle = number != known.end() && number->unit == std::string(unit::deg);
    if (number != known.end() && !angle && p.lower >= 0) {
      link.kind = LinkKind::log;
      if (std::isfinite(number->range.high) && std::isfinite(number->range.low)) {
        link.kind = LinkKind::logit;
        link.lower = std::max(p.lower, number->range.low);
        link.upper = std::min(p.upper, number->range.high);
      }
    }
    links.push_back(link);
  }
  return links;
}

// The same box for every specimen: what the link allows, not what the search of one fit does.
void widen(LeastSquares& model, const std::vector<Link>& links) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < links.size(); ++j) {
    const auto at = static_cast<Eigen::Index>(j);
    model.lower[at] = -infinity;
    model.upper[at] = infinity;
    if (links[j].kind == LinkKind::log) {
      model.lower[at] = 0;
    } else if (links[j].kind == LinkKind::logit) {
      model.lower[at] = links[j].lower;
      model.upper[at] = links[j].upper;
    }
  }
}

// Everything that the steps of the estimation share.
class Population {
 public:
  Population(const FitConfig& config, const std::function<Place(const std::string&)>& at)
      : config_(config), at_(at) {
    table_ = read_specimen_table(config.specimens->table.path, config.specimens->id);
    for (const std::string& id : table_.ids) {
      add_individual(id);
    }
    links_ = links_of(individuals_.front().problem);
    for (Individual& one : individuals_) {
      widen(one.model, links_);
    }
    Material law = config.law;
    const std::vector<MaterialParameter> known = parameters(law);
    for (const FreeParameter& p : individuals_.front().problem.free) {
      const auto number = std::ranges::find(known, p.key, &MaterialParameter::key);
      names_.push_back(number->name);
      units_.push_back(number->unit);
      keys_.push_back(p.key);
      const auto& shared = config.specimens->shared;
      varies_.push_back(std::ranges::find(shared, p.key) == shared.end());
    }
    check_number();
    make_design();
  }

  std::size_t size() const { return individuals_.size(); }
  Eigen::Index numbers() const { return static_cast<Eigen::Index>(links_.size()); }
  Eigen::Index varying() const { return std::ranges::count(varies_, true); }

  VecX forward(const VecX& theta) const {
    VecX phi(numbers());
    for (Eigen::Index j = 0; j < numbers(); ++j) {
      const auto k = static_cast<std::size_t>(j);
      phi[j] = links_[k].forward(theta[j], least_);
    }
    return phi;
  }
  VecX backward(const VecX& phi) const {
    VecX theta(numbers());
    for (Eigen::Index j = 0; j < numbers(); ++j) {
      theta[j] = links_[static_cast<std::size_t>(j)].backward(phi[j]);
    }
    return theta;
  }

  // residuals of one specimen and their slope, weighted
  bool residual(std::size_t i, const VecX& phi, VecX& u, MatX* slope) {
    Individual& one = individuals_[i];
    const VecX theta = backward(phi);
    if (!theta.allFinite() || !one.model.residual(theta, u) || !u.allFinite()) {
      return false;
    }
    if (slope) {
      for (Eigen::Index j = 0; j < numbers(); ++j) {
        const bool identity = links_[static_cast<std::size_t>(j)].kind == LinkKind::identity;
        double size = std::abs(theta[j]);
        if (identity) size = std::max(size, 1e-3 * std::abs(typical_[j]));
        one.model.typical[j] = std::max(size, 1e-12);
      }
      if (!jacobian(one.model, theta, *slope) || !slope->allFinite()) {
        return false;
      }
      for (Eigen::Index j = 0; j < numbers(); ++j) {
        slope->col(j) *= links_[static_cast<std::size_t>(j)].slope(phi[j]);
      }
      *slope = weighted(one, *slope);
    }
    u = weighted(one, u);
    return true;
  }

  // Weights of the noise of largest likelihood at these numbers.
  void reweigh(const std::vector<VecX>& phi, NoiseKind kind) {
    std::vector<double> e_all, f_all;
    std::vector<Eigen::Index> curves;
    std::vector<bool> rest;
    std::vector<VecX> e(size());
    for (std::size_t i = 0; i < size(); ++i) {
      Individual& one = individuals_[i];
      if (!one.model.residual(backward(phi[i]), e[i])) return;
      e_all.insert(e_all.end(), e[i].data(), e[i].data() + e[i].size());
      f_all.insert(f_all.end(), one.measured.data(), one.measured.data() + one.measured.size());
      curves.insert(curves.end(), one.curves.begin(), one.curves.end());
      rest.insert(rest.end(), one.rest.begin(), one.rest.end());
    }
    const auto n = static_cast<Eigen::Index>(e_all.size());
    const VecX residuals = Eigen::Map<const VecX>(e_all.data(), n);
    const VecX measured = Eigen::Map<const VecX>(f_all.data(), n);
    noise_ = NoiseModel{};
    noise_.kind = kind;
    if (kind != NoiseKind::white) {
      noise_ = most_likely_noise(residuals, measured, curves, rest, kind);
    }
    const double reference = std::max(1e-300, measured.norm() / std::sqrt(static_cast<double>(n)));
    log_weights_ = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      Individual& one = individuals_[i];
      one.rho = noise_.rho;
      const VecX f = (e[i] + one.measured) / reference;
      const VecX square = (1 - noise_.share) + noise_.share * f.array().square();
      one.scale = square.cwiseSqrt().cwiseInverse();
      log_weights_ += square.array().log().sum();
      log_weights_ -= static_cast<double>(one.curves.size()) * std::log1p(-one.rho * one.rho);
    }
  }

  // Samples of the population and its scatter, of an estimate with all columns.
  MixedDraws draws(const MixedResult& result, NoiseKind kind, const PosteriorConfig& config) {
    const auto [specimens, options] = mixed_problem(kind, design_columns());
    std::vector<VecX> modes;
    for (std::size_t i = 0; i < size(); ++i)
      modes.push_back(design_[i] * result.beta + result.b[i]);
    reweigh(modes, kind);
    return mixed_posterior(specimens, result, options, config, config_.jobs);
  }

  std::vector<Eigen::Index> design_columns() const {
    std::vector<Eigen::Index> columns(static_cast<std::size_t>(design_.front().cols()));
    std::iota(columns.begin(), columns.end(), 0);
    return columns;
  }

  std::pair<std::vector<MixedSpecimen>, MixedOptions> mixed_problem(
      NoiseKind kind, const std::vector<Eigen::Index>& columns) {
    std::vector<MixedSpecimen> specimens;
    for (std::size_t i = 0; i < size(); ++i) {
      specimens.push_back(
          {[this, i](const VecX& phi, VecX& u, MatX* slope) { return residual(i, phi, u, slope); },
           design_[i](Eigen::all, columns)});
    }
    MixedOptions options;
    options.varies = varies_;
    options.full = config_.specimens->scatter == Scatter::full;
    options.threads = config_.jobs;
    options.largest_deviation = VecX::Constant(numbers(), 1e300);
    for (Eigen::Index j = 0; j < numbers(); ++j) {
      const auto at = static_cast<std::size_t>(j);
      // a factor of 20 either way in two specimens of three, or any angle, is no scatter
      if (links_[at].kind != LinkKind::identity) options.largest_deviation[j] = 3;
      if (units_[at] == unit::deg) options.largest_deviation[j] = 60;
    }
    options.reweigh = [this, kind](const std::vector<VecX>& phi) {
      reweigh(phi, kind);
    };
    return {std::move(specimens), std::move(options)};
  }

  // The mixed model with these columns of its design left out.
  MixedResult estimate(const MixedState& start, NoiseKind kind,
                       const std::vector<Eigen::Index>& columns) {
    const auto [specimens, options] = mixed_problem(kind, columns);
    MixedResult result = fit_mixed_model(specimens, start, options);
    std::string unlimited;
    for (const Eigen::Index j : result.unlimited)
      append(unlimited, ", ", names_[static_cast<std::size_t>(j)]);
    if (!unlimited.empty())
      result.why = "the scatter of " + unlimited +
                   " grows without limit: the tests do not know it, or specimens lie on its bound";
    turn_angles_into_box(result);
    if (const std::string why = not_a_result(result, options); result.converged && !why.empty()) {
      result.converged = false;
      result.why = why;
    }
    result.minus_two_log_likelihood += log_weights_;
    result.likelihood_parameters += noise_.parameters();
    return result;
  }

  const FitConfig& config_;
  std::function<Place(const std::string&)> at_;
  SpecimenTable table_;
  std::vector<Individual> individuals_;
  std::vector<Link> links_;
  std::vector<std::string> names_, units_, keys_;
  std::vector<bool> varies_;
  std::vector<MatX> design_;
  struct Effect {
    std::size_t covariate;
    std::string name;  // age, site=ventral
    Eigen::Index number;
  };
  std::vector<Effect> effects_;  // columns of the design behind those of the population
  std::vector<CovariateColumns> covariates_;
  VecX typical_;
  NoiseModel noise_;
  double log_weights_ = 0;
  double least_ = 1e-6;

 private:
  // Angles that come again after half a turn are given within their box.
  void turn_angles_into_box(MixedResult& result) const {
    const Individual& first = individuals_.front();
    for (Eigen::Index j = 0; j < numbers(); ++j) {
      const FreeParameter& free = first.problem.free[static_cast<std::size_t>(j)];
      const double period = first.model.period_of(j);
      if (period > 0) result.beta[j] = into_box(result.beta[j], period, free.lower, free.upper);
    }
  }

  // Why the end of a search is no result: a median that the tests do not know, or one outside the
  // bounds that were given. Empty: it is one.
  std::string not_a_result(const MixedResult& result, const MixedOptions& options) const {
    for (Eigen::Index j = 0; j < numbers(); ++j) {
      const auto at = static_cast<std::size_t>(j);
      const double error = std::sqrt(result.beta_covariance(j, j));
      if (!(error <= options.largest_deviation[j]))
        return fmt::format("the tests do not know the median of {}: its interval is wider than {}",
                           names_[at], units_[at] == unit::deg ? "all angles" : "any bounds");
      const FreeParameter& free = individuals_.front().problem.free[at];
      const double median = links_[at].backward(result.beta[j]);
      const double margin = 1e-9 * std::max(std::abs(free.lower), std::abs(median));
      if (!(median >= free.lower - margin && median <= free.upper + margin))
        return fmt::format("the median of {}, {:.4g}, is outside its bounds {:.4g} to {:.4g}",
                           names_[at], median, free.lower, free.upper);
    }
    return "";
  }

  void add_individual(const std::string& id) {
    FitConfig own = config_;
    own.specimens.reset();
    std::erase_if(own.data, [&](const FitData& data) { return data.specimen != id; });
    if (own.data.empty()) {
      throw Failure(Exit::config,
                    Error{at_("specimens"), "specimens", fmt::format("no test of {}", id),
                          "the tests of each specimen of the table",
                          "the table has changed since `data` was made of it: plan the run again"});
    }
    Individual one;
    one.id = id;
    one.problem = fit_problem(own);
    one.problem.noise = NoiseKind::white;
    one.model = least_squares_problem(one.problem);
    one.measured = weights(one.problem.tests).cwiseProduct(measured_stress(one.problem.tests));
    one.curves = curve_sizes(one.problem);
    one.rest = zeros_at_rest(one.problem.tests);
    one.scale = VecX::Ones(one.measured.size());
    individuals_.push_back(std::move(one));
  }

  void check_number() const {
    const auto needed = static_cast<std::size_t>(varying()) + 1;
    if (config_.specimens->scatter == Scatter::full && size() < needed) {
      throw Failure(
          Exit::config,
          Error{
              at_("specimens"), "specimens.scatter",
              fmt::format("{} specimens for the correlations of {} parameters", size(), varying()),
              fmt::format("{} specimens at least", needed),
              "scatter: diagonal has no correlations; `shared` names parameters that do not vary"});
    }
  }

  void make_design() {
    const auto& asked = config_.specimens->covariates;
    std::vector<std::pair<Effect, std::vector<double>>> columns;
    for (std::size_t c = 0; c < asked.size(); ++c) {
      const std::string key = fmt::format("specimens.covariates[{}]", c);
      covariates_.push_back(covariate_columns(table_, asked[c].column, at_(key)));
      const CovariateColumns& one = covariates_.back();
      for (std::size_t k = 0; k < one.names.size(); ++k) {
        for (Eigen::Index j = 0; j < numbers(); ++j) {
          const auto at = static_cast<std::size_t>(j);
          const auto& on = asked[c].on;
          const bool wanted =
              on.empty() ? varies_[at] : std::ranges::find(on, keys_[at]) != on.end();
          if (wanted) columns.push_back({{c, one.names[k], j}, one.values[k]});
        }
      }
    }
    const auto q = numbers();
    const auto more = static_cast<Eigen::Index>(columns.size());
    for (std::size_t i = 0; i < size(); ++i) {
      MatX A = MatX::Zero(q, q + more);
      A.leftCols(q).setIdentity();
      for (Eigen::Index c = 0; c < more; ++c) {
        const auto& [effect, values] = columns[static_cast<std::size_t>(c)];
        A(effect.number, q + c) = values[i];
      }
      design_.push_back(A);
    }
    for (const auto& [effect, values] : columns) effects_.push_back(effect);
  }

  static MatX weighted(const Individual& one, const MatX& A) {
    const MatX scaled = one.scale.asDiagonal() * A;
    if (one.rho == 0) return scaled;
    return innovations(scaled, one.curves, one.rho);
  }
};

double median_of(std::vector<double> values) {
  std::ranges::sort(values);
  return quantile(values, 0.5);
}

// Where the estimation begins, and the two estimates that are often made in its place.
struct First {
  VecX of_mean_curve, average;  // numbers themselves
  MixedState state;
  std::vector<VecX> fits;  // of each specimen; empty where it has no optimum
};

// Fits one material to the mean of all specimens' curves. It is biased where curves are not linear
// in the parameters, but it is close enough to begin with.
FitResult fit_of_mean_curves(const Population& all) {
  FitProblem problem = all.individuals_.front().problem;
  std::vector<std::vector<Test>> tests;
  for (const Individual& one : all.individuals_) tests.push_back(one.problem.tests);
  problem.tests = mean_curves(tests);
  if (problem.tests.empty()) {
    // no test that all have: the specimen with most values
    const auto largest = std::ranges::max_element(
        all.individuals_, {}, [](const Individual& one) { return one.measured.size(); });
    problem.tests = largest->problem.tests;
  }
  const FitConfig& config = all.config_;
  return fit(problem, {config.searches(), static_cast<unsigned>(config.seed), {}});
}

// Begins with the mean curve, then fits each specimen alone. The mean and the scatter of these fits
// are the first estimate of the mixed model.
First first_estimates(Population& all) {
  First first;
  const FitResult mean = fit_of_mean_curves(all);
  if (!std::isfinite(mean.best.cost)) {
    throw Failure(Exit::not_converged,
                  Error{all.at_("parameters"), "parameters",
                        "the mean of the specimens' curves has no fit: " + mean.best.why, "",
                        "other start values or bounds"});
  }
  const auto q = all.numbers();
  first.of_mean_curve = mean.best.p;
  all.typical_ = mean.best.p.cwiseAbs().cwiseMax(1e-3);
  first.fits.resize(all.size());
  std::vector<double> squares(all.size(), 0), freedom(all.size(), 0);
  in_order(
      all.config_.jobs, static_cast<int>(all.size()),
      [&](int, int job) {
        const auto i = static_cast<std::size_t>(job);
        FitProblem problem = all.individuals_[i].problem;
        for (std::size_t j = 0; j < problem.free.size(); ++j) {
          FreeParameter& p = problem.free[j];
          p.start = std::clamp(mean.best.p[static_cast<Eigen::Index>(j)], p.lower, p.upper);
        }
        if (all.individuals_[i].measured.size() <= q) return;
        const FitResult found = fit(problem, {1, 1, {}});
        if (!found.best.converged) return;
        first.fits[i] = found.best.p;
        for (Eigen::Index j = 0; j < q; ++j) {
          const double turn = all.individuals_[i].model.period_of(j);
          if (!(turn > 0)) continue;
          double& angle = first.fits[i][j];
          angle -= turn * std::round((angle - mean.best.p[j]) / turn);
        }
        squares[i] = 2 * found.best.cost;
        freedom[i] = static_cast<double>(found.best.r.size() - q);
      },
      [](int, int) {});

  // numbers on a bound of 0 begin a little above it
  all.least_ = 1e-6;
  const VecX phi_mean = all.forward(first.of_mean_curve.cwiseMax(-1e300));
  first.average = VecX::Zero(q);
  MatX omega = MatX::Zero(q, q);
  VecX centre = phi_mean;
  int fits = 0;
  for (const VecX& p : first.fits) {
    if (p.size() == 0) continue;
    first.average += p;
    ++fits;
  }
  if (fits > 0) {
    first.average /= fits;
  } else {
    first.average.setConstant(not_known);
  }
  for (Eigen::Index j = 0; j < q; ++j) {
    const auto at = static_cast<std::size_t>(j);
    const LinkKind kind = all.links_[at].kind;
    std::vector<double> values;
    for (const VecX& p : first.fits) {
      if (p.size() > 0) values.push_back(all.forward(p)[j]);
    }
    double spread = 0.3;
    double least = 0.05;
    double most = 1;
    if (kind == LinkKind::identity) {
      const double size = std::max(std::abs(first.of_mean_curve[j]), 1e-3);
      const bool angle = all.units_[at] == unit::deg;
      spread = angle ? 5 : 0.3 * size;
      least = angle ? 1 : 0.05 * size;
      most = angle ? 20 : size;
    }
    if (values.size() >= 3) {
      const double middle = median_of(values);
      std::vector<double> off;
      for (const double value : values) off.push_back(std::abs(value - middle));
      spread = 1.4826 * median_of(off);
      const double shift = std::clamp(middle - phi_mean[j], -2 * most, 2 * most);
      centre[j] = phi_mean[j] + shift;
    }
    spread = std::clamp(spread, least, most);
    omega(j, j) = spread * spread;
  }
  first.state.beta = VecX::Zero(all.design_.front().cols());
  first.state.beta.head(q) = centre;
  first.state.omega = omega;
  const double values = std::accumulate(freedom.begin(), freedom.end(), 0.);
  const double square = std::accumulate(squares.begin(), squares.end(), 0.);
  first.state.sigma = std::sqrt(square / std::max(values, 1.));
  double largest = 0;
  for (const Individual& one : all.individuals_)
    largest = std::max(largest, one.measured.cwiseAbs().maxCoeff());
  first.state.sigma = std::max(first.state.sigma, 1e-6 * largest);
  return first;
}

std::vector<Eigen::Index> all_columns(const Population& all) {
  std::vector<Eigen::Index> columns;
  for (Eigen::Index c = 0; c < all.design_.front().cols(); ++c) columns.push_back(c);
  return columns;
}

// Akaike's criterion; the numbers of the noise model count as parameters.
double akaike(const MixedResult& result) {
  return result.minus_two_log_likelihood + 2 * result.likelihood_parameters;
}

// The mixed model under the noise that was asked for, or of lowest AIC.
MixedResult estimate(Population& all, const MixedState& start, NoiseModel& noise,
                     const std::function<void(const std::string&)>& say) {
  std::vector<NoiseKind> kinds{all.config_.noise_model};
  if (kinds.front() == NoiseKind::automatic) {
    kinds = {NoiseKind::white, NoiseKind::proportional, NoiseKind::autoregressive, NoiseKind::both};
  }
  MixedResult best;
  NoiseKind chosen = kinds.front();
  for (const NoiseKind kind : kinds) {
    const MixedState& from = best.converged ? static_cast<const MixedState&>(best) : start;
    MixedResult one = all.estimate(from, kind, all_columns(all));
    if (say) {
      std::string end = one.why;
      if (one.converged) end = fmt::format("converged after {} rounds", one.rounds);
      say(fmt::format("{} noise: {}, AIC {:.1f}", names(kind)[static_cast<std::size_t>(kind)], end,
                      akaike(one)));
    }
    if (!one.converged) {
      if (!best.converged && best.why.empty()) best = std::move(one);
      continue;
    }
    if (best.converged && !(akaike(one) < akaike(best))) continue;
    best = std::move(one);
    chosen = kind;
    noise = all.noise_;
  }
  if (best.converged && kinds.size() > 1 && kinds.back() != chosen) {
    // weights of the noise that was chosen
    MixedResult again = all.estimate(best, chosen, all_columns(all));
    if (again.converged) best = std::move(again);
    noise = all.noise_;
  }
  return best;
}

// The limits of a 95 % interval.
struct Range95 {
  double low = not_known, high = not_known;
};

// What the tables have of one number of the population.
struct NumberSummary {
  double median = 0, cv = 0, sd = 0, factor = 0, error = 0, shrinkage = not_known;
  Range95 of_median, of_cv, of_new;
};

// Coefficient of variation between specimens: exact for a lognormal parameter, sqrt(exp(sd^2) - 1),
// and to first order for other links.
double cv_of(const Link& link, double phi, double deviation) {
  if (link.kind == LinkKind::log) return std::sqrt(std::expm1(deviation * deviation));
  return std::abs(link.slope(phi)) * deviation / std::abs(link.backward(phi));
}

// Median, scatter and their intervals of one parameter. Intervals are symmetric on the scale of the
// link, so that a modulus never becomes negative. `of_new` is for a specimen that was not measured.
NumberSummary summary_of(const Population& all, const MixedResult& result, Eigen::Index j) {
  NumberSummary s;
  const Link& link = all.links_[static_cast<std::size_t>(j)];
  const double phi = result.beta[j];
  const auto n = static_cast<double>(all.size());
  double columns = 1;
  for (const Population::Effect& effect : all.effects_)
    if (effect.number == j) ++columns;
  const double freedom = std::max(2., n - columns);
  // Maximum likelihood divides the scatter by the number of specimens: what the population took
  // from it is put back in intervals.
  const double restored = std::sqrt(n / freedom);
  s.factor = student_95(freedom);
  s.error = restored * std::sqrt(result.beta_covariance(j, j));
  s.median = link.backward(phi);
  s.of_median = {link.backward(phi - s.factor * s.error), link.backward(phi + s.factor * s.error)};
  s.sd = std::sqrt(result.omega(j, j));
  s.cv = cv_of(link, phi, s.sd);
  if (!all.varies_[static_cast<std::size_t>(j)]) {
    s.of_new = s.of_median;
    return s;
  }
  const double log_error = result.log_deviation_error[j];
  const double centre = restored * s.sd;
  s.of_cv = {cv_of(link, phi, centre * std::exp(-s.factor * log_error)),
             cv_of(link, phi, centre * std::exp(s.factor * log_error))};
  const double of_new = s.factor * std::hypot(centre, s.error);
  s.of_new = {link.backward(phi - of_new), link.backward(phi + of_new)};
  double square = 0;
  for (const VecX& b : result.b) square += b[j] * b[j] / n;
  if (result.omega(j, j) > 0) s.shrinkage = 1 - square / result.omega(j, j);
  return s;
}

RecordTable population_table(const Population& all, const First& first, const MixedResult& result) {
  RecordTable table;
  table.name = "population";
  table.row = "parameter";
  for (const char* name : {"population_median", "between_specimen_cv", "lower_95", "upper_95",
                           "cv_lower_95", "cv_upper_95", "new_lower_95", "new_upper_95",
                           "shrinkage", "average_of_fits", "fit_of_mean_curve", "true"})
    table.column(name);
  for (Eigen::Index j = 0; j < all.numbers(); ++j) {
    const auto at = static_cast<std::size_t>(j);
    const NumberSummary s = summary_of(all, result, j);
    table.rows.push_back(all.names_[at]);
    const auto add = [&](const char* name, double value) {
      table.column(name).values.push_back(value);
    };
    add("population_median", s.median);
    add("between_specimen_cv", s.cv);
    add("lower_95", s.of_median.low);
    add("upper_95", s.of_median.high);
    add("cv_lower_95", s.of_cv.low);
    add("cv_upper_95", s.of_cv.high);
    add("new_lower_95", s.of_new.low);
    add("new_upper_95", s.of_new.high);
    add("shrinkage", s.shrinkage);
    add("average_of_fits", first.average[j]);
    add("fit_of_mean_curve", first.of_mean_curve[j]);
    add("true", all.config_.parameters[at].truth.value_or(not_known));
  }
  return table;
}

// Correlations between parameters with intervals by Fisher's transformation, which keeps them
// between -1 and 1.
std::string correlation_csv(const Population& all, const MixedResult& result) {
  std::string text = "parameter,other,correlation,lower_95,upper_95\n";
  const double factor = student_95(std::max(2., static_cast<double>(all.size()) - 2));
  for (Eigen::Index i = 0; i < all.numbers(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      const double size = std::sqrt(result.omega(i, i) * result.omega(j, j));
      if (!(size > 0)) continue;
      const double rho = result.omega(i, j) / size;
      const double z = std::atanh(std::clamp(rho, -1 + 1e-12, 1 - 1e-12));
      const double half = factor * result.correlation_error(i, j);
      text += fmt::format("{},{},{:.6g},{:.6g},{:.6g}\n", all.names_[static_cast<std::size_t>(j)],
                          all.names_[static_cast<std::size_t>(i)], rho, std::tanh(z - half),
                          std::tanh(z + half));
    }
  }
  return text;
}

// Squared distance of a specimen's deviations, by what scatter and data make of them.
double distance(const MixedResult& result, std::size_t i) {
  const MatX& C = result.explained[i];
  std::vector<Eigen::Index> kept;
  for (Eigen::Index j = 0; j < C.rows(); ++j)
    if (C(j, j) > 1e-12 * result.omega(j, j) && result.omega(j, j) > 0) kept.push_back(j);
  if (kept.empty()) return 0;
  const VecX b = result.b[i](kept);
  return b.dot(LeastNorm(C(kept, kept), 1e-8).solve(b));
}

// How far a specimen is from the population, how probable that is, and how well it is fitted.
struct SpecimenRow {
  double distance = 0, probability = 1, misfit = 0;
};

// The squared distance of a specimen has a chi-square distribution if it belongs to the population.
std::vector<SpecimenRow> specimen_rows(Population& all, const MixedResult& result) {
  std::vector<SpecimenRow> rows;
  const auto r = static_cast<double>(all.varying());
  for (std::size_t i = 0; i < all.size(); ++i) {
    SpecimenRow row;
    row.distance = distance(result, i);
    row.probability = chi_square_beyond(row.distance, r);
    VecX u;
    const VecX phi = all.design_[i] * result.beta + result.b[i];
    if (all.residual(i, phi, u, nullptr)) {
      const double freedom = std::max(1., static_cast<double>(u.size()) - r);
      row.misfit = u.norm() / std::sqrt(freedom) / result.sigma;
    }
    rows.push_back(row);
  }
  return rows;
}

// Empty where a number is not known.
std::string cell_of(double value) {
  return std::isfinite(value) ? fmt::format("{:.8g}", value) : std::string();
}

// Columns of specimens: who they are, and what the fit of each alone has found.
constexpr const char* identity_names = "specimen,tests,values";

std::string identity_cells(const Individual& one) {
  return fmt::format("{},{},{}", csv_cell(one.id), one.problem.tests.size(), one.measured.size());
}

std::string alone_names(const Population& all) {
  std::string text;
  for (std::size_t j = 0; j < all.names_.size(); ++j)
    text += "," + csv_name(all.names_[j] + "_alone", all.units_[j]);
  return text;
}

std::string alone_cells(const Population& all, const VecX& fit) {
  std::string text;
  for (Eigen::Index j = 0; j < all.numbers(); ++j) {
    text += ",";
    if (fit.size() > 0) text += cell_of(fit[j]);
  }
  return text;
}

std::string specimen_csv(Population& all, const First& first, const MixedResult& result,
                         const std::vector<SpecimenRow>& rows) {
  std::string text = identity_names;
  for (std::size_t j = 0; j < all.names_.size(); ++j)
    text += "," + csv_name(all.names_[j], all.units_[j]);
  text += alone_names(all) + ",distance,probability,misfit\n";
  for (std::size_t i = 0; i < all.size(); ++i) {
    text += identity_cells(all.individuals_[i]);
    const VecX theta = all.backward(all.design_[i] * result.beta + result.b[i]);
    for (const double x : theta) text += fmt::format(",{:.8g}", x);
    text += alone_cells(all, first.fits[i]);
    text += fmt::format(",{:.5g},{:.4g},{:.4g}\n", std::sqrt(std::max(0., rows[i].distance)),
                        rows[i].probability, rows[i].misfit);
  }
  return text;
}

// What a search without a result has reached: the numbers of the population, and the fits of its
// specimens alone, which need no population.
std::vector<PopulationFile> what_was_reached(const Population& all, const First& first,
                                             const MixedResult& reached) {
  std::string numbers =
      "parameter,key,reached,lower,upper,deviation_reached,average_of_fits,fit_of_mean_curve\n";
  const VecX values = all.backward(reached.beta.head(all.numbers()));
  for (Eigen::Index j = 0; j < all.numbers(); ++j) {
    const auto at = static_cast<std::size_t>(j);
    const FreeParameter& free = all.individuals_.front().problem.free[at];
    numbers += fmt::format("{},{},{:.8g},{},{},{:.8g},{},{:.8g}\n", csv_cell(all.names_[at]),
                           csv_cell(all.keys_[at]), values[j], free.lower, free.upper,
                           std::sqrt(reached.omega(j, j)), cell_of(first.average[j]),
                           first.of_mean_curve[j]);
  }
  std::string specimens = identity_names + alone_names(all) + "\n";
  for (std::size_t i = 0; i < all.size(); ++i)
    specimens += identity_cells(all.individuals_[i]) + alone_cells(all, first.fits[i]) + "\n";
  return {{"reached.csv", numbers}, {"reached_specimens.csv", specimens}};
}

// Effects of covariates, with the likelihood ratio of the model without each.
void add_effects(Population& all, const MixedResult& result, NoiseKind kind,
                 PopulationOutcome& outcome) {
  if (all.effects_.empty()) return;
  const auto q = all.numbers();
  std::string text = "covariate,parameter,effect,lower_95,upper_95,ratio,test,probability\n";
  for (std::size_t c = 0; c < all.covariates_.size(); ++c) {
    std::vector<Eigen::Index> kept, left;
    for (const Eigen::Index column : all_columns(all)) {
      const bool own =
          column >= q && all.effects_[static_cast<std::size_t>(column - q)].covariate == c;
      (own ? left : kept).push_back(column);
    }
    MixedState start = result;
    start.beta = result.beta(kept);
    const MixedResult without = all.estimate(start, kind, kept);
    const double ratio = without.minus_two_log_likelihood - result.minus_two_log_likelihood;
    double probability = not_known;
    if (without.converged)
      probability = chi_square_beyond(std::max(0., ratio), static_cast<double>(left.size()));
    const std::string& name = all.config_.specimens->covariates[c].column;
    const CovariateColumns& columns = all.covariates_[c];
    std::string about =
        fmt::format("the population is that of {} = {:.4g}, the mean", name, columns.mean);
    if (!columns.reference.empty())
      about = fmt::format("the population is that of {} = {}", name, columns.reference);
    outcome.lines.push_back(fmt::format(
        "{}: likelihood ratio {:.2f} with {} degrees of freedom, probability {:.3g}; {}", name,
        ratio, left.size(), probability, about));
    for (const Eigen::Index column : left) {
      const Population::Effect& effect = all.effects_[static_cast<std::size_t>(column - q)];
      const NumberSummary s = summary_of(all, result, effect.number);
      const auto n = static_cast<double>(all.size());
      double count = 1;
      for (const Population::Effect& other : all.effects_)
        if (other.number == effect.number) ++count;
      const double error = std::sqrt(n / std::max(2., n - count)) *
                           std::sqrt(result.beta_covariance(column, column));
      const double value = result.beta[column];
      const auto at = static_cast<std::size_t>(effect.number);
      double times = not_known;
      if (all.links_[at].kind == LinkKind::log) times = std::exp(value);
      text += fmt::format("{},{},{:.8g},{:.8g},{:.8g},{},{:.6g},{:.4g}\n", csv_cell(effect.name),
                          all.names_[at], value, value - s.factor * error, value + s.factor * error,
                          cell_of(times), ratio, probability);
    }
  }
  outcome.files.push_back({"effects.csv", text});
  // the weights are those of the whole model again
  all.estimate(result, kind, all_columns(all));
}

// The stresses of people who were not tested: median and 95 % of them, at the points of the first
// specimen that has the test.
std::string prediction_csv(const Population& all, const MixedResult& result) {
  const int people = all.config_.specimens->people;
  std::string text =
      "test,first,second,stress_x_median_MPa,stress_x_low_MPa,stress_x_high_MPa,"
      "stress_z_median_MPa,stress_z_low_MPa,stress_z_high_MPa\n";
  const auto q = all.numbers();
  const MatX root = covariance_root(result.omega);
  const MatX of_median = covariance_root(result.beta_covariance.topLeftCorner(q, q));
  std::vector<std::string> done;
  for (const Individual& one : all.individuals_) {
    for (const Test& test : one.problem.tests) {
      if (std::ranges::find(done, test.name) != done.end()) continue;
      done.push_back(test.name);
      std::vector<std::vector<double>> drawn(test.values());
      for (int i = 0; i < people; ++i) {
        Random random(static_cast<std::uint64_t>(all.config_.seed), static_cast<std::uint64_t>(i));
        VecX z(2 * q);
        for (double& x : z) x = random.normal();
        const VecX phi = result.beta.head(q) + root * z.head(q) + of_median * z.tail(q);
        const Material person = with_parameters(one.problem, all.backward(phi));
        std::vector<double> stress(test.values());
        if (!model_stress(person, test, one.problem.dilatation, stress.data())) continue;
        for (std::size_t k = 0; k < stress.size(); ++k) drawn[k].push_back(stress[k]);
      }
      for (std::size_t k = 0; k < test.points(); ++k) {
        text +=
            fmt::format("{},{:.8g},{:.8g}", csv_cell(test.name), test.first[k], test.second_at(k));
        for (const std::size_t at : {k, test.points() + k}) {
          if (at >= drawn.size()) {
            text += ",,,";
            continue;
          }
          std::ranges::sort(drawn[at]);
          text += fmt::format(",{:.6g},{:.6g},{:.6g}", quantile(drawn[at], 0.5),
                              quantile(drawn[at], 0.025), quantile(drawn[at], 0.975));
        }
        text += "\n";
      }
    }
  }
  return text;
}

// The record of material.h5: the median specimen with the errors of its numbers.
void set_record(Population& all, const MixedResult& result, const NoiseModel& noise,
                FitRecord& record) {
  const auto q = all.numbers();
  VecX slope(q);
  double inflation = 1;
  for (Eigen::Index j = 0; j < q; ++j) {
    const auto at = static_cast<std::size_t>(j);
    const NumberSummary s = summary_of(all, result, j);
    const FreeParameter& free = all.individuals_.front().problem.free[at];
    slope[j] = all.links_[at].slope(result.beta[j]);
    FittedParameter p{all.names_[at], all.units_[at], s.median,
                      free.lower,     free.upper,     std::abs(slope[j]) * s.error};
    p.key = all.keys_[at];
    p.factor = s.factor;
    p.low = s.of_median.low;
    p.high = s.of_median.high;
    p.truth = all.config_.parameters[at].truth.value_or(not_known);
    record.parameters.push_back(p);
    inflation = std::max(inflation, s.error * s.error / result.beta_covariance(j, j));
  }
  record.covariance = inflation * (slope.asDiagonal() * result.beta_covariance.topLeftCorner(q, q) *
                                   slope.asDiagonal());
  record.ties = all.individuals_.front().problem.ties;
  double square = 0, spread = 0, errors = 0, values = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    Individual& one = all.individuals_[i];
    VecX e;
    const VecX phi = all.design_[i] * result.beta + result.b[i];
    if (!one.model.residual(all.backward(phi), e)) continue;
    square += e.squaredNorm();
    spread += (one.measured.array() - one.measured.mean()).matrix().squaredNorm();
    const double largest = std::max(one.measured.cwiseAbs().maxCoeff(), 1e-300);
    errors += 100 * e.cwiseAbs().sum() / largest;
    values += static_cast<double>(e.size());
    record.max_error_percent =
        std::max(record.max_error_percent, 100 * e.cwiseAbs().maxCoeff() / largest);
  }
  record.cost = 0.5 * square;
  record.kkt_residual = not_known;
  record.r2 = 1 - square / std::max(spread, 1e-300);
  record.mean_error_percent = errors / std::max(values, 1.);
  const double k = result.likelihood_parameters;
  record.aicc = akaike(result) + 2 * k * (k + 1) / std::max(1., values - k - 1);
  record.bic = result.minus_two_log_likelihood + k * std::log(static_cast<double>(all.size()));
  record.starts = MatX(0, q + 1);
  record.residual_correlation = noise.rho;
  record.effective_values = values;
  record.noise.model = names(noise.kind)[static_cast<std::size_t>(noise.kind)];
  record.noise.correlation = noise.rho;
  record.noise.share = noise.share;
  record.noise.minus_two_log_likelihood = result.minus_two_log_likelihood;

  PopulationRecord population;
  population.names = all.names_;
  population.keys = all.keys_;
  population.units = all.units_;
  for (const Link& link : all.links_) {
    population.links.push_back(names(link.kind)[static_cast<std::size_t>(link.kind)]);
    population.lower.push_back(link.lower);
    population.upper.push_back(link.upper);
  }
  population.median = result.beta.head(q);
  population.scatter = result.omega;
  population.median_covariance = result.beta_covariance.topLeftCorner(q, q);
  population.sigma = result.sigma;
  record.population = population;
}

void say_result(const Population& all, const First& first, const MixedResult& result,
                const NoiseModel& noise, PopulationOutcome& outcome) {
  outcome.lines.push_back(fmt::format(
      "{} specimens, {} values, {} noise; -2 ln L {:.3f} with {} numbers, {} rounds", all.size(),
      result.values, names(noise.kind)[static_cast<std::size_t>(noise.kind)],
      result.minus_two_log_likelihood, result.likelihood_parameters, result.rounds));
  for (Eigen::Index j = 0; j < all.numbers(); ++j) {
    const auto at = static_cast<std::size_t>(j);
    const NumberSummary s = summary_of(all, result, j);
    std::string unit;
    if (all.units_[at] != unit::none) unit = " " + all.units_[at];
    std::string scatter = "the same in all specimens";
    if (all.varies_[at])
      scatter = fmt::format(
          "between specimens {:.1f} % ({:.1f} to {:.1f}), a new one {:.4g} to {:.4g}", 100 * s.cv,
          100 * s.of_cv.low, 100 * s.of_cv.high, s.of_new.low, s.of_new.high);
    outcome.lines.push_back(fmt::format(
        "{:>10}  median {:.4g}{} (95 %: {:.4g} to {:.4g}), {}; average of fits {:.4g}, fit of the "
        "mean curve {:.4g}",
        all.names_[at], s.median, unit, s.of_median.low, s.of_median.high, scatter,
        first.average[j], first.of_mean_curve[j]));
    if (std::isfinite(s.shrinkage) && s.shrinkage > 0.3)
      outcome.warnings.push_back(fmt::format(
          "{} is shrunk by {:.0f} %: the tests of one specimen say little of it, its estimates lean "
          "on the population",
          all.names_[at], 100 * s.shrinkage));
  }
}

// The posterior of a population: medians of its numbers and deviations between specimens, on the
// scale that varies normally.
void add_posterior(Population& all, const MixedResult& result, NoiseKind kind,
                   PopulationOutcome& outcome) {
  const MixedDraws draws = all.draws(result, kind, *all.config_.study->posterior);
  const auto q = all.numbers();
  Posterior posterior;
  posterior.chains = draws.chains;
  posterior.divergences = draws.divergences;
  posterior.acceptance = draws.acceptance;
  posterior.log_density = draws.log_density;
  std::vector<VecX> columns;
  for (Eigen::Index j = 0; j < q; ++j) {
    const auto at = static_cast<std::size_t>(j);
    VecX column = draws.beta.col(j);
    for (double& x : column) x = all.links_[at].backward(x);
    columns.push_back(column);
    posterior.names.push_back(all.names_[at]);
  }
  for (std::size_t c = 0; c < all.effects_.size(); ++c) {
    const Population::Effect& effect = all.effects_[c];
    columns.emplace_back(draws.beta.col(q + static_cast<Eigen::Index>(c)));
    posterior.names.push_back(all.names_[static_cast<std::size_t>(effect.number)] + "_by_" +
                              effect.name);
  }
  for (Eigen::Index j = 0; j < q; ++j) {
    if (!all.varies_[static_cast<std::size_t>(j)]) continue;
    columns.emplace_back(draws.deviations.col(j));
    posterior.names.push_back(all.names_[static_cast<std::size_t>(j)] + "_deviation");
  }
  posterior.samples.resize(draws.beta.rows(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t j = 0; j < columns.size(); ++j)
    posterior.samples.col(static_cast<Eigen::Index>(j)) = columns[j];
  summarise(posterior);
  for (const std::string& line : posterior_lines(posterior)) outcome.lines.push_back(line);
  for (const std::string& line : posterior_warnings(posterior)) outcome.warnings.push_back(line);
  outcome.record.tables.push_back(posterior.table);
  outcome.files.push_back({"posterior.csv", csv(posterior.table)});
  outcome.files.push_back({"posterior_samples.csv", posterior_csv(posterior)});
}

}  // namespace

std::vector<std::string> population_files(const FitConfig& config) {
  std::vector<std::string> files{"population.csv", "correlations.csv", "specimen_estimates.csv"};
  if (!config.specimens->covariates.empty()) files.push_back("effects.csv");
  if (config.specimens->people > 0) files.push_back("prediction.csv");
  if (config.study && config.study->posterior) {
    files.push_back("posterior.csv");
    files.push_back("posterior_samples.csv");
  }
  return files;
}

PopulationOutcome fit_population(const FitConfig& config,
                                 const std::function<Place(const std::string&)>& at,
                                 const std::function<void(const std::string&)>& say) {
  Population all(config, at);
  const First first = first_estimates(all);
  NoiseModel noise;
  const MixedResult result = estimate(all, first.state, noise, say);
  PopulationOutcome outcome;
  if (!result.converged) {
    std::string cure =
        "name parameters that the tests hardly know under `shared`, or leave them out of "
        "`parameters`; scatter: diagonal has fewer numbers";
    if (!config.specimens->shared.empty())
      cure += "; a number under `shared` that differs between specimens distorts the others";
    outcome.no_result = Error{at("specimens"), "specimens", result.why, "", cure};
    outcome.files = what_was_reached(all, first, result);
    return outcome;
  }
  outcome.median = with_parameters(all.individuals_.front().problem,
                                   all.backward(result.beta.head(all.numbers())));
  say_result(all, first, result, noise, outcome);
  add_effects(all, result, noise.kind, outcome);
  const std::vector<SpecimenRow> rows = specimen_rows(all, result);
  std::string outlying;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].probability * static_cast<double>(rows.size()) < 0.05)
      append(outlying, ", ",
             fmt::format("{} (probability {:.2g})", all.individuals_[i].id, rows[i].probability));
  if (!outlying.empty())
    outcome.warnings.push_back("outlying specimens, which may be of another population: " +
                               outlying);
  set_record(all, result, noise, outcome.record);
  outcome.record.tables.push_back(population_table(all, first, result));
  outcome.files.push_back({"population.csv", csv(outcome.record.tables.back())});
  if (config.study && config.study->posterior) add_posterior(all, result, noise.kind, outcome);
  outcome.files.push_back({"correlations.csv", correlation_csv(all, result)});
  outcome.files.push_back({"specimen_estimates.csv", specimen_csv(all, first, result, rows)});
  if (config.specimens->people > 0)
    outcome.files.push_back({"prediction.csv", prediction_csv(all, result)});
  return outcome;
}

}  // namespace langer
