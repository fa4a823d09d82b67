#include "accuracy/estimate/cell_parts.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/section.hpp"
#include "mechanics/mesh/select.hpp"

namespace langer {

std::vector<int> touched_cells(const Run& run, const StepRecord& last) {
  std::vector<char> touched(run.mesh.X.size(), 0);
  for (const RigidContact& contact : run.scene.contacts) {
    const std::vector<Vec3>& r = last.contacts.at(contact.name).r;
    for (std::size_t i = 0; i < r.size(); ++i)
      if (!r[i].isZero(0)) touched[static_cast<std::size_t>(contact.nodes[i])] = 1;
  }
  std::vector<int> cells;
  for (int e = 0; e < run.mesh.n_cells(); ++e)
    if (std::ranges::any_of(run.mesh.cell(e),
                            [&](int n) { return touched[static_cast<std::size_t>(n)] != 0; }))
      cells.push_back(e);
  return cells;
}

std::vector<double> parts_of(const std::vector<double>& of_cell, double smooth,
                             const std::vector<int>& touched, double of_contact) {
  std::vector<double> parts;
  for (double of_one : of_cell) parts.push_back(smooth * std::abs(of_one));
  for (int e : touched)
    parts[static_cast<std::size_t>(e)] += of_contact / static_cast<double>(touched.size());
  return parts;
}

double with_a_corner_inside(const Mesh& mesh) {
  std::vector<char> outside(mesh.X.size(), 0);
  int front = 0;
  if (mesh.section) front = n_front(mesh);
  for (const Facet& facet : boundary(mesh)) {
    const std::vector<int> nodes = facet_nodes(mesh, facet);
    const auto in_front =
        std::count_if(nodes.begin(), nodes.end(), [&](int n) { return n < front; });
    if (mesh.section && (in_front == 0 || in_front == std::ssize(nodes)))
      continue;  // a section goes on there
    for (int n : nodes) outside[static_cast<std::size_t>(n)] = 1;
  }
  int inside = 0;
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (int a = 0; a < mesh.cell().n_corners; ++a)
      if (!outside[static_cast<std::size_t>(mesh.cell(e)[a])]) {
        ++inside;
        break;
      }
  return static_cast<double>(inside) / mesh.n_cells();
}

PathErrors to_be_cut_everywhere(const Mesh& mesh, const std::string& why) {
  PathErrors out;
  out.not_known = {"errors are not known: " + why};
  out.of_cells.assign(static_cast<std::size_t>(mesh.n_cells()), 1);
  return out;
}

}  // namespace langer
