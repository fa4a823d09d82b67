#include "identification/inverse/inverse_fit.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "core/base/interrupt.hpp"
#include "core/base/stopwatch.hpp"
#include "core/base/text.hpp"
#include "core/tensor/dense.hpp"
#include "identification/statistics/study.hpp"
#include "results/store/curves_file.hpp"

namespace langer {

namespace {

constexpr double draft_factor = 2;  // of the cells' length
// Options of a search whose steps end at the relative size `step`: the runs are not more exact than
// that.
FitOptions options_of(const FitConfig& config, double step) {
  FitOptions options{config.searches(), static_cast<unsigned>(config.seed), {}};
  options.least_squares.iterations = 60;
  options.least_squares.kkt = 1e-11;
  options.least_squares.step = step;
  options.least_squares.good_enough = 1e-5;
  return options;
}

// a line at most every two seconds
std::function<void(const std::string&)> throttled(const Voice& voice, const std::string& level) {
  return [voice, level, last = wall_seconds()](const std::string& line) mutable {
    if (wall_seconds() - last < 2) return;
    last = wall_seconds();
    voice.progress(level + line);
  };
}

}  // namespace

InverseFit::InverseFit(const Voice& voice, const FitConfig& config, const SceneTests::Where& where,
                       FitProblem& problem, const std::vector<std::string>& files,
                       const std::string& journal, bool quotients)
    : voice_(voice),
      config_(config),
      where_(where),
      problem_(problem),
      cache_(std::make_shared<RunCache>(journal)) {
  if (cache_->read_back() > 0)
    voice_.say("continues with {} cached runs of an earlier fit", cache_->read_back());
  complete_scene_numbers(config, where, problem);
  scenes_ =
      std::make_shared<SceneTests>(config, where, problem, files, cache_,
                                   SceneFitOptions{config.jobs, quotients, throttled(voice, "")});
  if (config.draft) draft_ = scenes_->on_longer_cells(draft_factor);
  problem_.further = scenes_;
}

CostlyTests InverseFit::costly() const {
  CostlyTests costly;
  costly.tests = scenes_;
  costly.run_ahead = [scenes = scenes_](const std::vector<VecX>& p) {
    scenes->run_ahead(p);
  };
  costly.problem_with = [problem = problem_,
                         priors = priors_](const std::shared_ptr<FurtherTests>& others) {
    FitProblem with_others = problem;
    with_others.further = with_priors(priors, others);
    return with_others;
  };
  return costly;
}

// Fits at one mesh size. A signal ends the search with advice; cached runs are kept.
FitResult InverseFit::level(const std::shared_ptr<SceneTests>& scenes, const FitOptions& options) {
  problem_.further = with_priors(priors_, scenes);
  try {
    return fit(problem_, options);
  } catch (const Failure& failure) {
    if (!interrupted()) throw;
    throw Failure(
        failure.code(),
        Error{{},
              "",
              fmt::format("stopped by {}, after {} runs", signal_name(interrupted()), runs()),
              "",
              "the runs are kept, and the next fit of this config continues with them"});
  }
}

// Searches on coarse elements first and starts the search on the given ones from there. Coarse
// elements are skipped if they have no optimum or no equilibrium.
FitResult InverseFit::search() {
  const FitProblem asked = problem_;
  bool begun = false;
  if (draft_) {
    try {
      const FitResult first = level(draft_, options_of(config_, 1e-3));
      if (first.best.converged) {
        begun = true;
        for (std::size_t i = 0; i < problem_.free.size(); ++i)
          problem_.free[i].start = first.best.p[static_cast<Eigen::Index>(i)];
        voice_.say("on elements {:g} times as long: {} runs, chi-square {:.4g}", draft_factor,
                   draft_->runs(), 2 * first.best.cost);
      }
    } catch (const Failure& failure) {
      if (interrupted()) throw;
      voice_.say("elements {:g} times as long are too coarse: {}", draft_factor,
                 failure.errors().front().found);
    }
  }
  FitOptions options = options_of(config_, 1e-8);
  if (begun) options.starts = 1;
  FitResult found = level(scenes_, options);
  for (std::size_t i = 0; i < problem_.free.size(); ++i)
    problem_.free[i].start = asked.free[i].start;
  if (found.best.converged) return found;
  if (std::isfinite(found.best.cost)) reached_ = found;
  std::string why;
  if (!scenes_->last_failure().empty()) why = "; a trial had " + scenes_->last_failure();
  throw Failure(
      Exit::not_converged,
      Error{
          where_("parameters"), "parameters",
          fmt::format("no optimum after {} runs: {}{}; KKT residual {:.2g}, chi-square {:.6g}",
                      runs(), found.best.why, why, found.best.kkt, 2 * found.best.cost),
          "",
          "other start values or narrower bounds; shorter increments where scenes have no equilibrium"});
}

std::vector<FittedCurve> InverseFit::curves(const FitResult& fit) const {
  std::vector<FittedCurve> curves = scenes_->fitted(fit.further.head(scenes_->measured().size()));
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const FitQuality& q = fit.of_test[problem_.tests.size() + i];
    curves[i].r2 = q.r2;
    curves[i].mean_error_percent = q.mean_error_percent;
    curves[i].max_error_percent = q.max_error_percent;
  }
  return curves;
}

