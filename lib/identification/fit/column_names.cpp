#include "identification/fit/column_names.hpp"

#include <algorithm>
#include <map>

namespace langer {

namespace {

using Of = ColumnMeaning::Of;

struct Word {
  Of of;
  bool lengths = false;
  std::optional<StrainMeasure> strain = {};
  std::optional<StressMeasure> stress = {};
};

using Words = std::map<std::string, Word>;

Words words_of_deformation() {
  using enum StrainMeasure;
  const Word deformation{Of::deformation}, elongation{Of::deformation, true};
  const auto by = [](StrainMeasure measure) {
    return Word{Of::deformation, false, measure};
  };
  return {
      {"strain", deformation},
      {"tensile_strain", deformation},
      {"dehnung", deformation},
      {"deformation", deformation},
      {"d\xC3\xA9"
       "formation",
       deformation},
      {"engineering_strain", by(engineering)},
      {"eng_strain", by(engineering)},
      {"nominal_strain", by(engineering)},
      {"technische_dehnung", by(engineering)},
      {"true_strain", by(log)},
      {"log_strain", by(log)},
      {"logarithmic_strain", by(log)},
      {"hencky_strain", by(log)},
      {"wahre_dehnung", by(log)},
      {"green_strain", by(green_lagrange)},
      {"green_lagrange_strain", by(green_lagrange)},
      {"stretch", by(stretch)},
      {"stretch_ratio", by(stretch)},
      {"lambda", by(stretch)},
      {"streckung", by(stretch)},
      {"extension", elongation},
      {"elongation", elongation},
      {"displacement", elongation},
      {"crosshead", elongation},
      {"crosshead_displacement", elongation},
      {"weg", elongation},
      {"standardweg", elongation},
      {"traversenweg", elongation},
      {"verl\xC3\xA4ngerung", elongation},
      {"allongement", elongation},
      {"d\xC3\xA9placement", elongation},
      {"deplacement", elongation},
  };
}

Words words_of_stress() {
  using enum StressMeasure;
  const Word any_stress{Of::stress}, force{Of::stress, false, {}, nominal};
  const auto in = [](StressMeasure measure) {
    return Word{Of::stress, false, {}, measure};
  };
  return {
      {"stress", any_stress},
      {"tensile_stress", any_stress},
      {"spannung", any_stress},
      {"contrainte", any_stress},
      {"cauchy_stress", in(cauchy)},
      {"true_stress", in(cauchy)},
      {"wahre_spannung", in(cauchy)},
      {"nominal_stress", in(nominal)},
      {"engineering_stress", in(nominal)},
      {"eng_stress", in(nominal)},
      {"technische_spannung", in(nominal)},
      {"first_piola_stress", in(nominal)},
      {"pk1_stress", in(nominal)},
      {"second_piola_stress", in(second_piola)},
      {"pk2_stress", in(second_piola)},
      {"force", force},
      {"load", force},
      {"kraft", force},
      {"standardkraft", force},
      {"pr\xC3\xBC"
       "fkraft",
       force},
  };
}

const Words& words() {
  static const Words known = [] {
    Words all = words_of_deformation();
    all.merge(words_of_stress());
    return all;
  }();
  return known;
}

const std::map<std::string, StressUnit>& stress_units() {
  using enum StressUnit;
  static const std::map<std::string, StressUnit> known{
      {"MPa", MPa},      {"N/mm2", MPa}, {"N/mm^2", MPa}, {"N/mm\xC2\xB2", MPa},
      {"N/mm\xB2", MPa}, {"kPa", kPa},   {"Pa", Pa},      {"N", N},
      {"mN", mN},        {"kN", kN}};
  return known;
}

const std::map<std::string, StrainUnit>& strain_units() {
  using enum StrainUnit;
  static const std::map<std::string, StrainUnit> known{
      {"-", fraction},      {"1", fraction}, {"mm/mm", fraction}, {"m/m", fraction}, {"%", percent},
      {"percent", percent}, {"mm", mm},      {"um", um},          {"\xC2\xB5m", um}, {"\xB5m", um}};
  return known;
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t_");
  return first == std::string::npos ? ""
                                    : text.substr(first, text.find_last_not_of(" \t_") + 1 - first);
}

std::string without_brackets(const std::string& unit) {
  const bool in_brackets = unit.size() > 2 && ((unit.front() == '(' && unit.back() == ')') ||
                                               (unit.front() == '[' && unit.back() == ']'));
  return trimmed(in_brackets ? unit.substr(1, unit.size() - 2) : unit);
}

// "Force (N)" -> "Force", "N"
std::pair<std::string, std::string> split_unit(const std::string& name) {
  if (name.ends_with(')') || name.ends_with(']'))
    if (const std::size_t open = name.rfind(name.back() == ')' ? '(' : '[');
        open != std::string::npos && open > 0)
      return {trimmed(name.substr(0, open)), without_brackets(name.substr(open))};
  for (const char* between : {" / ", " in "})
    if (const std::size_t at = name.rfind(between); at != std::string::npos)
      return {trimmed(name.substr(0, at)), trimmed(name.substr(at + std::string(between).size()))};
  if (const std::size_t at = name.find_last_of("_ "); at != std::string::npos && at > 0) {
    const std::string end = name.substr(at + 1);
    if (stress_units().count(end) || (strain_units().count(end) && end != "1"))
      return {trimmed(name.substr(0, at)), end};
  }
  return {trimmed(name), ""};
}

std::string plain(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) {
    return c < 128 ? static_cast<char>(std::tolower(c)) : static_cast<char>(c);
  });
  for (char& c : name)
    if (c == ' ' || c == '-') c = '_';
  return name;
}

std::optional<Word> word(const std::string& name) {
  const auto found = words().find(name);
  if (found != words().end()) return found->second;
  // an axis or a specimen behind it: lambda_x, stretch_1, nominal_stress_z
  if (const std::size_t at = name.rfind('_'); at != std::string::npos && name.size() == at + 2)
    if (const auto stem = words().find(name.substr(0, at)); stem != words().end())
      return stem->second;
  return std::nullopt;
}

}  // namespace

ColumnMeaning column_meaning(const std::string& name, const std::string& unit_below) {
  auto [stem, unit] = split_unit(name);
  if (unit.empty()) unit = without_brackets(unit_below);
  ColumnMeaning m;
  if (const auto stress = stress_units().find(unit); stress != stress_units().end())
    m.stress_unit = stress->second, m.of = Of::stress;
  else if (const auto strain = strain_units().find(unit); strain != strain_units().end())
    m.strain_unit = strain->second;
  else
    m.foreign_unit = unit;
  if (const auto known = word(plain(stem))) {
    m.of = m.foreign_unit.empty() ? known->of : Of::unknown;
    m.lengths = known->lengths, m.strain = known->strain, m.stress = known->stress;
    if (m.stress_unit && is_force(*m.stress_unit)) m.stress = StressMeasure::nominal;
  } else {
    m.of = Of::unknown;
  }
  return m;
}

}  // namespace langer
