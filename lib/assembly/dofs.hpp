// Which degrees of freedom are free. Dof 3 i + k is displacement component k of node i.
// A prescribed component moves as  value * factor(t);  held components have value 0.
// Tied nodes, those of symmetry or of a section, have no dofs of their own: whoever needs their displacement asks their image.
#pragma once

#include <vector>

#include "base/history.hpp"
#include "mesh/symmetry.hpp"
#include "tensor/types.hpp"

namespace langer {

struct Prescribed {
  int dof = 0;
  double value = 0;             // [mm] its largest value
  LoadFactor factor = nullptr;  // of it; none: in proportion to t
  double at(double t) const { return value * factor_at(factor, t); }
};

struct Dofs {
  int n = 0;                           // 3 * nodes
  std::vector<int> equation;           // (n) row of a free dof, -1 where prescribed, tied or forbidden by symmetry
  std::vector<int> free;               // dof of each row
  std::vector<Prescribed> prescribed;  // ascending dof
  std::vector<Image> tie;              // by node; empty without symmetry

  int n_free() const { return static_cast<int>(free.size()); }
  int node(int i) const { return tie.empty() ? i : tie[i].of; }  // where node i has its dofs
};

// Later entries for the same dof must agree in value; `conflict` is the dof where they do not, or -1.
struct DofsResult {
  Dofs dofs;
  int conflict = -1;
};
DofsResult number_dofs(int n_nodes, std::vector<Prescribed> prescribed, std::vector<Image> tie = {});

}  // namespace langer
