// What a wanted accuracy takes: a rung of the ladder that pipelines/trade.yaml measures on three indentations of a block
// (isotropic without friction; Table 1 at 60 degrees and c1 = +0.317 at 30 degrees with friction). Without friction the rungs are
// of hex27, whose error falls fastest there; with friction, where it falls with the first power of the cell whatever the cell is,
// of hex8, which have more nodes in contact for the same time. A rung's error is that of the force in the scenes of its kind.
#pragma once

#include <string>
#include <vector>

#include "scene/solve_config.hpp"

namespace langer {

struct AccuracyRung {
  CellType cells;
  double edge;   // of the cells, in contact radii (IndentedBlock)
  double step;   // largest increment, as a share of the path to the first waypoint's end
  double error;  // [%]
};
const std::vector<AccuracyRung>& accuracy_rungs(bool friction);  // by falling error

struct ChosenRung {
  AccuracyRung rung;
  double wanted = 0;  // [%]
  bool met = false;   // false: the finest there is does not promise that much
  std::string words;
};
// Puts the rung's cells, increments and symmetry into the config; nothing where no accuracy is wanted.
std::optional<ChosenRung> choose_accuracy(SolveConfig& config);

}  // namespace langer
