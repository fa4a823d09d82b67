#include "identification/setup/fit_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "core/base/traps.hpp"
#include "identification/fit/stiffness_at_rest.hpp"
#include "identification/statistics/intervals.hpp"
#include "identification/statistics/within_bounds.hpp"
#include "mechanics/material/at_rest.hpp"
#include "mechanics/material/ellipticity.hpp"
#include "mechanics/material/review.hpp"
#include "results/store/curves_file.hpp"

namespace langer {

namespace {

// 95 % intervals by Student's factor for the noise that the residuals show (fit/residual_noise.hpp)
void set_intervals(const FitResult& fit, FitRecord& record) {
  const VecX factors = interval_factors(fit.columns, fit.left_out, fit.noise);
  const MatX white =
      covariance(fit.best.J, fit.left_out, white_noise(fit.noise.total(), fit.best.J.rows()));
  for (std::size_t i = 0; i < record.parameters.size(); ++i) {
    FittedParameter& p = record.parameters[i];
    const auto k = static_cast<Eigen::Index>(i);
    const NoTraps without_information_no_number;
    const double half = p.factor * factors[k] * std::sqrt(white(k, k));
    if (p.standard_error > 0 && std::isfinite(half)) p.factor = half / p.standard_error;
  }
}

// Intervals of tests where the model is not straight over those to first order, and none outside of
// the box.
void set_nonlinear(const FitProblem& problem, const FitResult& fit, FitRecord& record) {
  std::vector<Interval> first;
  for (const FittedParameter& p : record.parameters) {
    const auto [low, high] = interval_95(p);
    first.push_back({low, high});
  }
  const std::vector<Interval> intervals = intervals_95(problem, fit, first);
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    const Interval& one = intervals[i];
    const bool same = one.low == first[i].low && one.high == first[i].high;
    if (same || std::isnan(one.low) || std::isnan(one.high)) continue;
    record.parameters[i].low = one.low;
    record.parameters[i].high = one.high;
  }
}

// The noise model of the tests, and the AICc of the other kinds.
NoiseRecord noise_record(const FitProblem& problem, const FitResult& fit) {
  const auto word = [](NoiseKind kind) {
    return std::string(names(kind)[static_cast<std::size_t>(kind)]);
  };
  NoiseRecord record;
  const NoiseModel& noise = fit.noise_model;
  record.model = word(noise.kind);
  record.correlation = noise.rho;
  record.share = noise.share;
  record.limit = largest_correlation(curve_sizes(problem));
  record.at_limit = std::max(noise.rho, fit.noise.rho) >= record.limit * (1 - 1e-6);
  record.share_at_limit = noise.share == largest_share;
  record.minus_two_log_likelihood = minus_two_log_likelihood(fit.best.r);
  for (const NoiseCandidate& one : fit.noise_candidates)
    record.aicc.push_back({word(one.noise.kind), one.aicc});
  return record;
}

// Beside a bound that a parameter rests on: what is on it keeps no standard error, the others get
// that of fits within the bounds.
void set_bounded(const WithinBounds& bounded, FitRecord& record) {
  for (std::size_t i = 0; i < record.parameters.size(); ++i) {
    FittedParameter& p = record.parameters[i];
    const auto k = static_cast<Eigen::Index>(i);
    p.low = bounded.low[i];
    p.high = bounded.high[i];
    if (const double variance = bounded.moments(k, k);
        std::isfinite(variance) && std::isfinite(p.standard_error))
      p.standard_error = std::sqrt(variance);
  }
  if (bounded.moments.array().isFinite().any()) record.covariance = bounded.moments;
}

}  // namespace

