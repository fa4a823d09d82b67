// What the parts of an increment share: the body with its contacts, the last two accepted states,
// the trial state, and what the last linear solve adds to it.
//
//   IncrementState   this file
//   Border           unknowns that are no displacements (solve/border.hpp)
//   FactorCache      the tangent and which factorization serves (solve/factor_cache.hpp)
//   ContactStep      one correction of the trial state (solve/contact_step.hpp)
//   balance          is the trial state in equilibrium? (solve/balance.hpp)
//   MotionStep       increments with inertia (solve/motion_step.hpp)
//   TangentSigns     stability of the accepted state (solve/tangent_signs.hpp)
//   Increment        puts them together (solve/increment.hpp)
#pragma once

#include <optional>
#include <vector>

#include "mechanics/assembly/assembler.hpp"
#include "mechanics/contact/contact.hpp"
#include "mechanics/contact/touch.hpp"
#include "mechanics/dynamics/inertia.hpp"
#include "mechanics/solve/body_scale.hpp"
#include "mechanics/solve/body_state.hpp"
#include "mechanics/solve/bonds.hpp"
#include "mechanics/solve/tangent_factor.hpp"
#include "mechanics/solve/touching_bodies.hpp"

namespace langer {

struct IncrementOptions {
  int threads = 1;  // of the BLAS
  // penetration allowed [mm]; none: 1e-11 of the largest extent of the body
  std::optional<double> gap_tolerance;
  double law_tolerance = 1e-9;    // complementarity, relative
  bool signs_from_cells = false;  // signature(): first from the tangents of the cells
  bool extrapolate = true;        // start an increment from the movement of the last one
  double seconds = 0;             // of the path, for viscous bodies
  ContactBy contact_by = ContactBy::by_cost;
  LinearBy linear_by = LinearBy::direct;
  Inertia* inertia = nullptr;  // of the body, whose added term it is; none: equilibrium
};

struct SolveCost {
  double analysis = 0, assembly = 0, factor = 0, solve = 0, contact = 0;  // CPU seconds
  long factorizations = 0, sweeps = 0;
};

// The state that an increment seeks.
struct TrialState {
  double t = 0;
  VecX u;                   // (3 n) [mm]
  Reactions r;              // of the contacts, then of the deformable surfaces [N]
  double travel = 0;        // of the indenter under force control [mm]
  VecX pressures = {};      // of given volumes [MPa]
  double extrapolated = 0;  // of the movement of the last increment, with which this one was begun
  VecX expected = {};       // u that it was begun with, where the start of slip follows the travel
};

// What the last linear solve found besides the displacements: reactions at its end, and what is
// added to the others.
struct Correction {
  Reactions r;
  double travel = 0;    // [mm]
  double t = 0;         // of an arc
  VecX pressures = {};  // [MPa]
};

struct IncrementState {
  IncrementState(Assembler& assembler, std::vector<RigidContact> rigid,
                 const IncrementOptions& chosen, std::vector<SurfaceContact> deformable);
  IncrementState(const IncrementState&) = delete;
  IncrementState& operator=(const IncrementState&) = delete;

  // The indenter under force control; none: nullptr.
  const RigidContact* controlled() const;
  // The force that it gives to the body at its travel [N], and what that loses per travel [N/mm].
  double required_force() const;
  double force_falls() const;
  std::vector<Vec3> indenters(double t, double travel) const;  // displacement of each [mm]
  // how far each indenter goes from t0 to t1 [mm]
  std::vector<Vec3> moves_of_indenters(double t0, double travel0, double t1, double travel1) const;
  // The largest movement of an indenter or a prescribed dof from t0 to the trial [mm]. It scales
  // the error allowed in slip.
  double motion(double t0) const;

  VecX remaining_prescribed(const VecX& u) const;  // (3 n) what prescribed dofs lack of their value
  bool prescribed_reached(const VecX& u, const VecX& remaining) const;
  VecX on_free_rows(const VecX& all) const;  // of (3 n)
  bool admissible(const VecX& u) const;      // elements keep their orientation

  void move_to_touch();  // the indenter under force control, where it bears nothing
  void turn_surfaces();  // reactions of deformable surfaces, with the normals of the trial
  // Sets where the slip of the candidates begins within this increment (contact/touch.hpp).
  void slip_from_touch();
  void slip_from_touch(std::size_t k, const VecX& end);
  double slip_tolerance() const;  // [mm]
  // Whether a contact bears nothing at the accepted state, and where on the way to the trial the
  // first node of such a contact touches: a share, 1 where none does.
  bool may_touch() const;
  double share_before_touch() const;
  IncrementMove increment_move(const VecX& end) const;  // refers to `end`
  bool starts_with_travel() const;  // the slip of an indenter under force control
  // by its candidate, what the slip is measured from, per travel
  std::vector<Vec3> start_moves() const;
  // The state at which the contact law is linearised; refers to c and c_start.
  ContactState contact_state(const std::vector<Vec3>& c, const std::vector<Vec3>& c_start) const;
  // Of the trial state, or of the accepted one right after accept().
  std::vector<ContactDefect> defects() const;
  std::vector<ContactDefect> surface_defects() const;

  Assembler& body;
  std::vector<RigidContact> contacts;
  mutable TouchingBodies surfaces;
  IncrementOptions options;
  Bonds bonds;
  BodyScale scale;
  double gap_tolerance = 0;   // [mm]
  int controlled_index = -1;  // contact under force control
  BodyState now, before;      // accepted states
  TrialState trial;
  Correction next;
  // by contact, (3 n): what the increment's slip is measured from, the indenter where it began
  std::vector<VecX> u_start;
  SolveCost cost;

 private:
  double turning(const RigidContact& contact, double t0, const Vec3& c0) const;
};

}  // namespace langer
