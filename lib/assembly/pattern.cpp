#include "assembly/pattern.hpp"

#include <algorithm>

namespace langer {

namespace {
// neighbours of each node through cells, ascending, itself included; tied nodes are those they are tied to
std::vector<std::vector<int>> node_graph(const Mesh& mesh, const Dofs& dofs) {
  std::vector<std::vector<int>> cells_of(mesh.n_nodes());
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (int a : mesh.cell(e)) cells_of[dofs.node(a)].push_back(e);
  std::vector<std::vector<int>> graph(mesh.n_nodes());
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    auto& near = graph[i];
    for (int e : cells_of[i])
      for (int b : mesh.cell(e)) near.push_back(dofs.node(b));
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
  }
  return graph;
}
}  // namespace

Pattern make_pattern(const Mesh& mesh, const Dofs& dofs) {
  Pattern pattern;
  pattern.n = dofs.n_free();
  pattern.column_start.assign(pattern.n + 1, 0);
  const auto graph = node_graph(mesh, dofs);
  for (int c = 0; c < pattern.n; ++c) {  // rows are numbered by node, so neighbours in order give ascending rows
    const int dof = dofs.free[c];
    for (int b : graph[dof / 3])
      for (int k = 0; k < 3; ++k)
        if (int r = dofs.equation[3 * b + k]; r >= c) pattern.row.push_back(r);
    pattern.column_start[c + 1] = pattern.nnz();
  }
  const int n_dofs = 3 * nodes_per_cell(mesh.type);
  pattern.slots_per_element = n_dofs * (n_dofs + 1) / 2;
  pattern.slot.assign(static_cast<std::size_t>(mesh.n_cells()) * pattern.slots_per_element, -1);
  for (int e = 0; e < mesh.n_cells(); ++e) {
    const auto nodes = mesh.cell(e);
    int* slot = pattern.slot.data() + static_cast<std::size_t>(e) * pattern.slots_per_element;
    for (int i = 0; i < n_dofs; ++i)
      for (int j = 0; j <= i; ++j, ++slot) {
        int r = dofs.equation[3 * dofs.node(nodes[i / 3]) + i % 3], c = dofs.equation[3 * dofs.node(nodes[j / 3]) + j % 3];
        if (r < 0 || c < 0) continue;
        if (r < c) std::swap(r, c);
        const auto first = pattern.row.begin() + pattern.column_start[c],
                   last = pattern.row.begin() + pattern.column_start[c + 1];
        *slot = static_cast<int>(std::lower_bound(first, last, r) - pattern.row.begin());
      }
  }
  return pattern;
}

}  // namespace langer
