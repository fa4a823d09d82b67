// Stability of an equilibrium: the number of negative eigenvalues of the constrained tangent.
//
// By Sylvester's law of inertia it is the number of negative pivots of an L D L^T factorization. If
// the contact is condensed, the part without candidates is positive definite, and the eigenvalues
// of the Schur complement on the candidates decide. Contact removes directions (closed candidates)
// and subtracts the turning of its reactions, r_n times the curvature of the indenter.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "mechanics/solve/border.hpp"
#include "mechanics/solve/factor_cache.hpp"
#include "mechanics/solve/increment_state.hpp"

namespace langer {

// Signs of the eigenvalues of the constrained tangent: K less the turning of the contact reactions
// on a curved indenter, for movements of the free dofs that keep closed contacts closed and
// sticking ones where they are. Slipping ones may glide; what friction adds there is not symmetric
// and left out. Imposed displacements and the indenter stand still.
//   negative  directions in which the body gives way: the equilibrium is unstable; -1: the tangent is singular to the last digit
//   zero_energy   directions that nothing resists (below 1e-8 of the stiffest); counted with contact only
struct Signature {
  int negative = 0, zero_energy = 0;
};

// The effect of contact on one node: directions that are held, and r_n times the curvature of the
// indenter.
struct NodeContact {
  std::vector<Vec3> held;
  Mat3 turning = Mat3::Zero();
};

class TangentSigns {
 public:
  TangentSigns(IncrementState& state, const Border& border, FactorCache& factors)
      : state_(state),
        body_(state.body),
        now_(state.now),
        before_(state.before),
        trial_(state.trial),
        border_(border),
        factors_(factors) {}

  // Of the accepted state, right after accept(). The last factor serves where it was made within
  // that share of the step's movement from there, and is positive definite; otherwise K is
  // factorized once more. Not where the solution is iterative, which has no signs to show.
  static constexpr double nearly_there = 0.02;
  Signature signature(double within = nearly_there);
  // The same of the accepted state for other constraints than those of the equilibrium, summed over
  // them: one factorization each, by the solvers that are kept for the next state.
  Signature signature_under(std::span<OtherTangent> others,
                            std::vector<std::unique_ptr<LinearSolver>>& solvers);
  // Whether all of them are positive definite: no eigenvalues are counted.
  bool all_positive_under(std::span<OtherTangent> others,
                          std::vector<std::unique_ptr<LinearSolver>>& solvers);
  // The tangent of which signature() counts the negative eigenvalues, at the accepted state:
  // contacts as stiff springs. For bodies whose tangent has a factor.
  std::vector<double> constrained_tangent();
  std::vector<double> constrained_tangent(OtherTangent& other);

 private:
  // Assembles them and factorizes one after the other: true of those that are positive definite.
  std::vector<bool> factorize_under(std::span<OtherTangent> others,
                                    std::vector<std::unique_ptr<LinearSolver>>& solvers);
  Signature signature_with_contact(double within);
  Signature signs_on_candidates(MatX S, const std::vector<NodeContact>& contacts) const;
  int held_by_volumes(int negative);

  IncrementState& state_;
  Assembler& body_;
  const BodyState &now_, &before_;
  const TrialState& trial_;
  const Border& border_;
  FactorCache& factors_;
};

}  // namespace langer
