#include "core/base/measured_units.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>

#include "core/base/lower_case.hpp"

namespace langer {

namespace {

constexpr const char* unit_separators = " \t_";

std::string without_separators(const std::string& text) {
  const std::size_t first = text.find_first_not_of(unit_separators);
  if (first == std::string::npos) {
    return "";
  }
  return text.substr(first, text.find_last_not_of(unit_separators) + 1 - first);
}

bool is_enclosed(const std::string& text, char open, char close) {
  return text.size() > 2 && text.front() == open && text.back() == close;
}

std::string without_brackets(const std::string& text) {
  const std::string inner = without_separators(text);
  if (is_enclosed(inner, '(', ')') || is_enclosed(inner, '[', ']')) {
    return without_separators(inner.substr(1, inner.size() - 2));
  }
  return inner;
}

struct Spellings {
  MeasuredUnit unit;
  std::set<std::string> texts;
};

// Standard gravity and the pound and inch of 1959 define the units of weight and of psi.
constexpr double gram_force = 9.80665e-3;
constexpr double pound_force = 4.4482216152605;
constexpr double inch = 25.4;

// Spellings in which upper and lower case differ in meaning: mN and MN, mPa and MPa.
const std::array<Spellings, 21>& exact_spellings() {
  using enum UnitKind;
  static const std::array<Spellings, 21> known{{
      {{"fraction", ratio, 1}, {"-", "1", "mm/mm", "m/m", "in/in", "in./in."}},
      {{"percent", ratio, 0.01}, {"%", "percent"}},
      {{"um", length, 1e-3}, {"um", "\xC2\xB5m", "\xCE\xBCm", "\xB5m"}},
      {{"mm", length, 1}, {"mm"}},
      {{"cm", length, 10}, {"cm"}},
      {{"m", length, 1e3}, {"m"}},
      {{"in", length, inch}, {"in", "in.", "inch", "inches"}},
      {{"mN", force, 1e-3}, {"mN"}},
      {{"N", force, 1}, {"N"}},
      {{"kN", force, 1e3}, {"kN"}},
      {{"gf", force, gram_force}, {"gf", "g-f", "gram-force", "grams-force"}},
      {{"kgf", force, 1e3 * gram_force}, {"kgf", "kg-f", "kp"}},
      {{"lbf", force, pound_force}, {"lbf", "lb-f", "lbs-f"}},
      {{"Pa", stress, 1e-6}, {"Pa", "N/m2", "N/m^2", "N/m\xC2\xB2"}},
      {{"kPa", stress, 1e-3}, {"kPa", "kN/m2", "kN/m^2"}},
      {{"MPa", stress, 1}, {"MPa", "N/mm2", "N/mm^2", "N/mm\xC2\xB2", "N/mm\xB2"}},
      {{"GPa", stress, 1e3}, {"GPa"}},
      {{"psi", stress, pound_force / (inch * inch)}, {"psi", "PSI", "lbf/in2", "lbf/in^2"}},
      {{"mbar", stress, 1e-4}, {"mbar"}},
      {{"bar", stress, 0.1}, {"bar"}},
      {{"mmHg", stress, 1.33322387415e-4}, {"mmHg"}},
  }};
  return known;
}

// Times are spelled in any mixture of upper and lower case.
const std::array<Spellings, 6>& time_spellings() {
  using enum UnitKind;
  static const std::array<Spellings, 6> known{{
      {{"us", time, 1e-6}, {"us", "\xC2\xB5s", "\xCE\xBCs", "microseconds"}},
      {{"ms", time, 1e-3}, {"ms", "msec", "millisecond", "milliseconds", "millisekunden"}},
      {{"s", time, 1},
       {"s", "sec", "sec.", "secs", "second", "seconds", "sek", "sekunde", "sekunden", "secondes"}},
      {{"min", time, 60}, {"min", "min.", "mins", "minute", "minutes", "minuten"}},
      {{"h", time, 3600},
       {"h", "hr", "hrs", "hour", "hours", "stunde", "stunden", "heure", "heures", "std"}},
      {{"d", time, 86400}, {"d", "day", "days", "tage", "jours"}},
  }};
  return known;
}

// Units that a heading may end in behind a blank or an underscore. "lambda_m" is no length,
// "I1_bar" no pressure and "Dehnung 1" has no unit.
bool may_follow_blank(const MeasuredUnit& unit, const std::string& text) {
  if (unit.quantity == UnitKind::time || unit.quantity == UnitKind::ratio) {
    return text == "%" || text == "percent" || text == "-" || text == "mm/mm" || text == "m/m" ||
           text == "in/in";
  }
  return text != "m" && text != "in" && text != "in." && text != "kp" && text != "bar";
}

// "Kraft/N", "sigma/MPa", "Spannung/N/mm2": the first slash behind which a unit stands.
std::optional<Heading> split_at_slash(const std::string& name) {
  for (std::size_t at = name.find('/'); at != std::string::npos; at = name.find('/', at + 1)) {
    const std::string words = without_separators(name.substr(0, at));
    const std::string unit = without_brackets(name.substr(at + 1));
    const std::size_t last_word = words.find_last_of(unit_separators);
    std::string before;
    if (last_word == std::string::npos) {
      before = "";
    } else {
      before = words.substr(last_word + 1);
    }
    // "Stiffness N/mm" is a unit of its own
    if (!words.empty() && measured_unit(unit) && !measured_unit(before)) {
      return Heading{words, unit};
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<MeasuredUnit> measured_unit(const std::string& text) {
  const std::string inner = without_brackets(text);
  for (const Spellings& one : exact_spellings()) {
    if (one.texts.count(inner) > 0) {
      return one.unit;
    }
  }
  for (const Spellings& one : time_spellings()) {
    if (one.texts.count(lower_case(inner)) > 0) {
      return one.unit;
    }
  }
  return std::nullopt;
}

Heading split_heading(const std::string& name) {
  // "Force (N)", "Kraft [N]": whatever stands in brackets at the end
  if (name.ends_with(')') || name.ends_with(']')) {
    const std::size_t open = name.rfind(name.ends_with(')') ? '(' : '[');
    if (open != std::string::npos && open > 0) {
      return {without_separators(name.substr(0, open)), without_brackets(name.substr(open))};
    }
  }
  // "Extension / mm", "Strain in %"
  for (const std::string between : {" / ", " in "}) {
    const std::size_t at = name.rfind(between);
    if (at != std::string::npos) {
      return {without_separators(name.substr(0, at)),
              without_separators(name.substr(at + between.size()))};
    }
  }
  // "Fz, gf"
  const std::size_t comma = name.rfind(',');
  if (comma != std::string::npos && comma > 0 && measured_unit(name.substr(comma + 1))) {
    return {without_separators(name.substr(0, comma)), without_brackets(name.substr(comma + 1))};
  }
  // "force_N", "Dehnung %"
  const std::size_t blank = name.find_last_of("_ ");
  if (blank != std::string::npos && blank > 0) {
    const std::string end = name.substr(blank + 1);
    const auto unit = measured_unit(end);
    if (unit && may_follow_blank(*unit, end)) {
      return {without_separators(name.substr(0, blank)), end};
    }
  }
  if (const auto heading = split_at_slash(name)) {
    return *heading;
  }
  return {without_separators(name), ""};
}

std::string time_unit_text(const std::string& name, const std::string& unit_below) {
  const Heading heading = split_heading(name);
  if (!heading.unit.empty()) {
    return heading.unit;
  }
  if (!unit_below.empty()) {
    return without_brackets(unit_below);
  }
  const std::size_t blank = name.find_last_of("_ ");
  std::string end;
  if (blank == std::string::npos) {
    end = name;
  } else {
    end = name.substr(blank + 1);
  }
  const auto unit = measured_unit(end);
  // a column called "s" or "h" alone is no statement; "Minutes" or "seconds" is one
  const bool says_unit = blank != std::string::npos || end.size() > 2;
  if (unit && unit->quantity == UnitKind::time && says_unit) {
    return end;
  }
  return "";
}

}  // namespace langer
