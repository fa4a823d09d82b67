// Geometries of two-dimensional scenes: sections in the plane z = 0, one layer of cells deep
// (mesh/section.hpp).
//   SectionBox    a rectangle on two families of grid lines; axisymmetric: a cylinder, or a tube where origin is not on the axis
//   IndentedDisc  a disc under a round indenter on its axis; cells by one number, those of a quarter of an IndentedBlock
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/base/fields.hpp"
#include "mechanics/mesh/mesh.hpp"
#include "meshing/box.hpp"

namespace langer {

struct SectionBox {
  static constexpr const char* key = "section";
  SectionOf of = SectionOf::axisymmetric;
  std::array<double, 2> origin{}, size{};
  std::array<int, 2> divisions{1, 1};
  std::optional<TowardsCentre> centre;
  std::optional<TowardsTop> top;
  std::optional<double> thickness;
  std::optional<std::array<int, 2>> instead;  // of `divisions`, graded as they are; not for files
  std::vector<double>
      borders;  // y of the faces between layers: grid lines go through them; not for files
  std::optional<MeshFamily> family;  // not for files
  static void fields(auto& v) {
    v(&SectionBox::of, "of", unit::none,
      "a body of revolution about the y axis, x being the radius, or one that does not move along z",
      required);
    v(&SectionBox::origin, "origin", unit::mm, "corner with the least coordinates, x and y");
    v(&SectionBox::size, "size", unit::mm, "lengths along x and y", required, between(1e-3, 1e6));
    v(&SectionBox::divisions, "divisions", unit::none, "number of cells along x and y", required,
      between(1, 1000));
    v(&SectionBox::centre, "centre", unit::none,
      "refinement in x towards the side that is nearest to the axis; of plane strain towards the middle; none: even cells");
    v(&SectionBox::top, "top", unit::none, "refinement towards the top in y; none: even cells");
    v(&SectionBox::thickness, "thickness", unit::mm,
      "of plane strain, along z: forces and energies are those of it; none: 1", positive);
  }
  Box spans() const { return {{origin[0], origin[1], 0}, {size[0], size[1], 0}}; }
  std::array<int, 2> numbers() const;  // of cells, as meshed
  std::vector<Complaint> complaints() const;
};

struct IndentedDisc {
  static constexpr const char* key = "indented_disc";
  std::array<double, 2> size{};
  double base = 0, radius = 0, depth = 0, edge = 0.175;
  double longer = 1;  // all cells by this factor, as nearly as their numbers allow; not for files
  std::optional<double> even;   // how far from the axis cells are even; none: 1.1 radii of the
                                // contact; not for files [mm]
  std::vector<double> borders;  // y of the faces between layers; not for files
  static void fields(auto& v) {
    v(&IndentedDisc::size, "size", unit::mm, "radius and thickness of the disc", required,
      between(1e-3, 1e6));
    v(&IndentedDisc::base, "base", unit::mm, "y of its lower face");
    v(&IndentedDisc::radius, "radius", unit::mm, "of the indenter", required, positive);
    v(&IndentedDisc::depth, "depth", unit::mm, "how deep it is pressed, at most", required,
      positive);
    v(&IndentedDisc::edge, "edge", unit::none,
      "length of the cells under the indenter, in radii of the contact", between(0.002, 1));
  }
  Box spans() const { return {{0, base, 0}, {size[0], size[1], 0}}; }
  SectionBox section() const;
  std::vector<Complaint> complaints() const;
};

}  // namespace langer
