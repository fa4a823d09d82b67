// The parts of a file that store a mesh: /VTKHDF (ParaView's unstructured grid) and /sets. mesh.h5,
// solution.h5 and snapshots share them. docs/schema.md
// Reading refuses indices out of range, positions that are not finite, elements of another type and
// frames that are not orthonormal.
#pragma once

#include <vector>

#include "core/hdf5/h5.hpp"
#include "mechanics/mesh/mesh.hpp"
#include "mechanics/mesh/triangles.hpp"
#include "results/store/provenance.hpp"

namespace langer {

// Writes /VTKHDF with Version [1, minor...], the geometry, the body and the frame of each
// element; returns the group. Without frames they are the global axes.
h5::Group write_grid(const h5::Group& root, const Mesh& mesh,
                     const std::vector<std::int64_t>& version, bool with_frames = true);
// Whether a frame is anything but the global axes.
bool has_frames(const Mesh& mesh);
void write_sets(const h5::Group& root, const Mesh& mesh);
void write_section(const h5::Group& root, const Mesh& mesh);  // nothing for a body
void write_hanging(const h5::Group& root, const Mesh& mesh);  // nothing without hanging nodes
// The schema of a file with this mesh. Sections and hanging nodes have a higher version, so that
// readers that do not know them refuse the file.
Schema schema_of(const Schema& schema, const Mesh& mesh);

Mesh read_grid(const h5::Group& root);  // with sets and frames

void write_triangles(const h5::Group& group, const Triangles& triangles);
Triangles read_triangles(const h5::Group& group);

// Copies between vectors and their numbers one after another.
std::vector<double> flat(const std::vector<Vec3>& vectors);
std::vector<Vec3> vectors(const std::vector<double>& flat);

}  // namespace langer
