#include "scene/model/material_review.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mechanics/material/review.hpp"

namespace langer {

namespace {

double largest(const HistoryConfig& history) {
  double most = std::abs(history.value);
  for (const HistoryPointConfig& point : history.points) most = std::max(most, std::abs(point.to));
  return most;
}

// A body bears a pressure of some times its stiffness. One of hundreds of times is in other units.
std::vector<std::string> review_pressures(const SolveConfig& config,
                                          const std::vector<Material>& materials,
                                          const std::function<Place(const std::string&)>& where) {
  constexpr double doubtful = 300;
  double stiffest = 0;
  for (const Material& material : materials)
    stiffest = std::max({stiffest, shear_modulus(material), fibre_stiffness(material)});
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < config.loads.size() && stiffest > 0; ++i) {
    if (!config.loads[i].pressure) continue;
    const double pressure = largest(*config.loads[i].pressure);
    if (!(pressure > doubtful * stiffest)) continue;
    const std::string key = fmt::format("loads[{}].pressure", i);
    lines.push_back(text(Error{
        where(key), key,
        fmt::format("{:.3g} MPa is {:.0f} times the modulus of the stiffest material; 1 mbar is "
                    "1e-4 MPa, 1 mmHg is 1.33e-4 MPa",
                    pressure, pressure / stiffest),
        "", ""}));
  }
  return lines;
}

}  // namespace

std::vector<std::string> review_lines(const Material& material, const std::string& prefix,
                                      const std::function<Place(const std::string&)>& where) {
  std::vector<std::string> lines;
  for (const MaterialFinding& finding : review(material)) {
    const std::string key = prefix + finding.key;
    lines.push_back(text(Error{where(key), key, finding.words, "", ""}));
  }
  return lines;
}

std::vector<std::string> review_lines(const SolveConfig& config,
                                      const std::optional<Material>& of_file,
                                      const std::function<Place(const std::string&)>& where) {
  std::vector<std::string> lines;
  const auto add = [&](const std::vector<std::string>& more) {
    lines.insert(lines.end(), more.begin(), more.end());
  };
  const auto nowhere = [](const std::string&) {
    return Place{};
  };
  std::vector<Material> materials;
  if (config.material) {
    materials.push_back(*config.material);
    add(review_lines(*config.material, "material.", where));
  } else if (of_file) {
    materials.push_back(*of_file);
    add(review_lines(*of_file, "material.", nowhere));
  }
  for (const auto& [name, body] : config.materials) {
    if (body.material) {
      materials.push_back(*body.material);
      add(review_lines(*body.material, "materials." + name + ".material.", where));
    }
  }
  add(review_pressures(config, materials, where));
  return lines;
}

}  // namespace langer
