// How maps (post/map.hpp) are drawn: one panel, or several with one colour scale.
//   bands   between round numbers; if the values have both signs, white is 0
//   range   values beyond it have a colour of their own, and the colour bar ends in a tip
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/fields.hpp"
#include "results/plot/drawing.hpp"
#include "results/store/curves_file.hpp"

namespace langer {

// The listing `style` of maps.
struct MapStyle {
  std::optional<double> reach;
  std::optional<std::array<double, 2>> range;
  bool cells = false, fibres = true;
  std::string title;
  static void fields(auto& v) {
    v(&MapStyle::reach, "reach", unit::mm,
      "half the side of the square shown, around x = z = 0; by default all", positive);
    v(&MapStyle::range, "range", unit::none,
      "values at the ends of the colour bar, in the field's unit; by default those shown");
    v(&MapStyle::cells, "cells", unit::none, "draw the edges of the elements");
    v(&MapStyle::fibres, "fibres", unit::none, "draw the direction of the first fibre family");
    v(&MapStyle::title, "title", unit::none, "above the picture");
  }
  std::vector<Complaint> complaints() const;
};

// One map with the title of its panel.
struct MapPanel {
  std::string title;
  const SurfaceMap* map = nullptr;
};
// All panels show the same quantity, with one colour scale. They fill the page row by row.
Drawing map_drawing(const std::vector<MapPanel>& panels, const MapStyle& style, int columns = 1,
                    const Look& look = {});

}  // namespace langer
