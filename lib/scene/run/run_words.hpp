// What langer-solve says of a scene before it is solved, and sums up of a run for --json.
#pragma once

#include <string>
#include <vector>

#include "core/base/voice.hpp"
#include "results/store/provenance.hpp"
#include "scene/run/run.hpp"

namespace langer {

// laws that are unstable at rest and pressures under a plate (warnings), fibres that turn between
// neighbours, the reduction; returns the largest turn [degrees]
double report_scene(const Voice& voice, const Run& run);

// Motions that only contact resists, in words; empty where there are none. Throws Failure(config)
// for a body that nothing holds, and warns of one that only contact keeps from tipping over.
std::string held_by_contact(const Voice& voice, const Run& run, const Run::Where& where);

std::vector<Summary> summary_of(const Run& run, const RunEnd& end, int n_steps);
std::vector<Summary> joined(const std::vector<std::vector<Summary>>& parts);

}  // namespace langer
