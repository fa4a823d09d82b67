// Items of data that are waves: `kind: wave`, speeds over the direction.
#include <fmt/format.h>

#include <algorithm>

#include "identification/setup/fit_config.hpp"

namespace langer {

bool FitConfig::has_waves() const {
  return std::any_of(data.begin(), data.end(), [](const FitData& d) { return d.is_wave(); });
}

// Checks an item of kind: wave.
void FitData::complain_of_wave(std::vector<Complaint>& all) const {
  if (file.path.empty()) {
    all.push_back(
        {"file", "missing", "the path of a file with the columns angle_deg and speed_m_s", ""});
  }
  if (!density_kg_m3) {
    all.push_back({"density_kg_m3", "missing in a wave test", "the density of the skin in kg/m3",
                   "density_kg_m3: 1100"});
  }
  if (weight) {
    all.push_back({"weight", "found in a wave test", "standard_deviation, in m/s", ""});
  }
  if (!solve.path.empty()) {
    all.push_back({"solve", "found in a wave test", "kind: scene, or without it", ""});
  }
  std::vector<Complaint> others;
  FitData copy = *this;
  copy.thickness.reset();
  copy.complain_of_homogeneous_keys(others);
  for (Complaint& one : others) {
    one.found = "found in a wave test";
    one.hint = "a wave test does not read it";
    all.push_back(std::move(one));
  }
  if (!columns) return;
  for (const auto& [key, text] :
       {std::pair("angle", &columns->angle), {"speed", &columns->speed}}) {
    if (text->empty()) {
      all.push_back({std::string("columns.") + key, "missing", "the name of a column",
                     "columns: {angle: angle_deg, speed: speed_m_s}"});
    }
  }
}

// Keys of waves in another test.
void FitData::complain_of_wave_keys(std::vector<Complaint>& all) const {
  const auto refuse = [&](const char* key, bool found) {
    if (found) all.push_back({key, "found in a test that is no wave", "kind: wave", ""});
  };
  refuse("density_kg_m3", density_kg_m3.has_value());
  refuse("prestretch", prestretch.has_value());
  if (!columns) return;
  refuse("columns.angle", !columns->angle.empty());
  refuse("columns.speed", !columns->speed.empty());
  refuse("columns.frequency", !columns->frequency.empty());
}

// Reads keys such as data[0].prestretch.along.
std::optional<SceneNumber> wave_number_key(const FitConfig& config, const std::string& key) {
  for (std::size_t i = 0; i < config.data.size(); ++i) {
    if (!config.data[i].is_wave()) continue;
    if (key == fmt::format("data[{}].prestretch.along", i)) {
      return SceneNumber{SceneNumber::Of::stretch_along, "", i};
    }
    if (key == fmt::format("data[{}].prestretch.across", i)) {
      return SceneNumber{SceneNumber::Of::stretch_across, "", i};
    }
  }
  return std::nullopt;
}

}  // namespace langer
