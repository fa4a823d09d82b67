#include "scene/model/config_number.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/model/solve_config_io.hpp"

namespace langer {

namespace {

// The part of a tree at a path; nullptr where there is none.
const Tree* part_at(const Tree& tree, const std::string& path) {
  const std::vector<PathStep> steps = split_path(path);
  if (steps.empty()) return nullptr;
  const Tree* at = &tree;
  for (const PathStep& step : steps) {
    if (step.key.empty()) {
      const auto index = static_cast<std::size_t>(step.index);
      if (step.index < 0 || index >= at->list.size()) return nullptr;
      at = &at->list[index];
    } else {
      at = at->find(step.key);
    }
    if (!at) return nullptr;
  }
  return at;
}

// The number that a scalar is; nothing for words.
std::optional<double> number_of(const Tree& tree) {
  if (tree.kind != Tree::Kind::scalar || tree.quoted) return std::nullopt;
  try {
    std::size_t read = 0;
    const double value = std::stod(tree.scalar, &read);
    if (read == tree.scalar.size()) return value;
  } catch (const std::exception&) {
    return std::nullopt;
  }
  return std::nullopt;
}

// The direction in which an indenter sets out; zero where it stands still.
Vec3 first_way(const ContactConfig& contact) {
  if (contact.control) return vec(contact.control->along).normalized();
  if (contact.free) {
    const Vec3 along = vec(contact.free->along).normalized();
    return contact.free->speed() < 0 ? Vec3(-along) : along;
  }
  for (const WaypointConfig& point : contact.motion)
    if (vec(point.to).norm() > 0) return vec(point.to).normalized();
  return Vec3::Zero();
}

// A sphere of another radius still touches at the point that it had in front.
void keep_front(ContactConfig& contact, double former_radius) {
  auto* sphere = std::get_if<Sphere>(&*contact.rigid);
  if (!sphere) return;
  const Vec3 way = first_way(contact);
  for (std::size_t k = 0; k < 3; ++k)
    sphere->centre[k] -= (sphere->radius - former_radius) * way[static_cast<Eigen::Index>(k)];
}

// The number of a layer in mesh.bodies[k].thickness; -1 for other paths.
int layer_of(const std::string& path) {
  const std::vector<PathStep> steps = split_path(path);
  const bool layer = steps.size() == 4 && steps[0].key == "mesh" && steps[1].key == "bodies" &&
                     steps[2].key.empty() && steps[3].key == "thickness";
  if (layer) return steps[2].index;
  return -1;
}

// Whether a path is the size along y of what is meshed.
bool is_height(const std::string& path) {
  const std::vector<PathStep> steps = split_path(path);
  return steps.size() == 5 && steps[0].key == "mesh" && steps[1].key == "geometry" &&
         steps[3].key == "size" && steps[4].index == 1;
}

// Height of the node of a mesh that is closest to an indenter.
double closest_height(const Indenter& shape, const Mesh& mesh) {
  double least = std::numeric_limits<double>::infinity();
  double height = 0;
  for (const Vec3& x : mesh.X) {
    const double gap = shape_at(shape, x).gap;
    if (gap < least) {
      least = gap;
      height = x[1];
    }
  }
  return height;
}

}  // namespace

std::optional<double> config_number(const SolveConfig& config, const std::string& path) {
  const Tree tree = to_tree(config, as_held);
  const Tree* part = part_at(tree, path);
  if (!part) return std::nullopt;
  return number_of(*part);
}

SolveConfig with_config_number(const SolveConfig& config, const std::string& path, double value) {
  Tree tree = to_tree(config, as_held);
  set_value(tree, path, plain_tree(number_text(value)));
  SolveConfig other = read_config<SolveConfig>(std::move(tree)).config;
  other.touching = config.touching;  // which is no key (scene/model/scene_bodies.hpp)
  // a mesh that was chosen has numbers which no file can say
  if (!path.starts_with("mesh.") && !path.starts_with("bodies")) {
    other.mesh = config.mesh;
    other.bodies = config.bodies;
  }
  if (!path.starts_with("material.")) other.material = config.material;
  const auto name = contact_of_shape(path);
  if (name && path.ends_with(".sphere.radius")) {
    const double former = std::get<Sphere>(*config.contacts.at(*name).rigid).radius;
    keep_front(other.contacts.at(*name), former);
  }
  return other;
}

std::string unit_of_config_number(const std::string& path) {
  const auto has = [&](const char* word) {
    return path.find(word) != std::string::npos;
  };
  if (path.ends_with("friction") || has(".divisions")) return unit::none;
  if (path.ends_with("fibre_angle") || has("fibre_angles[") || path.ends_with(".offset"))
    return unit::deg;
  if (has(".rigid.") || has(".motion[") || has("thickness") || has(".size[") ||
      has(".displacement") || has(".radius"))
    return unit::mm;
  if (has(".rotation.angle")) return unit::deg;
  if (path.ends_with(".adhesion.work")) return "N/mm";
  if (path.ends_with(".adhesion.viscosity")) return "N s/mm";
  if (has(".adhesion.")) return "MPa/mm";
  if (has(".pressure") || has(".traction")) return unit::MPa;
  if (has(".force")) return unit::N;
  return unit::none;
}

std::optional<std::string> contact_of_shape(const std::string& path) {
  const std::string begin = "contacts.";
  const std::size_t end = path.find(".rigid.");
  if (!path.starts_with(begin) || end == std::string::npos) return std::nullopt;
  return path.substr(begin.size(), end - begin.size());
}

double LayerThickness::rate(double y) const {
  const double share = std::clamp((y - bottom) / (top - bottom), 0., 1.);
  if (top_stays) return share - 1;
  return share;
}

Mesh LayerThickness::with(Mesh mesh, double thickness) const {
  const double by = thickness - value();
  for (Vec3& x : mesh.X) x[1] += by * rate(x[1]);
  return mesh;
}

bool names_thickness(const std::string& path, const SolveConfig& config) {
  if (!config.mesh) return false;
  return is_height(path) || layer_of(path) >= 0;
}

std::optional<LayerThickness> layer_thickness(const std::string& path, const SolveConfig& config,
                                              const Mesh& mesh, std::string& why) {
  if (!names_thickness(path, config)) {
    why = "no thickness of a layer";
    return std::nullopt;
  }
  const MeshConfig& meshed = *config.mesh;
  const auto [low, high] = std::minmax_element(
      mesh.X.begin(), mesh.X.end(), [](const Vec3& a, const Vec3& b) { return a[1] < b[1]; });
  LayerThickness layer{(*low)[1], (*high)[1]};
  const double tolerance = 1e-9 * layer.value();
  if (meshed.bend) {
    why = "the body is bent";
    return std::nullopt;
  }
  const int number = layer_of(path);
  if (number < 0 && !meshed.bodies.empty()) {
    why = "the body has layers: mesh.bodies[k].thickness";
    return std::nullopt;
  }
  if (number >= 0) {
    if (static_cast<std::size_t>(number) >= meshed.bodies.size()) {
      why = "the mesh has " + std::to_string(meshed.bodies.size()) + " layers";
      return std::nullopt;
    }
    const std::string& name = meshed.bodies[static_cast<std::size_t>(number)].name;
    const auto found = std::find(mesh.bodies.begin(), mesh.bodies.end(), name);
    const auto body = static_cast<int>(found - mesh.bodies.begin());
    double bottom = layer.top;
    double top = layer.bottom;
    for (int e = 0; e < mesh.n_cells(); ++e) {
      if (mesh.body.empty() || mesh.body[static_cast<std::size_t>(e)] != body) continue;
      for (const int node : mesh.cell(e)) {
        const double y = mesh.X[static_cast<std::size_t>(node)][1];
        bottom = std::min(bottom, y);
        top = std::max(top, y);
      }
    }
    layer.bottom = bottom;
    layer.top = top;
    if (!(top > bottom)) {
      why = "the mesh has no cells of that layer";
      return std::nullopt;
    }
  }

  // The side that an indenter touches stays: its gap is that of the config whatever the thickness.
  bool above = false;
  bool below = false;
  for (const auto& [name, contact] : config.contacts) {
    if (!contact.rigid || is_from_file(*contact.rigid)) continue;
    const double y = closest_height(*contact.rigid, mesh);
    above = above || y > layer.bottom + tolerance;
    below = below || y < layer.top - tolerance;
    const bool beside = y > layer.bottom + tolerance && y < layer.top - tolerance;
    if (beside || (above && below)) {
      why = "indenters touch more than one side of the layer";
      return std::nullopt;
    }
  }
  layer.top_stays = !below;
  return layer;
}

}  // namespace langer
