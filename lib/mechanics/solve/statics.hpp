// Equilibrium of one body with supports and rigid contacts, at a value of the path parameter t.
//
// Statics holds the last accepted state and the trial state of an increment. The nonlinear solvers
// get their Problem from it. Each correction solves the linearised balance
//   K dx = -(F_int - F_ext - R) - K_fp du_p
// with the contact reactions R from the contact law (condensed bipotential), [A23] eqs 24-32.
// Prescribed displacements du_p and the movement of the indenter enter this linear system first
// and the state afterwards. The other order would make pressures of 1e4 MPa and an indefinite
// tangent near incompressibility.
//
// The sources of the class, by topic:
//   increment.cpp     predict the trial state, accept it
//   balance.cpp       residual, tolerances, contact law: is the trial in equilibrium?
//   contact_step.cpp  linearise, condense the contact, solve for a correction
//   statics_stability.cpp  signs of the eigenvalues of the constrained tangent
//   statics_bonds.cpp adhesion
//   statics_border.cpp  unknowns beside the displacements: t of an arc, pressures of given volumes
//   statics_motion.cpp  inertia: the body moves, and each increment ends in a balance with M a
#pragma once

#include <memory>
#include <vector>

#include "mechanics/assembly/assembler.hpp"
#include "mechanics/contact/contact.hpp"
#include "mechanics/contact/touch.hpp"
#include "mechanics/dynamics/inertia.hpp"
#include "mechanics/nonlinear/free_balance.hpp"
#include "mechanics/nonlinear/newton.hpp"
#include "mechanics/solve/body_scale.hpp"
#include "mechanics/solve/bonds.hpp"
#include "mechanics/solve/contact_linearisation.hpp"
#include "mechanics/solve/tangent_factor.hpp"
#include "mechanics/solve/touching_bodies.hpp"

namespace langer {

// The state of a body, complete enough to continue from.
struct BodyState {
  double t = 0;
  VecX u;  // (3 n) [mm]
  Reactions r;
  double travel = 0;      // of the indenter under force control [mm]
  BondStates bonds = {};  // empty where nothing adheres
  BondEnergy in_bonds = {};
  VecX pressures = {};      // of loads with a given volume [MPa]
  MotionState motion = {};  // empty without inertia
};

// The body before its first increment: t, travel, displacements, pressures and reactions are 0.
// Sizes, bonds and motion are those of `shape`.
BodyState at_rest(BodyState shape);

// Signs of the eigenvalues of the constrained tangent: K less the turning of the contact reactions
// on a curved indenter, for movements of the free dofs that keep closed contacts closed and
// sticking ones where they are. Slipping ones may glide; what friction adds there is not symmetric
// and left out. Imposed displacements and the indenter stand still.
//   negative  directions in which the body gives way: the equilibrium is unstable; -1: the tangent is singular to the last digit
//   zero_energy   directions that nothing resists (below 1e-8 of the stiffest); counted with contact only
struct Signature {
  int negative = 0, zero_energy = 0;
};

struct StaticsOptions {
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

class Statics {
 public:
  Statics(Assembler& equilibrium, std::vector<RigidContact> contacts, const StaticsOptions& options,
          std::vector<SurfaceContact> surfaces = {});

  void begin(double t);  // starts an increment to t: predicts its trial state
  // Starts an increment of which t, the factor of all loads in proportion to it, is an unknown: the
  // root mean square of the nodes' movement is `length` [mm] instead. The movement of each indenter
  // is added to it. towards: (3 n) where it goes from here; none: on as before.
  void begin_arc(double length, const VecX* towards = nullptr);
  // The same with a movement of `amplitude` [mm] along a mode (3 n, norm 1) instead.
  void begin_along(const VecX& mode, double amplitude);
  void begin_from(const VecX& u);  // in an increment that has begun: another trial state
  void restart();
  Problem problem();           // of the increment begun; refers to this object
  FreeBalance free_balance();  // the same with fixed contact reactions
  VecX& trial() { return u_; }
  double trial_t() const { return t_; }
  // Adhesion: the bonds of the trial state, and the functions by which an increment with bonds that
  // break moves its trial state (solve/release.hpp).
  Bonds& bonds() { return bonds_; }
  const Bonds& bonds() const { return bonds_; }
  struct Trial {
    VecX u;
    Reactions r;
  };
  Trial saved_trial() const { return {u_, r_}; }
  void restore_trial(const Trial& trial);
  double stored() const;                         // in body and bonds, of the trial
  double work_of_loads(const VecX& from) const;  // on the way to the trial, as they are now
  void jumped(double work, double released) {
    jump_.work_of_jumps = work;
    jump_.released = released;
  }
  double
  time_error();   // of the trial, once it is in equilibrium; before accept() of a viscous body
  void accept();  // the trial becomes the accepted state
  void replay(
      const BodyState& next);  // accepts a state that was found before; a viscous body follows
  void restore(const BodyState& accepted, const BodyState* before = nullptr);

