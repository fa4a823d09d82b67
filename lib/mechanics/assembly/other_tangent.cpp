// Tangents of a body under other constraints than those of its equilibrium.
#include <algorithm>
#include <utility>

#include "mechanics/assembly/assembler.hpp"

namespace langer {

namespace {

// entry (i, j) of a symmetric matrix whose lower triangle is there, row by row
int lower(int i, int j) {
  const int row = std::max(i, j);
  const int column = std::min(i, j);
  return row * (row + 1) / 2 + column;
}

// position of a cell's entry, row >= column, in the values of the pattern
int position_in(const Pattern& pattern, int e, int row, int column) {
  if (pattern.scattered(e)) return pattern.slots(e)[lower(row, column)];
  const int a = row / 3;
  const int b = column / 3;
  const int i = row % 3;
  const int j = column % 3;
  const int* at = pattern.blocks(e) + 3 * lower(a, b);
  if (at[0] == Pattern::none) return Pattern::none;
  if (a == b) return at[j] + i - j;
  if (at[0] >= 0) return at[j] + i;
  return Pattern::turned(at[i]) + j;
}

bool ties(const Dofs& dofs, std::span<const int> nodes) {
  return !dofs.tie.empty() && std::ranges::any_of(nodes, [&](int a) {
    return dofs.tie[a].of != a || !dofs.tie[a].T.isDiagonal(0);
  });
}

// Adds a cell's 3 x 3 blocks, folded onto the nodes that move. block(a, b): of nodes a >= b.
template <class BlockOf>
void add_cell(OtherTangent& to, int e, std::span<const int> nodes, const BlockOf& block) {
  const bool tied = ties(to.dofs, nodes);
  const int n = static_cast<int>(nodes.size());
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b <= a; ++b) {
      Mat3 K = block(a, b);
      bool share_a_node = false;
      if (tied) {
        const Image& row = to.dofs.tie[nodes[a]];
        const Image& column = to.dofs.tie[nodes[b]];
        K = (row.T.transpose() * K * column.T).eval();
        share_a_node = a != b && row.of == column.of;
      }
      for (int i = 0; i < 3; ++i) {
        const int last = a == b ? i : 2;
        for (int j = 0; j <= last; ++j) {
          const int at = position_in(to.pattern, e, 3 * a + i, 3 * b + j);
          if (at < 0) continue;
          // both halves of the matrix meet on the diagonal of a node that moves both
          to.K[at] += share_a_node && i == j ? 2 * K(i, j) : K(i, j);
        }
      }
    }
  }
}

}  // namespace

OtherTangent Assembler::tangent_under(Dofs dofs) const {
  Pattern pattern = make_pattern(body_.mesh(), body_.moving_nodes(), dofs, body_.own_cells());
  return {std::move(dofs), std::move(pattern)};
}

bool Assembler::assemble_under(const VecX& u, std::span<OtherTangent> others) const {
  for (OtherTangent& other : others) other.K.assign(other.pattern.nnz(), 0);
  PacketElement out(body_.n_nodes(), body_.n_pressures());
  for (std::size_t b = 0; b < packets_.blocks().size(); ++b) {
    packets_.evaluate(b, u, pressures_, viscous_, true, out);
    if (!(smallest(out.J_min) > 0)) return false;
    const ElementPackets::Block& block = packets_.blocks()[b];
    for (int lane = 0; lane < block.n; ++lane) {
      const int e = block.cells[lane];
      const auto block_of = [&](int a, int c) {
        Mat3 K;
        for (int i = 0; i < 3; ++i) {
          for (int j = 0; j < 3; ++j) K(i, j) = out.K[lower(3 * a + i, 3 * c + j)][lane];
        }
        return K;
      };
      for (OtherTangent& other : others) add_cell(other, e, body_.nodes(e), block_of);
    }
  }
  if (loads_.empty()) return true;
  const auto displacements = [&](int e) {
    return body_.displacements(u, e);
  };
  const auto add = [&](int e, const ElementNodes&, const MatX* stiffness) {
    if (!stiffness) return;
    const auto block_of = [&](int a, int c) -> Mat3 {
      return stiffness->block<3, 3>(3 * a, 3 * c);
    };
    for (OtherTangent& other : others) add_cell(other, e, body_.nodes(e), block_of);
  };
  loads_.each(t_loads_, displacements, true, add);
  return true;
}

}  // namespace langer
