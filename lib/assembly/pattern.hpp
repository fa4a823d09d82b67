// Sparsity of the symmetric tangent, made once: lower triangle by columns, and where each element's entries go.
//   column_start (n+1), row (nnz)   compressed columns, rows ascending
//   slot[e]                         for each element entry (i >= j), row-wise: its position in the value array;
//                                   -1 where a prescribed dof is involved
#pragma once

#include <vector>

#include "assembly/dofs.hpp"
#include "mesh/mesh.hpp"

namespace langer {

struct Pattern {
  int n = 0;
  int slots_per_element = 0;
  std::vector<int> column_start, row;
  std::vector<int> slot;

  int nnz() const { return static_cast<int>(row.size()); }
  const int* slots(int e) const { return slot.data() + static_cast<std::size_t>(e) * slots_per_element; }
};

Pattern make_pattern(const Mesh& mesh, const Dofs& dofs);

}  // namespace langer
