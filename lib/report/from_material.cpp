// A fitted material in a report. Three questions are answered: does the model follow the tests
// (fits and their misfit), do the tests determine the parameters (profiles, correlations, bounds),
// and is the model stable where it may be used (strong ellipticity over the plane of stretches)?
#include <algorithm>
#include <cmath>

#include "core/base/text.hpp"
#include "core/hdf5/h5.hpp"
#include "identification/fit/stiffness_at_rest.hpp"
#include "report/sources.hpp"
#include "results/store/material_file.hpp"

namespace langer::report {

namespace {

// One chart for each homogeneous test: the measured points and the curve of the fitted material
// over the stretch, or over the amount of shear.
void add_tests(ReportPage& page, const Source& source, const FitRecord& fit) {
  for (const FittedTest& test : fit.tests) {
    std::string x_label = "stretch along x";
    if (test.kind == "simple_shear") x_label = "amount of shear";
    Chart chart{"fits",
                fmt::format("{}: {}", source.label, test.name),
                x_label,
                "-",
                fmt::format("stress ({})", test.measure),
                "MPa",
                {},
                false};
    chart.series.push_back({"measured, x", test.first, test.stress_x, true});
    chart.series.push_back({"model, x", test.first, test.model_x, false});
    if (!test.stress_z.empty()) {
      chart.series.push_back({"measured, z", test.first, test.stress_z, true});
      chart.series.push_back({"model, z", test.first, test.model_z, false});
    }
    page.charts.push_back(std::move(chart));
  }
}

// One chart for each curve that was fitted with simulated scenes. A measured field of displacements
// is drawn over the coordinate x of its points.
void add_curves_of_scenes(ReportPage& page, const Source& source, const FitRecord& fit) {
  for (const FittedCurve& curve : fit.curves) {
    std::vector<double> x = curve.x;
    for (std::size_t i = 0; i < curve.places.size(); ++i) x[i] = curve.places[i][0];
    const bool field = !curve.places.empty();
    std::string x_name = curve.x_name;
    std::string x_unit = curve.x_unit;
    if (field) {
      x_name = "x";
      x_unit = "mm";
    }
    Chart chart{"fits",
                fmt::format("{}: {}", source.label, curve.name),
                x_name,
                x_unit,
                curve.quantity,
                curve.unit,
                {},
                false};
    chart.series.push_back({"measured", x, curve.measured, true});
    chart.series.push_back({"found", x, curve.model, field});
    page.charts.push_back(std::move(chart));
  }
}

// Standard deviation of a test's points about a smooth curve [MPa]; 0 below five points. Each point
// is compared with the cubic (Lagrange) polynomial through its four neighbours. If all points have
// the variance s², the difference has the variance s² (1 + sum of the squared weights).
double scatter(const std::vector<double>& x, const std::vector<double>& y) {
  double sum = 0;
  int n = 0;
  for (std::size_t i = 2; i + 2 < y.size(); ++i) {
    double polynomial = 0;
    double variance_factor = 1;
    for (std::size_t j : {i - 2, i - 1, i + 1, i + 2}) {
      double weight = 1;
      for (std::size_t k : {i - 2, i - 1, i + 1, i + 2})
        if (k != j) weight *= (x[i] - x[k]) / (x[j] - x[k]);
      polynomial += weight * y[j];
      variance_factor += weight * weight;
    }
    if (!std::isfinite(polynomial)) continue;  // two points have the same x
    sum += (y[i] - polynomial) * (y[i] - polynomial) / variance_factor;
    ++n;
  }
  if (n == 0) return 0;
  return std::sqrt(sum / n);
}

// The root mean square of the difference of two lists of equal length.
double root_mean_square(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, a.size())));
}

// A fit is called good if it misses every test by at most this many times the noise of the test.
constexpr double acceptable_misfit = 2;

