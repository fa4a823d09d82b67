#include "scene/model/material_review.hpp"

#include "mechanics/material/review.hpp"

namespace langer {

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
  if (config.material) {
    add(review_lines(*config.material, "material.", where));
  } else if (of_file) {
    add(review_lines(*of_file, "material.", nowhere));
  }
  for (const auto& [name, body] : config.materials) {
    if (body.material) {
      add(review_lines(*body.material, "materials." + name + ".material.", where));
    }
  }
  return lines;
}

}  // namespace langer
