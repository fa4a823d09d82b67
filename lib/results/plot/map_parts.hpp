// What maps of values and of fields draw alike.
#pragma once

#include <string>

#include "results/plot/drawing.hpp"

namespace langer::map_parts {

constexpr Colour ink{0.15, 0.15, 0.15}, grey{0.8, 0.8, 0.8};

inline Patch box(double x, double y, double w, double h, const Colour& colour, double hem = 0) {
  return {{{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}}, colour, hem};
}

inline Label label(double x, double y, const std::string& text, double size = 13,
                   Label::Anchor anchor = Label::Anchor::middle) {
  return {{x, y}, text, size, anchor};
}

}  // namespace langer::map_parts
