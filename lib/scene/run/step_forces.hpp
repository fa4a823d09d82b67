// The forces of a state by name, of which errors are told at every step:
//   force             on the indenter, of several the length of their sum [N]
//   force_<contact>   of several indenters: on each of them; of deformable surfaces: between them [N]
//   travel_<contact>  of an indenter under force control [mm]
//   reaction_<set>    of each set that is moved [N]
//   torque_<name>     of each indenter that turns and each set that is turned [N mm]
//   pull_off          of indenters that adhere: greatest pull so far, of all of them [N]
// and where accuracy.of names them, as they cost something or have no other use:
//   apex_height          u_y of the point "apex"; without such a point the greatest u_y of the
//                        face "top" [mm]
//   displacement_<point> length of the displacement of a named point [mm]
//   von_mises_max        greatest of the nodes, of elastic bodies [MPa]
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
  double pull = 0;  // of this step alone, where `pull_off` is the greatest so far [N]
};
// Of one step; pull_off is that of the step until append_step() compares it with earlier ones.
StepForces step_forces(const SolveConfig& config, const Scene& scene, const Mesh& mesh,
                       const StepRecord& whole);

void append_step(std::vector<StepForces>& path, StepForces step);

// By how much the greatest pull between the steps exceeds that of the steps: of the parabola
// through the step with the greatest and its neighbours [N].
double pull_between_steps(const std::vector<StepForces>& path);

// The greatest von Mises stress of the nodes, averaged as in tables [MPa], and the node that has
// it.
struct LargestStress {
  double value = 0;
  int node = 0;
};
LargestStress largest_von_mises_at(const Scene& scene, const Mesh& mesh,
                                   const std::vector<Vec3>& u);
double largest_von_mises(const Scene& scene, const Mesh& mesh, const std::vector<Vec3>& u);
bool has_viscous_law(const Scene& scene);

// Between two steps linear, 0 at t = 0 and for a name that is not there. path: ascending t
double force_at(const std::vector<StepForces>& path, const std::string& name, double t);
double touching_at(const std::vector<StepForces>& path, const std::string& name, double t);

// `listener`, and whoever collects the forces of the run's steps in `path`
RunListener collecting(RunListener listener, const SolveConfig& config, const Run& run,
                       std::vector<StepForces>& path);

}  // namespace langer