// Collects parameters, intervals, quality and curves of a fit.
FitRecord fit_record(const FitProblem& problem, const FitResult& fit) {
  FitRecord record;
  Material material = fit.material;
  const std::vector<MaterialParameter> all = parameters(material);
  for (std::size_t i = 0; i < problem.free.size(); ++i) {
    const FreeParameter& p = problem.free[i];
    const auto k = static_cast<Eigen::Index>(i);
    const auto known = std::ranges::find(all, p.key, &MaterialParameter::key);
    record.parameters.push_back({p.is_material_number() ? known->name : p.name,
                                 p.is_material_number() ? known->unit : p.unit, fit.best.p[k],
                                 p.lower, p.upper, std::sqrt(fit.covariance(k, k))});
    record.parameters.back().key = p.key;
  }
  if (fit.columns.size() > 0) set_intervals(fit, record);
  record.covariance = fit.covariance;
  if (const auto bounded = within_bounds(problem, fit)) set_bounded(*bounded, record);
  if (fit.residual.size() > 0) {
    set_nonlinear(problem, fit, record);
    record.noise = noise_record(problem, fit);
  }
  record.cost = 0.5 * fit.residual.squaredNorm();
  record.kkt_residual = fit.best.kkt;
  record.mean_error_percent = fit.quality.mean_error_percent;
  record.max_error_percent = fit.quality.max_error_percent;
  record.r2 = fit.quality.r2;
  record.aicc = fit.quality.aicc;
  record.bic = fit.quality.bic;
  record.residual_correlation = fit.noise.rho;
  record.effective_values = fit.noise.effective;
  record.ties = problem.ties;
  record.starts = fit.starts;
  const double* model = fit.model.data();
  for (std::size_t t = 0; t < problem.tests.size(); ++t) {
    const Test& test = problem.tests[t];
    const FitQuality& q = fit.of_test[t];
    FittedTest one{test.name,
                   names(test.kind)[static_cast<std::size_t>(test.kind)],
                   names(test.measure)[static_cast<std::size_t>(test.measure)],
                   test.fibre_angle_deg,
                   test.weight,
                   test.first,
                   test.second,
                   test.stress_x,
                   test.stress_z,
                   {},
                   {},
                   q.r2,
                   q.mean_error_percent,
                   q.max_error_percent};
    one.model_x.assign(model, model + test.stress_x.size());
    model += test.stress_x.size();
    one.model_z.assign(model, model + test.stress_z.size());
    model += test.stress_z.size();
    record.tests.push_back(std::move(one));
  }
  if (problem.tests.empty()) return record;
  // the range of engineering strain along x, over all tests that stretch
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Test& test : problem.tests)
    for (double x : test.first) {
      const double strain = strain_of(test.kind, x);
      low = std::min(low, strain);
      high = std::max(high, strain);
    }
  record.strain_min = low;
  record.strain_max = high;
  const FittedTest& first = record.tests.front();
  for (double x : first.first)
    record.strain.push_back(first.kind == "simple_shear" ? x : engineering_strain(x));
  record.stress = first.stress_x;
  record.model = first.model_x;
  return record;
}

// The table of all tests as the header describes it.
std::string fit_csv(const FitRecord& record) {
  const auto error = [](double model, double stress, const FittedTest& t) {
    double largest = 0;
    for (const auto* list : {&t.stress_x, &t.stress_z})
      for (double s : *list) largest = std::max(largest, std::abs(s));
    if (!(largest > 0)) return std::numeric_limits<double>::quiet_NaN();
    return 100 * (model - stress) / largest;
  };
  if (record.tests.empty()) return "";
  const FittedTest& only = record.tests.front();
  if (record.tests.size() == 1 && only.kind == "uniaxial") {
    std::vector<double> e;
    for (std::size_t i = 0; i < only.first.size(); ++i)
      e.push_back(error(only.model_x[i], only.stress_x[i], only));
    return csv({{"strain", "-", record.strain},
                {only.measure + "_stress", "MPa", only.stress_x},
                {"model", "MPa", only.model_x},
                {"error", "percent", e}});
  }
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> c[9];
  for (std::size_t t = 0; t < record.tests.size(); ++t) {
    const FittedTest& test = record.tests[t];
    for (std::size_t i = 0; i < test.first.size(); ++i) {
      double second = none;
      double stress_z = none;
      double model_z = none;
      double error_z = none;
      if (!test.second.empty()) second = test.second[i];
      if (!test.stress_z.empty()) {
        stress_z = test.stress_z[i];
        model_z = test.model_z[i];
        error_z = error(model_z, stress_z, test);
      }
      const double error_x = error(test.model_x[i], test.stress_x[i], test);
      const double row[] = {static_cast<double>(t + 1),
                            test.first[i],
                            second,
                            test.stress_x[i],
                            stress_z,
                            test.model_x[i],
                            model_z,
                            error_x,
                            error_z};
      for (int k = 0; k < 9; ++k) c[k].push_back(row[k]);
    }
  }
  return csv({{"test", "-", c[0]},
              {"first", "-", c[1]},
              {"second", "-", c[2]},
              {"stress_x", "MPa", c[3]},
              {"stress_z", "MPa", c[4]},
              {"model_x", "MPa", c[5]},
              {"model_z", "MPa", c[6]},
              {"error_x", "percent", c[7]},
              {"error_z", "percent", c[8]}});
}