std::vector<std::string> InverseFit::add_curves(const FitResult& fit, FitRecord& record) {
  record.curves = curves(fit);
  std::vector<std::string> lines = scenes_->extrapolations(fit.best.p);
  VecX coarse;
  if (!draft_ || !draft_->model(fit.best.p, coarse)) {
    lines.push_back("the discretisation error of the forces is not estimated");
    return lines;
  }
  // Richardson's extrapolation for forces of second order: the error of the fine mesh is the
  // difference to the coarse mesh over (factor^2 - 1).
  const VecX of_scenes = fit.further.head(coarse.size());
  const VecX beyond = (of_scenes - coarse) / (draft_factor * draft_factor - 1);
  Eigen::Index at = 0;
  for (FittedCurve& curve : record.curves) {
    const auto n = static_cast<Eigen::Index>(curve.measured.size());
    const double largest = Eigen::Map<const VecX>(curve.measured.data(), n).cwiseAbs().maxCoeff();
    curve.discretisation_percent = 100 * beyond.segment(at, n).cwiseAbs().maxCoeff() / largest;
    at += n;
  }
  // The change of the parameters to first order if the measured values were compared with
  // extrapolated ones: least squares of the error by the Jacobian.
  VecX r = VecX::Zero(fit.best.r.size());
  r.segment(r.size() - fit.further.size(), beyond.size()) = scenes_->weight().cwiseProduct(beyond);
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < fit.best.p.size(); ++i)
    if (!fit.left_out[static_cast<std::size_t>(i)]) free.push_back(i);
  const MatX J = fit.best.J(Eigen::all, free);
  const VecX change = -PivotedQr(J).solve(r);
  std::string words;
  for (std::size_t k = 0; k < free.size(); ++k) {
    const FittedParameter& p = record.parameters[static_cast<std::size_t>(free[k])];
    std::string unit;
    if (p.unit != unit::none) unit = " " + p.unit;
    append(words, ", ",
           fmt::format("{} by {:.2g}{}", p.name, change[static_cast<Eigen::Index>(k)], unit));
  }
  lines.push_back("without the discretisation error the parameters would change by about: " +
                  words);
  return lines;
}

