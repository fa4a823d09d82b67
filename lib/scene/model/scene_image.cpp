#include "scene/model/scene_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <variant>

#include "mechanics/mesh/facets.hpp"

namespace langer {

namespace {

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
bool same_families(const std::vector<Fibre>& families, const Isometry& op, std::span<const Vec3> a,
                   std::span<const Vec3> b) {
  std::vector<char> taken(families.size(), 0);
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (!has_direction(families[k])) continue;
    const Vec3 turned = op.turn * a[k];
    std::size_t j = 0;
    const auto is_image = [&] {
      return !taken[j] && std::min((turned - b[j]).norm(), (turned + b[j]).norm()) <= same_place &&
             same_law(families[k], families[j]);
    };
    while (j < b.size() && !is_image()) ++j;
    if (j == b.size()) return false;
    taken[j] = 1;
  }
  return true;
}

std::string broken_fibres(const MeshImage& g, const Isometry& op, const Mesh& mesh,
                          const Scene& scene, const Scene& image) {
  if (scene.families() == 0) return "";
  for (int e = 0; e < mesh.n_cells(); ++e)
    if (!same_families(scene.materials[mesh.body.empty() ? 0 : mesh.body[e]].fibres, op,
                       scene.directions.of(e), image.directions.of(g.cell[e])))
      return fmt::format("the fibres of cells {} and {}", e, g.cell[e]);
  return "";
}

// of one component of a displacement, whose sign the symmetry keeps or changes
bool is_image(const Prescribed& image, const Prescribed& of, double sign) {
  const auto near = [&](double a, double b, double size) {
    return std::abs(a - sign * b) <= same_place * size;
  };
  const bool held = image.value == 0 && of.value == 0;  // at any time, whatever the history
  if (!held && !same_factor(image.factor, of.factor)) return false;
  if (!near(image.value, of.value, std::abs(of.value))) return false;
  if (!image.turn || !of.turn) return !image.turn && !of.turn;
  const Turn &a = *image.turn, &b = *of.turn;
  const double size = b.radius() + same_place;  // a component of a node on the axis is rounding
  return a.angle == b.angle && near(a.along, b.along, size) && near(a.across, b.across, size);
}

std::string broken_supports(const MeshImage& g, const Scene& scene, const Scene& image) {
  std::map<int, Prescribed> imposed;
  for (const Prescribed& p : image.dofs.prescribed) imposed[p.dof] = p;
  const auto found = [&](const Prescribed& p) {
    Eigen::Index axis = 0;  // that its own becomes
    g.turn.col(p.dof % 3).cwiseAbs().maxCoeff(&axis);
    const auto other = imposed.find(3 * g.node[p.dof / 3] + static_cast<int>(axis));
    return other != imposed.end() && is_image(other->second, p, g.turn(axis, p.dof % 3));
  };
  for (const Prescribed& p : scene.dofs.prescribed)
    if (!found(p) || imposed.size() != scene.dofs.prescribed.size())
      return fmt::format("what holds or moves node {} along {}", p.dof / 3, "xyz"[p.dof % 3]);
  return "";
}

// The facets of a load by their corners, in order; those of its image under `g`.
std::vector<std::array<int, 4>> facet_keys(const Mesh& mesh, const SurfaceLoad& load,
                                           const MeshImage* g) {
  std::vector<std::array<int, 4>> keys;
  for (const Facet& facet : load.facets) {
    std::array<int, 4> key = facet_key(mesh, facet);
    for (int& node : key)
      if (g && node >= 0) node = g->node[node];
    std::sort(key.begin(), key.end());
    keys.push_back(key);
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}

bool is_image(const SurfaceLoad& image, const SurfaceLoad& of, const MeshImage& g) {
  const double change = (image.traction - g.turn * of.traction).norm();
  return change <= same_place * of.traction.norm() && image.pressure == of.pressure &&
         image.volume == of.volume && same_factor(image.factor, of.factor);
}

// Loads add up: each is the image of one other load, and no load of two.
std::string broken_loads(const MeshImage& g, const Mesh& mesh, const Scene& scene,
                         const Scene& image) {
  if (scene.loads.size() != image.loads.size()) return "the number of loads";
  std::vector<std::vector<std::array<int, 4>>> facets;
  for (const SurfaceLoad& load : image.loads) facets.push_back(facet_keys(mesh, load, nullptr));
  std::vector<char> matched(image.loads.size(), 0);
  for (const SurfaceLoad& load : scene.loads) {
    const auto images = facet_keys(mesh, load, &g);
    std::size_t j = 0;
    while (j < matched.size() &&
           (matched[j] || !is_image(image.loads[j], load, g) || facets[j] != images))
      ++j;
    if (j == matched.size())
      return fmt::format("a force, a traction or a pressure on {} facets", load.facets.size());
    matched[j] = 1;
  }
  return "";
}

bool same_motion(const std::vector<Waypoint>& a, const std::vector<Waypoint>& b,
                 const Isometry& op) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](const Waypoint& p, const Waypoint& q) {
                      return p.t == q.t && maps_direction(p.to, q.to, op);
                    });
}

