// From a solution file to what post works on, and back to files: states, snapshot fields, the
// indenters.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "mechanics/assembly/loads.hpp"
#include "results/post/curves.hpp"
#include "results/post/energy_columns.hpp"
#include "results/post/render.hpp"
#include "results/post/viscous_path.hpp"
#include "results/store/snapshot.hpp"
#include "results/store/solution_file.hpp"

namespace langer {

// The branch stresses of a viscous body at the rows of a solution, row 0 at rest: a row has them
// from all rows before it. Refers to both, and tells the body. Nothing for an elastic one.
class BranchRows {
 public:
  BranchRows(Body& body, const SolutionReader& solution) : body_(body), solution_(solution) {}
  void go_to(int row);

 private:
  Body& body_;
  const SolutionReader& solution_;
  std::optional<ViscousPath> path_;
  int row_ = 0;
};

Formulation formulation_of(const SolutionHeader& header,
                           const std::string& path);  // throws Failure(input)
StepState state_of(const StepRecord& record);

// Point data: u, nodal stress and what follows from it, reaction, contact state. Cell data: means,
// fibres before and after.
struct SnapshotFields {
  std::vector<Field> points, cells;
};
class ContactStates;
// row: of the table of states, which the record is of
SnapshotFields snapshot_fields(const Body& body, const SolutionHeader& header,
                               const StepRecord& record, int row, const ContactStates& contacts,
                               StressAt at);

// Field of a picture at each node.
std::vector<double> picture_values(const Body& body, const StepState& state, Quantity field,
                                   int family, StressAt at);

// How many steps of a solution lie before t or at it: the row of the last of them.
int steps_until(const SolutionReader& solution, double t);

// The rigid indenters as the solution's own config tells; none where it was written by a version
// that cannot be read. Those of triangles are missing where a version wrote it that did not keep
// them.
std::vector<RigidContact> indenters_of(const SolutionHeader& header);
// Indenters under force control then move as they were found to.
void follow_records(std::vector<RigidContact>& indenters, const SolutionReader& solution);
// Deformable surfaces that touch, from that config; none where they are not known.
std::vector<SurfaceContact> touching_surfaces(const SolutionHeader& header);
// names of contacts that are neither among the indenters nor among such surfaces
std::vector<std::string> indenters_missing(const SolutionHeader& header,
                                           const std::vector<RigidContact>& indenters,
                                           const std::vector<SurfaceContact>& surfaces);
// Whether the work of its contacts follows from its steps: in motion that of deformable surfaces is
// in the energy balance of the solver only.
bool knows_work(const SolutionHeader& header, const std::vector<SurfaceContact>& surfaces);
// where its loads have kinks, and what they turn
EnergyPath energy_path(const Mesh& mesh, std::vector<RigidContact> indenters,
                       const SolutionHeader& header, std::vector<SurfaceContact> surfaces = {});
// Supports, imposed displacements and forces on the surface as that config tells, on some nodes of
// each set; u (n) [mm] moves them.
std::vector<Action> actions_of(const SolutionHeader& header, const std::vector<Vec3>& u);
// What is shown of a body at rest; of the indenter there at t.
Shown shown_of(const Mesh& mesh);
Outline outline_at(const RigidContact& indenter, double t, const Shown& shown);
// Forces on its surface as that config tells; empty where there are none.
Loads loads_of(const SolutionHeader& header);
// The pressure at t [MPa], positive into the body, of the load with the largest one; 0 without such
// a load.
std::function<double(double t)> applied_pressure(const SolutionHeader& header);
// The record as a state of an energy path; reactions in the order of the indenters, then of the
// surfaces.
EnergyPath::State energy_state(const StepRecord& record, const std::vector<RigidContact>& indenters,
                               const Loads& loads,
                               const std::vector<SurfaceContact>& surfaces = {});

}  // namespace langer
