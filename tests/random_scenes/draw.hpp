// Scenes drawn at random, of many kinds: what nobody had in mind when a promise was made. The same
// seed gives the same scenes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace langer::test {

struct DrawnScene {
  std::string name;  // <number>_<kind>
  std::string yaml;  // a config of langer-solve without an accuracy
};
// Names of single kinds that may be asked for.
std::vector<std::string> names_of_kinds();

// Scene `number` of a seed: kinds in turn, of all of them (any), of indenters on a disc (section)
// or of suction; or one kind by name. STL files are those of tools.hpp, beside the config.
DrawnScene drawn_scene(std::uint64_t seed, int number, const std::string& kind_of = "any");

}  // namespace langer::test
