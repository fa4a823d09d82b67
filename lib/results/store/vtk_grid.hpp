// The parts of a file that hold a mesh: /VTKHDF (ParaView's unstructured grid) and /sets.
// docs/schema.md Shared by mesh.h5, solution.h5 and snapshots. Reading refuses indices out of
// range, positions that are not finite, cells of another type and frames that are not orthonormal.
#pragma once

#include <vector>

#include "core/hdf5/h5.hpp"
#include "mechanics/mesh/mesh.hpp"
#include "mechanics/mesh/triangles.hpp"
#include "results/store/provenance.hpp"

namespace langer {

// /VTKHDF with Version [1, minor...], geometry, body and frames; returns the group
h5::Group write_grid(const h5::Group& root, const Mesh& mesh,
                     const std::vector<std::int64_t>& version);
void write_sets(const h5::Group& root, const Mesh& mesh);
void write_section(const h5::Group& root, const Mesh& mesh);  // of a section only
void write_hanging(const h5::Group& root, const Mesh& mesh);
Schema schema_of(const Schema& schema,
                 const Mesh& mesh);  // readers that know no sections refuse them by their version

Mesh read_grid(const h5::Group& root);  // with sets and frames

void write_triangles(const h5::Group& group, const Triangles& triangles);
Triangles read_triangles(const h5::Group& group);

// flat row-major copies
std::vector<double> flat(const std::vector<Vec3>& vectors);
std::vector<Vec3> vectors(const std::vector<double>& flat);

}  // namespace langer
