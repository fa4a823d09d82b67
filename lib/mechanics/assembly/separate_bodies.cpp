#include "mechanics/assembly/separate_bodies.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "mechanics/assembly/zero_energy_modes.hpp"

namespace langer {

std::vector<std::vector<int>> separate_bodies(const Mesh& mesh) {
  std::vector<int> parent(mesh.X.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int node) {
    while (parent[static_cast<std::size_t>(node)] != node) {
      int& above = parent[static_cast<std::size_t>(node)];
      above = parent[static_cast<std::size_t>(above)];
      node = above;
    }
    return node;
  };
  for (int e = 0; e < mesh.n_cells(); ++e) {
    const int first = root(mesh.cell(e)[0]);
    for (int node : mesh.cell(e)) parent[static_cast<std::size_t>(root(node))] = first;
  }
  std::map<int, std::size_t> index;
  std::vector<std::vector<int>> bodies;
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    const auto [found, is_new] = index.try_emplace(root(node), bodies.size());
    if (is_new) bodies.emplace_back();
    bodies[found->second].push_back(node);
  }
  return bodies;
}

std::string free_motions(const Mesh& mesh, const Dofs& dofs, const std::vector<int>& nodes) {
  Mesh part;
  for (int node : nodes) part.X.push_back(mesh.X[static_cast<std::size_t>(node)]);
  Dofs held;
  for (Prescribed p : dofs.prescribed) {
    const auto found = std::lower_bound(nodes.begin(), nodes.end(), p.dof / 3);
    if (found == nodes.end() || *found != p.dof / 3) continue;
    p.dof = 3 * static_cast<int>(found - nodes.begin()) + p.dof % 3;
    held.prescribed.push_back(p);
  }
  return zero_energy_modes(part, held);
}

bool any_is_free(const Mesh& mesh, const Dofs& dofs) {
  const auto bodies = separate_bodies(mesh);
  return std::any_of(bodies.begin(), bodies.end(), [&](const std::vector<int>& nodes) {
    return !free_motions(mesh, dofs, nodes).empty();
  });
}

}  // namespace langer
