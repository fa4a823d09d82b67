// One correction of an increment: linearise the balance, condense the contact to the candidates,
// solve, and choose the factorization that serves for it.
//   whole tangent, no contact        K du = rhs
//   contact condensed                Schur complement of K on the candidates; the contact law is
//                                    solved on it (contact_linearisation.hpp)
//   contact in the tangent itself    rows of closed contacts join K (contact_in_tangent.hpp,
//                                    bodies_in_tangent.hpp)
// A factor of an earlier state of the increment serves for cheaper corrections (modified Newton).
#pragma once

#include <optional>

#include "mechanics/solve/border.hpp"
#include "mechanics/solve/contact_linearisation.hpp"
#include "mechanics/solve/factor_cache.hpp"
#include "mechanics/solve/increment_state.hpp"

namespace langer {

class ContactStep {
 public:
  ContactStep(IncrementState& state, Border& border, FactorCache& factors)
      : state_(state),
        body_(state.body),
        now_(state.now),
        trial_(state.trial),
        next_(state.next),
        border_(border),
        factors_(factors) {}

  void begin() { again_ = false; }
  // Movement of all dofs (3 n), with a tangent of the trial state; none where it is singular.
  std::optional<VecX> correction();
  // The same with the factor of an earlier state of this increment, in the mixed equations of u and
  // p. None if there is no such factor, or if prescribed dofs still have to move.
  std::optional<VecX> correction_again();
  // Called before u becomes u + step du: pressures, travel and contact reactions follow.
  void moved(const VecX& du, double step);

 private:
  std::optional<VecX> solve_with_contact(const VecX& rhs);
  std::optional<VecX> solve_with_bodies(const VecX& rhs);
  std::optional<VecX> solve_condensed(const VecX& rhs);
  std::optional<ContactChange> change_of_contact(const VecX& rhs, LinearSolver::Half& half);
  std::optional<VecX> move_with_contact(const VecX& rhs);
  VecX solve_nonsymmetric(const VecX& rhs);
  VecX solve_near_factor(const VecX& known, double accurate = 1e-6);
  bool omits_stiffness() const;
  VecX omitted_stiffness(const VecX& du) const;
  VecX with_prescribed_dofs(const VecX& free) const;
  LinearAnswers linear_answers();

  IncrementState& state_;
  Assembler& body_;
  const BodyState& now_;
  TrialState& trial_;
  Correction& next_;
  Border& border_;
  FactorCache& factors_;
  bool again_ = false;  // the last correction was made with an earlier factor
  VecX dp_;             // of an iterative solution: change of the pressures [MPa]; else empty
};

}  // namespace langer
