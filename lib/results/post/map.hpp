// Maps: a field on a part of the surface, seen from above. plot/map_drawing.hpp draws them.
//   on      facet set, in its undeformed position; x to the right, z downwards
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "results/plot/map_drawing.hpp"
#include "results/post/curves.hpp"
#include "results/store/curves_file.hpp"

namespace langer {

// The listing `maps`: the field, the part of the surface and the state that a map shows.
struct MapChoice {
  Quantity field = quantity("u_y");
  int family = 1;
  std::string on = "top", step = "last";
  std::vector<std::string> points;
  MapStyle style;
  static void fields(auto& v) {
    v(&MapChoice::field, "field", unit::none, "quantity of nodes or points", required);
    v(&MapChoice::family, "family", unit::none, "of a fibre stretch: which fibre family, from 1",
      at_least(1));
    v(&MapChoice::on, "on", unit::none, "facet set of the mesh, seen from above");
    v(&MapChoice::step, "step", unit::none,
      "which state: last, a row of the table (0 is unloaded), t=0.5 or u_ind=0.5");
    v(&MapChoice::points, "points", unit::none, "observation points that are marked");
    v(&MapChoice::style, "style", unit::none, "how it is drawn");
  }
  std::vector<Complaint> complaints() const;
};

// Names that the body lacks, with keys relative to the map: on, points[0], family.
std::vector<Complaint> complaints(const MapChoice& choice, const Body& body);

// The map of a field from its values at every node of the mesh. Facets and points must exist: see
// complaints().
SurfaceMap surface_map(const Body& body, const MapChoice& choice, const std::string& name,
                       const std::vector<double>& values, double t);

// The value at a place by bilinear interpolation; nothing outside the map.
std::optional<double> value_at(const SurfaceMap& map, const PlanePoint& place);

// The largest |a - b| relative to the largest |b|, over the nodes of b that are inside a and at
// least `beyond` away from x = z = 0.
double difference(const SurfaceMap& a, const SurfaceMap& b, double beyond = 0);

}  // namespace langer
