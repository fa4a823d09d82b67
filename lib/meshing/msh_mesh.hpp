// A mesh of ours from what a file of Gmsh holds: physical groups are bodies, facet sets and node
// sets. Throws Failure(input) for cells that are not ours, cells of two bodies, faces that belong
// to no cell.
#pragma once

#include <string>
#include <vector>

#include "mechanics/mesh/mesh.hpp"
#include "meshing/msh_model.hpp"

namespace langer {

// `path`: the file, for messages; `notes`: what was left out
Mesh mesh_of(const MshModel& model, const std::string& path, std::vector<std::string>& notes);

}  // namespace langer
