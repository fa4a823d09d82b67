// What has to stay the same when a scene is posed in another way, and how two answers are compared.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "relations/scene.hpp"
#include "relations/solve.hpp"

namespace langer::relations {

struct Twin {
  std::string relation;
  Scene scene;
  Change change;           // from the answer of the scene to that of the twin
  bool last_only = false;  // other increments: only the ends of the paths are compared
  bool killed = false;     // killed on its way, and run again
  bool may_fail = false;   // another way of solving, which need not converge
};

// all twins that a scene has; `seed` decides what is drawn of them, such as an angle
std::vector<Twin> twins(const Scene& scene, std::uint64_t seed);

// Differences above the tolerance, one line each; the tolerance is a share of the largest value of
// each quantity on the path.
std::vector<std::string> differences(const Answer& scene, const Answer& twin, const Twin& how,
                                     double tolerance);

}  // namespace langer::relations
