#include "identification/setup/file_name_sizes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <vector>

#include "core/base/csv_table.hpp"
#include "core/base/error.hpp"

namespace langer {

namespace {

const std::set<std::string> known_keys{"width",   "thickness",      "gauge_length",
                                       "width_z", "gauge_length_z", "fibre_angle"};

// A pattern is a row of parts: fixed text, any text, or a number of a key.
struct Part {
  enum class Kind { text, anything, number };
  Kind kind = Kind::text;
  std::string text;  // the fixed text, or the key
};

struct NamePattern {
  std::vector<Part> parts;
  std::string mistake;
};

// Splits a pattern into its texts and the names in braces.
NamePattern parse_pattern(const std::string& pattern) {
  NamePattern parsed;
  std::set<std::string> seen;
  std::string text;
  const auto finish_text = [&] {
    if (!text.empty()) parsed.parts.push_back({Part::Kind::text, text});
    text.clear();
  };
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (pattern[i] == '*') {
      finish_text();
      parsed.parts.push_back({Part::Kind::anything, ""});
    } else if (pattern[i] == '{') {
      finish_text();
      const std::size_t end = pattern.find('}', i);
      if (end == std::string::npos) {
        parsed.mistake = "found a brace that is not closed";
        return parsed;
      }
      const std::string key = pattern.substr(i + 1, end - i - 1);
      if (known_keys.count(key) == 0) {
        parsed.mistake = "found {" + key + "}";
        return parsed;
      }
      if (!seen.insert(key).second) {
        parsed.mistake = "found {" + key + "} twice";
        return parsed;
      }
      parsed.parts.push_back({Part::Kind::number, key});
      i = end;
    } else {
      text += pattern[i];
    }
  }
  finish_text();
  if (seen.empty()) parsed.mistake = "found no size in braces";
  return parsed;
}

// The number at the beginning of a text: its value, and how many characters it has.
struct LeadingNumber {
  double value = 0;
  std::size_t length = 0;
};

// The number at the beginning of a text; the letter p may stand for the decimal point.
std::optional<LeadingNumber> leading_number(const std::string& text) {
  std::size_t end = 0;
  if (text.starts_with('-')) end = 1;
  bool point = false;
  std::string plain = text.substr(0, end);
  for (; end < text.size(); ++end) {
    const bool digit = text[end] >= '0' && text[end] <= '9';
    const bool digit_follows =
        end + 1 < text.size() && text[end + 1] >= '0' && text[end + 1] <= '9';
    const bool decimals = !point && digit_follows && (text[end] == '.' || text[end] == 'p');
    if (!digit && !decimals) break;
    point = point || decimals;
    plain += digit ? text[end] : '.';
  }
  const auto value = csv_number(plain);
  if (!value) return std::nullopt;
  return LeadingNumber{*value, end};
}

// Matches the parts from `part` on with the text from `at` on; any text is tried from the shortest.
bool match(const std::vector<Part>& parts, std::size_t part, const std::string& name,
           std::size_t at, std::map<std::string, double>& found) {
  if (part == parts.size()) {
    return at == name.size();
  }
  const Part& next = parts[part];
  if (next.kind == Part::Kind::text) {
    return name.compare(at, next.text.size(), next.text) == 0 &&
           match(parts, part + 1, name, at + next.text.size(), found);
  }
  if (next.kind == Part::Kind::number) {
    const auto number = leading_number(name.substr(at));
    if (!number || !match(parts, part + 1, name, at + number->length, found)) return false;
    found[next.text] = number->value;
    return true;
  }
  for (std::size_t end = at; end <= name.size(); ++end) {
    if (match(parts, part + 1, name, end, found)) return true;
  }
  return false;
}

}  // namespace

std::string mistake_in_pattern(const std::string& pattern) {
  const NamePattern parsed = parse_pattern(pattern);
  const auto any = std::count(pattern.begin(), pattern.end(), '*');
  if (parsed.mistake.empty() && any > 4) return "found more than four *";
  return parsed.mistake;
}

// Matches the name of a file with the pattern and returns the sizes that it holds.
std::map<std::string, double> sizes_in_file_name(const std::string& path,
                                                 const std::string& pattern) {
  // ".5" of a name without an ending belongs to a number
  const std::filesystem::path file(path);
  const std::string ending = file.extension().string();
  const bool is_number = ending.size() > 1 && ending[1] >= '0' && ending[1] <= '9';
  std::string name = file.stem().string();
  if (is_number) name += ending;
  std::map<std::string, double> found;
  if (!match(parse_pattern(pattern).parts, 0, name, 0, found)) {
    throw Failure(Exit::input, {{path, 0, 0},
                                "name_pattern",
                                fmt::format("found the name {}", name),
                                "a name that matches " + pattern,
                                "* stands for any text, such as that in front of the first size"});
  }
  return found;
}

}  // namespace langer
