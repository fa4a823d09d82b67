// Errors of a result on any mesh, weighted with dual solutions: `estimate: dual`.          [BR01]
//
// A force is the derivative of the energy by the movement that it works on. Its error is therefore
// the derivative of the energy's error (accuracy/estimate/energy_error.hpp) along the body's answer
// to that movement, the dual solution. Each costs one back-substitution with the factor of the last
// state (StateTangent in solve/state_tangent.hpp):
//   force, force_<contact>   the answer to a movement of the indenters along the force
//   reaction_<set>           to a movement of the set along it
//   displacement_<point>     to a force of 1 N there, along the displacement
// The error is a sum over cells, so it also shows which cells to cut (adaptive_cells.hpp).
//
// The recovered fields are smooth. Nodes that come into contact one by one, and the edges of
// clamped faces, are not. For them a share of the sum of the parts' absolute values is added as
// scatter.
// The shares were measured: docs/accuracy.md, "Dual estimates".
#pragma once

#include "accuracy/estimate/error_estimate.hpp"

namespace langer {

// Of the state that `run` was left at, `last` that of the whole body. Throws Failure(not_converged)
// where no error is known, saying why; a quantity for which the cells are too long is left out,
// with a sentence in not_known. Where an accuracy is asked for and cells are too long for every
// quantity, all are left out, and PathErrors::of_cells tells which cells are to be cut.
PathErrors dual_errors(const SolveConfig& config, Run& run, const StepRecord& last,
                       const std::vector<Valued>& found);

}  // namespace langer
