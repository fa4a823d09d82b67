// The estimate of a solve's errors, made and told where its config asks for one.
#pragma once

#include <optional>
#include <vector>

#include "accuracy/error_estimate.hpp"
#include "base/voice.hpp"
#include "run/recording.hpp"

namespace langer {

// Estimates and says them; empty where config asks for none, or where there is none (a warning: the result itself stands).
// Throws Failure with the signal's code where one has come.
std::vector<ErrorEstimate> say_errors(const Voice& voice, const SolveConfig& config, const std::optional<Material>& material,
                                      const Run::Where& where, const Run& run, const StepRecord& last, const Recording& recording);

}  // namespace langer
