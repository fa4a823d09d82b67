#include "mechanics/mesh/select.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "mechanics/mesh/bounding_box.hpp"
#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/reference.hpp"

namespace langer {

namespace {

// Of the diagonal of the mesh: nodes that a mesher placed on a plane are there up to rounding.
constexpr double relative_tolerance = 1e-9;

int index(const std::string& axis) {
  if (axis == "x") return 0;
  if (axis == "y") return 1;
  return 2;
}
Vec3 vector(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

}  // namespace

// The diagonal of the bounding box [mm], the scale of all tolerances of length.
double size(const Mesh& mesh) { return bounding_box(mesh.X).size().norm(); }

std::vector<int> all_nodes(const Mesh& mesh) {
  std::vector<int> nodes(mesh.X.size());
  std::iota(nodes.begin(), nodes.end(), 0);
  return nodes;
}

namespace {

// Among nodes at the same distance the first is chosen, up to the tolerance, so that rounding does
// not decide between images of a symmetric mesh. No node at all gives an empty set.
std::vector<int> nearest_node(const Mesh& mesh, const NearestNode& nearest,
                              const std::vector<int>& among) {
  const Vec3 to = vector(nearest.to);
  const double tolerance = relative_tolerance * size(mesh);
  int best = -1;
  double least = 0;
  for (int n : among)
    if (const double distance = (mesh.X[n] - to).norm(); best < 0 || distance < least - tolerance) {
      best = n;
      least = distance;
    }
  if (best < 0) return std::vector<int>{};
  return std::vector<int>{best};
}

bool holds(const OnPlane& plane, const Vec3& x, double tolerance) {
  return std::abs(x[index(plane.axis)] - plane.at) <= tolerance;
}

// The faces of the box belong to it.
bool holds(const InBox& box, const Vec3& x, double tolerance) {
  return ((x - vector(box.from)).array() >= -tolerance).all() &&
         ((vector(box.to) - x).array() >= -tolerance).all();
}

// The distance from the axis, without limits along it. "beyond" is the inner radius of a tube.
bool holds(const InCylinder& cylinder, const Vec3& x, double tolerance) {
  Vec3 across = x - vector(cylinder.through);
  across[index(cylinder.axis)] = 0;
  return across.norm() <= cylinder.radius + tolerance &&
         across.norm() >= cylinder.beyond.value_or(0) - tolerance;
}

}  // namespace

// The nodes of "among" that a selection of the scene holds. The nearest node depends on all of them
// and is found apart; the other kinds are decided node by node.
std::vector<int> select(const Mesh& mesh, const Selection& selection,
                        const std::vector<int>& among) {
  if (const NearestNode* nearest = std::get_if<NearestNode>(&selection))
    return nearest_node(mesh, *nearest, among);
  const double tolerance = relative_tolerance * size(mesh);
  std::vector<int> chosen;
  for (int n : among)
    if (std::visit(
            [&](const auto& s) {
              if constexpr (std::is_same_v<std::decay_t<decltype(s)>, NearestNode>)
                return false;
              else
                return holds(s, mesh.X[n], tolerance);
            },
            selection))
      chosen.push_back(n);
  return chosen;
}

// A facet inside the body belongs to two cells and is found twice under the same sorted nodes. What
// is found once is on the boundary. The result is in the order of the cells.
std::vector<Facet> boundary(const Mesh& mesh) {
  std::map<std::array<int, 4>, std::vector<Facet>> by_nodes;
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (int f = 0; f < mesh.cell().n_facets(); ++f)
      by_nodes[facet_key(mesh, {e, f})].push_back({e, f});
  // a facet of a larger cell and the quarters beside it, around the node in its middle
  std::set<int> middles;
  for (const HangingNode& h : mesh.hanging) {
    std::array<int, 4> of = h.of;
    std::sort(of.begin(), of.end());
    if (of[0] == of[1]) continue;  // of an edge
    by_nodes.erase(of);
    middles.insert(h.node);
  }
  const auto inside = [&](int node) {
    return middles.count(node) > 0;
  };
  std::vector<Facet> outer;
  for (const auto& [nodes, facets] : by_nodes)
    if (facets.size() == 1 && (middles.empty() || std::none_of(nodes.begin(), nodes.end(), inside)))
      outer.push_back(facets[0]);
  std::sort(outer.begin(), outer.end(), [](const Facet& a, const Facet& b) {
    return std::pair(a.cell, a.local) < std::pair(b.cell, b.local);
  });
  return outer;
}

// A facet belongs to a set of nodes when all its nodes do. The nodes must ascend.
std::vector<Facet> facets_within(const Mesh& mesh, const std::vector<Facet>& facets,
                                 const std::vector<int>& nodes) {
  std::vector<Facet> chosen;
  for (const Facet& facet : facets) {
    const auto its = facet_nodes(mesh, facet);
    if (std::all_of(its.begin(), its.end(),
                    [&](int n) { return std::binary_search(nodes.begin(), nodes.end(), n); }))
      chosen.push_back(facet);
  }
  return chosen;
}

std::vector<std::string> side_names() {
  return {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max", "bottom", "top"};
}

// The six sides of the bounding box, as sets of nodes and of facets. y is upwards: "bottom" and
// "top" are other names for y_min and y_max. On a curved body a side has only the nodes that touch
// the box.
void name_sides(Mesh& mesh) {
  const BoundingBox b = bounding_box(mesh.X);
  const std::vector<Facet> outer = boundary(mesh);
  const std::vector<int> all = all_nodes(mesh);
  for (const char* axis : {"x", "y", "z"})
    for (bool high : {false, true}) {
      const std::string name = std::string(axis) + (high ? "_max" : "_min");
      const Vec3& corner = high ? b.high : b.low;
      const std::vector<int> nodes = select(mesh, OnPlane{axis, corner[index(axis)]}, all);
      mesh.facet_sets[name] = facets_within(mesh, outer, nodes);
      mesh.node_sets[name] = nodes;
    }
  for (const auto& [alias, name] : {std::pair("bottom", "y_min"), std::pair("top", "y_max")}) {
    mesh.node_sets[alias] = mesh.node_sets[name];
    mesh.facet_sets[alias] = mesh.facet_sets[name];
  }
}

}  // namespace langer
