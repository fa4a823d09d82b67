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

bool may_be_an_image(const Step& step) {
  if (!step.stage->port(port) || is_word(step.config, "symmetry", "none")) return false;
  const Tree* estimate = step.config.find("estimate");
  return !step.config.find("accuracy") && !step.config.find("fidelity") &&
         !is_word(step.config, "reduce", "auto") &&
         (!estimate || is_word(step.config, "estimate", "none")) &&
         std::none_of(step.inputs.begin(), step.inputs.end(),
                      [](const StepInput& input) { return input.port == port; });
}

// of the fibres, of which a and -a are the same: [0, 180) degrees; empty where they are none
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

// families may change places
bool same_lines(const std::vector<double>& a, std::vector<double> b) {
  for (double angle : a) {
    const auto found = std::find_if(b.begin(), b.end(), [&](double other) {
      return std::abs(std::remainder(angle - other, 180)) < 1e-9;
    });
    if (found == b.end()) return false;
    b.erase(found);
  }
  return b.empty();
}

bool by_operation(const std::vector<double>& a, const std::vector<double>& b, double sign,
                  double more) {
  std::vector<double> turned;
  for (double angle : a) turned.push_back(sign * angle + more);
  return same_lines(turned, b);
}

bool mirrored(const std::vector<double>& a, const std::vector<double>& b) {
  return by_operation(a, b, 1, 0) || by_operation(a, b, -1, 180);
}

bool turned(const std::vector<double>& a, const std::vector<double>& b) {
  return by_operation(a, b, 1, 90) || by_operation(a, b, -1, 90);
}

// what members that may be images have in common
std::string all_but_angles(const Step& step) {
  Tree config = step.config;
  std::erase_if(config.map, [](const Tree::Entry& entry) { return entry.key == "fibre_angles"; });
  std::string text = step.node + "\n" + to_text(config);
  for (const StepInput& input : step.inputs) text += fmt::format("\n{} {}", input.port, input.path);
  return text;
}

}  // namespace

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
    std::vector<Member>& alike = earlier[all_but_angles(step)];
    const auto of = [&](auto&& related) {
      return std::find_if(alike.begin(), alike.end(),
                          [&](const Member& other) { return related(other.angles, own.angles); });
    };
    auto sibling = of(mirrored);
    if (sibling == alike.end()) sibling = of(turned);
    if (sibling != alike.end())
      step.inputs.push_back({port, sibling->output, true, step.config.place});
    alike.push_back(own);
  }
}

}  // namespace langer::pipeline