namespace {
// an angle that leaves the covariance though it has no bound there
bool at_symmetry(const FittedParameter& p) {
  return p.unit == unit::deg && std::isnan(p.standard_error) && p.upper - p.lower >= 180;
}
}  // namespace

namespace {
std::string in_words(const FittedCurve& c) {
  double square = 0;
  for (std::size_t i = 0; i < c.model.size(); ++i)
    square += (c.model[i] - c.measured[i]) * (c.model[i] - c.measured[i]);
  const double missed = std::sqrt(square / static_cast<double>(c.model.size()));
  return fmt::format(
      "{:>10}: {} error {:.3g} {} (root mean square, {:.2f} standard deviations), {:.3g} % of the largest{}",
      c.name, c.quantity, missed, c.unit, missed / c.standard_deviation, c.mean_error_percent,
      std::isnan(c.discretisation_percent)
          ? ""
          : fmt::format("; discretisation error about {:.2g} %", c.discretisation_percent));
}
}  // namespace

namespace {

// The number of measured values.
std::size_t values_of(const FitRecord& record) {
  std::size_t values = 0;
  for (const FittedTest& t : record.tests) values += t.stress_x.size() + t.stress_z.size();
  for (const FittedCurve& c : record.curves) values += c.measured.size();
  return values;
}

std::string in_words(const NoiseRecord& noise) {
  std::string words = "noise: " + noise.model;
  if (noise.correlation > 0) {
    words += fmt::format(", correlation {:.4g}", noise.correlation);
    if (noise.at_limit) words += " (the limit)";
  }
  if (noise.share > 0) {
    words += fmt::format(", {:.3g} of the variance in proportion to the stress", noise.share);
    if (noise.share_at_limit) words += " (the limit)";
  }
  if (noise.aicc.size() < 2) return words;
  std::string compared;
  for (const auto& [kind, aicc] : noise.aicc) {
    if (!compared.empty()) compared += ", ";
    if (std::isfinite(aicc)) {
      compared += fmt::format("{} {:.6g}", kind, aicc);
    } else {
      compared += kind + " none (too few values)";
    }
  }
  return words + "; chosen by AICc: " + compared;
}

}  // namespace

// Lines about parameters, tests and the quality of the fit.
std::vector<std::string> fit_results(const FitRecord& record) {
  std::vector<std::string> lines;
  const bool held = std::any_of(record.parameters.begin(), record.parameters.end(), at_symmetry);
  for (const FittedParameter& p : record.parameters) {
    const bool turns =
        p.unit == unit::deg && p.upper - p.lower >= 180;  // an angle that has no bounds
    const bool on_bound = !turns && (p.value == p.lower || p.value == p.upper);
    std::string known;
    if (on_bound) {
      if (std::isnan(p.low)) {
        known = "on its bound";
      } else {
        known = fmt::format("on its bound; 95 % interval {:.4g} to {:.4g}", p.low, p.high);
      }
    } else if (std::isnan(p.standard_error) && p.unit == unit::deg && !std::isnan(p.low)) {
      known =
          fmt::format("at an angle of symmetry, or not determined; 95 % interval {:.4g} to {:.4g}",
                      p.low, p.high);
    } else if (std::isnan(p.standard_error) && p.unit == unit::deg) {
      known = "at an angle of symmetry, or not determined: see its profile";
    } else if (std::isnan(p.standard_error)) {
      known = "not determined by this curve";
    } else {
      known = fmt::format("standard error {:.2g}{}", p.standard_error,
                          held ? " with the angle held: see its profile" : "");
    }
    lines.push_back(fmt::format("{:>10} = {:12.6g} {:<5}  {}", p.name, p.value,
                                p.unit == "-" ? "" : p.unit, known));
  }
  for (const Tie& tie : record.ties)
    lines.push_back(fmt::format("{} = {}", tie.key, tie_text(tie)));
  if (record.tests.size() + record.curves.size() > 1)
    for (const FittedTest& t : record.tests)
      lines.push_back(fmt::format("{:>10}: R2 {:.4f}, mean error {:.3g} %, largest {:.3g} %",
                                  t.name, t.r2, t.mean_error_percent, t.max_error_percent));
  for (const FittedCurve& c : record.curves) lines.push_back(in_words(c));
  std::size_t points = 0;
  for (const FittedTest& t : record.tests) points += t.first.size();
  for (const FittedCurve& c : record.curves) points += c.x.size();
  std::string aicc;
  if (std::isnan(record.aicc)) {
    aicc = fmt::format("no AICc ({} values are too few for {} parameters and their noise)",
                       values_of(record), record.parameters.size());
  } else {
    aicc = fmt::format("AICc {:.6g}", record.aicc);
  }
  lines.push_back(fmt::format("R2 {:.6f}, {}, BIC {:.6g}", record.r2, aicc, record.bic));
  if (!record.noise.aicc.empty()) lines.push_back(in_words(record.noise));
  if (std::isfinite(record.left_out_error_percent))
    lines.push_back(fmt::format(
        "each test predicted from the others: error {:.3g} % of its largest stress (root mean square)",
        record.left_out_error_percent));
  lines.push_back(fmt::format(
      "mean error {:.3g} %, largest {:.3g} % of the largest {}; KKT residual {:.1e}; {} points, {} starts",
      record.mean_error_percent, record.max_error_percent,
      record.curves.empty() ? "stress" : "value", record.kkt_residual, points,
      record.starts.rows()));
  return lines;
}

