// What moves a cell beside larger ones. A hanging node has no displacement of its own: u = (u_a +
// u_b) / 2 in the middle of an edge, the mean of four in that of a facet (Mesh::hanging). A cell
// with m of them has m corners of others in their place, those of the larger cell that it was cut
// from; so it has eight nodes that move it, and as shape functions
//   N'_b = sum_a C_ab N_a,   u_a = sum_b C_ab u_b   at its own eight nodes
// with which forces, tangents and dilatations are those of any other cell.
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
  void take(int e, const std::vector<const HangingNode*>& hangs);

  const Mesh& mesh_;
  std::vector<int> row_;  // by cell, into what follows; -1
  std::vector<std::array<int, 8>> nodes_;
  std::vector<MatX> weights_;
};

// that of a node, of those of a mesh; nullptr: it moves by itself
const HangingNode* hanging_at(const std::vector<HangingNode>& hanging, int node);

// sums of nodes (areas, forces): what hanging ones have goes to those that they hang on
template <class Values>
void fold_hanging(const Mesh& mesh, Values& sums) {
  for (const HangingNode& h : mesh.hanging) {
    for (int n : h.of) sums[n] += 0.25 * sums[h.node];
    sums[h.node] *= 0;
  }
}

// values at nodes, 0 at hanging ones, which get the mean of those that they hang on
template <class Values>
void spread_to_hanging(const Mesh& mesh, Values& values) {
  for (const HangingNode& h : mesh.hanging)
    for (int n : h.of) values[h.node] += 0.25 * values[n];
}

// these, ascending, and those that hang on no others than these
std::vector<int> with_hanging(const Mesh& mesh, std::vector<int> nodes);

// "", or why nothing can hang so: other cells than hex8, nodes in no order, away from the middle,
// on some that hang themselves
std::string hanging_fault(const Mesh& mesh);

}  // namespace langer
