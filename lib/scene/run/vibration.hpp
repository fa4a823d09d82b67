// Small vibrations about the state at the end of a run, as the config asks for them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mechanics/vibration/frozen_body.hpp"
#include "mechanics/vibration/modes.hpp"
#include "results/store/vibration_record.hpp"
#include "scene/run/run.hpp"

namespace langer {

// Driver that the config names, in terms of the body that is solved. Throws Failure(config) where
// it is not symmetric as the scene is, or the mesh has no such set.
Driver driver_of(const SolveConfig& config, const Run& run, const Run::Where& where);

// Refuses before the path what can be known there: names, directions, symmetry. Throws
// Failure(config).
void check_vibration(const SolveConfig& config, const Run& run, const Run::Where& where);

// Sees the modes of the body that is solved, and may add to their record.
using ModesListener =
    std::function<void(const Modes&, const std::vector<double>& density, ModesRecord& record)>;

// Nothing where the config asks for none. Of the run's accepted state; Failure(config) and
// Failure(not_converged) as the above and mechanics/vibration say.
std::optional<VibrationRecord> vibration_of(const SolveConfig& config, Run& run,
                                            const Run::Where& where,
                                            const ModesListener& listener = {});

// What langer-solve prints, and the numbers of its summary.
std::vector<std::string> in_words(const VibrationRecord& record, const Run& run);
std::vector<Summary> summary_of(const VibrationRecord& record);

// Names of the CSV files beside the solution, and their text.
std::vector<std::string> vibration_files(const SolveConfig& config);

}  // namespace langer
