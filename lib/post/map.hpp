// Maps: a field on a part of the surface, seen from above, as bands of equal colour. One panel, or several on one scale.
//   on      facet set; x to the right, z downwards, undeformed places
//   bands   between round numbers; where the values have both signs white is 0, blue below and red above
//   range   values beyond it take a colour of their own, and the colour bar ends in a tip
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plot/drawing.hpp"
#include "post/curves.hpp"
#include "store/curves_file.hpp"

namespace langer {

struct MapStyle {
  std::optional<double> reach;
  std::optional<std::array<double, 2>> range;
  bool cells = false, fibres = true;
  std::string title;
  static void fields(auto& v) {
    v(&MapStyle::reach, "reach", unit::mm, "half the side of the square shown, around x = z = 0; by default all", positive);
    v(&MapStyle::range, "range", unit::none, "values at the ends of the colour bar, in the field's unit; by default those shown");
    v(&MapStyle::cells, "cells", unit::none, "draw the edges of the cells");
    v(&MapStyle::fibres, "fibres", unit::none, "draw the direction of the first fibre family");
    v(&MapStyle::title, "title", unit::none, "above the picture");
  }
  std::vector<Complaint> complaints() const;
};

struct MapChoice {
  Quantity field = quantity("u_y");
  int family = 1;
  std::string on = "top", step = "last";
  std::vector<std::string> points;
  MapStyle style;
  static void fields(auto& v) {
    v(&MapChoice::field, "field", unit::none, "quantity of nodes or points", required);
    v(&MapChoice::family, "family", unit::none, "of a fibre stretch: which fibre family, from 1", at_least(1));
    v(&MapChoice::on, "on", unit::none, "facet set of the mesh, seen from above");
    v(&MapChoice::step, "step", unit::none, "which state: last, a row of the table (0 is unloaded), t=0.5 or u_ind=0.5");
    v(&MapChoice::points, "points", unit::none, "observation points that are marked");
    v(&MapChoice::style, "style", unit::none, "how it is drawn");
  }
  std::vector<Complaint> complaints() const;
};

// what the body lacks, with keys relative to the map: on, points[0], family
std::vector<Complaint> complaints(const MapChoice& choice, const Body& body);

// values: of the field at every node of the mesh; facets and points must be there
SurfaceMap surface_map(const Body& body, const MapChoice& choice, const std::string& name, const std::vector<double>& values,
                       double t);

// value at a place by bilinear interpolation; nothing outside the map
std::optional<double> value_at(const SurfaceMap& map, const PlanePoint& place);

// largest |a - b| relative to the largest |b|, over the nodes of b that lie in a and not nearer to x = z = 0 than `beyond`
double difference(const SurfaceMap& a, const SurfaceMap& b, double beyond = 0);

struct MapPanel {
  std::string title;
  const SurfaceMap* map = nullptr;
};
// all panels show the same quantity; one colour scale for all
Drawing map_drawing(const std::vector<MapPanel>& panels, const MapStyle& style, int columns = 1);

}  // namespace langer
