// A result of a stage that is a word and no number, such as the kind of a critical point. Numbers
// are Summary (provenance.hpp).
#pragma once

#include <string>

namespace langer {

struct TextResult {
  std::string name;
  std::string text;
};

}  // namespace langer
