// A path as a time series for ParaView, PyVista, VisIt and meshio: one .vtu file for each state and
// a .pvd file that lists them with their times. The files are VTK XML; the arrays follow the text
// as they are in memory (appended, raw, header UInt64). The first scalar, vector and symmetric
// tensor of points and of elements are marked as the active ones; `time` is TimeValue in each file.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "mechanics/mesh/mesh.hpp"
#include "results/store/snapshot.hpp"

namespace langer {

// The positions are those of the mesh (reference). Throws Failure(input) if the file cannot be
// written.
void write_vtu(const std::string& path, const Mesh& mesh, double time,
               const std::vector<Field>& point_fields, const std::vector<Field>& cell_fields);
// `files` has the time and path of each state, relative to the folder of the .pvd file.
void write_pvd(const std::string& path, const std::vector<std::pair<double, std::string>>& files);

// The attributes Scalars, Vectors and Tensors of points or elements: the names of the first
// fields with 1, 3 and 6 components; "" if there is none.
struct ActiveFields {
  std::string scalars, vectors, tensors;
};
ActiveFields active_fields(const std::vector<Field>& fields);

}  // namespace langer
