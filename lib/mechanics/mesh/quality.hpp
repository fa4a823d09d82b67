// How well shaped the cells are; a mesh with a Jacobian that is not positive is refused. Of a
// section, in its plane.
//   jacobian          dX/dxi (3,3) [mm]: columns along the xi, eta, zeta edges
//   scaled Jacobian   det of the three normalised edges at a corner: 1 for a brick, <= 0 for a folded cell
//   aspect            longest edge of a cell over its shortest
#pragma once

#include <array>
#include <optional>
#include <string>

#include "mechanics/mesh/mesh.hpp"

namespace langer {

struct Quality {
  double least_jacobian = 0;  // det dX/dxi over nodes and Gauss points [mm^3]; of a section [mm^2]
  int at_cell = -1;           // where that is
  Vec3 at = Vec3::Zero();
  double least_scaled_jacobian = 0;
  double largest_aspect = 0;
  double shortest_edge = 0, longest_edge = 0;  // [mm]
  double volume = 0;  // [mm^3]; of the whole body that a section stands for
};

Mat3 jacobian(const Mesh& mesh, int cell, const Vec3& xi);
Quality quality(const Mesh& mesh);

// two nodes at one place, where the mesh is torn without a gap; nothing where there are none
std::optional<std::array<int, 2>> coincident_nodes(const Mesh& mesh, double closer_than);

// throws Failure(config), `key` naming the part of the config that the mesh came from
void refuse_folded(const Quality& quality, const std::string& key);

}  // namespace langer
