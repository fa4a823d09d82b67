#include "identification/statistics/study_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/hdf5/seal.hpp"
#include "identification/sensitivity/sensitivity_tables.hpp"
#include "results/plot/field_map.hpp"
#include "results/plot/gnuplot.hpp"
#include "results/plot/heat_map.hpp"
#include "results/plot/pictures.hpp"
#include "results/store/curves_file.hpp"

namespace langer {

namespace {

// Pictures that could not be drawn, with the reason.
std::vector<std::string> lines_of(const Pictures& pictures) {
  std::vector<std::string> lines;
  for (const auto& [reason, figures] : pictures.failed())
    lines.push_back(fmt::format("not drawn: {} ({})", figures, reason));
  return lines;
}

// chi-square with one degree of freedom: 3.84 holds 95 %
constexpr double threshold = 3.84;

// Correlations and profiles.
void draw_identifiability(Pictures& pictures, const IdentifiabilityRecord& r) {
  HeatMap map;
  map.title = "correlation of the parameters";
  map.x_names = map.y_names = r.names;
  map.values = r.correlation;
  map.numbers = map.first_row_on_top = true;
  pictures.draw("correlation", heat_map(map, pictures.look()));
  if (r.profiles.empty()) return;
  Plot plot;
  plot.title = "profiles: one parameter is held, the others follow";
  plot.marks = {{threshold, "95 % interval"}};
  plot.y_most = 4 * threshold;
  plot.x_label = "change of the parameter (%)";
  plot.y_label = "rise of chi-square";
  for (const std::string& name : r.names)
    plot.lines.push_back(
        {"profile_" + name + ".csv", csv_name("change", "percent"), "rise", literal(name)});
  pictures.draw("profiles", plot);
}

// The map of the minimum acoustic eigenvalue.
void draw_stability(Pictures& pictures, const StabilityMap& m) {
  HeatMap plane;
  plane.title = "minimum acoustic eigenvalue; red: strong ellipticity lost";
  plane.x_label = "stretch along x";
  plane.y_label = "stretch along z";
  plane.value_label = "MPa";
  plane.x_from = plane.y_from = m.stretch.front();
  plane.x_to = plane.y_to = m.stretch.back();
  plane.values = m.plane;
  plane.zero_line = plane.swap_colours = true;
  // logarithmic about its size at rest: neither what is soft nor what is stiff ends in one colour
  Eigen::Index rest = 0;
  for (std::size_t i = 0; i < m.stretch.size(); ++i)
    if (std::abs(m.stretch[i] - 1) < std::abs(m.stretch[static_cast<std::size_t>(rest)] - 1))
      rest = static_cast<Eigen::Index>(i);
  plane.middle = std::max(std::abs(m.plane(rest, rest)), 1e-12);
  plane.limit = plane.middle;
  for (Eigen::Index i = 0; i < m.plane.size(); ++i)
    if (const double v = std::abs(m.plane.data()[i]); std::isfinite(v))
      plane.limit = std::max(plane.limit, v);
  pictures.draw("stability_plane", heat_map(plane, pictures.look()));

  HeatMap losses;
  losses.title = "first loss: strain or shear from which the law is unstable";
  losses.x_label = "angle between fibres and x (°)";
  losses.losses = true;
  const auto angles = static_cast<Eigen::Index>(m.angle.size());
  losses.values.resize(2 * static_cast<Eigen::Index>(all_paths.size()), angles);
  for (double a : m.angle) losses.x_names.push_back(fmt::format("{:g}", a));
  for (std::size_t k = 0; k < all_paths.size(); ++k) {
    std::string name = names(Path{})[static_cast<std::size_t>(all_paths[k])];
    std::replace(name.begin(), name.end(), '_', ' ');
    losses.y_names.push_back(name + ", slope");
    losses.y_names.push_back(name + ", ellipt.");
    for (Eigen::Index j = 0; j < angles; ++j) {
      const PathStability& p = m.paths[k * m.angle.size() + static_cast<std::size_t>(j)];
      losses.values(2 * static_cast<Eigen::Index>(k), j) = p.slope_loss;
      losses.values(2 * static_cast<Eigen::Index>(k) + 1, j) = p.ellipticity_loss;
    }
  }
  losses.limit = m.amount.back();
  losses.numbers = losses.first_row_on_top = true;
  pictures.draw("stability_directions", heat_map(losses, pictures.look()));
}

}  // namespace

std::vector<std::string> write_study_files(const StudyRecord& study, const StudyConfig& config,
                                           const FigureStyle& style, const std::string& folder) {
  for (const TextFile& file : study_tables(study))
    write_text_file((std::filesystem::path(folder) / file.name).string(), file.text);
  if (!config.figures) return {};
  Pictures pictures(folder, style);
  if (study.identifiability) draw_identifiability(pictures, *study.identifiability);
  if (study.stability) draw_stability(pictures, study.stability->map);
  return lines_of(pictures);
}

// Measured and computed stresses of each test.
std::vector<std::string> draw_fit(const std::string& measured_column, const FigureStyle& style,
                                  const std::string& folder) {
  Pictures pictures(folder, style);
  Plot plot;
  plot.x_label = "strain";
  plot.y_label = "stress (MPa)";
  plot.title = "measured and fitted";
  plot.lines = {{"fit.csv", "strain", measured_column, "measured"},
                {"fit.csv", "strain", "model_MPa", "model"}};
  plot.lines[0].points = true;  // seen where the model lies on it
  pictures.draw("figure_4", plot);
  plot.y_label = "error (% of the largest stress)";
  plot.title = "model less measured";
  plot.lines = {{"fit.csv", "strain", "error_percent", "error"}};
  pictures.draw("figure_5", plot);
  return lines_of(pictures);
}

namespace {

// Maps of a field at the last value of its abscissa: measured, found and their difference at their
// places
void draw_field(Pictures& pictures, const FittedCurve& curve) {
  const double end = *std::max_element(
      curve.x.begin(), curve.x.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  FieldMap map;
  map.title = fmt::format("{} at {} = {:g} {}", curve.name, curve.x_name, end,
                          curve.x_unit == "-" ? "" : curve.x_unit);
  map.x_label = "x (mm)";
  map.y_label = "z (mm)";
  map.unit = curve.unit;
  FieldPanel measured{"measured", {}, 0}, found{"found", {}, 0},
      difference{"found less measured", {}, 0};
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    if (curve.x[i] != end) continue;
    map.x.push_back(curve.places[i][0]);
    map.y.push_back(curve.places[i][2]);
    measured.values.push_back(curve.measured[i]);
    found.values.push_back(curve.model[i]);
    difference.values.push_back(curve.model[i] - curve.measured[i]);
    measured.limit =
        std::max({measured.limit, std::abs(curve.measured[i]), std::abs(curve.model[i])});
    difference.limit = std::max(difference.limit, std::abs(difference.values.back()));
  }
  for (FieldPanel* panel : {&measured, &difference})
    if (panel->limit == 0) panel->limit = 1;
  found.limit = measured.limit;
  map.panels = {measured, found, difference};
  pictures.draw("map_" + curve.name, field_map(map));
}

}  // namespace

// Measured and computed curves of scenes.
std::vector<std::string> draw_curves(const std::vector<FittedCurve>& curves,
                                     const FigureStyle& style, const std::string& folder) {
  Pictures pictures(folder, style);
  for (const FittedCurve& curve : curves) {
    const std::string file = "fit_" + curve.name + ".csv";
    std::string over = "x_mm";
    if (curve.places.empty()) over = csv_name(curve.x_name, curve.x_unit);
    Plot plot;
    plot.title = literal(curve.name) + ": measured and found";
    if (curve.places.empty()) {
      plot.x_label = fmt::format("{} ({})", literal(curve.x_name), curve.x_unit);
    } else {
      plot.x_label = "x (mm)";
    }
    plot.y_label = fmt::format("{} ({})", literal(curve.quantity), curve.unit);
    plot.lines = {{file, over, csv_name(curve.quantity, curve.unit), "measured"},
                  {file, over, csv_name("model", curve.unit), "found"}};
    plot.lines[0].points = true;
    plot.lines[1].points = !curve.places.empty();
    pictures.draw("fit_" + curve.name, plot);
    plot.title = literal(curve.name) + ": found less measured";
    plot.y_label = "error (% of the largest)";
    plot.lines = {{file, over, "error_percent", "error"}};
    plot.lines[0].points = !curve.places.empty();
    pictures.draw("error_" + curve.name, plot);
    if (!curve.places.empty()) draw_field(pictures, curve);
  }
  return lines_of(pictures);
}

// Effects and indices over the strain.
std::vector<std::string> draw_sensitivity(const SensitivityRecord& r, const FigureStyle& style,
                                          const std::string& folder) {
  Pictures pictures(folder, style);
  Plot effects;
  effects.title = "one parameter at a time: mean effect over its range";
  effects.x_label = "strain";
  effects.y_label = "μ* (MPa)";
  effects.rows = static_cast<int>(r.strain.size());
  for (const RankedNumber& p : r.parameters)
    effects.lines.push_back(
        {"sensitivity.csv", "strain", csv_name("mu_star_range_" + p.name, "MPa"), literal(p.name)});
  pictures.draw("effects", effects);

  Bars b;
  for (const Zone& z : r.zones)
    b.groups.push_back(fmt::format("strain {:g} to {:g}", z.from, z.to));
  for (const RankedNumber& p : r.parameters) b.series.push_back(p.name);
  b.title = "effect of each parameter over its range, one at a time";
  b.y_label = "μ* (MPa)";
  b.values = over_range(r, zone_means(r.effects.mu_star, r.strain, r.zones));
  pictures.draw("effects_by_zone", bars(b, pictures.look()));
  const auto draw = [&](const std::string& name, const std::string& title, const std::string& unit,
                        const Estimate& e) {
    b.title = title;
    b.y_label = unit;
    b.values = e.value;
    b.low = e.low;
    b.high = e.high;
    pictures.draw(name, bars(b, pictures.look()));
  };
  if (r.morris) {
    draw("morris_by_zone", "Morris trajectories: μ* with 95 % intervals", "μ* (MPa)",
         r.morris->group_mu_star);
    draw("morris_sigma_by_zone", "Morris trajectories: σ, curvature and interaction", "σ (MPa)",
         r.morris->group_sigma);
  }
  if (r.sobol) {
    draw("sobol_by_zone", "Sobol: total share of the variance with 95 % intervals", "share",
         r.sobol->group_total);
    draw("sobol_first_by_zone", "Sobol: share of the variance alone", "share",
         r.sobol->group_first);
  }
  return lines_of(pictures);
}

}  // namespace langer
