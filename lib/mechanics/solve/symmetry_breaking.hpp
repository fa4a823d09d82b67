// Stability of a body that symmetry has reduced, for movements that break the symmetry.
// The tangent of a symmetric state does not couple movements of different symmetry: those that the
// reduced body can make, and one kind for each set of mirror planes (or the half turn) under which
// a movement changes its sign. Each kind lives on the mesh of the reduced body with other
// conditions on the mirror planes, so that one more factorization of the reduced mesh counts its
// negative eigenvalues. The sum over all kinds is the count of the whole body, exactly.
//
// Several kinds are first looked at together. On mirror planes a kind holds some directions and
// leaves others free. If the tangent is positive definite with all of these directions free, it is
// so with any of them held: one factorization then shows that no kind has a negative eigenvalue.
#pragma once

#include <memory>
#include <vector>

#include "mechanics/solve/increment.hpp"

namespace langer {

class SymmetryBreaking {
 public:
  // dofs: of the reduced body, one for each kind of movement; refers to the body
  SymmetryBreaking(const Assembler& body, std::vector<Dofs> dofs);
  // factorizations of a stable state
  static int factors_of_stable(const std::vector<Dofs>& kinds);
  // of the accepted state, right after accept()
  Signature signature(Increment& increment);

 private:
  const Assembler* body_;
  std::vector<Dofs> dofs_;
  // what is factorized is made when it is first needed
  std::vector<OtherTangent> together_, tangents_;
  std::vector<std::unique_ptr<LinearSolver>> solver_together_, solvers_;
  bool look_together_ = false;
};

}  // namespace langer
