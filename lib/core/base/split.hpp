// Splits a text at separators. A separator at the end ends the last part and begins no further one.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace langer {

inline std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

}  // namespace langer
