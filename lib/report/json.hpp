// Text of JSON for the <script> of a page. Nothing in it can end the script, and numbers that are
// not finite become null.
//
//   object({{"name", words("force")}, {"y", numbers({1, 2})}}).text   is {"name":"force","y":[1,2]}
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/quoted.hpp"
#include "core/base/text.hpp"

namespace langer::report {

// A value of JSON as its text.
struct Json {
  std::string text = "null";
};

// Nine digits are more than a screen shows, and keep the page small.
inline Json number(double x) {
  if (!std::isfinite(x)) return {"null"};
  return {fmt::format("{:.9g}", x)};
}

// A string. HTML interprets "</script" and "<!--" even inside of a string, so "<" is escaped.
inline Json words(const std::string& s) { return {quoted(s, "<")}; }

// A list: `each` makes a Json from an item.
Json list(const auto& range, auto&& each) {
  std::string text;
  for (const auto& item : range) append(text, ",", each(item).text);
  return {"[" + text + "]"};
}
// A list of values that are JSON already.
inline Json list(const std::vector<Json>& values) {
  return list(values, [](const Json& value) { return value; });
}
inline Json numbers(const std::vector<double>& values) { return list(values, number); }

// A map from keys to values, in the given order.
inline Json object(const std::vector<std::pair<const char*, Json>>& parts) {
  std::string text;
  for (const auto& [key, value] : parts) append(text, ",", words(key).text + ":" + value.text);
  return {"{" + text + "}"};
}

}  // namespace langer::report
