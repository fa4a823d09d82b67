// Increments of a body with inertia (dynamics/inertia.hpp).
//   begin    the trial state goes on with the velocities that the body and an indenter with mass
//            have; M a + C v joins the balance as an added term of the assembly
//   accept   velocities and accelerations at the end, and the account of energies:
//              kinetic + stored + viscous + damped  =  at the beginning + work from outside + balance
//            Work from outside is that of supports, loads, weight and indenters, with friction as
//            work that these take, and of friction between deformable surfaces; `balance` is what
//            the scheme gains or loses.
#pragma once

#include "mechanics/solve/increment_state.hpp"

namespace langer {

class MotionStep {
 public:
  explicit MotionStep(IncrementState& state)
      : state_(state),
        body_(state.body),
        now_(state.now),
        before_(state.before),
        trial_(state.trial) {}

  void begin(double seconds);
  void accept();
  double error() const;  // of the trial (Inertia::error())

 private:
  VecX predicted_move() const;
  double work_from_outside(const VecX& du, const VecX& f_ext, const VecX& reactions,
                           const Reactions& r) const;
  double work_of_friction(const VecX& u1, const VecX& du);

  IncrementState& state_;
  Assembler& body_;
  BodyState &now_, &before_;
  TrialState& trial_;
  VecX f_ext_start_;  // loads where the increment began (3 n) [N]
};

}  // namespace langer