  const BodyState& accepted() const { return now_; }
  // An indenter past whose edge a node went in this increment, by name (solve/edge_slip.hpp): the
  // trial may be an equilibrium that shorter increments do not lead to.
  std::optional<std::string> edge_passed() const;
  std::vector<ContactDefect> defects()
      const;  // of the trial state, or of the accepted one right after accept()
  const std::vector<RigidContact>& contacts() const { return contacts_; }
  // Deformable surfaces that touch: their reactions follow those of the indenters in BodyState::r.
  const std::vector<SurfaceContact>& surfaces() const { return bodies_.surfaces(); }
  std::vector<ContactDefect> surface_defects() const;                    // as defects()
  const std::vector<std::vector<MortarNode>>& surface_averages() const;  // of the trial
  // of each pair the deepest node of either side inside the facets of the other [mm]
  std::vector<double> surface_penetrations() const;
  const RigidContact* controlled() const {
    if (controlled_ >= 0) return &contacts_[static_cast<std::size_t>(controlled_)];
    return nullptr;
  }
  // Of the accepted state, right after accept(). The last factor serves where it was made within a
  // fiftieth of the step's movement from there; otherwise K is factorized once more. Not where
  // iterative(), which has no signs to show.
  Signature signature();
  // The same of the accepted state for other constraints than those of the equilibrium, summed over
  // them: one factorization each, by the solvers that are kept for the next state.
  Signature signature_under(std::span<OtherTangent> others,
                            std::vector<std::unique_ptr<LinearSolver>>& solvers);
  // The tangent of which signature() counts the negative eigenvalues, at the accepted state:
  // contacts as stiff springs. For bodies whose tangent has a factor.
  std::vector<double> constrained_tangent();
  std::vector<double> constrained_tangent(OtherTangent& other);
  // Forces of 1 MPa on each surface of a given volume, on the free rows.
  std::vector<VecX> volume_gradients() const;
  VecX reactions() const;  // (3 n) F_int at supports and contact nodes, 0 elsewhere
  // tangents so far that were not positive definite without contact, and among them those that were
  // not with contact
  int n_indefinite() const { return factor_.counts().indefinite; }
  int n_unstable() const { return factor_.counts().unstable; }
  struct Cost {
    double analysis = 0, assembly = 0, factor = 0, solve = 0, contact = 0;  // CPU seconds
    long factorizations = 0, sweeps = 0;
  };
  Cost cost() const;
  // Factorizes the tangent of the accepted state, right after accept() or restore(); false where it
  // is singular. The next increment begins with it where it is positive definite and contact is
  // condensed.
  bool factorize_accepted();
  const LinearSolver& linear() const { return factor_.linear(); }  // none where iterative()
  LinearSolver::Size size() const { return factor_.size(); }
  bool contact_in_tangent() const { return factor_.in_tangent() != nullptr; }
  bool iterative() const { return factor_.iterative(); }
  const MixedSolver* mixed() const {
    if (factor_.mixed()) return &factor_.mixed()->solver();
    return nullptr;
  }
  double motion_error() const;  // of the trial of a body in motion (Inertia::error())
  const Inertia* inertia() const { return options_.inertia; }
  bool gave_up_iterating() const { return factor_.gave_up_iterating(); }

