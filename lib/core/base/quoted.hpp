// A text between double quotes as JSON reads it, and YAML, which takes JSON's escapes in double
// quotes.
#pragma once

#include <string>
#include <string_view>

#include <fmt/format.h>

namespace langer {

// `also`: letters that are escaped by their number though JSON would not ask for it
inline std::string quoted(const std::string& s, std::string_view also = "") {
  std::string q = "\"";
  for (const char c : s) {
    if (c == '"' || c == '\\')
      q += std::string("\\") + c;
    else if (c == '\n')
      q += "\\n";
    else if (static_cast<unsigned char>(c) < 0x20 || also.find(c) != std::string_view::npos)
      q += fmt::format("\\u{:04x}", static_cast<int>(c));
    else
      q += c;
  }
  return q + "\"";
}

}  // namespace langer
