// mesh.h5: a static VTKHDF file with sets and frames. docs/schema.md
#pragma once

#include <string>

#include "mechanics/mesh/mesh.hpp"
#include "results/store/identity.hpp"
#include "results/store/provenance.hpp"

namespace langer {

void write_mesh(const std::string& path, const Mesh& mesh, const Identity& identity,
                const std::vector<Summary>& summary = {});

struct MeshFile {
  Mesh mesh;
  std::string content_id;
};
// Throws Failure(input) with the path and the fault.
MeshFile read_mesh(const std::string& path);

}  // namespace langer
