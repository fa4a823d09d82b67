// Small scenes drawn at random over the keys of a solve config. The same seed gives the same
// scenes.
#pragma once

#include <cstdint>
#include <string>

#include "relations/scene.hpp"

namespace langer::relations {

struct DrawnScene {
  std::string name;  // <number>_<kind>
  Scene scene;
};

// Kinds take turns; everything else of a scene is drawn.
DrawnScene drawn_scene(std::uint64_t seed, int number);

}  // namespace langer::relations
