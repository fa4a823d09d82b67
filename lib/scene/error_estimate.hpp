// What a result is worth: the scene is solved again on cells longer by r = sqrt 2 and by 2, and on those by r in increments of
// another length.
//   cells       max(|q(r h) - q(h)|, |q(2 h) - q(r h)| / r^p) / (r^p - 1): two cells may agree by chance, three rarely. Forces and
//               displacements fall with p = 2 without friction and with p = 1 with it, the greatest stress with p = 1
//   increments  |q(2 dt) - q(dt)| on the coarser cells (first order); nothing where no friction makes the path matter.
//               Of a single increment: twice what halving it changes
//   extrapolated  q(h) - (q(r h) - q(h)) / (r^p - 1), the limit of the two
//   solver      the last residual relative to the forces that it balances
// For meshes of the kind indented_block, whose cells one number scales.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.hpp"
#include "scene/solve_config.hpp"
#include "store/solution_file.hpp"

namespace langer {

struct Valued {
  std::string name, unit;
  double value = 0;
};
// of a state of the whole body: force on the indenter, greatest von Mises stress of the nodes, displacement of each named point
std::vector<Valued> valued(const Scene& scene, const Mesh& mesh, const StepRecord& state);

// of the state at t = 1 of a config that holds its mesh; nothing is written
// Throws Failure(not_converged) where there is none.
std::vector<Valued> end_of_path(const SolveConfig& config, const std::optional<Material>& material,
                                const std::function<Place(const std::string&)>& where);

struct ErrorEstimate {
  Valued of;
  double cells = 0, increments = 0, solver = 0;  // in the unit of the quantity
  double extrapolated = 0;
  double total() const { return cells + increments + solver; }
};

// Of the state that `config` led to. Throws Failure(not_converged) where a coarser scene has no equilibrium,
// Failure(config) for another kind of mesh.
std::vector<ErrorEstimate> estimate_errors(const SolveConfig& config, const std::optional<Material>& material,
                                           const std::function<Place(const std::string&)>& where, const std::vector<Valued>& found,
                                           double residual);

}  // namespace langer