// How a test is missed, in words; empty if it is not. The noise of a test is the scatter of its
// points, but at least 1 % of its largest stress: smooth data would otherwise fail any model.
std::string misfit_words(const FittedTest& test) {
  constexpr double least_noise = 0.01;
  double largest = 0;
  for (const auto* list : {&test.stress_x, &test.stress_z})
    for (double s : *list) largest = std::max(largest, std::abs(s));
  for (const auto& [stress, model] :
       {std::pair{&test.stress_x, &test.model_x}, {&test.stress_z, &test.model_z}}) {
    const double misfit = root_mean_square(*stress, *model);
    const double points = scatter(test.first, *stress);
    const double noise = std::max(points, least_noise * largest);
    if (stress->empty() || !(misfit > acceptable_misfit * noise)) continue;
    return fmt::format("{} by {:.2g} % of its largest stress, its points scatter by {:.2g} %",
                       test.name, 100 * misfit / largest, 100 * points / largest);
  }
  return "";
}

// Compares the misfit of each test with its noise.
void judge_fit(ReportPage& page, const Source& source, const FitRecord& fit) {
  std::string missed;
  for (const FittedTest& test : fit.tests) {
    const std::string misfit = misfit_words(test);
    if (!misfit.empty()) append(missed, "; ", misfit);
  }
  for (const FittedCurve& curve : fit.curves) {
    const double misfit = root_mean_square(curve.measured, curve.model);
    if (!(misfit > acceptable_misfit * curve.standard_deviation)) continue;
    append(missed, "; ",
           fmt::format("{} by {:.2g} times its standard deviation", curve.name,
                       misfit / curve.standard_deviation));
  }
  const std::string errors =
      fmt::format("mean error {:.2g} %, at most {:.2g} % of the largest {}; R² = {:.5f}",
                  fit.mean_error_percent, fit.max_error_percent,
                  fit.curves.empty() ? "stress" : "value", fit.r2);
  if (missed.empty()) {
    page.verdicts.push_back({Level::good, source.label,
                             "the material follows the tests within their scatter: " + errors});
    return;
  }
  page.verdicts.push_back(
      {Level::warning, source.label,
       fmt::format("the material misses tests by more than their scatter ({}), root mean squares: "
                   "another material model or a shorter range may follow them; {}",
                   missed, errors)});
}

// A matrix as rows, as the page stores it.
std::vector<std::vector<double>> rows_of(const MatX& m) {
  std::vector<std::vector<double>> rows;
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    rows.emplace_back();
    for (Eigen::Index j = 0; j < m.cols(); ++j) rows.back().push_back(m(i, j));
  }
  return rows;
}

// How well the tests determine the parameters: the profile of each one (the rise of chi-squared
// while all others are fitted again) with the limit of its 95 % interval, and the correlations.
void add_identifiability(ReportPage& page, const Source& source, const FitRecord& fit,
                         const h5::Group& root) {
  constexpr double ends = 3.84;  // chi-square of one degree of freedom at 95 %
  const std::string profiles = "identifiability/profiles";
  for (const FittedParameter& p : fit.parameters) {
    if (!root.has(profiles + "/" + p.name)) continue;
    const h5::Group profile = root.group(profiles).group(p.name);
    Chart chart{
        "profiles", fmt::format("profile of {}", p.name), p.name, p.unit, "rise of χ²", "-", {},
        false};
    chart.series.push_back({p.name, profile.read<double>("value", {h5::any}).values,
                            profile.read<double>("rise", {h5::any}).values});
    chart.marks.push_back({"95 %", ends});
    page.charts.push_back(std::move(chart));
  }
  if (fit.parameters.size() < 2) return;
  Matrix matrix{
      "correlation of the parameters, " + source.label, {}, rows_of(correlation(fit.covariance))};
  for (const FittedParameter& p : fit.parameters) matrix.names.push_back(p.name);
  page.matrices.push_back(std::move(matrix));
}

