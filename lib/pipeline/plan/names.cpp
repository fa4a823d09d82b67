#include "pipeline/plan/names.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/text.hpp"
#include "core/config/member.hpp"
#include "mechanics/mesh/mesh.hpp"
#include "scene/model/solve_config.hpp"
#include "scene/run/post_config.hpp"

namespace langer {

namespace {

using What = NameReference::What;

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

// Fibre angles refer to the families of a material: of the scene's, or of the body's own.
void add_angles(std::vector<NameReference>& references, const std::vector<double>& angles,
                const std::string& key, const FindPlace& where,
                const std::optional<Material>& own) {
  if (angles.empty()) return;
  NameReference a{What::angles, "", key, where(key), angles.size()};
  if (own) a.families = own->fibres.size();
  references.push_back(a);
}

// What a column of a post config refers to: contact, a node set, a fibre family.
void add_columns(std::vector<NameReference>& references, const std::vector<ColumnChoice>& columns,
                 const std::string& list, const FindPlace& where) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const ColumnChoice& c = columns[i];
    if (!c.quantity || c.quotient || c.history) continue;
    const QuantityLine& line = line_of(*c.quantity);
    const auto key = [&](const char* part) {
      return fmt::format("{}[{}].{}", list, i, part);
    };
    if (line.needs.contact)
      references.push_back({What::contact, line.word, key("quantity"), where(key("quantity"))});
    if (c.at && needs_place(line))
      references.push_back({What::place, *c.at, key("at"), where(key("at"))});
    if (!line.needs.fibres) continue;
    if (is<OfPoint>(line)) {
      references.push_back({What::family, line.word, key("family"), where(key("family")),
                            static_cast<std::size_t>(c.family)});
    } else if (is<OfBody>(line)) {
      references.push_back({What::family, line.word, key("quantity"), where(key("quantity")), 1});
    }
  }
}

std::string hint_for(const std::string& name, const std::vector<std::string>& known) {
  return did_you_mean(nearest(name, known));
}

// The error of a name that the mesh does not have.
std::optional<Error> error_in_mesh(const NameReference& a, const MeshNames& mesh) {
  const std::string found = fmt::format("found \"{}\"", a.name);
  if (a.what == What::body && !has(mesh.bodies, a.name))
    return Error{a.place, a.key, found, "a body of the mesh: " + list_words(mesh.bodies),
                 hint_for(a.name, mesh.bodies)};
  if (a.what == What::set && !has(mesh.sets, a.name))
    return Error{a.place, a.key, found, "a node set of the mesh: " + list_words(mesh.sets),
                 hint_for(a.name, mesh.sets)};
  if (a.what == What::place && !has(mesh.sets, a.name))
    return Error{a.place, a.key, fmt::format("the mesh has no nodes called \"{}\"", a.name),
                 "one of " + list_words(mesh.sets), hint_for(a.name, mesh.sets)};
  if (a.what == What::point && !has(mesh.sets, a.name)) {
    std::string expected = "an observation point, and the mesh has none";
    if (!mesh.points.empty())
      expected = "an observation point of the mesh: " + list_words(mesh.points);
    return Error{a.place, a.key, found, expected, hint_for(a.name, mesh.points)};
  }
  return std::nullopt;
}

// The error of fibre angles or a fibre family that the material does not have.
std::optional<Error> error_in_material(const NameReference& a, const SceneNames& names) {
  std::optional<std::size_t> families = names.families;
  if (a.families) families = a.families;
  if (!families) return std::nullopt;
  if (a.what == What::angles && a.number != *families)
    return Error{a.place, a.key, fmt::format("found {} angles", a.number),
                 fmt::format("{}, one for each fibre family of the material", *families), ""};
  // A quantity of a family exists if any body has that many families.
  const std::size_t most = std::max(*families, names.more_families);
  if (a.what != What::family || a.number <= most) return std::nullopt;
  if (most == 0)
    return Error{a.place, a.key, fmt::format("{} of a material without fibres", a.name),
                 "another quantity", ""};
  return Error{a.place, a.key, fmt::format("family {} of a material with {}", a.number, most),
               fmt::format("a family from 1 to {}", most), ""};
}

}  // namespace

