// Makes the error estimate of a run if its config asks for one, and prints it.
#pragma once

#include <optional>
#include <vector>

#include "accuracy/checks/recording.hpp"
#include "accuracy/estimate/error_estimate.hpp"
#include "accuracy/estimate/recovered_path.hpp"
#include "core/base/voice.hpp"

namespace langer {

// Which estimate a run gets: that of its config; with auto that by other meshes where it takes less
// than a third of the solve by the forecast; else, and where the config has no such key, that by
// recovery where it tells anything (accuracy/estimate/recovered_path.hpp), else none. auto says
// why.
EstimateBy estimate_of(const Voice& voice, const SolveConfig& config,
                       const std::optional<Material>& material, const Run::Where& where, Run& run);

// Estimates and details them, and what half of them would cost; empty where config.estimate says
// none, or where there is none (a warning: the result itself stands). resolved: contact is, by the
// cells. Throws Failure with the signal's code where one has come.
PathErrors report_errors(const Voice& voice, const SolveConfig& config,
                         const std::optional<Material>& material, const Run::Where& where, Run& run,
                         const StepRecord& last, const Recording& recording,
                         const RecoveredPath& recovered, bool resolved);

// The last words of a run: what it was solved for, with its error bar. Forces, torques and travels,
// or whatever has an estimate where there are none.
void report_results(const Voice& voice, const SolveConfig& config, const Run& run,
                    const StepRecord& last, const std::vector<ErrorEstimate>& estimates);

// What a run and its estimate will take, said and as numbers (run/dry_run.hpp). spent: CPU seconds
// that a run has needed when it gets here; finer: those of the meshes that follow this one
std::vector<Summary> report_forecast(const Voice& voice, const SolveConfig& config,
                                     const std::optional<Material>& material,
                                     const Run::Where& where, Run& run, const RunWatch& watch,
                                     double spent, double finer = 0);

// of PathErrors::along, by their names in /history of a solution
SolutionWriter::Histories histories_of(const PathErrors& estimate);

}  // namespace langer