// How much wider the interval of each parameter would be if a held number were one more parameter:
// with C the covariance, c the weighted slope by the number and b = C J^T c,
//   variance grows by  b_j^2 / (c.c - (J^T c).b)
std::vector<InverseFit::Widening> InverseFit::widenings(const FitResult& fit) {
  constexpr double worth_naming = 1.5;
  std::vector<Widening> all;
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < fit.best.p.size(); ++i)
    if (!fit.left_out[static_cast<std::size_t>(i)]) free.push_back(i);
  if (free.empty()) return all;
  // Parameters on a bound or at an angle of symmetry have no standard error that could grow.
  const MatX J = fit.best.J(Eigen::all, free);
  const MatX H = J.transpose() * J;
  const MatX C = LeastNorm(H).solve_columns(MatX::Identity(H.rows(), H.cols()));
  const std::vector<std::string> names = parameter_names(problem_);
  for (HeldNumber& held : scenes_->held_numbers(fit.best.p)) {
    // Values of scenes stand behind those of homogeneous tests and before those of priors.
    VecX c = VecX::Zero(J.rows());
    c.segment(J.rows() - fit.further.size(), held.slope.size()) =
        scenes_->weight().cwiseProduct(held.slope);
    const double whole = c.squaredNorm();
    if (!(whole > 0)) continue;
    const VecX seen = J.transpose() * c;
    const VecX b = C * seen;
    const double left = whole - seen.dot(b);
    // what of the slope no combination of parameters can repeat decides how much wider they become
    Widening widest;
    for (std::size_t k = 0; k < free.size(); ++k) {
      const auto j = static_cast<Eigen::Index>(k);
      double factor = std::numeric_limits<double>::infinity();
      if (left > 1e-8 * whole) factor = std::sqrt(1 + b[j] * b[j] / (left * C(j, j)));
      // of a number that cannot be told from parameters the one that would follow it most
      const bool more = factor > widest.factor;
      const bool follows = !std::isfinite(factor) && b[j] * b[j] > 1e-6 * C(j, j) * whole;
      if (more && (std::isfinite(factor) || follows)) {
        widest.factor = factor;
        widest.parameter = names[static_cast<std::size_t>(free[k])];
      }
    }
    // what changes little of the errors is not worth a line
    if (widest.factor < worth_naming) continue;
    widest.held = std::move(held);
    all.push_back(std::move(widest));
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Widening& a, const Widening& b) { return a.factor > b.factor; });
  return all;
}

std::string in_words(const InverseFit::Widening& widening) {
  std::string unit;
  if (widening.held.unit != unit::none) unit = " " + widening.held.unit;
  const std::string begin =
      fmt::format("{} is fixed at {:.4g}{}; ", widening.held.name, widening.held.value, unit);
  if (!std::isfinite(widening.factor))
    return begin + fmt::format("the tests do not separate it from {}: an error in it is one in {}",
                               widening.parameter, widening.parameter);
  return begin + fmt::format("freeing it widens {} by a factor {:.2g}", widening.parameter,
                             widening.factor);
}

std::vector<std::string> InverseFit::cost() const {
  double seconds = scenes_->run_seconds();
  std::string coarse;
  if (draft_) {
    seconds += draft_->run_seconds();
    coarse = fmt::format("; {} of them on coarse elements", draft_->runs());
  }
  return {fmt::format("{} runs of {} scene{}, {:.1f} s of CPU{}", runs(), scenes_->scenes(),
                      plural_s(scenes_->scenes()), seconds, coarse)};
}

std::string parameters_csv(const FitRecord& record) {
  std::string text = "parameter,true,found,standard_error,lower_95,upper_95\n";
  const auto cell = [](double x) {
    std::string text;
    if (std::isfinite(x)) text = fmt::format("{}", x);
    return text;
  };
  for (const FittedParameter& p : record.parameters) {
    const auto [low, high] = interval_95(p);
    text += fmt::format("{},{},{},{},{},{}\n", csv_cell(p.name), cell(p.truth), cell(p.value),
                        cell(p.standard_error), cell(low), cell(high));
  }
  return text;
}

// One table for each measured curve.
std::vector<NamedTable> curve_tables(const FitRecord& record) {
  std::vector<NamedTable> tables;
  for (const FittedCurve& curve : record.curves) {
    std::vector<Column> columns{{curve.x_name, curve.x_unit, curve.x}};
    if (!curve.places.empty())
      for (int j = 0; j < 3; ++j) {
        columns.push_back({std::string(1, "xyz"[j]), "mm", {}});
        for (const Vec3& place : curve.places) columns.back().values.push_back(place[j]);
      }
    double largest = 0;
    for (double value : curve.measured) largest = std::max(largest, std::abs(value));
    std::vector<double> error;
    for (std::size_t i = 0; i < curve.model.size(); ++i)
      error.push_back(100 * (curve.model[i] - curve.measured[i]) / largest);
    columns.push_back({curve.quantity, curve.unit, curve.measured});
    columns.push_back({"model", curve.unit, curve.model});
    columns.push_back({"error", "percent", error});
    tables.push_back({"fit_" + curve.name, csv(columns)});
  }
  return tables;
}

}  // namespace langer
