#include "scene/model/scene_section.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>

namespace langer {

namespace {

bool has_symmetry_of(SectionOf of, const Indenter& shape) {
  if (of == SectionOf::axisymmetric) return is_revolved_about({}, shape);
  return unchanged_by(shape, {Vec3(1, 1, -1).asDiagonal()});
}

// a direction that the section's own symmetry leaves alone
bool kept(const Fibre& fibre, const Vec3& a, SectionOf of) {
  if (!has_direction(fibre)) return true;
  if (of == SectionOf::axisymmetric) return std::abs(a[1]) >= 1 - same_place;
  return std::abs(a[2]) <= same_place || std::abs(a[2]) >= 1 - same_place;
}

using Refuse = std::function<void(const std::string& key, const std::string& found,
                                  const std::string& expected, const std::string& hint)>;

// fibres that lead out of the plane of a section, once for each body
void refuse_fibres(const SolveConfig& config, const Mesh& mesh, const Scene& scene, bool is_round,
                   const Refuse& refuse) {
  if (scene.materials.size() != mesh.bodies.size()) return;  // said elsewhere
  std::vector<char> said(mesh.bodies.size(), 0);
  for (int e = 0; e < mesh.n_cells(); ++e) {
    const auto body = static_cast<std::size_t>(mesh.body.empty() ? 0 : mesh.body[e]);
    const std::vector<Fibre>& families = scene.materials[body].fibres;
    if (families.empty() || said[body]) continue;
    const auto a = scene.directions.of(e);
    for (std::size_t k = 0; k < families.size() && !said[body]; ++k) {
      if (kept(families[k], a[k], mesh.section->of)) continue;
      said[body] = 1;
      const bool own = config.materials.count(mesh.bodies[body]) > 0;
      refuse(own ? "materials." + mesh.bodies[body] : "material",
             fmt::format("fibres in the body \"{}\"", mesh.bodies[body]),
             is_round
                 ? "no fibres (c1: 0), or fibres along y or without direction (kappa: 1/3)"
                 : "no fibres, or fibres in the plane, along z or without direction (kappa: 1/3)",
             "fibres in one direction make a body that needs all three dimensions: a block");
    }
  }
}

}  // namespace

std::vector<Error> section_errors(const SolveConfig& config, const Mesh& mesh, const Scene& scene,
                                  const std::function<Place(const std::string&)>& where) {
  std::vector<Error> errors;
  const bool is_round = mesh.section->of == SectionOf::axisymmetric;
  const std::string of = is_round ? "an axisymmetric section" : "a plane-strain section";
  std::string along_axis = "a direction in the plane of x and y";
  std::string movement = "a movement in the plane of x and y";
  std::string shape = "a shape with its centre in z = 0, or a plane normal to that";
  if (is_round) {
    along_axis = "a direction along y";
    movement = "a movement along y";
    shape = "a shape of revolution about the y axis (x = z = 0), or a plane normal to it";
  }
  const auto refuse = [&](const std::string& key, const std::string& found,
                          const std::string& expected, const std::string& hint) {
    errors.push_back({where(key), key, found + ", on " + of, expected, hint});
  };
  if (config.symmetry != SymmetryChoice::none && config.symmetry != SymmetryChoice::automatic)
    refuse("symmetry",
           fmt::format("found {}", names(config.symmetry)[static_cast<int>(config.symmetry)]),
           "none or auto", "the section stands for the whole body already");
  for (std::size_t i = 0; i < config.loads.size(); ++i)
    if (const auto z = config.loads[i].imposed(2); z && z->moves()) {
      const std::string key = fmt::format("loads[{}].displacement.z", i);
      refuse(key, fmt::format("found {:g}", history_of(*z, config.path.seconds).value),
             "none, or 0", "nothing moves out of the plane of a section");
    }
  for (std::size_t i = 0; i < config.loads.size(); ++i)
    if (config.loads[i].rotation)
      refuse(fmt::format("loads[{}].rotation", i), "found a set that is turned", "none",
             "nothing moves out of the plane of a section: a block is needed");
  for (const auto& [name, contact] : config.contacts) {
    const std::string key = "contacts." + name;
    if (contact.rotation)
      refuse(key + ".rotation", "found an indenter that turns", "none",
             "nothing moves out of the plane of a section: a block is needed");
    if (!has_symmetry_of(mesh.section->of, contact.rigid))
      refuse(key + ".rigid", "found a shape or place without its symmetry", shape,
             "a block is needed for others");
    if (const auto& free = contact.free;
        free && (free->along[2] != 0 || (is_round && free->along[0] != 0)))
      refuse(
          key + ".free.along",
          fmt::format("found [{:g}, {:g}, {:g}]", free->along[0], free->along[1], free->along[2]),
          along_axis, "a block is needed for others");
    if (const auto& control = contact.control;
        control && (control->along[2] != 0 || (is_round && control->along[0] != 0)))
      refuse(key + ".control.along",
             fmt::format("found [{:g}, {:g}, {:g}]", control->along[0], control->along[1],
                         control->along[2]),
             along_axis, "a block is needed for others");
    for (std::size_t i = 0; i < contact.motion.size(); ++i) {
      const auto& to = contact.motion[i].to;
      if (to[2] == 0 && (!is_round || to[0] == 0)) continue;
      refuse(fmt::format("{}.motion[{}].to", key, i),
             fmt::format("found [{:g}, {:g}, {:g}]", to[0], to[1], to[2]), movement,
             "a block is needed for others");
    }
  }
  refuse_fibres(config, mesh, scene, is_round, refuse);
  return errors;
}

std::string section_words(const Mesh& mesh) {
  if (mesh.section->of == SectionOf::axisymmetric)
    return "axisymmetric section: forces and energies are those of the whole body";
  return fmt::format(
      "plane-strain section: forces and energies are those of {:g} mm along z; an indenter is a bar along z",
      mesh.section->depth);
}

}  // namespace langer
