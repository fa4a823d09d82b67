// Text as the value of an attribute in XML, for the files that name arrays for other programs.
#pragma once

#include <string>

namespace langer {

inline std::string xml_attribute(const std::string& text) {
  std::string s;
  for (const char c : text) c == '&' ? s += "&amp;" : c == '<' ? s += "&lt;" : c == '"' ? s += "&quot;" : s += c;
  return s;
}

}  // namespace langer
