// Cells of Abaqus and CalculiX by the names that *ELEMENT gives them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <fmt/ranges.h>

#include "mechanics/mesh/reference.hpp"

namespace langer {

struct InpCell {
  const ReferenceCell* cell = nullptr;  // that it becomes
  const AbaqusCell* theirs = nullptr;
};

// "C3D8R": letters behind the name of a cell say how it is integrated, or that it is a hybrid
inline std::optional<InpCell> inp_cell(const std::string& type) {
  for (const ReferenceCell& cell : reference_cells())
    for (const AbaqusCell& theirs : cell.names.abaqus.read)
      if (type.starts_with(theirs.name) &&
          type.find_first_not_of("RHIMS", std::string(theirs.name).size()) == type.npos)
        return InpCell{&cell, &theirs};
  return std::nullopt;
}

inline std::string known_inp_cells() {
  std::vector<std::string> known;
  for (const ReferenceCell& cell : reference_cells())
    for (const AbaqusCell& theirs : cell.names.abaqus.read) known.push_back(theirs.name);
  return fmt::format("one of {}, or the like with R, H, I, M or S behind", fmt::join(known, ", "));
}

}  // namespace langer
