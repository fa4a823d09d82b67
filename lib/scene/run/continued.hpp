// What lets a solve go on from the steps that an earlier run kept.
#pragma once

#include "results/store/solution_file.hpp"
#include "scene/model/solve_config.hpp"

namespace langer {

// Identity with the hash of what the steps depend on: all of the config but threads, blas_threads,
// solver, path.smallest, on_unstable and estimate, which say how equilibrium is found, when to give
// up and what is told of it.
Identity with_steps_hash(Identity identity, const SolveConfig& config);

// Where the tolerance is smaller than in the run that kept a step, the step's residual has to be
// within it; says where one is not.
SolutionWriter::StillGood within_tolerance(const SolveConfig& config);

}  // namespace langer
