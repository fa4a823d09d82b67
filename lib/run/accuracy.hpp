// What a wanted accuracy takes: a rung of the ladder that pipelines/trade.yaml measures on three indentations of a block
// (isotropic without friction; Table 1 at 60 degrees and c1 = +0.317 at 30 degrees with friction). Isotropic bodies without friction
// get hex27, whose error falls fastest there; all others hex8: with friction nodes stick too early by a share of their distance, and
// hex8 have more of them in contact for the same time; with fibres and no friction hex27 were up to 1.3 % off where hex8 were 0.4
// (make accuracy). A rung's error is that of the force in the scenes of its kind.
#pragma once

#include <string>
#include <vector>

#include "run/error_estimate.hpp"
#include "scene/solve_config.hpp"

namespace langer {

struct AccuracyRung {
  CellType cells;
  double edge;   // of the cells, in contact radii (IndentedBlock)
  double step;   // largest increment, as a share of the path to the first waypoint's end
  double error;  // [%]
};
const std::vector<AccuracyRung>& accuracy_rungs(bool plain);  // by falling error; plain: isotropic, without friction

struct ChosenRung {
  AccuracyRung rung;
  double wanted = 0;  // [%]
  bool met = false;   // false: the finest there is does not promise that much
  std::string words;
};
// Puts the rung's cells, increments and symmetry into the config; nothing where no accuracy is wanted.
// material: of the bodies that the config names none for
std::optional<ChosenRung> choose_accuracy(SolveConfig& config, const std::optional<Material>& material);

// What was reached of it: the largest estimated error of a force; what the rung promises where nothing was estimated.
struct ReachedAccuracy {
  double percent = 0;
  bool met = false;
  std::string words;  // where it is not: what was asked for, what was found, what to do
};
ReachedAccuracy reached(const ChosenRung& chosen, const std::vector<ErrorEstimate>& estimates);

}  // namespace langer
