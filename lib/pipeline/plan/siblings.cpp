#include "pipeline/plan/siblings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

#include "core/config/writer.hpp"

namespace langer::pipeline {

namespace {

constexpr const char* port = "mirror";

bool is_word(const Tree& config, const char* key, const char* word) {
  const Tree* value = config.find(key);
  return value && value->kind == Tree::Kind::scalar && value->scalar == word;
}

// Whether the pipeline gives a solution at the port `mirror` already.
bool has_mirror(const Step& step) {
  return std::ranges::find(step.inputs, port, &StepInput::port) != step.inputs.end();
}

// Whether the solution of a step may be the image of another one; see siblings.hpp.
bool may_be_an_image(const Step& step) {
  if (!step.stage->port(port) || has_mirror(step)) return false;
  if (is_word(step.config, "symmetry", "none") || is_word(step.config, "reduce", "auto"))
    return false;
  if (step.config.find("accuracy") || step.config.find("fidelity")) return false;
  return !step.config.find("estimate") || is_word(step.config, "estimate", "none");
}

// The fibre angles of a step in degrees; empty if one of them is not a number.
std::vector<double> angles_of(const Step& step) {
  const Tree* list = step.config.find("fibre_angles");
  std::vector<double> angles;
  if (!list || list->kind != Tree::Kind::list) return angles;
  for (const Tree& item : list->list) {
    char* end = nullptr;
    const double angle = std::strtod(item.scalar.c_str(), &end);
    if (item.kind != Tree::Kind::scalar || item.scalar.empty() || *end || !std::isfinite(angle))
      return {};
    angles.push_back(angle);
  }
  return angles;
}

// Whether two sets of fibre families have the same directions, which count modulo 180 degrees. The
// families may be in another order.
bool same_directions(const std::vector<double>& a, std::vector<double> b) {
  for (double angle : a) {
    const auto found = std::ranges::find_if(
        b, [&](double other) { return std::abs(std::remainder(angle - other, 180)) < 1e-9; });
    if (found == b.end()) return false;
    b.erase(found);
  }
  return b.empty();
}

// Whether angle -> sign angle + offset carries the directions a to the directions b.
bool related(const std::vector<double>& a, const std::vector<double>& b, double sign,
             double offset) {
  std::vector<double> image;
  for (double angle : a) image.push_back(sign * angle + offset);
  return same_directions(image, b);
}

bool mirrored(const std::vector<double>& a, const std::vector<double>& b) {
  return related(a, b, 1, 0) || related(a, b, -1, 180);
}

bool turned(const std::vector<double>& a, const std::vector<double>& b) {
  return related(a, b, 1, 90) || related(a, b, -1, 90);
}

// Node, config and inputs of a step without its fibre angles. Members that may be images have the
// same text.
std::string text_without_angles(const Step& step) {
  Tree config = step.config;
  std::erase_if(config.map, [](const Tree::Entry& entry) { return entry.key == "fibre_angles"; });
  std::string text = step.node + "\n" + to_text(config);
  for (const StepInput& input : step.inputs) text += fmt::format("\n{} {}", input.port, input.path);
  return text;
}

}  // namespace

// Members are compared in their order, so a solution is offered by an earlier step only, and no
// step waits for a later one.
void offer_siblings(std::vector<Step>& steps) {
  struct Member {
    std::vector<double> angles;
    std::string output;
  };
  std::map<std::string, std::vector<Member>> earlier;
  for (Step& step : steps) {
    if (!may_be_an_image(step)) continue;
    const Member own{angles_of(step), step.output()};
    if (own.angles.empty()) continue;
    std::vector<Member>& candidates = earlier[text_without_angles(step)];
    const auto first_related = [&](auto&& relation) {
      return std::ranges::find_if(
          candidates, [&](const Member& other) { return relation(other.angles, own.angles); });
    };
    auto sibling = first_related(mirrored);
    if (sibling == candidates.end()) sibling = first_related(turned);
    if (sibling != candidates.end())
      step.inputs.push_back({port, sibling->output, true, step.config.place});
    candidates.push_back(own);
  }
}

}  // namespace langer::pipeline
