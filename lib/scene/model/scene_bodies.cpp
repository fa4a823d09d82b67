#include "scene/model/scene_bodies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/text.hpp"
#include "mechanics/assembly/separate_bodies.hpp"
#include "mechanics/mesh/section.hpp"
#include "scene/model/make_mesh.hpp"
#include "scene/model/scene_adhesion.hpp"

namespace langer {

namespace {

using Find = std::function<Place(const std::string&)>;

// The value of a key, which is added where it is missing; its place is that of the map.
Tree& entry(Tree& tree, const std::string& key, Tree::Kind kind) {
  tree.kind = Tree::Kind::map;
  for (Tree::Entry& e : tree.map)
    if (e.key == key) return e.value;
  Tree value;
  value.kind = kind;
  value.place = tree.place;
  tree.map.push_back({key, std::move(value)});
  return tree.map.back().value;
}

// items of the body's list, whose sets get its name, at the end of that of the scene
template <class Item>
void append_list(const std::string& body, const std::vector<Item>& items, const Tree* from,
                 const char* key, std::vector<Item>& to, Tree& tree) {
  if (items.empty()) return;
  for (Item item : items) {
    item.on = body + "_" + item.on;
    to.push_back(std::move(item));
  }
  const Tree* list = from ? from->find(key) : nullptr;
  if (!list) return;
  const std::vector<Tree> added = list->list;
  Tree& target = entry(tree, key, Tree::Kind::list);
  target.kind = Tree::Kind::list;
  target.list.insert(target.list.end(), added.begin(), added.end());
}

}  // namespace

// Whether two surfaces of the mesh touch each other, rather than an indenter.
bool has_deformable_contact(const SolveConfig& config) {
  return std::any_of(config.contacts.begin(), config.contacts.end(),
                     [](const auto& contact) { return contact.second.deformable(); });
}

void expand_bodies(SolveConfig& config, Tree& tree) {
  if (config.bodies.empty() && !has_deformable_contact(config)) return;
  for (auto contact = config.contacts.begin(); contact != config.contacts.end();) {
    if (contact->second.deformable()) {
      config.touching.insert(*contact);
      contact = config.contacts.erase(contact);
    } else {
      ++contact;
    }
  }
  const Tree given = tree;
  const Tree* bodies = given.find("bodies");
  for (const auto& [name, body] : config.bodies) {
    const Tree* from = bodies ? bodies->find(name) : nullptr;
    if (body.material || !body.fibre_angles.empty() || body.fibre_field) {
      config.materials[name] = {body.material, body.fibre_angles, body.fibre_field};
      if (from) {
        const Tree copy = *from;
        entry(entry(tree, "materials", Tree::Kind::map), name, Tree::Kind::map) = copy;
      }
    }
    append_list(name, body.supports, from, "supports", config.supports, tree);
    append_list(name, body.loads, from, "loads", config.loads, tree);
  }
  const bool by_default = !config.estimate || config.estimate == EstimateBy::automatic;
  if (by_default && (config.accuracy || config.fidelity)) config.estimate = EstimateBy::refinement;
  if (config.estimate != EstimateBy::refinement) config.estimate = EstimateBy::none;
  config.stability = StabilityCheck::off;
  config.homogeneous = Homogeneous::off;
}

// Nodes and elements of one body follow those of the body before it, and so do their numbers in
// sets and connectivity. A body without layers becomes one layer with its own name.
Mesh joined(const std::vector<std::pair<std::string, Mesh>>& bodies) {
  Mesh all;
  all.type = bodies.front().second.type;
  for (const auto& [name, mesh] : bodies) {
    const int first_node = all.n_nodes();
    const int first_cell = all.n_cells();
    const int first_body = static_cast<int>(all.bodies.size());
    all.X.insert(all.X.end(), mesh.X.begin(), mesh.X.end());
    for (int node : mesh.connectivity) all.connectivity.push_back(first_node + node);
    for (int body : mesh.body) all.body.push_back(first_body + body);
    all.frames.insert(all.frames.end(), mesh.frames.begin(), mesh.frames.end());
    for (const std::string& layer : mesh.bodies) {
      const bool alone = mesh.bodies.size() == 1;
      all.bodies.push_back(alone ? name : name + "_" + layer);
    }
    for (const auto& [set, nodes] : mesh.node_sets)
      for (int node : nodes) all.node_sets[name + "_" + set].push_back(first_node + node);
    for (const auto& [set, facets] : mesh.facet_sets)
      for (const Facet& facet : facets)
        all.facet_sets[name + "_" + set].push_back({first_cell + facet.cell, facet.local});
  }
  return all;
}

Mesh mesh_of_bodies(const SolveConfig& config, const Find& where, std::vector<std::string>* notes) {
  std::vector<std::pair<std::string, Mesh>> meshes;
  for (const auto& [name, body] : config.bodies) {
    const std::string key = "bodies." + name + ".mesh";
    try {
      MadeMesh made = make_mesh(body.mesh, [](const std::string&) { return Place{}; });
      if (notes) {
        for (const std::string& note : made.of_file) notes->push_back(name + ": " + note);
      }
      meshes.emplace_back(name, std::move(made.mesh));
    } catch (const Failure& failure) {
      std::vector<Error> errors = failure.errors();
      for (Error& e : errors) {
        if (!e.where.file.empty()) continue;
        e.key = key + "." + e.key;
        e.where = where(e.key);
      }
      throw Failure(failure.code(), errors);
    }
    if (meshes.back().second.type != CellType::hex8)
      throw Failure(Exit::config,
                    Error{where(key), key, "found other cells than hex8 in one of several bodies",
                          "hex8", "contact of two deformable surfaces knows hex8 only"});
  }
  Mesh mesh = joined(meshes);
  std::vector<std::string> names = mesh.bodies;
  std::sort(names.begin(), names.end());
  if (const auto twice = std::adjacent_find(names.begin(), names.end()); twice != names.end())
    throw Failure(Exit::config, Error{where("bodies"), "bodies",
                                      fmt::format("two bodies are called \"{}\"", *twice),
                                      "names of their own", "a layer of a body is <body>_<layer>"});
  return mesh;
}

namespace {

std::vector<Facet> facets_of(const Mesh& mesh, const std::string& set, const std::string& key,
                             const Find& where, std::vector<Error>& errors) {
  const auto found = mesh.node_sets.find(set);
  if (found == mesh.node_sets.end()) {
    std::vector<std::string> known;
    std::string list;
    for (const auto& [name, facets] : mesh.facet_sets) {
      known.push_back(name);
      append(list, ", ", name);
    }
    errors.push_back({where(key), key, fmt::format("found \"{}\"", set),
                      "a set of the mesh that covers facets: " + list,
                      did_you_mean(nearest(set, known))});
    return {};
  }
  std::vector<Facet> facets = surface_of(mesh, set);
  if (facets.empty())
    errors.push_back({where(key), key, fmt::format("the set \"{}\" covers no facet", set),
                      "a set that covers facets of the surface", ""});
  return facets;
}

// Nodes of the non-mortar side that are inside the other body by more than 1 % of a facet.
void refuse_overlap(const SurfaceContact& surface, const Mesh& mesh, const std::string& key,
                    const Find& where, std::vector<Error>& errors) {
  const MortarNode* deepest = nullptr;
  const auto nodes = mortar_nodes(surface, positions(mesh.X));
  for (const MortarNode& node : nodes)
    if (node.gap() < -0.01 * std::sqrt(node.area) && (!deepest || node.gap() < deepest->gap()))
      deepest = &node;
  if (!deepest) return;
  const auto node =
      static_cast<std::size_t>(surface.nodes[static_cast<std::size_t>(deepest->candidate)]);
  const Vec3& X = mesh.X[node];
  errors.push_back(
      {where(key), key,
       fmt::format("the surfaces overlap at the start by {:.3g} mm at ({:g}, {:g}, {:g})",
                   -deepest->gap(), X[0], X[1], X[2]),
       "bodies apart or touching, to 1 % of a facet", "move a mesh by the origin of its geometry"});
}

std::string name_of_body(const Mesh& mesh, int node) {
  for (int e = 0; e < mesh.n_cells(); ++e) {
    const auto cell = mesh.cell(e);
    if (std::find(cell.begin(), cell.end(), node) != cell.end())
      return mesh.bodies[static_cast<std::size_t>(mesh.body[static_cast<std::size_t>(e)])];
  }
  return "";
}

// A body that can move as a whole, and what is against it has no friction. One translation across
// the surface is left to the contact; all else is not held by anything.
void refuse_loose(const Scene& scene, const Mesh& mesh, const std::vector<Prescribed>& prescribed,
                  const Find& where, std::vector<Error>& errors) {
  Dofs held;
  held.prescribed = prescribed;
  for (const std::vector<int>& body : separate_bodies(mesh)) {
    const std::string free = free_motions(mesh, held, body);
    if (free.empty()) continue;
    const SurfaceContact* smooth = nullptr;
    bool rough = false;
    Vec3 across = Vec3::Zero();
    const VecX x = positions(mesh.X);
    for (const SurfaceContact& surface : scene.surfaces) {
      if (surface.touches_itself()) continue;  // holds nothing
      const bool touches =
          std::any_of(surface.all_nodes.begin(), surface.all_nodes.end(),
                      [&](int node) { return std::binary_search(body.begin(), body.end(), node); });
      if (!touches) continue;
      const bool sticks = surface.adhesion && surface.adhesion->tangential > 0;
      rough = rough || surface.mu > 0 || sticks;
      smooth = &surface;
      for (const Vec3& n : mortar_normals(surface, x)) across += n;
    }
    for (const RigidContact& contact : scene.contacts)
      if (!contact.nodes.empty() &&
          std::binary_search(body.begin(), body.end(), contact.nodes.front()))
        rough = true;  // examined with the indenters
    if (rough) continue;
    const std::string name = name_of_body(mesh, body.front());
    if (!smooth) {
      errors.push_back({where("supports"), "supports",
                        fmt::format("nothing holds the body \"{}\": {}", name, free),
                        "supports, imposed displacements or contact for each body", ""});
      continue;
    }
    // free to move along the normal of the contact, and nothing else
    Dofs with_contact = held;
    int axis = 0;
    across.cwiseAbs().maxCoeff(&axis);
    for (int node : smooth->all_nodes)
      if (std::binary_search(body.begin(), body.end(), node))
        with_contact.prescribed.push_back({3 * node + axis});
    const std::string left = free_motions(mesh, with_contact, body);
    if (left.empty()) continue;
    const std::string key = "contacts." + smooth->name;
    errors.push_back({where(key), key,
                      fmt::format("holds the body \"{}\" alone, without friction: {}", name, left),
                      "supports that hold the body along the surface, or friction above 0", ""});
  }
}

}  // namespace

std::vector<char> held_by_supports(const SolveConfig& config, const Mesh& mesh) {
  std::vector<char> held(3 * mesh.X.size(), 0);
  for (const SupportConfig& support : config.supports) {
    const auto set = mesh.node_sets.find(support.on);
    if (set == mesh.node_sets.end()) continue;  // an error of its own
    for (int node : set->second)
      for (Axis axis : support.hold)
        held[3 * static_cast<std::size_t>(node) + static_cast<std::size_t>(axis)] = 1;
  }
  return held;
}

void add_surfaces(Scene& scene, const SolveConfig& config, const Mesh& mesh,
                  const std::vector<Prescribed>& prescribed, const Find& where,
                  std::vector<Error>& errors) {
  const std::size_t before = errors.size();
  const std::vector<char> held = held_by_supports(config, mesh);
  for (const auto& [name, contact] : config.touching) {
    const std::string key = "contacts." + name;
    if (mesh.type != CellType::hex8 || mesh.section || !mesh.hanging.empty()) {
      errors.push_back({where(key + ".against"), key + ".against",
                        "found with other cells than hex8, a section or cuts", "hex8", ""});
      continue;
    }
    const std::vector<Facet> own = facets_of(mesh, contact.on, key + ".on", where, errors);
    const std::vector<Facet> other =
        facets_of(mesh, *contact.against, key + ".against", where, errors);
    if (own.empty() || other.empty()) continue;
    if (contact.on == *contact.against) {
      SurfaceContact surface = self_contact(name, contact.friction, mesh, own);
      find_mirrors(surface, mesh, held);
      refuse_overlap(surface, mesh, key, where, errors);
      take_adhesion(surface, contact, mesh, own, key, where, errors);
      scene.surfaces.push_back(std::move(surface));
      continue;
    }
    SurfaceContact surface = surface_contact(name, contact.friction, mesh, own, other);
    find_mirrors(surface, mesh, held);
    std::vector<int> others;
    for (const QuadNodes& facet : surface.other)
      others.insert(others.end(), facet.begin(), facet.end());
    std::sort(others.begin(), others.end());
    const bool shared = std::any_of(surface.nodes.begin(), surface.nodes.end(), [&](int node) {
      return std::binary_search(others.begin(), others.end(), node);
    });
    if (shared) {
      errors.push_back({where(key + ".against"), key + ".against",
                        "shares nodes with the set of `on`: the two are glued there",
                        "a surface of another body, or the set of `on` itself",
                        "`bodies` gives each body a mesh of its own; a surface that folds names "
                        "the same set twice"});
      continue;
    }
    refuse_overlap(surface, mesh, key, where, errors);
    take_adhesion(surface, contact, mesh, own, key, where, errors);
    scene.surfaces.push_back(std::move(surface));
  }
  if (config.in_motion()) return;  // inertia resists every motion
  if (errors.size() == before && (!config.bodies.empty() || !scene.surfaces.empty()))
    refuse_loose(scene, mesh, prescribed, where, errors);
}

}  // namespace langer
