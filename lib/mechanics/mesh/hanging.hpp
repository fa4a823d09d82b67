// Hanging nodes: the nodes whose displacements move a cell next to larger ones. A hanging node has
// no displacement of its own: u = (u_a + u_b) / 2 in the middle of an edge, the mean of four in the
// middle of a facet (Mesh::hanging). A cell with m hanging nodes depends on m corners of the larger
// cell that it was cut from instead, so it still has eight nodes that move it, with the shape
// functions
//   N'_b = sum_a C_ab N_a,   u_a = sum_b C_ab u_b   at its own eight nodes
// With these, forces, tangents and dilatations are computed as in any other cell.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "mechanics/mesh/mesh.hpp"

namespace langer {

class MovingNodes {
 public:
  explicit MovingNodes(const Mesh& mesh);  // refers to the mesh; hex8 where some nodes hang

  std::span<const int> of(int e) const;  // that move cell e
  const MatX* weights(int e) const;      // C (8, 8); none where no node of the cell hangs

 private:
  void add_cell(int e, const std::vector<const HangingNode*>& hangs);

  const Mesh& mesh_;
  std::vector<int> row_;  // by cell, into what follows; -1
  std::vector<std::array<int, 8>> nodes_;
  std::vector<MatX> weights_;
};

// The entry of a node in the list of a mesh; nullptr if the node is not hanging.
const HangingNode* hanging_at(const std::vector<HangingNode>& hanging, int node);

// For nodal sums (areas, forces): the values of hanging nodes are distributed to the nodes that
// they depend on.
template <class Values>
void fold_hanging(const Mesh& mesh, Values& sums) {
  for (const HangingNode& h : mesh.hanging) {
    for (int n : h.of) sums[n] += 0.25 * sums[h.node];
    sums[h.node] *= 0;
  }
}

// For nodal values that are 0 at hanging nodes: these get the mean of the nodes that they depend
// on.
template <class Values>
void spread_to_hanging(const Mesh& mesh, Values& values) {
  for (const HangingNode& h : mesh.hanging)
    for (int n : h.of) values[h.node] += 0.25 * values[n];
}

// The given nodes, ascending, and the hanging nodes that depend on these only.
std::vector<int> with_hanging(const Mesh& mesh, std::vector<int> nodes);

// The reason why hanging nodes of a mesh are not valid: other cells than hex8, wrong order, not in
// the middle, dependent on another hanging node. Empty if they are valid.
std::string hanging_fault(const Mesh& mesh);

}  // namespace langer
