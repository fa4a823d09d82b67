// What a solve would take, before it: for --dry-run, and to refuse a run that will not fit in
// memory.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mechanics/solve/forecast.hpp"
#include "mechanics/solve/increment.hpp"
#include "results/store/provenance.hpp"
#include "scene/model/scene.hpp"
#include "scene/run/run.hpp"

namespace langer {

std::string memory_in_words(double bytes);      // "430 MB"
std::string duration_in_words(double seconds);  // "40 s"

// Throws Failure(config) where the factor of the tangent, or that of a mesh beside it, exceeds the
// memory that is free or allowed.
void check_memory(const Increment& increment, const Increment* beside, int threads);

// solve/forecast.hpp, by the solver and the path of `config`
Forecast forecast_of(const SolveConfig& config, Assembler& body, const Increment& increment,
                     const Scene& scene);

// of a scene that is made for it
Forecast forecast_of(const SolveConfig& config, const std::optional<Material>& material,
                     const Run::Where& where);

// Of a run whose body one hexahedron stands for: what its mesh takes on top. Follows the path,
// which costs little; examined: the mesh with the analysis of its tangent, none where no state's
// stability is. Nothing where the mesh is solved itself.
MeshChecks forecast_of_mesh(Run& run, const Increment* examined, StabilityCheck when);

// Says on stderr which parts the scene has, their sizes, memory and time; returns the numbers.
// estimate: seconds that the estimate of its errors takes, 0 where none is wanted; spent: CPU
// seconds that a run has needed when it gets here; checks: of the mesh that the body stands for
std::vector<Summary> dry_run(const SolveConfig& config, const Scene& scene, Assembler& body,
                             const Increment& increment, const MeshChecks& checks, double estimate,
                             double spent, bool quiet);

}  // namespace langer
