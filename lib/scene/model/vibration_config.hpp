// Small vibrations about the state at the end of the path, as the solve stage's YAML may ask for
// them.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/base/fields.hpp"

namespace langer {

struct ModesConfig {
  int count = 10;
  static void fields(auto& v) {
    v(&ModesConfig::count, "count", unit::none, "how many, from the lowest frequency on",
      between(1, 200));
  }
};

enum class FrequencyScale { log, linear };
constexpr auto names(FrequencyScale) { return std::array{"log", "linear"}; }

// A list, or a range: {from: 1, to: 1000, count: 20, scale: log}.
struct FrequenciesConfig {
  static constexpr const char* list_key = "list";
  std::vector<double> list;
  std::optional<double> from, to;
  int count = 20;
  FrequencyScale scale = FrequencyScale::log;
  static void fields(auto& v) {
    constexpr const char* cycles = "Hz";
    const Hint static_limit{"a frequency of 0 is the quasi-static solution itself"};
    v(&FrequenciesConfig::list, "list", cycles, "frequencies", positive, static_limit);
    v(&FrequenciesConfig::from, "from", cycles, "first frequency of a range", positive,
      static_limit);
    v(&FrequenciesConfig::to, "to", cycles, "last frequency of a range", positive);
    v(&FrequenciesConfig::count, "count", unit::none, "frequencies of a range, both ends included",
      between(1, 10000));
    v(&FrequenciesConfig::scale, "scale", unit::none,
      "log: at equal ratios; linear: at equal steps");
  }
  std::vector<Complaint> complaints() const {
    if (!list.empty() && (from || to))
      return {{"list", "found together with a range", "one of the two", ""}};
    if (!list.empty()) return {};
    if (!from || !to)
      return {{"", "found no frequencies", "[1, 10, 100] or {from: 1, to: 1000, count: 20}", ""}};
    if (*to < *from) return {{"to", "found a frequency below from", "from or more", ""}};
    if (count == 1 && *to != *from) return {{"count", "found 1 of a range", "2 or more", ""}};
    return {};
  }
  std::vector<double> values() const {  // [Hz]
    if (!list.empty()) return list;
    std::vector<double> all{*from};
    for (int i = 1; i < count; ++i) {
      const double share = static_cast<double>(i) / (count - 1);
      if (i == count - 1) {
        all.push_back(*to);
      } else if (scale == FrequencyScale::log) {
        all.push_back(std::pow(10, std::log10(*from) + share * std::log10(*to / *from)));
      } else {
        all.push_back(*from + share * (*to - *from));
      }
    }
    return all;
  }
};

struct HarmonicConfig {
  FrequenciesConfig frequencies;
  std::optional<std::string> indenter, face;
  std::optional<std::array<double, 3>> along;
  static void fields(auto& v) {
    v(&HarmonicConfig::frequencies, "frequencies", "Hz",
      "a list, or a range {from: 1, to: 1000, count: 20, scale: log}", required);
    v(&HarmonicConfig::indenter, "indenter", unit::none,
      "the indenter that oscillates, by its name in contacts; none: the only one");
    v(&HarmonicConfig::face, "face", unit::none,
      "instead of an indenter: a node set that oscillates as a whole");
    v(&HarmonicConfig::along, "along", unit::none,
      "direction of the oscillation; any length. None: that in which the indenter was moved or "
      "pushed last; a face needs it");
  }
  std::vector<Complaint> complaints() const {
    std::vector<Complaint> found;
    if (indenter && face)
      found.push_back({"face", "found together with indenter", "one of the two", ""});
    if (along && *along == std::array<double, 3>{})
      found.push_back({"along", "found [0, 0, 0]", "a direction", ""});
    if (face && !along)
      found.push_back({"along", "missing", "the direction in which the face oscillates", ""});
    return found;
  }
};

}  // namespace langer
