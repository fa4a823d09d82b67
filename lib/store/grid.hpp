// The parts of a file that hold a mesh: /VTKHDF (ParaView's unstructured grid) and /sets.                docs/schema.md
// Shared by mesh.h5, solution.h5 and snapshots. Reading refuses indices out of range, positions that are not finite,
// cells of another type and frames that are not orthonormal.
#pragma once

#include <vector>

#include "mesh/mesh.hpp"
#include "store/h5.hpp"

namespace langer {

// /VTKHDF with Version [1, minor...], geometry, body and frames; returns the group
h5::Group write_grid(const h5::Group& root, const Mesh& mesh, const std::vector<std::int64_t>& version);
void write_sets(const h5::Group& root, const Mesh& mesh);

Mesh read_grid(const h5::Group& root);  // with sets and frames

// flat row-major copies
std::vector<double> flat(const std::vector<Vec3>& vectors);
std::vector<Vec3> vectors(const std::vector<double>& flat);

}  // namespace langer
