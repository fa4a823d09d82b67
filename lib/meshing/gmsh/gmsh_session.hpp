// A gmsh session: one at a time, quiet, independent of the user's gmsh settings.
#pragma once

#include <gmsh.h>

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

}  // namespace langer
