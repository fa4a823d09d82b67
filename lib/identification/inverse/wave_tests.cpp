#include "identification/inverse/wave_tests.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <optional>

#include "core/base/csv_table.hpp"
#include "core/base/text.hpp"
#include "core/config/writer.hpp"
#include "mechanics/material/states.hpp"

namespace langer {

namespace {

constexpr double degrees = std::numbers::pi / 180;
// Files have speeds in m/s, as devices report them; the solver works in mm and s.
constexpr double mm_per_m = 1000;

// A fault of a data file, with the line and the column of the file in the message.
[[noreturn]] void refuse_wave(const Place& place, const std::string& key, std::string found,
                              std::string expected, std::string hint = "") {
  throw Failure(Exit::input,
                Error{place, key, std::move(found), std::move(expected), std::move(hint)});
}

// The place of a column in the line of names.
std::optional<std::size_t> find_column(const CsvTable& table, const std::string& name) {
  for (std::size_t i = 0; i < table.header.cells.size(); ++i) {
    if (table.header.cells[i].text == name) return i;
  }
  return std::nullopt;
}

// The message lists all columns of the file: most faults are misspelt names.
std::size_t column_called(const CsvTable& table, const std::string& name, const std::string& key) {
  if (const auto found = find_column(table, name)) return *found;
  std::string all;
  for (const CsvCell& cell : table.header.cells) append(all, ", ", cell.text);
  refuse_wave({table.name, table.header.line, 1}, key, "no column \"" + name + "\"",
              "one of " + all, "columns: {angle: ..., speed: ...} names them");
}

// Infinity and NaN are refused as well: a fit would end with them in every parameter.
double number_at(const CsvTable& table, const CsvRow& row, std::size_t column,
                 const std::string& key) {
  const CsvCell& cell = row.cells[column];
  const auto number = table.number(cell);
  if (!number || !std::isfinite(*number)) {
    refuse_wave({table.name, row.line, cell.column}, key, "found \"" + cell.text + "\"",
                "a number");
  }
  return *number;
}

// Speeds and frequencies are above 0.
double positive_at(const CsvTable& table, const CsvRow& row, std::size_t column,
                   const std::string& key, const char* unit) {
  const double number = number_at(table, row, column, key);
  if (!(number > 0)) {
    refuse_wave({table.name, row.line, row.cells[column].column}, key,
                "found " + number_text(number), std::string("a number > 0 in ") + unit);
  }
  return number;
}

}  // namespace

// Tests of the data that are speeds of surface waves. They depend on the parameters of the law and
// perhaps on prestretches. The copy of the problem is only used to set parameters of the law, so
// its own tests are removed. All speeds together form one vector of residuals, each weighted with
// the inverse of the standard deviation of its test.
WaveTests::WaveTests(const FitConfig& config, const Where& where, const FitProblem& problem)
    : config_(config), law_(problem) {
  law_.tests.clear();
  law_.further.reset();
  std::vector<double> measured;
  std::vector<double> weight;
  for (std::size_t i = 0; i < config_.data.size(); ++i) {
    if (!config_.data[i].is_wave()) continue;
    WaveTest test = read(i, where);
    // Two files with the same name would share a curve in the results: the later one is numbered.
    const std::string name = test.name;
    const auto is_taken = [&](const WaveTest& other) {
      return other.name == test.name;
    };
    for (int n = 2; std::ranges::any_of(tests_, is_taken); ++n) {
      test.name = fmt::format("{}_{}", name, n);
    }
    measured.insert(measured.end(), test.speed.begin(), test.speed.end());
    weight.insert(weight.end(), test.speed.size(), 1 / test.deviation);
    curves_.push_back(static_cast<Eigen::Index>(test.speed.size()));
    tests_.push_back(std::move(test));
  }
  measured_ = Eigen::Map<const VecX>(measured.data(), static_cast<Eigen::Index>(measured.size()));
  weight_ = Eigen::Map<const VecX>(weight.data(), static_cast<Eigen::Index>(weight.size()));
}

// Reads one file. Columns without names in the scene have the names that the layers stage writes,
// so that its results can be fitted without further keys.
WaveTests::WaveTest WaveTests::read(std::size_t item, const Where& where) const {
  const FitData& data = config_.data[item];
  FitColumns columns = data.columns.value_or(FitColumns{});
  if (!data.columns) {
    columns.angle = "angle_deg";
    columns.speed = "speed_m_s";
  }
  CsvReading reading{data.decimal};
  // Devices write lines of remarks first: the line of names is the one with the column of speeds.
  reading.is_header = [&](const std::vector<CsvCell>& cells) {
    return std::ranges::any_of(cells,
                               [&](const CsvCell& cell) { return cell.text == columns.speed; });
  };
  const CsvTable table = read_table(data.file.path, reading);
  const std::size_t angle = column_called(table, columns.angle, "columns.angle");
  const std::size_t speed = column_called(table, columns.speed, "columns.speed");
  std::optional<std::size_t> frequency;
  if (!columns.frequency.empty()) {
    frequency = column_called(table, columns.frequency, "columns.frequency");
  } else if (!data.columns) {
    frequency = find_column(table, "frequency_Hz");
  }
  // The speed depends on the frequency in a layer of finite thickness and in a viscous law. Without
  // frequencies such a test cannot be computed.
  const bool viscous = is_viscous(config_.law);
  if (!frequency && (data.thickness || viscous)) {
    const std::string key = fmt::format("data[{}].columns.frequency", item);
    throw Failure(
        Exit::config,
        Error{where(key), key,
              viscous ? "missing, and the law is viscous" : "missing, in a layer with a thickness",
              "the column of frequencies in Hz: the speed depends on them",
              "columns: {angle: angle_deg, speed: speed_m_s, frequency: frequency_Hz}"});
  }
  WaveTest test;
  test.data = item;
  test.name = data.name;
  if (test.name.empty()) test.name = std::filesystem::path(data.file.path).stem().string();
  for (const CsvRow& row : table.rows) {
    bool chosen = true;
    for (const auto& [name, text] : data.where) {
      chosen = chosen && row.cells[column_called(table, name, "where")].text == text;
    }
    if (!chosen) continue;
    test.angle.push_back(number_at(table, row, angle, "columns.angle"));
    test.speed.push_back(positive_at(table, row, speed, "columns.speed", "m/s"));
    if (frequency) {
      test.frequency.push_back(positive_at(table, row, *frequency, "columns.frequency", "Hz"));
    }
  }
  if (test.speed.empty()) {
    refuse_wave({table.name, table.header.line, 1}, "file", "no rows", "a row of numbers at least",
                data.where.empty() ? "" : "see `where`");
  }
  // Without a standard deviation the noise is a share of the largest speed of the test.
  const double largest = *std::ranges::max_element(test.speed);
  test.deviation = data.standard_deviation.value_or(config_.noise() * largest);
  return test;
}

// One layer at the parameters p. Free stretches of this test replace those of the scene; stretches
// of other tests have numbers of their own and are skipped. Without a thickness the layer is a
// half-space.
LayerStack WaveTests::stack_at(const WaveTest& test, const VecX& p) const {
  const FitData& data = config_.data[test.data];
  PrestretchConfig prestretch = data.prestretch.value_or(PrestretchConfig{});
  for (std::size_t i = 0; i < law_.free.size(); ++i) {
    const auto number = scene_number(config_, law_.free[i]);
    if (!number || number->data != test.data) continue;
    const double value = p[static_cast<Eigen::Index>(i)];
    if (number->of == SceneNumber::Of::stretch_along) prestretch.along = value;
    if (number->of == SceneNumber::Of::stretch_across) prestretch.across = value;
  }
  Layer layer;
  layer.material = with_parameters(law_, p);
  layer.fibres = specimen_fibres(layer.material, data.fibre_angle);
  layer.thickness = data.thickness.value_or(std::numeric_limits<double>::infinity());
  layer.density = density_in_t_mm3(*data.density_kg_m3);
  return {{layer_state(layer, prestretch.deformation(), config_.dilatation)}};
}

// The computed speeds in m/s, in the order of the measured ones. False where a surface wave does
// not exist, for example in a state that is unstable: the fit then rejects the parameters.
bool WaveTests::model(const VecX& p, VecX& values) {
  values.resize(measured_.size());
  Eigen::Index at = 0;
  for (const WaveTest& test : tests_) {
    const LayerStack stack = stack_at(test, p);
    for (std::size_t row = 0; row < test.angle.size(); ++row) {
      WaveQuery query;
      query.angle = test.angle[row] * degrees;
      const bool needed = stack.is_dispersive();
      if (needed) query.frequency = 2 * std::numbers::pi * test.frequency[row];
      const GuidedWave wave = guided_wave(stack, query);
      if (!wave.exists) return false;
      values[at++] = wave.speed / mm_per_m;
    }
  }
  return true;
}

// The slope by central differences; at the edge of the states in which waves exist, by a difference
// to the side that has them. The step is relative to the parameter, with a floor of a share of its
// interval for parameters near 0. False where neither side has a wave.
bool WaveTests::slope(const VecX& p, MatX& J) {
  J.resize(measured_.size(), p.size());
  for (Eigen::Index i = 0; i < p.size(); ++i) {
    const FreeParameter& free = law_.free[static_cast<std::size_t>(i)];
    double width = free.upper - free.lower;
    // A parameter without bounds has no interval.
    if (!std::isfinite(width)) width = 1;
    const double h = 1e-5 * std::max(std::abs(p[i]), 1e-2 * width);
    VecX above;
    VecX below;
    VecX moved = p;
    moved[i] = p[i] + h;
    const bool has_above = model(moved, above);
    moved[i] = p[i] - h;
    const bool has_below = model(moved, below);
    VecX here;
    if (has_above && has_below) {
      J.col(i) = (above - below) / (2 * h);
    } else if (!model(p, here)) {
      return false;
    } else if (has_above) {
      J.col(i) = (above - here) / h;
    } else if (has_below) {
      J.col(i) = (here - below) / h;
    } else {
      return false;
    }
  }
  return true;
}

// Curves for the results: measured and computed speeds over the angle. The qualities of the
// homogeneous tests come first in the list of the fit.
std::vector<FittedCurve> WaveTests::fitted(const FitResult& fit,
                                           std::size_t homogeneous_tests) const {
  std::vector<FittedCurve> all;
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < tests_.size(); ++i) {
    const WaveTest& test = tests_[i];
    FittedCurve one{test.name,      "speed",    "m/s",      "angle", "deg",
                    test.deviation, test.angle, test.speed, {},      {}};
    const auto rows = static_cast<Eigen::Index>(test.speed.size());
    const VecX model = fit.further.segment(at, rows);
    one.model.assign(model.data(), model.data() + rows);
    const FitQuality& q = fit.of_test[homogeneous_tests + i];
    one.r2 = q.r2;
    one.mean_error_percent = q.mean_error_percent;
    one.max_error_percent = q.max_error_percent;
    all.push_back(std::move(one));
    at += rows;
  }
  return all;
}

}  // namespace langer
