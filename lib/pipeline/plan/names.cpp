#include "pipeline/plan/names.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/config/member.hpp"
#include "mechanics/mesh/mesh.hpp"
#include "scene/model/solve_config.hpp"
#include "scene/run/post_config.hpp"

namespace langer {

namespace {

using What = AskedName::What;

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void ask_angles(std::vector<AskedName>& asked, const std::vector<double>& angles,
                const std::string& key, const FindPlace& where,
                const std::optional<Material>& own) {
  if (angles.empty()) return;
  AskedName a{What::angles, "", key, where(key), angles.size()};
  if (own) a.families = own->fibres.size();
  asked.push_back(a);
}

void ask_columns(std::vector<AskedName>& asked, const std::vector<ColumnChoice>& columns,
                 const std::string& list, const FindPlace& where) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const ColumnChoice& c = columns[i];
    if (!c.quantity || c.quotient || c.history) continue;
    const QuantityLine& line = line_of(*c.quantity);
    const auto key = [&](const char* part) {
      return fmt::format("{}[{}].{}", list, i, part);
    };
    if (line.needs.contact)
      asked.push_back({What::contact, line.word, key("quantity"), where(key("quantity"))});
    if (c.at && needs_place(line))
      asked.push_back({What::place, *c.at, key("at"), where(key("at"))});
    if (line.needs.fibres && (is<OfPoint>(line) || is<OfBody>(line))) {
      const bool of_one = is<OfPoint>(line);
      const std::string at = key(of_one ? "family" : "quantity");
      asked.push_back({What::family, line.word, at, where(at),
                       of_one ? static_cast<std::size_t>(c.family) : 1});
    }
  }
}

std::string near_words(const std::string& name, const std::vector<std::string>& known) {
  const std::string near = nearest(name, known);
  if (near.empty()) return "";
  return fmt::format("did you mean \"{}\"?", near);
}

std::optional<Error> lost_in_mesh(const AskedName& a, const MeshNames& mesh) {
  const std::string found = fmt::format("found \"{}\"", a.name);
  if (a.what == What::body && !has(mesh.bodies, a.name))
    return Error{a.place, a.key, found, "a body of the mesh: " + list_words(mesh.bodies),
                 near_words(a.name, mesh.bodies)};
  if (a.what == What::set && !has(mesh.sets, a.name))
    return Error{a.place, a.key, found, "a node set of the mesh: " + list_words(mesh.sets),
                 near_words(a.name, mesh.sets)};
  if (a.what == What::place && !has(mesh.sets, a.name))
    return Error{a.place, a.key, fmt::format("the mesh has no nodes called \"{}\"", a.name),
                 "one of " + list_words(mesh.sets), near_words(a.name, mesh.sets)};
  if (a.what == What::point && !has(mesh.sets, a.name))
    return Error{a.place, a.key, found,
                 mesh.points.empty()
                     ? "an observation point, and the mesh has none"
                     : "an observation point of the mesh: " + list_words(mesh.points),
                 near_words(a.name, mesh.points)};
  return std::nullopt;
}

std::optional<Error> lost_in_law(const AskedName& a, const SceneNames& names) {
  const std::optional<std::size_t> families = a.families ? a.families : names.families;
  if (!families) return std::nullopt;
  if (a.what == What::angles && a.number != *families)
    return Error{a.place, a.key, fmt::format("found {} angles", a.number),
                 fmt::format("{}, one for each fibre family of the material", *families), ""};
  const std::size_t most = std::max(*families, names.more_families);
  if (a.what == What::family && a.number > most)
    return Error{a.place, a.key,
                 most == 0 ? fmt::format("{} of a material without fibres", a.name)
                           : fmt::format("family {} of a material with {}", a.number, most),
                 most == 0 ? "another quantity" : "a family that is there", ""};
  return std::nullopt;
}

}  // namespace

MeshNames names_of(const Mesh& mesh) {
  MeshNames names;
  for (const auto& [name, nodes] : mesh.node_sets) {
    if (!nodes.empty()) names.sets.push_back(name);
    if (nodes.size() == 1) names.points.push_back(name);
  }
  names.bodies = mesh.bodies;
  return names;
}

SceneNames names_in(const MeshConfig& config) {
  SceneNames names;
  if (std::holds_alternative<FromFile>(config.geometry)) return names;
  MeshNames mesh;
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

SceneNames names_in(const Material& law) {
  SceneNames names;
  names.families = law.fibres.size();
  return names;
}

SceneNames names_in(const SolveConfig& config, const FindPlace& where) {
  SceneNames names;
  if (config.mesh) names.mesh = names_in(*config.mesh).mesh;
  if (config.material) names.families = config.material->fibres.size();
  names.contacts = !config.contacts.empty();
  const auto ask = [&](What what, const std::string& name, const std::string& key) {
    names.asked.push_back({what, name, key, where(key)});
  };
  for (std::size_t i = 0; i < config.supports.size(); ++i)
    ask(What::set, config.supports[i].on, fmt::format("supports[{}].on", i));
  for (std::size_t i = 0; i < config.loads.size(); ++i)
    ask(What::set, config.loads[i].on, fmt::format("loads[{}].on", i));
  for (const auto& [name, contact] : config.contacts)
    if (!contact.on.empty()) ask(What::set, contact.on, fmt::format("contacts.{}.on", name));
  for (const auto& [name, body] : config.materials) {
    ask(What::body, name, "materials." + name);
    ask_angles(names.asked, body.fibre_angles, fmt::format("materials.{}.fibre_angles", name),
               where, body.material);
    if (body.material)
      names.more_families = std::max(names.more_families, body.material->fibres.size());
  }
  // beside `materials` it depends on the bodies whether any takes them
  if (config.materials.empty())
    ask_angles(names.asked, config.fibre_angles, "fibre_angles", where, std::nullopt);
  return names;
}

SceneNames names_in(const PostConfig& config, const FindPlace& where) {
  SceneNames names;
  ask_columns(names.asked, config.columns, "columns", where);
  ask_columns(names.asked, config.further, "further", where);
  const auto ask_points = [&](const RenderChoice& choice, const std::string& key) {
    for (std::size_t i = 0; i < choice.points.size(); ++i) {
      const std::string at = fmt::format("{}.points[{}]", key, i);
      names.asked.push_back({What::point, choice.points[i], at, where(at)});
    }
  };
  if (config.render) ask_points(*config.render, "render");
  for (const auto& [name, choice] : config.renders) ask_points(choice, "renders." + name);
  return names;
}

std::vector<Error> lost_names(const SceneNames& names) {
  std::vector<Error> errors;
  for (const AskedName& a : names.asked) {
    std::optional<Error> error;
    if (a.what == What::angles || a.what == What::family)
      error = lost_in_law(a, names);
    else if (a.what == What::contact && names.contacts == false)
      error = Error{a.place, a.key, fmt::format("{} of a solution without contact", a.name),
                    "a quantity that needs no indenter", ""};
    else if (names.mesh && a.what != What::contact)
      error = lost_in_mesh(a, *names.mesh);
    if (error) errors.push_back(std::move(*error));
  }
  return errors;
}

}  // namespace langer
