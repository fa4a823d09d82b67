// A path as a time series that ParaView, PyVista, VisIt and meshio open: one .vtu for each state,
// and a .pvd that names them with their times. VTK XML, arrays as they are in memory behind the
// text (appended, raw, header UInt64). Of each place the first scalar, vector and symmetric tensor
// are marked as the active ones; `time` stands as TimeValue in each file.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "mechanics/mesh/mesh.hpp"
#include "results/store/snapshot.hpp"

namespace langer {

// positions are the mesh's own (reference); throws Failure(input) where it cannot be written
void write_vtu(const std::string& path, const Mesh& mesh, double time,
               const std::vector<Field>& point_fields, const std::vector<Field>& cell_fields);
// files: time and path of each state, relative to the .pvd's folder
void write_pvd(const std::string& path, const std::vector<std::pair<double, std::string>>& files);

// attributes Scalars, Vectors, Tensors of a place: names of the first fields with 1, 3, 6
// components; "" where there is none
struct ActiveFields {
  std::string scalars, vectors, tensors;
};
ActiveFields active_fields(const std::vector<Field>& fields);

}  // namespace langer
