#include "scene/model/scene_parameters.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/text.hpp"
#include "mechanics/material/parameters.hpp"
#include "mechanics/mesh/facets.hpp"

namespace langer {

namespace {

// A key as a part of a column's name: "fibres[0].c1" becomes "fibres_0_c1".
std::string name_of(const std::string& key) {
  std::string name;
  for (char c : key)
    if (c != ']') {
      if (c == '.' || c == '[') {
        name += '_';
      } else {
        name += c;
      }
    }
  return name;
}

// the part behind a beginning; nothing where it begins otherwise
std::optional<std::string> behind(const std::string& text, const std::string& beginning) {
  if (!text.starts_with(beginning)) return std::nullopt;
  return text.substr(beginning.size());
}

// bodies that take the material at the top, and its angles
std::vector<int> followers(const SolveConfig& config, const Mesh& mesh, bool angles) {
  std::vector<int> bodies;
  for (std::size_t b = 0; b < mesh.bodies.size(); ++b) {
    const auto own = config.materials.find(mesh.bodies[b]);
    if (own == config.materials.end() ||
        (!own->second.material && (!angles || own->second.fibre_angles.empty())))
      bodies.push_back(static_cast<int>(b));
  }
  return bodies;
}

// Whether the directions of a body come from a field and not from its angles.
bool has_field(const SolveConfig& config, const std::string& body) {
  const auto own = config.materials.find(body);
  if (own == config.materials.end()) return config.fibre_field.has_value();
  const bool follows = !own->second.material && own->second.fibre_angles.empty();
  return own->second.fibre_field.has_value() || (follows && config.fibre_field.has_value());
}

// The number of the family whose angle the key means; -1 where it means no angle.
int family_of(const std::string& key) {
  const auto rest = behind(key, "fibres[");
  if (rest && rest->ends_with("].alpha") && rest->find('.') == rest->rfind('.')) {
    return std::stoi(*rest);
  }
  return -1;
}

double& number(Material& material, const std::string& key) {
  for (const MaterialParameter& p : parameters(material))
    if (p.key == key) return *p.value;
  throw Failure(Exit::bug, Error{{}, key, "no number of the law", "one", ""});
}

// Directions of one family in some bodies, turned in the plane of the skin.
Directions turned(const Directions& directions, const Mesh& mesh, const std::vector<int>& bodies,
                  int family, double by_deg) {
  Directions out(directions.from_field());
  for (int e = 0; e < mesh.n_cells(); ++e) {
    std::vector<Vec3> a{directions.of(e).begin(), directions.of(e).end()};
    int body = 0;
    if (mesh.body.empty()) {
      body = 0;
    } else {
      body = mesh.body[static_cast<std::size_t>(e)];
    }
    if (std::find(bodies.begin(), bodies.end(), body) != bodies.end() &&
        static_cast<std::size_t>(family) < a.size()) {
      Vec3 axis = Vec3::UnitY();
      if (!mesh.frames.empty()) axis = mesh.frames[static_cast<std::size_t>(e)].col(1);
      Vec3& one = a[static_cast<std::size_t>(family)];
      one =
          Eigen::AngleAxisd(-by_deg * std::numbers::pi / 180, axis) * one;  // from e_x towards e_z
    }
    out.append(std::move(a));
  }
  return out;
}

// The scale of a material: step sizes of numbers that are 0 follow it [MPa].
double largest_modulus(Material material) {
  double largest = 0;
  for (const MaterialParameter& p : parameters(material))
    if (p.modulus()) largest = std::max(largest, std::abs(*p.value));
  return largest > 0 ? largest : 1;
}

}  // namespace

std::string derivative_name(const std::string& quantity, const SceneParameter& parameter) {
  return "d_" + quantity + "_d_" + parameter.name;
}

SceneParameters::SceneParameters(const SolveConfig& config, const Mesh& mesh, const Scene& scene,
                                 const Where& where) {
  for (std::size_t i = 0; i < config.sensitivity.size(); ++i) {
    const std::string at = fmt::format("sensitivity[{}]", i), &key = config.sensitivity[i];
    take(key, config, mesh, scene, {where(at), at, fmt::format("found \"{}\"", key), "", ""},
         where);
  }
  add_other_loads(config, mesh, scene, where);
}

namespace {

// A set of facets that a thickness would turn or stretch: what acts on them would change.
bool moves_facets(const LayerThickness& layer, const Mesh& mesh, const SurfaceLoad& load) {
  for (const Facet& facet : load.facets)
    for (const auto& quad : facet_quads(mesh, facet)) {
      const double first = layer.rate(mesh.X[static_cast<std::size_t>(quad[0])][1]);
      for (const int node : quad)
        if (std::abs(layer.rate(mesh.X[static_cast<std::size_t>(node)][1]) - first) > 1e-9)
          return true;
    }
  return false;
}

[[noreturn]] void refuse_number(Error error, const std::string& found, std::string expected,
                                std::string hint) {
  error.found += ", " + found;
  error.expected = std::move(expected);
  error.hint = std::move(hint);
  throw Failure(Exit::config, std::move(error));
}

}  // namespace

// A number of the shape of an indenter, by two shapes on either side of the present one.
bool SceneParameters::take_shape(const std::string& key, const SolveConfig& config,
                                 const Error& refused) {
  const auto name = contact_of_shape(key);
  if (!name || !config.contacts.count(*name) || !config.contacts.at(*name).rigid) return false;
  const auto value = config_number(config, key);
  if (!value) return false;
  if (is_from_file(*config.contacts.at(*name).rigid))
    refuse_number(refused, "and the shape comes from a file", "a shape of numbers", "");
  const double h = 1e-6 * std::max(std::abs(*value), 0.1);
  const auto shape_with = [&](double by) {
    return *with_config_number(config, key, *value + by).contacts.at(*name).rigid;
  };
  Of of;
  of.contact = *name;
  of.shape = ShapeChange{shape_with(-h), shape_with(h), 2 * h};
  list_.push_back({key, name_of(key), unit_of_config_number(key), *value});
  of_.push_back(std::move(of));
  return true;
}

namespace {

// A number of the law of bonds, and the law in which it alone is 1.
struct BondNumber {
  const char* key;
  double value;
  Adhesion alone;
};

std::vector<BondNumber> numbers_of(const Adhesion& law) {
  return {{"work", law.work, {1, 0, 0, 0}},
          {"stiffness", law.stiffness, {0, 1, 0, 0}},
          {"tangential", law.tangential, {0, 0, 1, 0}},
          {"viscosity", law.viscosity, {0, 0, 0, 1}}};
}

std::string bond_key(const std::string& contact, const BondNumber& number) {
  return "contacts." + contact + ".adhesion." + number.key;
}

}  // namespace

// A number of the law by which an indenter adheres.
bool SceneParameters::take_bonds(const std::string& key, const RigidContact& contact,
                                 const Error& refused) {
  for (const BondNumber& number : numbers_of(*contact.adhesion)) {
    if (key != bond_key(contact.name, number)) continue;
    if (!(number.value > 0))
      refuse_number(refused, "which is 0", std::string(number.key) + " above 0", "");
    Of of;
    of.contact = contact.name;
    of.bonds = number.alone;
    list_.push_back({key, name_of(key), unit_of_config_number(key), number.value});
    of_.push_back(std::move(of));
    return true;
  }
  return false;
}

// The thickness of a layer. What acts on its sides, and directions that are given by places, would
// change with it: then nothing but whole runs tell the derivative.
bool SceneParameters::take_thickness(const std::string& key, const SolveConfig& config,
                                     const Mesh& mesh, const Scene& scene, const Error& refused) {
  if (!names_thickness(key, config)) return false;
  std::string why;
  const auto layer = layer_thickness(key, config, mesh, why);
  if (!layer)
    refuse_number(refused, "and " + why, "the thickness of a flat layer with indenters on one side",
                  "");
  if (!scene.surfaces.empty())
    refuse_number(refused, "and surfaces touch, which would move", "another number", "");
  for (const Material& material : scene.materials)
    if (is_viscous(material))
      refuse_number(refused, "and a material is viscous", "an elastic material, or another number",
                    "langer-fit finds it by differences of runs");
  if (scene.directions.from_field())
    refuse_number(refused, "and a fibre_field gives directions by places", "another number",
                  "langer-fit finds it by differences of runs");
  for (const SurfaceLoad& load : scene.loads)
    if (moves_facets(*layer, mesh, load))
      refuse_number(refused, "and a load acts on its sides", "another number",
                    "langer-fit finds it by differences of runs");
  Of of;
  of.layer = layer;
  list_.push_back({key, name_of(key), unit::mm, layer->value()});
  of_.push_back(std::move(of));
  return true;
}

namespace {

// Numbers of loads that a state can be differentiated by.
bool names_load(const std::string& key) {
  if (key.starts_with("contacts.") && key.ends_with(".control.force")) return true;
  if (!key.starts_with("loads[")) return false;
  for (const char* kind : {"].displacement.", "].force.", "].traction.", "].rotation.angle"})
    if (key.find(kind) != std::string::npos) return true;
  return key.ends_with("].pressure");
}

// The numbers of loads that a config has.
std::vector<std::string> load_numbers(const SolveConfig& config) {
  std::vector<std::string> keys;
  const auto add = [&](const std::string& key) {
    if (config_number(config, key)) keys.push_back(key);
  };
  for (std::size_t i = 0; i < config.loads.size(); ++i) {
    const std::string load = fmt::format("loads[{}].", i);
    for (const char* kind : {"displacement", "force", "traction"})
      for (const char* axis : {"x", "y", "z"}) add(load + kind + "." + axis);
    add(load + "rotation.angle");
    add(load + "pressure");
  }
  for (const auto& [name, contact] : config.contacts) add("contacts." + name + ".control.force");
  return keys;
}

// The scene of the config with the materials of another, which may come from a file.
Scene with_materials_of(const Scene& scene, const SolveConfig& config, const Mesh& mesh,
                        const SceneParameters::Where& where) {
  Scene other = make_scene(config, mesh, scene.materials.front(), where);
  other.materials = scene.materials;
  other.directions = scene.directions;
  return other;
}

}  // namespace

// A number of a load that is in proportion to t. Forces and movements are linear in it but those of
// a rotation, so the step of their difference may be long.
bool SceneParameters::take_load(const std::string& key, const SolveConfig& config, const Mesh& mesh,
                                const Scene& scene, const Where& where) {
  if (!names_load(key)) return false;
  const auto value = config_number(config, key);
  if (!value) return false;
  const double share = key.ends_with("rotation.angle") ? 1e-4 : 1e-3;
  const double h = *value != 0 ? share * std::abs(*value) : share;
  const auto scene_with = [&](double by) {
    return std::make_shared<const Scene>(
        with_materials_of(scene, with_config_number(config, key, *value + by), mesh, where));
  };
  Of of;
  of.load = LoadChange{scene_with(-h), scene_with(h), 2 * h};
  list_.push_back({key, name_of(key), unit_of_config_number(key), *value});
  of_.push_back(std::move(of));
  return true;
}

// All numbers of loads changed at once, each by another share.
void SceneParameters::add_other_loads(const SolveConfig& config, const Mesh& mesh,
                                      const Scene& scene, const Where& where) {
  std::optional<SolveConfig> other;
  for (std::size_t i = 0; i < list_.size(); ++i) {
    if (!of_[i].load) continue;
    if (!other) other = config;
    const double share = 0.01 * static_cast<double>(i + 1);
    const double value = list_[i].value;
    const double changed = value != 0 ? (1 + share) * value : share;
    other = with_config_number(*other, list_[i].key, changed);
  }
  if (!other) return;
  other_loads_ = std::make_shared<const Scene>(with_materials_of(scene, *other, mesh, where));
}

// Finds the number that a key means: friction of a contact, a number of the material at the top, or
// of one body. Everything that cannot be differentiated is refused with the reason.
void SceneParameters::take(const std::string& key, const SolveConfig& config, const Mesh& mesh,
                           const Scene& scene, const Error& refused, const Where& where) {
  const auto refuse = [&](std::string found, std::string expected, std::string hint = "") {
    Error error = refused;
    if (!found.empty()) error.found += ", " + found;
    error.expected = std::move(expected);
    error.hint = std::move(hint);
    throw Failure(Exit::config, std::move(error));
  };
  for (const SceneParameter& other : list_)
    if (other.key == key) refuse("a second time", "each number once");
  std::vector<std::string> known;
  for (const RigidContact& contact : scene.contacts) {
    if (contact.adhesion) {
      for (const BondNumber& number : numbers_of(*contact.adhesion))
        if (number.value > 0) known.push_back(bond_key(contact.name, number));
      if (take_bonds(key, contact, refused)) return;
    }
    const std::string friction = "contacts." + contact.name + ".friction";
    if (contact.mu > 0) known.push_back(friction);
    if (key != friction) continue;
    if (!(contact.mu > 0))
      refuse("which is 0", "friction above 0",
             "without friction nothing says how a contact slips that sticks");
    list_.push_back({key, name_of(key), unit::none, contact.mu});
    of_.push_back({contact.name, "", {}});
    return;
  }
  for (const SurfaceContact& surface : scene.surfaces) {
    const std::string friction = "contacts." + surface.name + ".friction";
    if (surface.mu > 0) known.push_back(friction);
    if (key != friction) continue;
    if (!(surface.mu > 0)) refuse("which is 0", "friction above 0");
    list_.push_back({key, name_of(key), unit::none, surface.mu});
    of_.push_back({surface.name, "", {}});
    return;
  }
  if (take_shape(key, config, refused)) return;
  if (take_thickness(key, config, mesh, scene, refused)) return;
  if (take_load(key, config, mesh, scene, where)) return;
  const auto look_in = [&](const std::string& beginning, const std::vector<int>& bodies,
                           const std::vector<int>& of_angles) {
    if (bodies.empty()) return false;
    Material material = scene.materials[static_cast<std::size_t>(bodies[0])];
    for (const MaterialParameter& p : parameters(material)) {
      known.push_back(beginning + p.key);
      if (key != beginning + p.key && key != beginning + "material." + p.key) continue;
      if (p.key.starts_with("spectrum.tau"))
        refuse("which decides how many branches there are", "spectrum.c, or branches of viscous");
      const int family = family_of(p.key);
      const std::vector<int>& concerned = family >= 0 ? of_angles : bodies;
      for (int b : concerned)
        if (family == 0 && has_field(config, mesh.bodies[static_cast<std::size_t>(b)]))
          refuse("and a fibre_field gives the directions of that family", "another number");
      list_.push_back({key, name_of(key), p.unit, *p.value});
      of_.push_back({"", p.key, concerned, family, p.modulus(), largest_modulus(material)});
      return true;
    }
    return false;
  };
  if (look_in("", followers(config, mesh, false), followers(config, mesh, true))) return;
  for (std::size_t b = 0; b < mesh.bodies.size(); ++b) {
    const auto own = config.materials.find(mesh.bodies[b]);
    if (own == config.materials.end() ||
        (!own->second.material && own->second.fibre_angles.empty()))
      continue;
    const std::vector<int> body{static_cast<int>(b)};
    const std::string beginning = "materials." + mesh.bodies[b] + ".";
    std::string own_key;
    if (key.starts_with(beginning)) own_key = key.substr(beginning.size());
    const bool angle =
        family_of(own_key.starts_with("material.") ? own_key.substr(9) : own_key) >= 0;
    if (!own->second.material && !angle && !own_key.empty())
      refuse("and this body takes the material at the top", own_key,
             "that number is one of all bodies that take it");
    if (look_in(beginning, body, body)) return;
  }
  for (const std::string& number : load_numbers(config)) known.push_back(number);
  if (names_load(key))
    refuse("which is no number of this scene",
           fmt::format("a number of the scene: {}", fmt::join(known, ", ")),
           "a load with a history has no single number");
  const std::string near = nearest(key, known);
  refuse("", fmt::format("a number of the scene: {}", fmt::join(known, ", ")), did_you_mean(near));
}

bool SceneParameters::moves_mesh() const {
  return std::any_of(of_.begin(), of_.end(), [](const Of& of) { return of.layer.has_value(); });
}

bool SceneParameters::turns_fibres() const {
  return std::any_of(of_.begin(), of_.end(), [](const Of& of) { return of.family >= 0; });
}

// Step of finite differences. Energies are linear in moduli, so any step is exact for them.
double SceneParameters::step(std::size_t i) const {
  if (of_[i].family >= 0) return 1e-3;  // degrees
  if (of_[i].linear) return of_[i].modulus;
  // exponents and shares that are almost 0 still act as much as one of 0.1 does
  const double size = std::max(std::abs(list_[i].value), list_[i].unit == unit::none ? 0.1 : 0);
  if (size > 0) return 1e-5 * size;
  return 1e-5;
}

SceneParameters::Laws SceneParameters::varied(const Scene& scene, const Mesh& mesh, std::size_t i,
                                              double by) const {
  Laws laws{scene.materials, scene.directions};
  const Of& of = of_[i];
  if (of.family >= 0) laws.directions = turned(scene.directions, mesh, of.bodies, of.family, by);
  for (int b : of.bodies) number(laws.materials[static_cast<std::size_t>(b)], of.key) += by;
  return laws;
}

// All numbers changed at once, each by another share. A symmetry that this scene has does not
// depend on the values, so derivatives have it as well.
Scene SceneParameters::varied_unlike(const Scene& scene, const Mesh& mesh) const {
  Scene other = other_loads_ ? *other_loads_ : scene;
  for (std::size_t i = 0; i < list_.size(); ++i) {
    const double share = 0.01 * static_cast<double>(i + 1);
    if (of_[i].load) continue;
    if (!of_laws(i)) {
      for (RigidContact& contact : other.contacts)
        if (contact.name == of_[i].contact) {
          if (of_[i].shape) {
            contact.shape = of_[i].shape->more;
          } else if (of_[i].bonds) {
            contact.adhesion->work *= 1 + share;
          } else {
            contact.mu *= 1 + share;
          }
        }
      for (SurfaceContact& surface : other.surfaces)
        if (surface.name == of_[i].contact) surface.mu *= 1 + share;
      continue;
    }
    const double value = list_[i].value;
    double change = share * value;
    if (value == 0) change = share;
    if (of_[i].family >= 0) change = 137 * share;  // [degrees]
    Laws laws = varied(other, mesh, i, change);
    other.materials = std::move(laws.materials);
    other.directions = std::move(laws.directions);
  }
  return other;
}

}  // namespace langer
