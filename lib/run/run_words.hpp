// What langer-solve says of a scene before it is solved, and sums up of a run for --json.
#pragma once

#include <string>
#include <vector>

#include "base/voice.hpp"
#include "run/accuracy.hpp"
#include "run/error_estimate.hpp"
#include "run/recording.hpp"

namespace langer {

// laws that are unstable at rest (a warning), fibres that turn between neighbours, the reduction; returns the largest turn [degrees]
double say_scene(const Voice& voice, const Run& run);

// Motions that only contact resists, in words; empty where there are none. Throws Failure(config) for a body that nothing holds.
std::string held_by_contact(const Run& run, const Run::Where& where);

// Estimates and says them; empty where config asks for none, or where there is none (a warning: the result itself stands).
// Throws Failure with the signal's code where one has come.
std::vector<ErrorEstimate> say_errors(const Voice& voice, const SolveConfig& config, const std::optional<Material>& material,
                                      const Run::Where& where, const Run& run, const StepRecord& last, const Recording& recording);

std::vector<Summary> summary_of(const Run& run, const RunEnd& end, int n_steps);
std::vector<Summary> joined(const std::vector<std::vector<Summary>>& parts);

}  // namespace langer
