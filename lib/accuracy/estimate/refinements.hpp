// The scenes that an estimate by refinement solves in addition to the one that it judges: which
// meshes and which increments (accuracy/estimate/error_estimate.hpp).
#pragma once

#include <array>
#include <functional>
#include <map>
#include <vector>

#include "core/base/error.hpp"
#include "scene/model/solve_config.hpp"

namespace langer {

struct Refinements {
  std::vector<SolveConfig> hex8, hex27;  // without what is known
  std::vector<double> length;            // of the hex8 meshes' cells, `own` included
  std::vector<double> hex27_length;      // of the hex27 meshes' cells, the solved one included
  bool own = false;                      // the solved mesh is the finest of its family
  bool edge_unresolved =
      false;  // the cells are too long for the shear at the edge of a contact with friction
  SolveConfig other_increments;
  double per_change =
      0;  // error of the increments per what these change; 0: none, the path does not matter
  std::map<Truncation, std::array<SolveConfig, 2>>
      wider;  // than the one with the longest cells (accuracy/estimate/truncation.hpp)
  int n_scenes() const {
    return static_cast<int>(hex8.size() + hex27.size() + 2 * wider.size()) + (per_change != 0);
  }
};

// Throws Failure(config, not_converged) for a mesh that coarser ones cannot be made from.
Refinements refinements(const SolveConfig& config,
                        const std::function<Place(const std::string&)>& where);

// Of a body in motion: two scenes whose elements and increments are longer by one factor, which is
// `length`. Throws as refinements().
struct LongerScene {
  SolveConfig config;
  double length = 1;
};
std::vector<LongerScene> longer_in_space_and_time(
    const SolveConfig& config, const std::function<Place(const std::string&)>& where);

}  // namespace langer
