// A body in motion as a run solves and records it.
#pragma once

#include <memory>

#include "results/store/solution_file.hpp"
#include "scene/run/reduction.hpp"

namespace langer {

// The inertia of the part that is solved, joined to its balance; none of a scene at rest.
std::unique_ptr<Inertia> inertia_of(const Reduction& reduction, Assembler& body,
                                    const LoadPathOptions& path, const Place& place);

// The path with the increments that the motion asks for.
LoadPathOptions motion_path(const Scene& scene, LoadPathOptions path);

// Adds velocities, energies and momentum of the accepted state.
void record_motion(const Increment& increment, const Assembler& body, StepRecord& record);

}  // namespace langer
