// The mesh of a scene: as the keys of a config, or as a file that holds it turned.
#pragma once

#include <string>

#include "relations/scene.hpp"

namespace langer::relations {

std::string vector_text(const Vec3& v);  // all digits

std::string mesh_yaml(const Body& body);

// as .inp: a block's hexahedra, or six tetrahedra for each, with all sets, turned by body.turn
std::string inp_text(const Body& body);

}  // namespace langer::relations
