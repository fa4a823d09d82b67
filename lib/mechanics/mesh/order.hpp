// The order and the exactness of a mesh that some mesher made: the same geometry gives the same
// file.
#pragma once

#include <array>

#include "mechanics/mesh/mesh.hpp"

namespace langer {

// Turns each cell so that its xi, eta, zeta edges lie nearest to the x, y, z axes.
void turn_cells(Mesh& mesh);

// How the blocks around a core are numbered: each as its neighbour turned by 90 degrees, or
// opposite ones as mirror images. Turned blocks look the same after half a turn about the axis, and
// so does every field on them; mirrored ones do not.
enum class Blocks { turned, mirrored };
constexpr auto names(Blocks) { return std::array{"turned", "mirrored"}; }

// Turns the cells outside the square |x|, |z| < core about `axis` (a line along y) so that xi
// points away from the axis and eta up; mirrored: zeta points towards +z in the blocks at +x and
// -x, towards +x in those at +z and -z, and eta up or down. For levelled cells that turn_cells has
// seen.
void turn_outwards(Mesh& mesh, const Vec3& axis, double core, Blocks blocks);

// Numbers nodes by (y, z, x), x fastest, and cells by their centres alike. For meshes without sets.
void number_in_order(Mesh& mesh);

// Where the mesh has mirror planes through `centre` normal to x or z, or is unchanged when x and z
// change places, to 1e-7 of its size, makes that exact to the last digit (where the centre's x and
// z are 0).
void make_symmetric(Mesh& mesh, const Vec3& centre);

}  // namespace langer
