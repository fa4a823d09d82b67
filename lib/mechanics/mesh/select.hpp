// Named sets of a mesh: nodes by plane, box, cylinder or nearness; facets of the boundary; the six
// sides of a block. Limits are included, with a tolerance of 1e-9 of the mesh's size. Sets are
// ascending.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/fields.hpp"
#include "mechanics/mesh/mesh.hpp"

namespace langer {

struct OnPlane {
  static constexpr const char* key = "plane";
  std::string axis;
  double at = 0;
  static void fields(auto& v) {
    v(&OnPlane::axis, "axis", unit::none, "axis that the plane is normal to", required,
      one_of("x", "y", "z"));
    v(&OnPlane::at, "at", unit::mm, "coordinate of the plane", required);
  }
};

struct InBox {
  static constexpr const char* key = "box";
  std::array<double, 3> from{}, to{};
  static void fields(auto& v) {
    v(&InBox::from, "from", unit::mm, "corner with the least coordinates", required);
    v(&InBox::to, "to", unit::mm, "corner with the largest coordinates", required);
  }
};

struct InCylinder {
  static constexpr const char* key = "cylinder";
  std::string axis;
  std::array<double, 3> through{};
  double radius = 0;
  std::optional<double> beyond = {};
  static void fields(auto& v) {
    v(&InCylinder::axis, "axis", unit::none, "direction of the axis; the cylinder has no ends",
      required, one_of("x", "y", "z"));
    v(&InCylinder::through, "through", unit::mm, "a point of the axis");
    v(&InCylinder::radius, "radius", unit::mm, "nodes within this distance of the axis", required,
      positive);
    v(&InCylinder::beyond, "beyond", unit::mm, "and at least this far from it: a ring", positive);
  }
  std::vector<Complaint> complaints() const {
    if (!beyond || *beyond < radius) return {};
    return {{"beyond", "found at least the radius", "less than the radius", ""}};
  }
};

// the one node nearest to a point; of several equally near the first
struct NearestNode {
  static constexpr const char* key = "nearest";
  std::array<double, 3> to{};
  static void fields(auto& v) { v(&NearestNode::to, "to", unit::mm, "point", required); }
};

using Selection = std::variant<OnPlane, InBox, InCylinder, NearestNode>;

double size(const Mesh& mesh);  // diagonal of the bounding box [mm]

// those nodes of `among` that the selection holds
std::vector<int> select(const Mesh& mesh, const Selection& selection,
                        const std::vector<int>& among);
std::vector<int> all_nodes(const Mesh& mesh);

// facets that belong to one cell only, by cell and local number
std::vector<Facet> boundary(const Mesh& mesh);

// facets with all their nodes in an ascending set
std::vector<Facet> facets_within(const Mesh& mesh, const std::vector<Facet>& facets,
                                 const std::vector<int>& nodes);

// x_min ... z_max by the bounding box, and top = y_max, bottom = y_min, as nodes and as facets
void name_sides(Mesh& mesh);
std::vector<std::string> side_names();

}  // namespace langer