// Turns are no arrows: a mirror that leaves the axis in place turns the other way.
bool same_rotation(const RigidContact& a, const RigidContact& b, const Isometry& op) {
  if (!a.rotation || !b.rotation) return !a.rotation && !b.rotation;
  const History &angle = a.rotation->angle, &image = b.rotation->angle;
  const double hand = cross(op.turn.col(0), op.turn.col(1)).dot(op.turn.col(2));
  return same_factor(angle.factor, image.factor) &&
         (hand * angle.value * (op.turn * a.rotation->axis.along) -
          image.value * b.rotation->axis.along)
                 .norm() <= same_place * std::abs(angle.value);
}

// The facets of one side by their nodes, in order; those of its image under `g`.
std::vector<QuadNodes> facet_keys(const std::vector<QuadNodes>& side, const MeshImage* g) {
  std::vector<QuadNodes> keys = side;
  for (QuadNodes& key : keys) {
    for (int& node : key)
      if (g) node = g->node[static_cast<std::size_t>(node)];
    std::ranges::sort(key);
  }
  std::ranges::sort(keys);
  return keys;
}

// Each pair of surfaces is its own image, side by side. A surface that touches itself may do so
// across a plane of symmetry.
std::string broken_surfaces(const MeshImage& g, const Scene& scene, const Scene& image) {
  if (scene.surfaces.size() != image.surfaces.size()) return "the number of surfaces that touch";
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    const SurfaceContact &a = scene.surfaces[s], &b = image.surfaces[s];
    if (a.touches_itself() || b.touches_itself())
      return fmt::format("the surface of \"{}\", which touches itself,", a.name);
    if (a.mu != b.mu) return fmt::format("the friction of \"{}\"", a.name);
    if (a.adhesion != b.adhesion) return fmt::format("the adhesion of \"{}\"", a.name);
    if (facet_keys(a.own, &g) != facet_keys(b.own, nullptr) ||
        facet_keys(a.other, &g) != facet_keys(b.other, nullptr))
      return fmt::format("a surface of \"{}\"", a.name);
  }
  return "";
}

// what keeps b from being the image of a; empty where nothing
std::string difference(const RigidContact& a, const RigidContact& b, const MeshImage& g,
                       const Isometry& op) {
  if (!maps_onto(a.shape, b.shape, op))
    return fmt::format("the shape or place of the indenter \"{}\"", a.name);
  if (a.mu != b.mu) return fmt::format("the friction of the indenter \"{}\"", a.name);
  if (a.adhesion != b.adhesion) return fmt::format("the adhesion of the indenter \"{}\"", a.name);
  const bool both_free = !a.control && !b.control;
  const bool alike =
      both_free ||
      (a.control && b.control && a.name == b.name && a.control->force == b.control->force &&
       (op.turn * a.control->along - b.control->along).norm() <= same_place);
  if (!alike) return fmt::format("the force on the indenter \"{}\"", a.name);
  if (!same_motion(a.motion, b.motion, op))
    return fmt::format("the path of the indenter \"{}\"", a.name);
  if (!same_rotation(a, b, op)) return fmt::format("the rotation of the indenter \"{}\"", a.name);
  std::vector<char> candidate(g.node.size(), 0);
  for (int node : b.nodes) candidate[node] = 1;
  const bool all = a.nodes.size() == b.nodes.size() &&
                   std::all_of(a.nodes.begin(), a.nodes.end(),
                               [&](int node) { return candidate[g.node[node]]; });
  if (all) return "";
  return fmt::format("the nodes that may touch \"{}\"", a.name);
}

// Each indenter is the image of one other, and none of two: of itself where it can be.
std::string match_contacts(const MeshImage& g, const Isometry& op, const Scene& scene,
                           const Scene& other, std::vector<int>& image) {
  const std::vector<RigidContact>&all = scene.contacts, &others = other.contacts;
  const int n = static_cast<int>(all.size());
  if (others.size() != all.size()) return "the number of indenters";
  image.assign(all.size(), -1);
  std::vector<char> matched(all.size(), 0);
  for (int i = 0; i < n; ++i) {
    const std::string own = difference(all[i], others[i], g, op);
    if (own.empty() && !matched[i]) image[i] = i;
    for (int j = 0; j < n && image[i] < 0; ++j)
      if (j != i && !matched[j] && difference(all[i], others[j], g, op).empty()) image[i] = j;
    if (image[i] < 0) {
      if (own.empty()) {
        return fmt::format("the number of indenters like \"{}\"", all[i].name);
      }
      return own;
    }
    matched[image[i]] = 1;
  }
  return "";
}

}  // namespace

SceneImage image_of(const MeshImage& g, const Mesh& mesh, const Scene& scene, const Scene& image) {
  const Isometry op{g.turn, g.centre};
  SceneImage found;
  found.broken = broken_fibres(g, op, mesh, scene, image);
  if (found.broken.empty()) found.broken = broken_supports(g, scene, image);
  if (found.broken.empty()) found.broken = broken_loads(g, mesh, scene, image);
  if (found.broken.empty()) found.broken = broken_surfaces(g, scene, image);
  if (found.broken.empty()) found.broken = match_contacts(g, op, scene, image, found.contact);
  return found;
}

}  // namespace langer
