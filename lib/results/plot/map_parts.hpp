// Parts of drawings that maps of values and of fields share.
#pragma once

#include <string>

#include "results/plot/drawing.hpp"

namespace langer::map_parts {

constexpr Colour ink{0.15, 0.15, 0.15}, grey{0.8, 0.8, 0.8};

// A rectangle with its upper left corner at (x, y).
inline Patch box(double x, double y, double w, double h, const Colour& colour,
                 double border_width = 0) {
  return {{{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}}, colour, border_width};
}

// A text of a drawing, centred at x by default.
inline Label label(double x, double y, const std::string& text, double size = 13,
                   Label::Anchor anchor = Label::Anchor::middle) {
  return {{x, y}, text, size, anchor};
}

}  // namespace langer::map_parts
