#include "scene/run/loaded_area.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mechanics/element/surface.hpp"
#include "scene/model/supports.hpp"

namespace langer {

namespace {

constexpr double enough = 0.05;  // share of the area; smaller differences do not matter

// What a box cuts out of a side [mm^2].
double part_of_side(const Box& block, int axis, const InBox& within) {
  double area = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    if (static_cast<int>(k) == axis) continue;
    const double low = std::max(block.origin[k], within.from[k]);
    const double high = std::min(block.origin[k] + block.size[k], within.to[k]);
    area *= std::max(0.0, high - low);
  }
  return area;
}

// What a cylinder or ring cuts out of a side [mm^2]; 0 where it is not known.
double part_of_side(const Box& block, int axis, const InCylinder& within) {
  if (within.axis[0] - 'x' != axis) return 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (static_cast<int>(k) == axis) continue;
    if (within.through[k] - within.radius < block.origin[k] ||
        within.through[k] + within.radius > block.origin[k] + block.size[k])
      return 0;
  }
  const double inner = within.beyond.value_or(0);
  return std::numbers::pi * (within.radius * within.radius - inner * inner);
}

double described_area(const MeshConfig& mesh, const SetConfig& set) {
  if (!set.of) return 0;
  const int axis = axis_of_side(*set.of);
  if (axis < 0) return 0;
  const Box block = box(mesh.geometry);
  if (const auto* within = std::get_if<InBox>(&set.within))
    return part_of_side(block, axis, *within);
  if (const auto* within = std::get_if<InCylinder>(&set.within))
    return part_of_side(block, axis, *within);
  return 0;
}

bool is_block(const Geometry& geometry) {
  return std::holds_alternative<Block>(geometry) || std::holds_alternative<IndentedBlock>(geometry);
}

}  // namespace

double area_of(const Mesh& mesh, const std::string& set) {
  const auto facets = mesh.facet_sets.find(set);
  if (facets == mesh.facet_sets.end()) return 0;
  return nodal_areas(mesh, facets->second).sum();
}

std::vector<std::string> loads_on_other_areas(const SolveConfig& config, const Mesh& mesh) {
  std::vector<std::string> found;
  if (!config.mesh || !is_block(config.mesh->geometry)) return found;
  for (std::size_t i = 0; i < config.loads.size(); ++i) {
    const LoadConfig& load = config.loads[i];
    if (!load.pressure && !load.traction) continue;
    const auto set = config.mesh->sets.find(load.on);
    if (set == config.mesh->sets.end()) continue;
    const double described = described_area(*config.mesh, set->second);
    const double area = area_of(mesh, load.on);
    if (described == 0 || area == 0 || std::abs(area / described - 1) <= enough) continue;
    found.push_back(fmt::format(
        "loads[{}].on: the load acts on the {:.4g} mm^2 of whole facets in \"{}\", which is {:.4g} mm^2 large; "
        "shorter cells, or grid lines along its edges, bring them together (with a box, accuracy does that)",
        i, area, load.on, described));
  }
  return found;
}

}  // namespace langer
