// Letters A to Z of a text as a to z, for words that people write in either case. Bytes of other
// letters stay as they are.
#pragma once

#include <string>

namespace langer {

inline std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

}  // namespace langer
