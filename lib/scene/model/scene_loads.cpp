#include "scene/model/scene_loads.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <set>

#include "core/base/text.hpp"
#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/section.hpp"

namespace langer {

namespace {

using Find = std::function<Place(const std::string&)>;

std::string sets_with_facets(const Mesh& mesh) {
  std::string list;
  for (const auto& [name, facets] : mesh.facet_sets)
    if (!surface_of(mesh, name).empty()) append(list, ", ", name);
  return list;
}

// whether supports or imposed displacements hold every node of the set in this direction
bool is_held(const SolveConfig& config, const Mesh& mesh, const std::string& set, int axis) {
  std::set<int> left;
  for (int n : mesh.node_sets.at(set)) left.insert(n);
  const auto take = [&](const std::string& other) {
    if (const auto found = mesh.node_sets.find(other); found != mesh.node_sets.end())
      for (int n : found->second) left.erase(n);
  };
  for (const SupportConfig& support : config.supports)
    if (std::find(support.hold.begin(), support.hold.end(), static_cast<Axis>(axis)) !=
        support.hold.end())
      take(support.on);
  for (const LoadConfig& load : config.loads)
    if (load.tells(axis)) take(load.on);
  return left.empty();
}

// Whether some facet of the set can move along its normal: only that changes the volume above it.
bool can_enclose(const SolveConfig& config, const Mesh& mesh, const std::string& set,
                 const std::vector<Facet>& facets) {
  const int axes = mesh.section ? 2 : 3;
  for (int axis = 0; axis < axes; ++axis) {
    if (is_held(config, mesh, set, axis)) continue;
    for (const Facet& facet : facets) {
      for (const std::array<int, 4>& quad : facet_quads(mesh, facet)) {
        const Vec3 normal =
            (mesh.X[quad[2]] - mesh.X[quad[0]]).cross(mesh.X[quad[3]] - mesh.X[quad[1]]);
        if (std::abs(normal[axis]) > 1e-9 * normal.norm()) return true;
      }
    }
  }
  return false;
}

bool has_direction(const Section& section, int axis) {
  return axis == 1 || (axis == 0 && section.of == SectionOf::plane_strain);
}

}  // namespace

std::vector<SurfaceLoad> surface_loads(const SolveConfig& config, const Mesh& mesh,
                                       const Find& where, std::vector<Error>& errors) {
  std::vector<SurfaceLoad> loads;
  for (std::size_t i = 0; i < config.loads.size(); ++i) {
    const LoadConfig& load = config.loads[i];
    if (!load.on_surface()) continue;
    const std::string key = fmt::format("loads[{}]", i);
    const auto refuse = [&](const std::string& at, std::string found, std::string expected,
                            std::string hint = "") {
      errors.push_back({where(at), at, std::move(found), std::move(expected), std::move(hint)});
    };
    if (!mesh.node_sets.count(load.on)) continue;  // said where its nodes are asked for
    const std::vector<Facet> facets = surface_of(mesh, load.on);
    double area = nodal_areas(mesh, facets).sum();
    if (mesh.section) area *= cell_share(*mesh.section);
    if (!(area > 0)) {
      refuse(key + ".on", fmt::format("found \"{}\", a set without facets", load.on),
             "a set that covers facets: " + sets_with_facets(mesh),
             "a force on a point is a force on the facets around it");
      continue;
    }
    if (load.pressure) {
      const History p = history_of(*load.pressure, config.path.seconds);
      loads.push_back({facets, Vec3::Zero(), p.value, p.factor});
      continue;
    }
    if (load.volume) {
      if (!can_enclose(config, mesh, load.on, facets)) {
        refuse(key + ".on",
               fmt::format("found \"{}\", which is held along its normal everywhere", load.on),
               "a face that can move", "the volume above a face that is held cannot change");
        continue;
      }
      const History v = history_of(*load.volume, config.path.seconds);
      loads.push_back({facets, Vec3::Zero(), 0, v.factor, v.value, load.on});
      continue;
    }
    for (int axis = 0; axis < 3; ++axis) {
      const auto& along = load.dead(axis);
      if (!along || !along->moves()) continue;
      const std::string at = key + (load.force ? ".force." : ".traction.") + "xyz"[axis];
      if (mesh.section && !has_direction(*mesh.section, axis))
        refuse(at, "found on a section, which has no force in this direction",
               "a pressure, or a force along y", "a block is needed for others");
      else if (is_held(config, mesh, load.on, axis))
        refuse(at,
               fmt::format("every node of \"{}\" is held or moved along {} already", load.on,
                           "xyz"[axis]),
               "a direction in which the set may move",
               "what supports take does not reach the body");
      const History f = history_of(*along, config.path.seconds);
      loads.push_back({facets, f.value / (load.force ? area : 1) * Vec3::Unit(axis), 0, f.factor});
    }
  }
  return loads;
}

}  // namespace langer
