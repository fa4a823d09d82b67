// Scenes drawn at random, of many kinds: what nobody had in mind when a promise was made. The same
// seed gives the same scenes.
#pragma once

#include <cstdint>
#include <string>

namespace langer::test {

struct DrawnScene {
  std::string name;  // <number>_<kind>
  std::string yaml;  // a config of langer-solve without an accuracy
};
// Scene `number` of a seed: kinds in turn, of all kinds of indentation and tension (any), of
// indenters on a disc (section) or of suction.
DrawnScene drawn_scene(std::uint64_t seed, int number, const std::string& kind_of = "any");

}  // namespace langer::test