 private:
  friend class StateTangent;      // solve/state_tangent.hpp
  bool continues_motion() const;  // imposed displacements, as in the last increment
  void extrapolate(double s);     // by s times the last increment
  void slip_from_touch();
  void slip_from_touch(std::size_t k, const VecX& expected);
  IncrementMove increment_move(const VecX& expected) const;  // refers to `expected`
  double slip_tolerance() const;                             // [mm]
  bool starts_with_travel() const;  // the slip of an indenter under force control
  std::vector<Vec3> start_moves()
      const;  // by its candidate, what the slip is measured from, per travel
  Assessment assess(const VecX& u, bool with_tangent);
  double force_scale() const;  // size of the forces that the residual is compared with [N]
  bool contact_law_holds(const VecX& u) const;
  std::optional<VecX> correction();
  std::optional<VecX> correction_again();
  std::optional<VecX> solve_condensed(const VecX& rhs);
  std::optional<ContactChange> change_of_contact(const VecX& rhs, LinearSolver::Half& half);
  int level_of_increment(const BodyState& from, double t, double last_travel) const;
  VecX solve_nonsymmetric(const VecX& rhs);
  bool omits_stiffness() const;
  VecX omitted_stiffness(const VecX& du) const;
  VecX solve_near_factor(const VecX& known, double accurate = 1e-6);
  std::optional<VecX> solve_with_contact(const VecX& rhs);
  VecX with_prescribed_dofs(const VecX& free) const;
  bool bordered() const { return arc_.has_value() || p_.size() > 0; }
  void begin_border();
  VecX imposed_direction(const VecX& u) const;  // what K_du() of the next assembly is of
  void update_border();
  void solve_border(VecX& move);
  std::optional<VecX> move_with_contact(const VecX& rhs);
  std::optional<VecX> solve_arc_with_contact(const VecX& rhs);
  double arc_product(const VecX& u, const std::vector<Vec3>& c, const VecX& du,
                     const std::vector<Vec3>& dc) const;
  std::vector<Vec3> moves_of_indenters(double t0, double travel0, double t1, double travel1) const;
  void begin_contact_of_arc();
  bool contact_closes(double s) const;
  double arc_step(const VecX& a, const VecX& b) const;
  void move_border(double step);
  std::string border_defect(const VecX& u) const;
  void take_border_of(const BodyState& state);
  int held_by_volumes(int negative);
  Signature signature_with_contact();
  void update_tangent();
  bool factorize();
  void update_factor_of_accepted(double within);  // a share of the step's movement
  TangentFactor&
  condensed_factor();  // the one of the body, or where contact stands in its tangent one beside it
  double cost_ratio() const;  // of a correction with a new tangent in units of one with the last
  bool admissible(const VecX& u) const;
  bool slips_away() const;
  void moved(const VecX& du, double step);
  double motion(double t0)
      const;  // largest movement of an indenter or a prescribed dof from t0 to the trial [mm]
  double turning(const RigidContact& contact, double t0,
                 const Vec3& c0) const;                        // the same of what turns with it
  std::vector<Vec3> indenters(double t, double travel) const;  // displacement of each
  void begin_motion(double seconds);
  VecX predicted_move() const;
  void accept_motion();
  double work_from_outside(const VecX& du, const VecX& f_ext, const VecX& reactions,
                           const Reactions& r) const;
  double work_of_friction(const VecX& u1, const VecX& du);
  VecX trial_reactions() const;
  double required_force() const;  // of the indenter under force control or with mass, on the body
  double force_falls() const;     // what that loses per travel
  void begin_bonds();
  void accept_bonds();
  void move_to_touch();  // the indenter under force control, where it bears nothing
  bool force_is_given() const;
  VecX remaining_prescribed(const VecX& u) const;
  bool prescribed_reached(const VecX& u, const VecX& remaining) const;
  VecX free_residual() const;                // -(F_int - F_ext - R) on the free rows
  VecX on_free_rows(const VecX& all) const;  // of (3 n)

  Assembler& equilibrium_;
  std::vector<RigidContact> contacts_;
  mutable TouchingBodies bodies_;
  StaticsOptions options_;
  Cost cost_;
  TangentFactor factor_;
  Bonds bonds_;
  BondEnergy jump_;  // of the increment
  BodyScale scale_;
  double gap_tolerance_ = 0;  // [mm]
  BodyState now_, before_;    // accepted states
  double t_ = 0;              // of the trial
  VecX u_;
  double extrapolated_ = 0;  // of the movement of the last increment, with which this one was begun
  VecX expected_;            // u that it was begun with, where the start of slip follows the travel
  int controlled_ = -1;      // contact under force control
  VecX f_ext_start_;         // of a body in motion: loads where the increment began (3 n) [N]
  double travel_ = 0, travel_next_ = 0;  // of it, on trial; and what the last linear solve adds
  Reactions r_, r_next_;                 // on trial; r_next_: what the last linear solve found
  // Of an increment of which t is an unknown: sphere |u - u_n| = size around the accepted state, or
  // plane  normal . (u - u_n) = size.
  struct Arc {
    double size = 0;                // [mm], of the vector of all dofs
    double nodes = 0;               // the weight of the squared movement of an indenter
    VecX normal;                    // of a plane; empty for a sphere
    VecX towards;                   // of the beginning; may be empty
    VecX last;                      // where contact closes: the movement of the last increment
    std::vector<Vec3> last_c = {};  // and of the indenters in it
  };
  std::optional<Arc> arc_;
  double t_next_ = 0;            // what the last linear solve adds to t
  VecX rates_;                   // (3 n) of imposed displacements, per t
  VecX p_, p_next_;              // pressures of given volumes on trial, and what is added [MPa]
  std::vector<VecX> columns_;    // (free) forces per unknown of the border
  std::vector<VecX> gradients_;  // (3 n) of each given volume
  VecX dp_;  // of an iterative solution: change of the pressures [MPa]; else empty
  std::vector<VecX> u_start_;  // by contact, (3 n): what the increment's slip is measured from, the
                               // indenter where it began
  VecX factored_at_;           // u of the tangent that was factorized last
  bool K_current_ = false;     // K is that of the trial
  bool factor_serves_ = false;  // also for other corrections of this increment
  bool again_ = false;          // the last correction was such a one
  bool of_accepted_ = false;    // the factor is that of the accepted state
  std::unique_ptr<TangentFactor> second_factor_;
  bool unsettled_ = false;  // the remainder's modulus is not yet that of where a FreeBalance was
                            // left (linear_dilatation)
};

}  // namespace langer
