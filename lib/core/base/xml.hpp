// Text in XML and HTML, between tags or as the value of an attribute.
#pragma once

#include <string>

namespace langer {

// Control characters, which XML cannot hold, become spaces.
inline std::string xml_text(const std::string& text) {
  std::string s;
  for (const char c : text) {
    if (c == '&')
      s += "&amp;";
    else if (c == '<')
      s += "&lt;";
    else if (c == '>')
      s += "&gt;";
    else if (c == '"')
      s += "&quot;";
    else {
      if (static_cast<unsigned char>(c) < ' ') {
        s += ' ';
      } else {
        s += c;
      }
    }
  }
  return s;
}

}  // namespace langer
