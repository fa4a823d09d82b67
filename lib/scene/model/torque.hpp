// What turns a body, in the record of a step: of each indenter that turns and of each set that is
// turned, by name
//   angle_<name>    by which it has turned [deg]
//   torque_<name>   with which it turns the body about its axis, positive in the sense of a positive angle [N mm]
#pragma once

#include "results/store/solution_file.hpp"
#include "scene/model/scene.hpp"

namespace langer {

// whole: of the whole body, with travels of pushed indenters
void add_torques(StepRecord& whole, const Mesh& mesh, const Scene& scene);

// Of torque_<name> by name, where displacements, reactions and an indenter's travel change by those
// of `derivative`.
std::map<std::string, double> torque_derivatives(const StepRecord& whole,
                                                 const StepRecord& derivative, const Mesh& mesh,
                                                 const Scene& scene);

// of the named ones, the size of each [N mm]
std::map<std::string, double> torques_of(const StepRecord& whole, const Scene& scene);

}  // namespace langer
