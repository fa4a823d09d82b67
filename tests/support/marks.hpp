// The marks of one kind in a drawing.
#pragma once

#include <variant>
#include <vector>

#include "results/plot/drawing.hpp"

namespace langer::test {

template <class Mark>
std::vector<Mark> marks_of(const Drawing& drawing) {
  std::vector<Mark> marks;
  for (const auto& mark : drawing.marks)
    if (const Mark* m = std::get_if<Mark>(&mark)) marks.push_back(*m);
  return marks;
}

}  // namespace langer::test
