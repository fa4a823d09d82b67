#include <algorithm>
#include <filesystem>
#include <string>

#include "identification/setup/fit_config.hpp"

namespace langer {

std::vector<Test> measured_tests(const FitConfig& config) {
  std::vector<Test> tests;
  for (const FitData& data : config.data) {
    if (data.is_scene()) continue;
    TestFormat format;
    Test& like = format.like;
    like.name =
        data.name.empty() ? std::filesystem::path(data.file.path).stem().string() : data.name;
    like.kind = static_cast<TestKind>(data.kind);
    like.shear = data.shear, like.fibre_angle_deg = data.fibre_angle;
    like.weight = data.standard_deviation ? 1 / *data.standard_deviation : data.weight.value_or(1);
    format.strain = data.strain, format.stress = data.stress, format.strain_unit = data.strain_unit;
    format.stress_unit = data.stress_unit, format.decimal = data.decimal;
    format.width = data.width, format.thickness = data.thickness,
    format.gauge_length = data.gauge_length;
    format.width_z = data.width_z, format.gauge_length_z = data.gauge_length_z,
    format.toe = data.toe;
    if (data.columns) {
      format.strain_x = data.columns->strain_x, format.strain_z = data.columns->strain_z;
      format.stress_x = data.columns->stress_x, format.stress_z = data.columns->stress_z;
      format.time = data.columns->time;
      format.where = data.where, format.split = data.split;
      if (!data.split.empty() && data.name.empty()) like.name.clear();
    }
    const auto set = [](double& limit, const std::optional<double>& given) {
      limit = given.value_or(limit);
    };
    set(format.part.strain_from, data.strain_from), set(format.part.strain_to, data.strain_to);
    set(format.part.time_from, data.time_from), set(format.part.time_to, data.time_to);
    set(format.part.compare_from, data.compare_from);
    format.rest_at_start = data.zero_at == ZeroAt::start, format.normalised = data.normalised;
    std::vector<Test> found = read_tests(data.file.path, format);
    for (Test& test : found) {
      if (config.has_scenes() && !data.standard_deviation)
        test.weight = 1 / (config.noise() * std::max(largest_stress(test), 1e-300));
      const std::string name = test.name;
      const auto taken = [&] {
        return std::any_of(tests.begin(), tests.end(),
                           [&](const Test& t) { return t.name == test.name; });
      };
      for (int n = 2; taken(); ++n) test.name = name + "_" + std::to_string(n);
      tests.push_back(std::move(test));
    }
  }
  return tests;
}

}  // namespace langer
