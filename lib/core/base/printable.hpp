// Control characters in names. A line break in a name ends a comment of a Makefile, and an escape
// sequence in a message moves the cursor of a terminal: names with such characters are refused
// where they reach a generated file, and shown by their codes in messages.
#pragma once

#include <algorithm>
#include <string>

#include <fmt/format.h>

namespace langer {

inline bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < 0x20 || byte == 0x7f;
}

inline bool has_control(const std::string& text) {
  return std::any_of(text.begin(), text.end(), is_control);
}

// The text with every control character as \n, \t or \x1b. `kept` stay as they are.
inline std::string printable(const std::string& text, const std::string& kept = "") {
  std::string shown;
  for (const char c : text) {
    if (!is_control(c) || kept.find(c) != std::string::npos) {
      shown += c;
    } else if (c == '\n') {
      shown += "\\n";
    } else if (c == '\t') {
      shown += "\\t";
    } else {
      shown += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    }
  }
  return shown;
}

}  // namespace langer
