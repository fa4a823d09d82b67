// Errors of a result on any mesh, weighted with the dual solution of each quantity: one
// back-substitution with the factor of the last state each (Statics::movement), and integrals over
// recovered fields (accuracy/estimate/energy_error.hpp).
//   force, force_<contact>   the body's answer to a movement of the indenters along the force
//   reaction_<set>           to a movement of the set along it
//   displacement_<point>     to a force of 1 N there, along the displacement
// What the fields cannot tell is put into the bar as scatter, a share of the sum of all cells'
// parts without their signs: nodes that come into contact one by one, and, where faces are clamped,
// the neighbourhood of their edges, where nothing is smooth. The shares were measured
// (docs/work_precision.md).
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
