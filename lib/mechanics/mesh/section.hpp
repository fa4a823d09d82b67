// A section of a body: one layer of hexahedra, from the plane z = 0 back to
//   axisymmetric  z = depth x, a thin wedge about the y axis: x is the radius
//   plane_strain  z = depth
// Nodes are numbered layer by layer, those in z = 0 first; node i of the layer at the share s of
// the way is node i in front of it moved back, and moves with it:
//   u = (u_x, u_y, s depth u_x) of an axisymmetric body,  u = (u_x, u_y, 0) of plane strain,  u_x = 0 on the axis
// Then F of the trilinear or triquadratic cell is that of the body of revolution, with F_zz = 1 +
// u_r/r at every depth; only the shear s depth (du_r/dr - u_r/r), s depth du_r/dy is too much, and
// its energy is of the order of depth^2. Sets name nodes in z = 0. A cell counts 2 pi/depth times,
// or once: forces and energies are those of the whole circle, or of the slab.
#pragma once

#include <string>
#include <vector>

#include "mechanics/mesh/symmetry.hpp"

namespace langer {

int n_front(const Mesh& mesh);  // nodes in z = 0
double cell_share(const Section& section);
// Facets of a set that are the body's surface: of a section those that turn about its axis or lie
// along its depth, none of its planes.
std::vector<Facet> surface_of(const Mesh& mesh, const std::string& set);
std::vector<Image> section_ties(const Mesh& mesh);

// One layer of cells, zeta along z, in whatever order and place along z -> a section.
void make_section(Mesh& mesh, const Section& section);
// the reason why a mesh with a `section` is no valid one; empty if it is
std::string section_fault(const Mesh& mesh);

std::vector<int> through_layers(const Mesh& mesh, const std::vector<int>& nodes);  // ascending
std::vector<int> in_front(const Mesh& mesh, const std::vector<int>& nodes);        // those in z = 0

// The section with a depth of 2 mm everywhere, for measures of the shape of its cells: det dX/dxi
// is then that of the plane.
Mesh as_plate(const Mesh& mesh);

}  // namespace langer