// Warnings about the material: instability, negative moduli, correlated parameters and residuals.
std::vector<std::string> fit_warnings(const FitRecord& record, const Material& material) {
  std::vector<std::string> lines;
  if (record.at_rest) lines.push_back(in_words(*record.at_rest));
  if (at_rest(material) == AtRest::without_stiffness)
    lines.push_back(fmt::format("the law has {}: no body of it can be solved; it needs {}",
                                at_rest_in_words(material), stiffness_at_rest_cure(material)));
  for (const MaterialFinding& finding : review(material)) {
    lines.push_back(fmt::format("{}: {}", finding.key, finding.words));
  }
  for (const MatrixTerm& term : material.matrix)
    if (const double mu = shear_modulus(term); mu < 0)
      lines.push_back(fmt::format(
          "{} starts with a negative slope: the shear modulus of this term is {:.4g} MPa at rest",
          std::visit([](const auto& law) { return law.key; }, term), mu));
  for (const Fibre& fibre : material.fibres)
    if (const auto* hgo = std::get_if<HgoFibre>(&fibre.law); hgo && hgo->c1 < 0)
      lines.push_back(fmt::format(
          "c1 = {:.4g} MPa is negative: the energy is unbounded below, and solutions exist in a limited range only",
          hgo->c1));
  for (const FittedTest& test : record.tests)
    if (record.tests.size() > 1 && test.r2 < 0)
      lines.push_back(fmt::format(
          "test {}: R2 {:.3g}: the law describes this test worse than its mean does; check its signs "
          "(sign: -1), measures and units, or fit it alone",
          test.name, test.r2));
  if (record.residual_correlation > 0) {
    std::string limit;
    if (record.noise.at_limit)
      limit = ", the largest value that curves of this length allow: the true one may be larger";
    lines.push_back(fmt::format(
        "residuals are correlated by {:.3f} from one value of a curve to the next{}: {} values count as {:.0f} in "
        "errors and intervals; the law misses the curves, or the device drifts",
        record.residual_correlation, limit, values_of(record), record.effective_values));
    if (record.noise.correlation > 0 && record.noise.at_limit)
      lines.push_back(
          "the parameters are those of largest likelihood under this correlation: they follow the slopes of the "
          "curves more than their levels; noise: white gives least squares");
  }
  const MatX correlations = correlation(record.covariance);
  for (std::size_t i = 0; i < record.parameters.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double r = correlations(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      if (std::isgreater(std::abs(r), 0.99))  // never NaN, without a trap
        lines.push_back(
            fmt::format("{} and {} are correlated by {:.4f}: this curve cannot separate them",
                        record.parameters[j].name, record.parameters[i].name, r));
    }
  const std::vector<Vec3> a = fibre_directions(material);
  const double far = 1.5 * record.strain_max;
  for (int i = 0; i <= 200 && far > 0; ++i) {
    const Uniaxial u = uniaxial_incompressible(material, 1 + i * far / 200);
    double value = 0;
    if (u.converged) {
      value = smallest_shear_stiffness(material, u.stretch.asDiagonal(), a).value;
    } else {
      value = std::numeric_limits<double>::quiet_NaN();
    }
    if (std::isgreaterequal(value, 0)) continue;
    lines.push_back(
        fmt::format("{} at strain {:.2g}; the curve ends at {:.2g}",
                    std::isnan(value) ? "the material has no stress" : "strong ellipticity is lost",
                    i * far / 200, record.strain_max));
    break;
  }
  return lines;
}

}  // namespace langer
