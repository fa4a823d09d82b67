// Sparsity of the symmetric tangent, made once: lower triangle by columns, and where each element's
// entries go.
//   column_start (n+1), row (nnz)   compressed columns, rows ascending
//   blocks(e)                       for each pair of nodes a >= b, row-wise, where its 3 x 3 block has the three columns of the node
//                                   that comes first: the position of their first entries in the value array (of the diagonal's
//                                   where a = b). As it is where b comes first, turned(it) where a does; none where one of the nodes
//                                   is held in all directions.
//   slots(e)                        only where scattered(e), because a node is held in some directions or moves as another does:
//                                   for each element entry (i >= j), row-wise, its position; none where a prescribed dof is involved
#pragma once

#include <vector>

#include "mechanics/assembly/dofs.hpp"
#include "mechanics/mesh/hanging.hpp"
#include "mechanics/mesh/mesh.hpp"

namespace langer {

struct Pattern {
  static constexpr int none = -1;
  static constexpr int turned(int position) { return -2 - position; }

  int n = 0;
  int blocks_per_element = 0, slots_per_element = 0;
  std::vector<int> column_start, row;
  std::vector<int> block,
      block_of;                    // block_of: by element, the number of its blocks; empty: its own
  std::vector<int> slot, slot_of;  // slot_of: by element, the number of its slots; none

  int nnz() const { return static_cast<int>(row.size()); }
  std::size_t number(int e) const {
    return static_cast<std::size_t>(block_of.empty() ? e : block_of[static_cast<std::size_t>(e)]);
  }
  const int* blocks(int e) const { return block.data() + number(e) * 3 * blocks_per_element; }
  bool scattered(int e) const { return slot_of[e] >= 0; }
  const int* slots(int e) const {
    return slot.data() + static_cast<std::size_t>(slot_of[e]) * slots_per_element;
  }
};

// cells: ascending, those that have entries; the block of a node with itself is there for all nodes
Pattern make_pattern(const Mesh& mesh, const MovingNodes& moving, const Dofs& dofs,
                     const std::vector<int>& cells);

}  // namespace langer
