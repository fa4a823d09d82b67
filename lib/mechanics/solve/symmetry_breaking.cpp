#include "mechanics/solve/symmetry_breaking.hpp"

namespace langer {

SymmetryBreaking::SymmetryBreaking(const Assembler& body, std::vector<Dofs> dofs)
    : solvers_(dofs.size()) {
  for (Dofs& kind : dofs) tangents_.push_back(body.tangent_under(std::move(kind)));
}

Signature SymmetryBreaking::signature(Increment& increment) {
  return increment.signature_under(tangents_, solvers_);
}

}  // namespace langer
