// A law in the words of another program.
#pragma once

#include <string>

#include "core/base/error.hpp"

namespace langer {

struct ForeignLaw {
  std::string text;            // empty where the program lacks the law
  std::string lacks, nearest;  // what it lacks, and what could be written instead
};

// the text, or Failure(config) for what the program lacks
inline std::string held_by(const std::string& program, const ForeignLaw& law) {
  if (law.text.empty())
    throw Failure(Exit::config,
                  Error{{program}, "material", "it lacks " + law.lacks, law.nearest, ""});
  return law.text;
}

}  // namespace langer
