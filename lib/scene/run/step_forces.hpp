// The forces of a state by name, of which errors are told at every step:
//   force             on the indenter, of several the length of their sum [N]
//   force_<contact>   of several indenters: on each of them [N]
//   travel_<contact>  of an indenter under force control [mm]
//   reaction_<set>    of each set that is moved [N]
//   torque_<name>     of each indenter that turns and each set that is turned [N mm]
// touching: of forces on indenters, how many nodes of the whole body they come from, of a section
// how many of those in z = 0; of the sum over several indenters the fewest
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "scene/run/run.hpp"

namespace langer {

// sets with an imposed displacement other than 0
std::set<std::string> moved_sets(const SolveConfig& config);

struct StepForces {
  double t = 0;
  std::map<std::string, double> of;
  std::map<std::string, double> touching = {};
};
StepForces step_forces(const SolveConfig& config, const Scene& scene, const Mesh& mesh,
                       const StepRecord& whole);

// Between two steps linear, 0 at t = 0 and for a name that is not there. path: ascending t
double force_at(const std::vector<StepForces>& path, const std::string& name, double t);
double touching_at(const std::vector<StepForces>& path, const std::string& name, double t);

// `listener`, and whoever collects the forces of the run's steps in `path`
RunListener collecting(RunListener listener, const SolveConfig& config, const Run& run,
                       std::vector<StepForces>& path);

}  // namespace langer
