// A gmsh session: one at a time, quiet, independent of the user's gmsh settings.
// What gmsh refuses is thrown as Failure(config) with its own last words.
#pragma once

#include <gmsh.h>

#include <array>
#include <string>

#include "base/error.hpp"
#include "base/traps.hpp"
#include "mesh/mesh.hpp"

namespace langer {

class GmshSession {
 public:
  GmshSession() {
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::option::setNumber("General.NumThreads", 1);  // the same mesh whatever the machine
    gmsh::model::add("langer");
  }
  ~GmshSession() { gmsh::finalize(); }
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;
};

// runs `build` in a session and returns the mesh that it leaves behind, before any sets and frames
template <class Build>
Mesh meshed_by_gmsh(const std::string& key, Build build);

// our corner a of a hexahedron is gmsh's local node order[a]
std::array<int, 8> hexahedron_order(int type);

// hexahedra of the current model, in VTK order; throws where there are none, or other cells beside them
Mesh to_mesh();

template <class Build>
Mesh meshed_by_gmsh(const std::string& key, Build build) {
  const GmshSession session;
  try {
    build();
    {
      const NoTraps in_gmsh;
      gmsh::model::mesh::generate(3);
    }
    return to_mesh();
  } catch (const Failure&) {
    throw;
  } catch (...) {  // gmsh 4.8 throws texts, later ones exceptions
    std::string words;
    gmsh::logger::getLastError(words);
    throw Failure(Exit::config,
                  Error{{}, key, "gmsh cannot mesh this: " + (words.empty() ? "no reason given" : words), "", ""});
  }
}

}  // namespace langer
