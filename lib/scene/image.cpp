#include "scene/image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <variant>

#include "mesh/facets.hpp"

namespace langer {

namespace {

constexpr double same = same_place;

// visits a listing: whether all members are equal
template <class T>
struct EqualMembers {
  const T &a, &b;
  bool equal = true;
  void operator()(auto member, auto&&...) { equal = equal && a.*member == b.*member; }
};

bool same_law(const Fibre& a, const Fibre& b) {
  if (a.kappa != b.kappa || a.tension_switch != b.tension_switch) return false;
  return std::visit(
      [&]<class Law>(const Law& law) {
        const Law* other = std::get_if<Law>(&b.law);
        if (!other) return false;
        EqualMembers<Law> members{law, *other};
        Law::fields(members);
        return members.equal;
      },
      a.law);
}

// whether families with the directions a, turned, are those with the directions b
bool same_families(const std::vector<Fibre>& families, const Isometry& op, std::span<const Vec3> a, std::span<const Vec3> b) {
  std::vector<char> taken(families.size(), 0);
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (!has_direction(families[k])) continue;
    const Vec3 turned = op.turn * a[k];
    std::size_t j = 0;
    const auto is_image = [&] {
      return !taken[j] && std::min((turned - b[j]).norm(), (turned + b[j]).norm()) <= same && same_law(families[k], families[j]);
    };
    while (j < b.size() && !is_image()) ++j;
    if (j == b.size()) return false;
    taken[j] = 1;
  }
  return true;
}

std::string broken_fibres(const Symmetry& g, const Isometry& op, const Mesh& mesh, const Scene& scene) {
  if (scene.families() == 0) return "";
  for (int e = 0; e < mesh.n_cells(); ++e)
    if (!same_families(scene.materials[mesh.body.empty() ? 0 : mesh.body[e]].fibres, op, scene.directions.of(e),
                       scene.directions.of(g.cell[e])))
      return fmt::format("the fibres of cells {} and {}", e, g.cell[e]);
  return "";
}

std::string broken_supports(const Symmetry& g, const Scene& scene) {
  std::map<int, Prescribed> imposed;
  for (const Prescribed& p : scene.dofs.prescribed) imposed[p.dof] = p;
  for (const auto& [dof, p] : imposed) {
    const auto other = imposed.find(3 * g.node[dof / 3] + dof % 3);
    if (other == imposed.end() || std::abs(other->second.value - g.signs[dof % 3] * p.value) > same * std::abs(p.value) ||
        !same_factor(other->second.factor, p.factor))
      return fmt::format("what holds or moves node {} along {}", dof / 3, "xyz"[dof % 3]);
  }
  return "";
}

// whether a load goes over into one with the same factor: the facets by their corners
std::string broken_loads(const Symmetry& g, const Mesh& mesh, const Scene& scene) {
  const auto keys = [&](const SurfaceLoad& load, bool image) {
    std::set<std::array<int, 4>> all;
    for (const Facet& facet : load.facets) {
      std::array<int, 4> key = facet_key(mesh, facet);
      if (image)
        for (int& node : key) node = node < 0 ? node : g.node[node];
      std::sort(key.begin(), key.end());
      all.insert(key);
    }
    return all;
  };
  for (std::size_t i = 0; i < scene.loads.size(); ++i) {
    const SurfaceLoad& load = scene.loads[i];
    const auto facets = keys(load, true);
    const bool found = std::any_of(scene.loads.begin(), scene.loads.end(), [&](const SurfaceLoad& other) {
      return (other.traction - g.signs.cwiseProduct(load.traction)).norm() <= same * load.traction.norm() &&
             other.pressure == load.pressure && same_factor(other.factor, load.factor) && keys(other, false) == facets;
    });
    if (!found) return fmt::format("a force, a traction or a pressure on {} facets", load.facets.size());
  }
  return "";
}

bool same_motion(const std::vector<Waypoint>& a, const std::vector<Waypoint>& b, const Isometry& op) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](const Waypoint& p, const Waypoint& q) { return p.t == q.t && turns_to(p.to, q.to, op); });
}

// what keeps b from being the image of a; empty where nothing
std::string difference(const RigidContact& a, const RigidContact& b, const Symmetry& g, const Isometry& op) {
  if (!becomes(a.shape, b.shape, op)) return fmt::format("the shape or place of the indenter \"{}\"", a.name);
  if (a.mu != b.mu) return fmt::format("the friction of the indenter \"{}\"", a.name);
  const bool both_free = !a.control && !b.control;
  const bool alike = both_free || (&a == &b && (op.turn * a.control->along - a.control->along).norm() <= same);
  if (!alike) return fmt::format("the force on the indenter \"{}\"", a.name);
  if (!same_motion(a.motion, b.motion, op)) return fmt::format("the path of the indenter \"{}\"", a.name);
  std::vector<char> candidate(g.node.size(), 0);
  for (int node : b.nodes) candidate[node] = 1;
  const bool all = a.nodes.size() == b.nodes.size() &&
                   std::all_of(a.nodes.begin(), a.nodes.end(), [&](int node) { return candidate[g.node[node]]; });
  return all ? "" : fmt::format("the nodes that may touch \"{}\"", a.name);
}

std::string match_contacts(const Symmetry& g, const Isometry& op, const Scene& scene, std::vector<int>& image) {
  const std::vector<RigidContact>& all = scene.contacts;
  const int n = static_cast<int>(all.size());
  image.assign(all.size(), -1);
  for (int i = 0; i < n; ++i) {
    const std::string own = difference(all[i], all[i], g, op);
    if (own.empty()) image[i] = i;
    for (int j = 0; j < n && image[i] < 0; ++j)
      if (j != i && std::find(image.begin(), image.end(), j) == image.end() && difference(all[i], all[j], g, op).empty())
        image[i] = j;
    if (image[i] < 0) return own;
  }
  return "";
}

}  // namespace

SceneImage image_of(const Symmetry& g, const Mesh& mesh, const Scene& scene) {
  const Isometry op{g.signs.asDiagonal(), g.centre};
  SceneImage image;
  image.broken = broken_fibres(g, op, mesh, scene);
  if (image.broken.empty()) image.broken = broken_supports(g, scene);
  if (image.broken.empty()) image.broken = broken_loads(g, mesh, scene);
  if (image.broken.empty()) image.broken = match_contacts(g, op, scene, image.contact);
  return image;
}

}  // namespace langer