// The names of a mesh that exists. Empty sets do not count: nothing can be supported by them.
MeshNames names_of(const Mesh& mesh) {
  MeshNames names;
  for (const auto& [name, nodes] : mesh.node_sets) {
    if (!nodes.empty()) names.sets.push_back(name);
    if (nodes.size() == 1) names.points.push_back(name);
  }
  names.bodies = mesh.bodies;
  return names;
}

// A section has no sides z_min and z_max. A mesh from a file may have any names.
SceneNames names_in(const MeshConfig& config) {
  SceneNames names;
  if (std::holds_alternative<FromFile>(config.geometry)) return names;
  MeshNames mesh;
  // The sides of a block always exist; other sets and points come from the config.
  for (const std::string& side : side_names())
    if (!is_section(config.geometry) || (side != "z_min" && side != "z_max"))
      mesh.sets.push_back(side);
  for (const auto& [name, set] : config.sets) mesh.sets.push_back(name);
  for (const auto& [name, x] : config.points) {
    mesh.sets.push_back(name);
    mesh.points.push_back(name);
  }
  std::sort(mesh.sets.begin(), mesh.sets.end());
  for (const LayerConfig& layer : config.bodies) mesh.bodies.push_back(layer.name);
  if (mesh.bodies.empty()) mesh.bodies = {config.body};
  names.mesh = std::move(mesh);
  return names;
}

// A material defines the number of its fibre families only.
SceneNames names_in(const Material& material) {
  SceneNames names;
  names.families = material.fibres.size();
  return names;
}

// A solve config refers to sets and bodies of the mesh and to families of the material. It defines
// these names for the post configs that read its solution.
SceneNames names_in(const SolveConfig& config, const FindPlace& where) {
  SceneNames names;
  if (config.mesh) names.mesh = names_in(*config.mesh).mesh;
  if (config.material) names.families = config.material->fibres.size();
  names.contacts = !config.contacts.empty();
  const auto refer = [&](What what, const std::string& name, const std::string& key) {
    names.references.push_back({what, name, key, where(key)});
  };
  for (std::size_t i = 0; i < config.supports.size(); ++i)
    refer(What::set, config.supports[i].on, fmt::format("supports[{}].on", i));
  for (std::size_t i = 0; i < config.loads.size(); ++i)
    refer(What::set, config.loads[i].on, fmt::format("loads[{}].on", i));
  for (const auto& [name, contact] : config.contacts)
    if (!contact.on.empty()) refer(What::set, contact.on, fmt::format("contacts.{}.on", name));
  for (const auto& [name, body] : config.materials) {
    refer(What::body, name, "materials." + name);
    add_angles(names.references, body.fibre_angles, fmt::format("materials.{}.fibre_angles", name),
               where, body.material);
    if (body.material)
      names.more_families = std::max(names.more_families, body.material->fibres.size());
  }
  // With `materials`, whether any body uses these angles depends on the bodies of the mesh.
  if (config.materials.empty())
    add_angles(names.references, config.fibre_angles, "fibre_angles", where, std::nullopt);
  return names;
}

// A post config only refers to names.
SceneNames names_in(const PostConfig& config, const FindPlace& where) {
  SceneNames names;
  add_columns(names.references, config.columns, "columns", where);
  add_columns(names.references, config.further, "further", where);
  const auto add_points = [&](const RenderChoice& choice, const std::string& key) {
    for (std::size_t i = 0; i < choice.points.size(); ++i) {
      const std::string at = fmt::format("{}.points[{}]", key, i);
      names.references.push_back({What::point, choice.points[i], at, where(at)});
    }
  };
  if (config.render) add_points(*config.render, "render");
  for (const auto& [name, choice] : config.renders) add_points(choice, "renders." + name);
  return names;
}

// A reference to a part that is not known from the configs alone is not checked here.
std::vector<Error> unknown_names(const SceneNames& names) {
  std::vector<Error> errors;
  for (const NameReference& a : names.references) {
    std::optional<Error> error;
    if (a.what == What::angles || a.what == What::family)
      error = error_in_material(a, names);
    else if (a.what == What::contact && names.contacts == false)
      error = Error{a.place, a.key, fmt::format("{} of a solution without contact", a.name),
                    "a quantity that needs no indenter", ""};
    else if (names.mesh && a.what != What::contact)
      error = error_in_mesh(a, *names.mesh);
    if (error) errors.push_back(std::move(*error));
  }
  return errors;
}

}  // namespace langer
