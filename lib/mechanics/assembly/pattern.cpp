#include "mechanics/assembly/pattern.hpp"

#include <algorithm>

namespace langer {

namespace {
// neighbours of each node through cells, ascending, itself included; tied nodes are those they are
// tied to
std::vector<std::vector<int>> node_graph(const Mesh& mesh, const MovingNodes& moving,
                                         const Dofs& dofs, const std::vector<int>& cells) {
  std::vector<std::vector<int>> cells_of(mesh.n_nodes());
  for (int e : cells)
    for (int a : moving.of(e)) cells_of[dofs.node(a)].push_back(e);
  std::vector<std::vector<int>> graph(mesh.n_nodes());
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    auto& near = graph[i];
    near.push_back(i);
    for (int e : cells_of[i])
      for (int b : moving.of(e)) near.push_back(dofs.node(b));
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
  }
  return graph;
}

// position of an entry of the lower triangle; none where a dof is prescribed
int position(const Pattern& pattern, int r, int c) {
  if (r < 0 || c < 0) return Pattern::none;
  if (r < c) std::swap(r, c);
  const auto first = pattern.row.begin() + pattern.column_start[c];
  const auto last = pattern.row.begin() + pattern.column_start[c + 1];
  return static_cast<int>(std::lower_bound(first, last, r) - pattern.row.begin());
}

// all of the node's directions are free, or none
bool even(const Dofs& dofs, int node) {
  const int* row = &dofs.equation[3 * static_cast<std::size_t>(node)];
  if (!dofs.tie.empty() && (dofs.tie[node].of != node || !dofs.tie[node].T.isDiagonal(0)))
    return false;
  return (row[0] < 0 && row[1] < 0 && row[2] < 0) || (row[0] >= 0 && row[1] >= 0 && row[2] >= 0);
}
}  // namespace

Pattern make_pattern(const Mesh& mesh, const MovingNodes& moving, const Dofs& dofs,
                     const std::vector<int>& cells) {
  Pattern pattern;
  pattern.n = dofs.n_free();
  pattern.column_start.assign(pattern.n + 1, 0);
  const auto graph = node_graph(mesh, moving, dofs, cells);
  for (int c = 0; c < pattern.n;
       ++c) {  // rows are numbered by node, so neighbours in order give ascending rows
    const int dof = dofs.free[c];
    for (int b : graph[dof / 3])
      for (int k = 0; k < 3; ++k)
        if (int r = dofs.equation[3 * b + k]; r >= c) pattern.row.push_back(r);
    pattern.column_start[c + 1] = pattern.nnz();
  }
  const int n_nodes = nodes_per_cell(mesh.type);
  const int n_dofs = 3 * n_nodes;
  pattern.blocks_per_element = n_nodes * (n_nodes + 1) / 2;
  pattern.slots_per_element = n_dofs * (n_dofs + 1) / 2;
  if (cells.size() < static_cast<std::size_t>(mesh.n_cells())) {
    pattern.block_of.assign(mesh.n_cells(), Pattern::none);
    for (std::size_t i = 0; i < cells.size(); ++i) pattern.block_of[cells[i]] = static_cast<int>(i);
  }
  pattern.block.assign(cells.size() * 3 * pattern.blocks_per_element, Pattern::none);
  pattern.slot_of.assign(mesh.n_cells(), Pattern::none);
  int n_scattered = 0;
  for (int e : cells) {
    const auto nodes = moving.of(e);
    const auto equation = [&](int i) {
      return dofs.equation[3 * dofs.node(nodes[i / 3]) + i % 3];
    };
    if (!std::all_of(nodes.begin(), nodes.end(), [&](int node) { return even(dofs, node); })) {
      pattern.slot_of[e] = n_scattered++;
      for (int i = 0; i < n_dofs; ++i)
        for (int j = 0; j <= i; ++j)
          pattern.slot.push_back(position(pattern, equation(i), equation(j)));
      continue;
    }
    int* at = pattern.block.data() + pattern.number(e) * 3 * pattern.blocks_per_element;
    for (int a = 0; a < n_nodes; ++a)
      for (int b = 0; b <= a; ++b, at += 3) {
        const int row = equation(3 * a);
        const int column = equation(3 * b);
        if (row < 0 || column < 0) continue;
        for (int k = 0; k < 3; ++k) {
          if (a == b) {
            at[k] = position(pattern, row + k, column + k);
          } else if (row > column) {
            at[k] = position(pattern, row, column + k);
          } else {
            at[k] = Pattern::turned(position(pattern, column, row + k));
          }
        }
      }
  }
  return pattern;
}

}  // namespace langer
