#include "mechanics/solve/symmetry_breaking.hpp"

#include <algorithm>
#include <utility>

namespace langer {

namespace {

bool can_be_together(const std::vector<Dofs>& kinds) {
  return kinds.size() > 1 && std::ranges::none_of(kinds, ties_nodes);
}

// Free is what is free in any of the kinds.
Dofs union_of(const std::vector<Dofs>& kinds) {
  Dofs all = kinds.front();
  all.free.clear();
  all.tie.clear();
  all.prescribed.clear();
  for (int dof = 0; dof < all.n; ++dof) {
    const bool is_free =
        std::ranges::any_of(kinds, [&](const Dofs& kind) { return kind.equation[dof] >= 0; });
    all.equation[dof] = -1;
    if (!is_free) continue;
    all.equation[dof] = all.n_free();
    all.free.push_back(dof);
  }
  return all;
}

}  // namespace

SymmetryBreaking::SymmetryBreaking(const Assembler& body, std::vector<Dofs> dofs)
    : body_(&body), dofs_(std::move(dofs)) {
  look_together_ = can_be_together(dofs_);
}

int SymmetryBreaking::factors_of_stable(const std::vector<Dofs>& kinds) {
  if (can_be_together(kinds)) return 1;
  return static_cast<int>(kinds.size());
}

Signature SymmetryBreaking::signature(Increment& increment) {
  if (look_together_) {
    if (together_.empty()) {
      together_.push_back(body_->tangent_under(union_of(dofs_)));
      solver_together_.resize(1);
    }
    if (increment.all_positive_under(together_, solver_together_)) return {};
    // A body that needs its mirror planes to be stable needs them at the next state, too.
    look_together_ = false;
    together_.clear();
    solver_together_.clear();
  }
  if (tangents_.empty()) {
    for (Dofs& kind : dofs_) tangents_.push_back(body_->tangent_under(std::move(kind)));
    solvers_.resize(tangents_.size());
  }
  return increment.signature_under(tangents_, solvers_);
}

}  // namespace langer
