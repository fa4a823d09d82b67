// langer-layers: waves and wrinkles of stretched layers, without a mesh in the plane.
//   langer-layers waves.yaml -o table.h5       also writes table.csv and figures
//
// Each row of the table is one direction (and frequency, or wavelength). The mechanics is in
// lib/layers; this stage reads the config, goes through the directions and writes the result.
#include <cmath>
#include <limits>
#include <numbers>

#include "core/hdf5/seal.hpp"
#include "layers/layers_config.hpp"
#include "results/plot/gnuplot.hpp"
#include "results/plot/pictures.hpp"
#include "results/store/curves_file.hpp"
#include "results/store/material_file.hpp"
#include "scene/run/step_record.hpp"
#include "stage.hpp"

namespace langer {
namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
constexpr double degrees = std::numbers::pi / 180;

// One prestretch of the config: that of the first columns, or one to compare with.
struct Case {
  std::string name;  // empty: the first
  PlaneDeformation prestretch;
};

std::vector<Case> cases_of(const LayersConfig& config) {
  std::vector<Case> cases{{"", config.prestretch.deformation()}};
  for (const auto& [name, one] : config.compare) cases.push_back({name, one.deformation()});
  return cases;
}

std::string column_of(const std::string& quantity, const Case& one) {
  if (one.name.empty()) return quantity;
  return quantity + "_" + one.name;
}

std::vector<Layer> layers_of(const Job<LayersConfig>& job) {
  std::optional<Material> others;
  if (job.has("material")) others = material_from(job.input("material"));
  return layers_at_rest(job.config, others, job.where);
}

// Directions without a result, each reason once.
void warn_of(const Job<LayersConfig>& job, const Case& one,
             const std::map<std::string, std::vector<double>>& without) {
  for (const auto& [reason, angles] : without) {
    std::string state;
    if (!one.name.empty()) state = one.name + ": ";
    std::string where = fmt::format("{:g} deg", angles.front());
    if (angles.size() > 1) where += fmt::format(" and {} more", angles.size() - 1);
    job.warn("{}{} at {}, whose cells are empty", state, reason, where);
  }
}

// A figure with the numbers that it shows.
void draw(const Job<LayersConfig>& job, const std::string& name, const std::vector<Column>& columns,
          const Plot& plot) {
  if (!job.config.figures) return;
  write_text_file(job.side_file(name + ".csv"), csv(columns));
  Pictures pictures(job.side_file(""), job.config.figure_style);
  pictures.draw(name, plot);
  for (const auto& [reason, names] : pictures.failed()) {
    job.say("not drawn: {} ({})", names, reason);
  }
}

// --- waves

// What is given besides the direction.
struct Given {
  std::optional<double> frequency_Hz, wavelength_mm;
};

std::vector<Given> given_of(const LayersConfig& config) {
  std::vector<Given> given;
  if (config.frequency_Hz) given.push_back({config.frequency_Hz, {}});
  if (config.wavelength_mm) given.push_back({{}, config.wavelength_mm});
  for (const double f : config.frequencies_Hz) given.push_back({f, {}});
  for (const double l : config.wavelengths_mm) given.push_back({{}, l});
  if (given.empty()) given.push_back({});
  return given;
}

std::vector<Summary> waves(const Job<LayersConfig>& job, const std::vector<Layer>& layers) {
  const LayersConfig& config = job.config;
  const std::vector<double> angles = config.angles();
  const std::vector<Given> given = given_of(config);
  std::vector<Column> columns{{"angle", "deg", {}}};
  std::vector<Summary> summary;
  std::vector<Column> details;
  for (const Case& one : cases_of(config)) {
    LayerStack stack;
    for (const Layer& layer : layers) {
      stack.layers.push_back(layer_state(layer, one.prestretch, config.dilatation));
    }
    stack.bottom = config.bottom;
    stack.surface_tension = config.surface_tension_N_m * 1e-3;  // N/mm
    Column speed{column_of("speed", one), "m/s", {}};
    Column group{"group_speed", "m/s", {}};
    Column frequency{"frequency", "Hz", {}};
    Column wavelength{"wavelength", "mm", {}};
    Column attenuation{"attenuation", "1/mm", {}};
    Column mode{"mode", "-", {}};
    Column error{"speed_error", "m/s", {}};
    std::map<std::string, std::vector<double>> without;
    for (const Given& what : given) {
      for (const double angle : angles) {
        if (one.name.empty()) columns[0].values.push_back(angle);
        WaveQuery query;
        query.angle = angle * degrees;
        query.mode = config.mode;
        if (what.frequency_Hz) query.frequency = 2 * std::numbers::pi * *what.frequency_Hz;
        if (what.wavelength_mm) query.wavenumber = 2 * std::numbers::pi / *what.wavelength_mm;
        const GuidedWave wave = guided_wave(stack, query);
        if (!wave.exists) without[wave.reason].push_back(angle);
        const auto value = [&wave](double x) {
          return wave.exists ? x : not_known;
        };
        const double mm_per_m = 1000;
        const bool of_any_length = !stack.is_dispersive() && !what.frequency_Hz;
        speed.values.push_back(value(wave.speed / mm_per_m));
        group.values.push_back(value(wave.group_speed / mm_per_m));
        attenuation.values.push_back(value(wave.attenuation));
        mode.values.push_back(value(wave.mode));
        error.values.push_back(value(wave.error * wave.speed / mm_per_m));
        const bool any = of_any_length && !what.wavelength_mm;
        frequency.values.push_back(any ? not_known
                                       : value(wave.frequency / (2 * std::numbers::pi)));
        wavelength.values.push_back(any ? not_known
                                        : value(2 * std::numbers::pi / wave.wavenumber));
      }
    }
    warn_of(job, one, without);
    double slowest = std::numeric_limits<double>::infinity();
    double fastest = 0;
    double fastest_at = not_known;
    for (std::size_t i = 0; i < speed.values.size(); ++i) {
      const double c = speed.values[i];
      if (std::isnan(c)) continue;
      slowest = std::min(slowest, c);
      if (c > fastest * (1 + 1e-9)) {
        fastest = c;
        fastest_at = columns[0].values[i];
      }
    }
    if (!(fastest > 0)) {
      throw Failure(Exit::not_converged,
                    {job.where("prestretch"), "prestretch",
                     "no wave travels in any direction: " + without.begin()->first, "",
                     "another prestretch, frequency or law"});
    }
    summary.push_back({column_of("speed_max_m_s", one), fastest, "-"});
    summary.push_back({column_of("speed_min_m_s", one), slowest, "-"});
    summary.push_back({column_of("fastest_at", one), fastest_at, "deg"});
    summary.push_back({column_of("speed_ratio", one), fastest / slowest, "-"});
    job.say("{}fastest {:.4g} m/s at {:g} deg, slowest {:.4g} m/s",
            one.name.empty() ? "" : one.name + ": ", fastest, fastest_at, slowest);
    columns.push_back(std::move(speed));
    if (one.name.empty()) {
      details = {group, frequency, wavelength};
      if (stack.is_viscous()) details.push_back(attenuation);
      details.push_back(mode);
      details.push_back(error);
    }
  }
  columns.insert(columns.end(), details.begin(), details.end());
  write_curves(job.output, {{}, columns, {}, summary}, job.identity);

  Plot plot;
  plot.title = "Waves of stretched layers";
  plot.x_label = "direction from the fibres' 0 degrees (deg)";
  plot.y_label = "speed (m/s)";
  plot.rows = static_cast<int>(columns[0].values.size());
  for (const Column& column : columns) {
    if (!column.name.starts_with("speed") || column.name == "speed_error") continue;
    const bool first = column.name == "speed";
    plot.lines.push_back({"speed.csv", "angle_deg", csv_name(column.name, column.unit),
                          first ? "prestretch" : literal(column.name.substr(6))});
  }
  if (given.size() == 1) draw(job, "speed", columns, plot);
  return summary;
}

// --- wrinkles

std::string in_words(Wrinkle::Kind kind) {
  switch (kind) {
    case Wrinkle::Kind::none:
      return "no wrinkle before the smallest stretch";
    case Wrinkle::Kind::at_once:
      return "unstable at the prestretch already";
    case Wrinkle::Kind::no_state:
      return "a law has no state before a wrinkle";
    default:
      return names(kind)[static_cast<std::size_t>(kind)];
  }
}

std::vector<Summary> wrinkles(const Job<LayersConfig>& job, const std::vector<Layer>& layers) {
  const LayersConfig& config = job.config;
  const CompressionConfig load = config.load();
  const bool shear = load.load == WrinkleLoad::shear;
  const std::string quantity = shear ? "critical_shear" : "critical_stretch";
  std::vector<Column> columns{{"angle", "deg", config.angles()}};
  std::vector<Column> further;
  std::vector<Summary> summary;
  bool any_surface = false;
  bool any_buckling = false;
  bool any = false;
  for (const Case& one : cases_of(config)) {
    WrinkleProblem problem;
    problem.layers = layers;
    problem.bottom = config.bottom;
    problem.surface_tension = config.surface_tension_N_m * 1e-3;  // N/mm
    problem.dilatation = config.dilatation;
    problem.prestretch = one.prestretch;
    problem.load = load.load;
    problem.width = load.width;
    problem.limit = load.smallest;
    Column critical{column_of(quantity, one), "-", {}};
    Column wavelength{column_of("wavelength", one), "mm", {}};
    Column before{"wavelength_prestretched", "mm", {}};
    Column wave_angle{"wave_angle", "deg", {}};
    Column kind{"kind", "-", {}};
    Column error{quantity + "_error", "-", {}};
    std::map<std::string, std::vector<double>> without;
    for (const double angle : config.angles()) {
      const Wrinkle found = first_wrinkle(problem, angle * degrees);
      if (std::isnan(found.s)) without[in_words(found.kind)].push_back(angle);
      any_surface = any_surface || found.kind == Wrinkle::Kind::surface;
      any_buckling = any_buckling || found.kind == Wrinkle::Kind::buckling;
      any = any || !std::isnan(found.s);
      critical.values.push_back(found.s);
      wavelength.values.push_back(found.wavelength);
      before.values.push_back(found.wavelength_before);
      wave_angle.values.push_back(found.wave_angle / degrees);
      kind.values.push_back(static_cast<double>(found.kind));
      error.values.push_back(found.error);
    }
    warn_of(job, one, without);
    // the direction that wrinkles first
    std::optional<std::size_t> first;
    for (std::size_t i = 0; i < critical.values.size(); ++i) {
      const double s = critical.values[i];
      if (std::isnan(s)) continue;
      const bool sooner = !first || (shear ? s < critical.values[*first] * (1 - 1e-9)
                                           : s > critical.values[*first] * (1 + 1e-9));
      if (sooner) first = i;
    }
    if (first) {
      summary.push_back({column_of(quantity + "_first", one), critical.values[*first], "-"});
      summary.push_back({column_of("first_at", one), columns[0].values[*first], "deg"});
      if (std::isfinite(wavelength.values[*first])) {
        summary.push_back({column_of("wavelength_first", one), wavelength.values[*first], "mm"});
      }
      std::string length;
      if (std::isfinite(wavelength.values[*first])) {
        length = fmt::format(", wavelength {:.4g} mm", wavelength.values[*first]);
      }
      job.say("{}unstable first at {:g} deg: {} {:.5g}{}", one.name.empty() ? "" : one.name + ": ",
              columns[0].values[*first], shear ? "shear" : "stretch", critical.values[*first],
              length);
    }
    columns.push_back(std::move(critical));
    columns.push_back(std::move(wavelength));
    if (one.name.empty()) further = {before, wave_angle, kind, error};
  }
  columns.insert(columns.end(), further.begin(), further.end());
  if (any_surface) {
    job.warn(
        "surface instability (Biot): all short wavelengths become unstable at once, so there is no "
        "wavelength. Creases appear earlier (at 35 % in plane strain of neo-Hooke), which a "
        "linearisation cannot find");
  }
  if (any_buckling) {
    job.warn(
        "buckling: the longest wave becomes unstable first, as of a sheet that nothing holds; "
        "there is no wavelength");
  }
  write_curves(job.output, {{}, columns, {}, summary}, job.identity);
  if (!any) return summary;

  Plot plot;
  plot.title = "First wrinkle of stretched layers";
  plot.x_label = "direction of the compression from the fibres' 0 degrees (deg)";
  plot.y_label = shear ? "critical shear" : "critical stretch";
  plot.rows = static_cast<int>(columns[0].values.size());
  for (const Column& column : columns) {
    if (!column.name.starts_with(quantity) || column.name.ends_with("_error")) continue;
    const bool first = column.name == quantity;
    plot.lines.push_back({"critical.csv", "angle_deg", csv_name(column.name, column.unit),
                          first ? "prestretch" : literal(column.name.substr(quantity.size() + 1))});
  }
  draw(job, "critical", columns, plot);
  return summary;
}

std::vector<Summary> layers(const Job<LayersConfig>& job) {
  const std::vector<Layer> body = layers_of(job);
  if (job.config.kind == LayersKind::waves) return waves(job, body);
  return wrinkles(job, body);
}

std::vector<std::string> side_files(const LayersConfig& config) {
  if (!config.figures) return {};
  if (config.kind == LayersKind::waves) return {"speed.csv", "speed.gp"};
  return {"critical.csv", "critical.gp"};
}

}  // namespace
}  // namespace langer

int main(int argc, char** argv) {
  return langer::run_stage<langer::LayersConfig>(argc, argv, "layers", langer::layers,
                                                 langer::side_files);
}
