// The order and the exactness of a mesh that some mesher made: the same geometry gives the same file.
#pragma once

#include "mesh/mesh.hpp"

namespace langer {

// Turns each cell so that its xi, eta, zeta edges lie nearest to the x, y, z axes.
void turn_cells(Mesh& mesh);

// Numbers nodes by (y, z, x), x fastest, and cells by their centres alike. For meshes without sets.
void number_in_order(Mesh& mesh);

// Where the mesh has mirror planes through `centre` normal to x or z, or is unchanged when x and z change places,
// to 1e-7 of its size, makes that exact to the last digit (where the centre's x and z are 0).
void make_symmetric(Mesh& mesh, const Vec3& centre);

}  // namespace langer
