// Text of JSON for a page's <script>: nothing in it can end the script, numbers that are not finite
// become null.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/quoted.hpp"
#include "core/base/text.hpp"

namespace langer::report {

struct Json {
  std::string text = "null";
};

inline Json number(double x) { return {std::isfinite(x) ? fmt::format("{:.9g}", x) : "null"}; }

// "</script" and "<!--" mean something to HTML even inside of a string
inline Json words(const std::string& s) { return {quoted(s, "<")}; }

// each item of a range by a function that makes it a Json
Json list(const auto& range, auto&& each) {
  std::string text;
  for (const auto& item : range) append(text, ",", each(item).text);
  return {"[" + text + "]"};
}
inline Json numbers(const std::vector<double>& values) { return list(values, number); }

inline Json object(const std::vector<std::pair<const char*, Json>>& parts) {
  std::string text;
  for (const auto& [key, value] : parts) append(text, ",", words(key).text + ":" + value.text);
  return {"{" + text + "}"};
}

}  // namespace langer::report
