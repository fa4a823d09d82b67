// A picture of the deformed body: its outer surface in orthographic projection, coloured by a
// field, with colour bar, axes and the rigid indenters. Everything is painted from back to front
// (painter's algorithm), so that no display or graphics library is needed.
//   view      azimuth: turned about the y axis, 0 looks along -z; elevation above the x-z plane
//             [deg]
//   outline   the edges of the undeformed body
//   points    named places, with their names
//   actions   supports and imposed displacements
//   cuts      only the elements on one side of each plane are shown. The first plane that meets an
//             indenter cuts it too.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "mechanics/contact/outline.hpp"
#include "mechanics/mesh/mesh.hpp"
#include "results/plot/drawing.hpp"
#include "results/post/curves.hpp"

namespace langer {

enum class CutNormal { x, y, z };
constexpr auto names(CutNormal) { return std::array{"x", "y", "z"}; }
enum class Side { below, above };
constexpr auto names(Side) { return std::array{"below", "above"}; }

// A plane that cuts the body open.
struct Cut {
  CutNormal axis = CutNormal::z;
  double at = 0;
  Side keep = Side::below;
  static void fields(auto& v) {
    v(&Cut::axis, "axis", unit::none, "normal of the plane", required);
    v(&Cut::at, "at", unit::mm, "reference coordinate of the plane", required);
    v(&Cut::keep, "keep", unit::none, "which side is shown: of smaller or larger coordinates");
  }
};

// The listing `renders`: one picture of the body.
struct RenderChoice {
  std::optional<Quantity> field;
  int family = 1;
  std::string step = "last";
  std::optional<std::array<double, 2>> view;
  std::vector<Cut> cuts;
  std::optional<std::array<double, 2>> range;
  std::vector<std::string> points;
  bool outline = false, actions = false;
  std::string title;
  std::optional<int> mode;
  bool critical = false;
  double amplitude = 0.1;
  static void fields(auto& v) {
    v(&RenderChoice::field, "field", unit::none,
      "quantity of nodes or points that colours the surface; none: the mesh alone");
    v(&RenderChoice::family, "family", unit::none, "of a fibre stretch: which fibre family, from 1",
      at_least(1));
    v(&RenderChoice::step, "step", unit::none,
      "which state: last, a row of the table (0 is unloaded), t=0.5 or u_ind=0.5");
    v(&RenderChoice::view, "view", unit::deg,
      "azimuth and elevation of the eye; none: 35 and 28, of a section 0 and 0",
      between(-360, 360));
    v(&RenderChoice::cuts, "cuts", unit::none,
      "planes; the elements on one side of each are left out");
    v(&RenderChoice::range, "range", unit::none,
      "values at the ends of the colour bar, in the field's unit; by default those shown");
    v(&RenderChoice::points, "points", unit::none, "observation points that are marked and named");
    v(&RenderChoice::outline, "outline", unit::none, "draw the edges of the undeformed body");
    v(&RenderChoice::actions, "actions", unit::none,
      "draw supports and imposed displacements with their values");
    v(&RenderChoice::title, "title", unit::none, "above the picture");
    v(&RenderChoice::mode, "mode", unit::none,
      "draw this natural vibration about the last state (modes in the solve config), from 1 on",
      at_least(1));
    v(&RenderChoice::critical, "critical", unit::none,
      "draw the mode of the first critical point of the path; step: none is the state before it");
    v(&RenderChoice::amplitude, "amplitude", unit::none,
      "of a mode: its largest movement, over the size of the body", between(0, 1));
  }
  std::vector<Complaint> complaints() const;
};

// A displacement that is imposed on a set of nodes; 0 is a support.
struct Action {
  std::vector<Vec3> at;        // some of its nodes, deformed [mm]
  Vec3 along = Vec3::UnitX();  // unit vector of the movement; of a support from outside to the body
  bool moves = false;
  std::string says;  // its label: "u_x = 18 mm"
};

// The deformed body and everything drawn with it.
struct RenderScene {
  const Mesh& mesh;
  std::vector<Vec3> x;             // deformed positions (n) [mm]
  std::vector<double> values;      // of the field (n); empty without a field
  std::string label;               // of the colour bar, with unit; enhanced text
  std::vector<Outline> indenters;  // at their present position
  std::vector<std::pair<std::string, Vec3>> points = {};  // deformed [mm]
  std::vector<Action> actions = {};
};

Drawing render(const RenderScene& scene, const RenderChoice& choice, const Look& look = {});

// The facets that belong to exactly one of the kept elements, corners counter-clockwise seen from
// outside.
std::vector<std::array<int, 4>> outer_surface(const Mesh& mesh, const std::vector<bool>& kept);

}  // namespace langer
