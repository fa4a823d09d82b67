// Stability of a body that symmetry has reduced, for movements that break the symmetry.
// The tangent of a symmetric state does not couple movements of different symmetry: those that the
// reduced body can make, and one kind for each set of mirror planes (or the half turn) under which
// a movement changes its sign. Each kind lives on the mesh of the reduced body with other
// conditions on the mirror planes, so that one more factorization of the reduced mesh counts its
// negative eigenvalues. The sum over all kinds is the count of the whole body, exactly.
#pragma once

#include <memory>
#include <vector>

#include "mechanics/solve/increment.hpp"

namespace langer {

class SymmetryBreaking {
 public:
  // dofs: of the reduced body, one for each kind of movement
  SymmetryBreaking(const Assembler& body, std::vector<Dofs> dofs);
  // of the accepted state, right after accept()
  Signature signature(Increment& increment);

 private:
  std::vector<OtherTangent> tangents_;
  std::vector<std::unique_ptr<LinearSolver>> solvers_;  // made when they are first needed
};

}  // namespace langer
