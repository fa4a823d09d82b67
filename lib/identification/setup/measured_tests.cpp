#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "core/base/error.hpp"
#include "core/config/writer.hpp"
#include "identification/setup/file_name_sizes.hpp"
#include "identification/setup/fit_config.hpp"

namespace langer {

namespace {

void set_limit(double& limit, const std::optional<double>& given) { limit = given.value_or(limit); }

// Puts the sizes in the file's name where the config gives none; both have to agree.
void add_sizes_in_name(const FitData& data, TestFormat& format) {
  if (data.name_pattern.empty()) {
    return;
  }
  const std::string& file = data.file.path;
  const auto add = [&](const std::string& key, double found, std::optional<double>& size) {
    if (size && *size != found) {
      throw Failure(Exit::input, {{file, 0, 0},
                                  key,
                                  fmt::format("found {} in the file's name", number_text(found)),
                                  number_text(*size) + ", as in the item of `data`",
                                  "one of the two"});
    }
    if (!(found > 0)) {
      throw Failure(Exit::input, {{file, 0, 0},
                                  key,
                                  fmt::format("found {} in the file's name", number_text(found)),
                                  "a size above 0 mm",
                                  ""});
    }
    size = found;
  };
  for (const auto& [key, found] : sizes_in_file_name(file, data.name_pattern)) {
    if (key == "width") {
      add(key, found, format.width);
    } else if (key == "thickness") {
      add(key, found, format.thickness);
    } else if (key == "gauge_length") {
      add(key, found, format.gauge_length);
    } else if (key == "width_z") {
      add(key, found, format.width_z);
    } else if (key == "gauge_length_z") {
      add(key, found, format.gauge_length_z);
    } else if (data.fibre_angle == 0) {
      format.like.fibre_angle_deg = found;
    } else {
      throw Failure(Exit::input, {{file, 0, 0},
                                  key,
                                  "found in the file's name and in the item of `data`",
                                  "one of the two",
                                  ""});
    }
  }
}

// How the file of an item is to be read.
TestFormat test_format(const FitData& data, const Material& law) {
  TestFormat format;
  Test& like = format.like;
  like.name = data.name;
  if (like.name.empty()) {
    like.name = std::filesystem::path(data.file.path).stem().string();
  }
  like.kind = static_cast<TestKind>(data.kind);
  like.shear = data.shear;
  like.fibre_angle_deg = data.fibre_angle;
  like.weight = data.weight.value_or(1);
  if (data.standard_deviation) {
    like.weight = 1 / *data.standard_deviation;
  }

  format.strain = data.strain;
  format.stress = data.stress;
  format.strain_unit = data.strain_unit;
  format.stress_unit = data.stress_unit;
  format.time_unit = data.time_unit;
  format.decimal = data.decimal;
  format.strain_sign = data.sign ? data.sign : data.strain_sign;
  format.stress_sign = data.sign ? data.sign : data.stress_sign;
  format.width = data.width;
  format.thickness = data.thickness;
  format.gauge_length = data.gauge_length;
  format.width_z = data.width_z;
  format.gauge_length_z = data.gauge_length_z;
  format.toe = data.toe;
  add_sizes_in_name(data, format);

  if (data.columns) {
    format.strain_x = data.columns->strain_x;
    format.strain_z = data.columns->strain_z;
    format.stress_x = data.columns->stress_x;
    format.stress_z = data.columns->stress_z;
    format.time = data.columns->time;
    format.where = data.where;
    format.split = data.split;
    if (!data.split.empty() && data.name.empty()) like.name.clear();
  }
  format.block = data.block;
  format.ratio = data.ratio;

  set_limit(format.part.strain_from, data.strain_from);
  set_limit(format.part.strain_to, data.strain_to);
  set_limit(format.part.time_from, data.time_from);
  set_limit(format.part.time_to, data.time_to);
  set_limit(format.part.compare_from, data.compare_from);
  format.cycles = {data.until, data.branch, data.cycle, data.skip_cycles};
  format.step_at = data.step_at;
  format.ramp = data.ramp;
  format.viscous = is_viscous(law);
  format.rest_at_start = data.zero_at == ZeroAt::start;
  format.normalised = data.normalised;
  return format;
}

}  // namespace

// Reads all files that are no scenes. Next to scenes a test needs a standard deviation: by default
// it is the noise of the study. Equal names get a number.
std::vector<Test> measured_tests(const FitConfig& config) {
  std::vector<Test> tests;
  const auto is_taken = [&](const std::string& name) {
    return std::any_of(tests.begin(), tests.end(), [&](const Test& t) { return t.name == name; });
  };
  for (const FitData& data : config.data) {
    if (data.is_scene() || data.is_wave()) continue;
    for (Test& test : read_tests(data.file.path, test_format(data, config.law))) {
      if ((config.has_scenes() || config.has_waves()) && !data.standard_deviation) {
        test.weight = 1 / (config.noise() * std::max(largest_stress(test), 1e-300));
      }
      const std::string name = test.name;
      for (int n = 2; is_taken(test.name); ++n) test.name = name + "_" + std::to_string(n);
      tests.push_back(std::move(test));
    }
  }
  return tests;
}

}  // namespace langer
