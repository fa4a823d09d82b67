// Adds the stiffness of a cell to the values of a pattern. Nodes that move as others do have no
// rows of their own: with u(node) = T u(node of), a block of nodes a and b goes to the rows of
// those that they move with, as T_a^T K_ab T_b.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mechanics/assembly/dofs.hpp"
#include "mechanics/assembly/pattern.hpp"
#include "mechanics/element/packet_solid.hpp"
#include "mechanics/mesh/reference.hpp"

namespace langer {

class FoldedCell {
 public:
  // nodes: of element e. Refers to pattern and dofs.
  FoldedCell(const Pattern& pattern, const Dofs& dofs, int e, std::span<const int> nodes)
      : pattern_(pattern), e_(e) {
    if (dofs.tie.empty()) return;
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      const Image& tie = dofs.tie[static_cast<std::size_t>(nodes[a])];
      of_[a] = tie.of;
      tied_ = tied_ || tie.of != nodes[a];
      // The diagonal T of a node that moves alone only holds directions, which have no rows.
      if (tie.of != nodes[a] || !tie.T.isDiagonal(0)) turned_[a] = &tie.T;
    }
  }

  // (3 nodes, 3 nodes), symmetric
  void add(const MatX& stiffness, std::vector<double>& values) const {
    for (int a = 0; 3 * a < stiffness.rows(); ++a) {
      for (int b = 0; b <= a; ++b) {
        const Mat3 K = stiffness.block<3, 3>(3 * a, 3 * b);
        if (!K.isZero(0)) add_block(a, b, K, values);
      }
    }
  }
  // lane of a packet of elements
  void add(const PacketElement& element, int lane, std::vector<double>& values) const {
    for (int a = 0; 3 * a < element.n_dofs; ++a) {
      for (int b = 0; b <= a; ++b) add_block(a, b, block_of(element, lane, a, b), values);
    }
  }

 private:
  // K: of its nodes a >= b
  void add_block(int a, int b, const Mat3& K, std::vector<double>& values) const {
    if (!turned_[a] && !turned_[b]) {
      add_folded(a, b, K, values);
      return;
    }
    Mat3 folded = K;
    if (turned_[a]) folded = turned_[a]->transpose() * K;
    if (turned_[b]) folded = (folded * *turned_[b]).eval();
    add_folded(a, b, folded, values);
  }

  // The 3 x 3 block of the nodes a >= b of an element's stiffness, whose lower triangle is stored
  // row by row.
  static Mat3 block_of(const PacketElement& element, int lane, int a, int b) {
    Mat3 K;
    for (int i = 0; i < 3; ++i) {
      const int row = 3 * a + i;
      const Packet* from = &element.K[static_cast<std::size_t>(row * (row + 1) / 2 + 3 * b)];
      for (int j = 0; j < 3 && 3 * b + j <= row; ++j) K(i, j) = from[j][lane];
    }
    if (a != b) return K;
    return K.selfadjointView<Eigen::Lower>();
  }

  void add_folded(int a, int b, const Mat3& K, std::vector<double>& values) const {
    const int block = a * (a + 1) / 2 + b;
    if (!pattern_.scattered(e_)) {
      add_to_columns(a == b, pattern_.blocks(e_) + 3 * block, K, values);
      return;
    }
    // Two nodes that move with one: both halves of the symmetric matrix meet on its diagonal.
    const bool meet = tied_ && a != b && of_[a] == of_[b];
    for (int i = 0; i < 3; ++i) {
      const int row = 3 * a + i;
      const int* slot = pattern_.slots(e_) + row * (row + 1) / 2 + 3 * b;
      for (int j = 0; j < 3 && 3 * b + j <= row; ++j) {
        if (slot[j] < 0) continue;
        double entry = K(i, j);
        if (meet && i == j) entry *= 2;
        values[static_cast<std::size_t>(slot[j])] += entry;
      }
    }
  }

  static void add_to_columns(bool diagonal, const int* at, const Mat3& K,
                             std::vector<double>& values) {
    if (at[0] == Pattern::none) return;
    if (diagonal) {
      for (int j = 0; j < 3; ++j)
        for (int i = j; i < 3; ++i) values[static_cast<std::size_t>(at[j] + i - j)] += K(i, j);
    } else if (at[0] >= 0) {
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) values[static_cast<std::size_t>(at[j] + i)] += K(i, j);
    } else {
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          values[static_cast<std::size_t>(Pattern::turned(at[i]) + j)] += K(i, j);
    }
  }

  const Pattern& pattern_;
  int e_;
  bool tied_ = false;
  std::array<int, most_nodes> of_{};
  std::array<const Mat3*, most_nodes> turned_{};
};

}  // namespace langer
