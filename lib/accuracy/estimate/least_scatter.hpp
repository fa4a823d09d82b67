// What three meshes cannot show, as a share of the value: lower limits of the scatter of an error
// estimate (docs/accuracy.md, "Estimates by refinement").
//
// Nodes come into contact one by one, and stresses are known in points only. Three meshes may
// therefore agree by chance. `touching` is the number of nodes in contact on the finest mesh of the
// estimate; on a section it is that of a radius.
#pragma once

#include "scene/model/solve_config.hpp"

namespace langer {

// force, from the nodes that come into contact one by one
double one_by_one(double touching, bool section);
// the same of the pull of bonds: they let go gradually, and a node with them counts less
double bond_by_bond(double touching, bool section);
// by how much longer one_by_one() is on a layer that is held below and thinner than two radii of
// the contact; 1 on others, and under planes and flat punches
double on_thin_layer(const SolveConfig& config);

// force with friction, from the shear at the edge of the contact: 0.7 times the square of the
// nodes' distance in contact radii
double shear_at_edge(const SolveConfig& config, double touching);
// the same on a section, where few cells may agree by chance
double shear_on_section(const SolveConfig& config, double touching, bool section);

// force under a punch with a rounded edge
double round_an_edge(const SolveConfig& config, double touching, bool section);
// largest von Mises stress below indenters
double between_points(const SolveConfig& config, double touching, bool section);

// largest von Mises stress of layers, from the cells over their thickness
double across_few_cells(const SolveConfig& config);
// displacement of a point of a body that is indented, in parts of the travel of the indenter
double beside_contact(const SolveConfig& config, double touching, bool section);

// reaction of a clamped body whose values go to and fro on three meshes
double beside_clamps(const SolveConfig& config);

}  // namespace langer