// Where the material is strongly elliptic: its minimum acoustic eigenvalue over the plane of two
// stretches. The colour scale is centred at twice the value of the undeformed material.
void add_stability(ReportPage& page, const Source& source, const h5::Group& root) {
  if (!root.has("stability/plane")) return;
  const h5::Group stability = root.group("stability");
  PlaneMap map{"minimum acoustic eigenvalue, " + source.label,
               "stretch along x",
               "stretch along z",
               "minimum acoustic eigenvalue",
               "MPa",
               stability.read<double>("stretch", {h5::any}).values,
               {},
               1};
  const std::size_t n = map.at.size();
  const std::vector<double> values = stability.read<double>("plane", {n, n}).values;
  for (std::size_t i = 0; i < n; ++i)
    map.values.emplace_back(values.begin() + static_cast<std::ptrdiff_t>(i * n),
                            values.begin() + static_cast<std::ptrdiff_t>((i + 1) * n));
  // The point of the grid that is closest to the undeformed state.
  std::size_t rest = 0;
  for (std::size_t i = 0; i < n; ++i)
    if (std::abs(map.at[i] - 1) < std::abs(map.at[rest] - 1)) rest = i;
  if (n > 0 && std::abs(map.values[rest][rest]) > 0)
    map.middle = 2 * std::abs(map.values[rest][rest]);
  page.maps.push_back(std::move(map));
}

// Whether another message of the fit already covers this parameter: the shear modulus at rest.
bool is_modulus_at_rest(const FitRecord& fit, const FittedParameter& p) {
  return fit.at_rest && fit.at_rest->key.ends_with("." + p.name);
}

// Which parameters the tests do not determine: those on a bound, and those whose standard error is
// more than half their value.
void judge_parameters(ReportPage& page, const Source& source, const FitRecord& fit) {
  std::string open, on_bound;
  double worst = 0;
  for (const FittedParameter& p : fit.parameters) {
    if (p.value == p.lower || p.value == p.upper) {
      if (!is_modulus_at_rest(fit, p)) append(on_bound, ", ", p.name);
    } else if (std::islessequal(p.standard_error, 0.5 * std::abs(p.value))) {
      worst = std::max(worst, p.standard_error / std::abs(p.value));
    } else {
      append(open, ", ", p.name);
    }
  }
  if (!open.empty())
    page.verdicts.push_back(
        {Level::warning, source.label,
         fmt::format("the tests barely determine {}: standard error above half the value", open)});
  if (!on_bound.empty())
    page.verdicts.push_back(
        {Level::warning, source.label,
         fmt::format("the fit ends on a bound of {}: the tests do not determine its value",
                     on_bound)});
  if (fit.at_rest) page.verdicts.push_back({Level::warning, source.label, in_words(*fit.at_rest)});
  if (open.empty() && on_bound.empty() && !fit.at_rest && !fit.parameters.empty())
    page.verdicts.push_back(
        {Level::good, source.label,
         fmt::format("the tests determine every parameter: standard errors of at most {:.2g} %",
                     100 * worst)});
}

}  // namespace

// The tables, charts and verdicts of a fitted material. A material that was not fitted adds
// nothing.
void add_materials(ReportPage& page, const std::vector<Source>& sources) {
  for (const Source& source : sources) {
    const auto fit = read_material(source.path).fit;
    if (!fit) continue;
    ReportTable table{"Parameters: " + source.label,
                      {{"parameter", "-"},
                       {"unit", "-"},
                       {"value", "-"},
                       {"standard error", "-"},
                       {"lower bound", "-"},
                       {"upper bound", "-"}},
                      {}};
    for (const FittedParameter& p : fit->parameters)
      table.rows.push_back({p.name, p.unit, p.value, p.standard_error, p.lower, p.upper});
    page.tables.push_back(std::move(table));
    judge_fit(page, source, *fit);
    judge_parameters(page, source, *fit);
    const h5::File file = h5::File::open(source.path);
    const auto attribute_of = [&](const char* group, const char* attribute) {
      if (!file.root().has(group) || !file.root().group(group).has_attribute(attribute))
        return std::string();
      return file.root().group(group).text_attribute(attribute);
    };
    if (const std::string verdict = attribute_of("stability", "verdict"); !verdict.empty()) {
      Level level = Level::note;
      if (verdict.find("lost") != std::string::npos) level = Level::warning;
      if (verdict.find("loses") != std::string::npos) level = Level::warning;
      page.verdicts.push_back({level, source.label, verdict});
    }
    if (const std::string least = attribute_of("identifiability", "words"); !least.empty())
      page.verdicts.push_back(
          {Level::note, source.label, "least identifiable combination: " + least});
    add_tests(page, source, *fit);
    add_curves_of_scenes(page, source, *fit);
    add_identifiability(page, source, *fit, file.root());
    add_stability(page, source, file.root());
  }
}

}  // namespace langer::report
