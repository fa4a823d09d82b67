// Between the mechanics and solution.h5: header, one record per accepted step, and the state to
// continue from.
#pragma once

#include "mechanics/solve/increment.hpp"
#include "results/store/provenance.hpp"
#include "results/store/solution_file.hpp"
#include "scene/model/scene.hpp"

namespace langer {

Material material_from(
    const std::string& path);  // material.h5, or YAML with the keys of a material
Material material_of_body(
    const std::string& path);  // the same; throws Failure(input) where it has no stiffness at rest

SolutionHeader header_of(const Mesh& mesh, Formulation formulation, const Scene& scene,
                         const Identity& identity);
// The name of a history of a given volume: with that of its set where there are several.
std::string of_volume(const char* name, const Loads& loads, int i);
VecX pressures_of(const StepRecord& step, const Loads& loads);  // of given volumes [MPa]
// of the indenter at a recorded step [mm]
Vec3 indenter_at(const RigidContact& indenter, const StepRecord& step);
// of the nodes of a body that hang, what those they hang on have of u
void hang(const Assembler& body, const VecX& u, std::vector<Vec3>& nodal);
StepRecord step_record(const Increment& increment, const Assembler& body, double taken, double next,
                       const SolveReport& report);
BodyState state_of(const StepRecord& record, const Scene& scene);

}  // namespace langer
