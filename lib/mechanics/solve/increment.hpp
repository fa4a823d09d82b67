// One increment of a body with supports and contacts: from the accepted state at a value of the
// path parameter t to the next equilibrium.
//
// An Increment holds the last accepted state and the trial state. After accept() the same object
// begins the next increment. The nonlinear solvers get their Problem from it. Each correction
// solves the linearised balance
//   K dx = -(F_int - F_ext - R) - K_fp du_p
// with the contact reactions R from the contact law (condensed bipotential), [A23] eqs 24-32.
// Prescribed displacements du_p and the movement of the indenter enter this linear system first
// and the state afterwards. The other order would make pressures of 1e4 MPa and an indefinite
// tangent near incompressibility.
//
// An increment from its start to its acceptance:
//   begin     u = u_n + s (u_n - u_{n-1}), s the ratio of the two increments of t, if the loading
//             goes on without a kink; an indenter under force control is moved to its first touch
//   problem   residual, correction and acceptance test, for the nonlinear solver
//   accept    u_{n+1} = u, with the reactions of contact and the state of viscous points and bonds
// The parts of an increment are listed in solve/increment_state.hpp.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mechanics/nonlinear/free_balance.hpp"
#include "mechanics/nonlinear/newton.hpp"
#include "mechanics/solve/border.hpp"
#include "mechanics/solve/contact_step.hpp"
#include "mechanics/solve/factor_cache.hpp"
#include "mechanics/solve/increment_state.hpp"
#include "mechanics/solve/motion_step.hpp"
#include "mechanics/solve/tangent_signs.hpp"

namespace langer {

class Increment {
 public:
  Increment(Assembler& equilibrium, std::vector<RigidContact> contacts,
            const IncrementOptions& options, std::vector<SurfaceContact> surfaces = {});

  void begin(double t);  // starts an increment to t: predicts its trial state
  // In an increment that has begun: what to do where the body is not stable without its contacts.
  using WhereUnstable = FactorCache::WhereUnstable;
  bool may_go_into_tangent() const { return !border_.active() && factors_.may_go_into_tangent(); }
  void where_unstable(WhereUnstable what) { factors_.where_unstable(what); }
  bool stopped_unstable() const { return factors_.stopped(); }
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
  VecX& trial() { return trial_.u; }
  double trial_t() const { return trial_.t; }
  // Adhesion: the bonds of the trial state, and the functions by which an increment with bonds that
  // break moves its trial state (solve/release.hpp).
  Bonds& bonds() { return state_.bonds; }
  const Bonds& bonds() const { return state_.bonds; }
  struct Trial {
    VecX u;
    Reactions r;
  };
  Trial saved_trial() const { return {trial_.u, trial_.r}; }
  void restore_trial(const Trial& trial);
  double stored() const;                         // in body and bonds, of the trial
  double work_of_loads(const VecX& from) const;  // on the way to the trial, as they are now
  void jumped(double work, double released) {
    jump_.work_of_jumps = work;
    jump_.released = released;
  }
  // of the trial, once it is in equilibrium; before accept() of a viscous body
  double time_error();
  void accept();  // the trial becomes the accepted state
  // accepts a state that was found before; a viscous body follows
  void replay(const BodyState& next);
  void restore(const BodyState& accepted, const BodyState* before = nullptr);

  const BodyState& accepted() const { return now_; }
  // An indenter past whose edge a node went in this increment, by name (solve/edge_slip.hpp): the
  // trial may be an equilibrium that shorter increments do not lead to.
  std::optional<std::string> edge_passed() const;
  // Of the trial state, or of the accepted one right after accept().
  std::vector<ContactDefect> defects() const { return state_.defects(); }
  const std::vector<RigidContact>& contacts() const { return state_.contacts; }
  // Deformable surfaces that touch: their reactions follow those of the indenters in BodyState::r.
  const std::vector<SurfaceContact>& surfaces() const { return state_.surfaces.surfaces(); }
  std::vector<ContactDefect> surface_defects() const { return state_.surface_defects(); }
  const std::vector<std::vector<MortarNode>>& surface_averages() const;  // of the trial
  // of each pair the deepest node of either side inside the facets of the other [mm]
  std::vector<double> surface_penetrations() const;
  const RigidContact* controlled() const { return state_.controlled(); }
  // Stability of the accepted state (solve/tangent_signs.hpp).
  Signature signature(double within = TangentSigns::nearly_there) {
    return signs_.signature(within);
  }
  Signature signature_under(std::span<OtherTangent> others,
                            std::vector<std::unique_ptr<LinearSolver>>& solvers) {
    return signs_.signature_under(others, solvers);
  }
  bool all_positive_under(std::span<OtherTangent> others,
                          std::vector<std::unique_ptr<LinearSolver>>& solvers) {
    return signs_.all_positive_under(others, solvers);
  }
  std::vector<double> constrained_tangent() { return signs_.constrained_tangent(); }
  std::vector<double> constrained_tangent(OtherTangent& other) {
    return signs_.constrained_tangent(other);
  }
  // Forces of 1 MPa on each surface of a given volume, on the free rows.
  std::vector<VecX> volume_gradients() const { return border_.volume_gradients(); }
  VecX reactions() const;  // (3 n) F_int at supports and contact nodes, 0 elsewhere
  // tangents so far that were not positive definite without contact, and among them those that were
  // not with contact
  int n_indefinite() const { return factors_.factor.counts().indefinite; }
  int n_unstable() const { return factors_.factor.counts().unstable; }
  using Cost = SolveCost;
  Cost cost() const;
  // The accepted state with the tangent there, for derivatives (solve/state_tangent.hpp).
  const IncrementState& state() const { return state_; }
  bool factorize_accepted() { return factors_.factorize_accepted(); }
  TangentFactor& condensed_factor() { return factors_.condensed_factor(); }
  const LinearSolver& linear() const { return factors_.factor.linear(); }  // none where iterative()
  LinearSolver::Size size() const { return factors_.size(); }
  bool contact_in_tangent() const { return factors_.contact_in_tangent() || bodies_in_tangent(); }
  bool bodies_in_tangent() const { return factors_.bodies_in_tangent() != nullptr; }
  bool iterative() const { return factors_.factor.iterative(); }
  const MixedSolver* mixed() const {
    if (const MixedTangent* mixed = factors_.factor.mixed()) return &mixed->solver();
    return nullptr;
  }
  // Where an increment to t should end so that the first touch in it comes at its end; t where
  // nothing touches, or at once. Begins an increment.
  double end_at_touch(double t);
  // of the trial of a body in motion (Inertia::error())
  double motion_error() const { return motion_.error(); }
  const Inertia* inertia() const { return state_.options.inertia; }
  bool gave_up_iterating() const { return factors_.factor.gave_up_iterating(); }

 private:
  bool continues_motion() const;  // imposed displacements, as in the last increment
  void extrapolate(double s);     // by s times the last increment
  void follow(const Arc& arc);
  Assessment assess(const VecX& u, bool with_tangent);
  void begin_bonds();
  void accept_bonds();

  IncrementState state_;
  Assembler& body_;
  BodyState &now_, &before_;
  TrialState& trial_;
  Border border_;
  FactorCache factors_;
  ContactStep step_;
  TangentSigns signs_;
  MotionStep motion_;
  BondEnergy jump_;         // of the increment
  bool unsettled_ = false;  // the remainder's modulus is not yet that of where a FreeBalance was
                            // left (linear_dilatation)
};

}  // namespace langer
