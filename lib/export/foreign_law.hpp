// A material model in the input language of another program.
#pragma once

#include <string>

#include "core/base/error.hpp"

namespace langer {

struct ForeignLaw {
  std::string text;     // empty if the program lacks the model
  std::string lacks;    // the part that it lacks
  std::string nearest;  // the closest alternative
};

// The text. Throws Failure(config) if the program lacks the model.
inline std::string require_text(const std::string& program, const ForeignLaw& law) {
  if (law.text.empty())
    throw Failure(Exit::config,
                  Error{{program}, "material", "it lacks " + law.lacks, law.nearest, ""});
  return law.text;
}

}  // namespace langer
