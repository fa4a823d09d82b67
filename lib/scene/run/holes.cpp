#include "scene/run/holes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numbers>

namespace langer {

namespace {

// along x, the mean of those of a line
double cell_length(const Geometry& geometry) {
  return box(geometry).size[0] / numbers_of_cells(geometry)[0];
}

}  // namespace

// A plate with a hole ends to half a cell there: what the ring of that width is of its area, a
// share of its force. It slips and lifts at the edge, which cells as long as that do not see; what
// is fitted to them was half of their error (docs/loads.md).
double beside_holes(const SolveConfig& config) {
  std::optional<RoundHole> hole;
  for (const auto& [name, contact] : config.contacts)
    if (!hole) hole = hole_of(contact.rigid.value());
  if (!hole || !config.mesh) return 0;
  const double radius = hole->radius;
  const auto size = box(config.mesh->geometry).size;
  double top = 0;
  if (is_section(config.mesh->geometry)) {
    top = std::numbers::pi * size[0] * size[0];
  } else {
    top = size[0] * size[2];
  }
  return std::min(0.5, std::numbers::pi * radius * cell_length(config.mesh->geometry) /
                           std::max(top - std::numbers::pi * radius * radius, 1e-300));
}

// What is sucked through the hole of a plate: of drawn scenes its height was off by up to 0.083 of
// the cells' length in radii of the hole, and three meshes of eight cells over the radius did not
// tell it (docs/loads.md).
double under_holes(const SolveConfig& config) {
  double least = 0;
  if (!config.mesh) return least;
  for (const auto& [name, contact] : config.contacts)
    if (const auto hole = hole_of(contact.rigid.value()))
      least = std::max(least, 0.12 * cell_length(config.mesh->geometry) / hole->radius);
  return std::min(0.5, least);
}

// A region that a pressure sucks into a ring that is held: at its rim stresses are singular, and
// what cells beside it miss of the dome is a share of their length in radii, of drawn scenes up to
// 0.07; on eight cells over the radius three meshes did not tell it (docs/loads.md).
double beside_rims(const SolveConfig& config, bool clamped) {
  if (!config.mesh) return 0;  // several bodies
  double least = 0;
  for (const LoadConfig& load : config.loads) {
    const auto set = config.mesh->sets.find(load.on);
    if (!load.pressure || set == config.mesh->sets.end()) continue;
    if (const auto* round = std::get_if<InCylinder>(&set->second.within)) {
      if (least > 0) {
        least = std::min(least, round->radius);
      } else {
        least = round->radius;
      }
    }
  }
  if (least == 0 || !config.contacts.empty() || !clamped) return 0;
  return std::min(0.5, 0.08 * cell_length(config.mesh->geometry) / least);
}

namespace {

// The shortest width, along x and z, of what a box holds and of what it leaves free, where it ends
// inside the body; infinity where it does not.
double narrowest(const InBox& held, const Box& body) {
  double width = std::numeric_limits<double>::infinity();
  for (const std::size_t axis : {0U, 2U}) {
    const double size = body.size[axis];
    const double low = held.from[axis] - body.origin[axis];
    const double high = held.to[axis] - body.origin[axis];
    const double near = 1e-9 * size;
    if (low > near) width = std::min(width, low);
    if (high < size - near) width = std::min(width, size - high);
    if (low > near || high < size - near)
      width = std::min(width, std::min(high, size) - std::max(low, 0.0));
  }
  return width;
}

}  // namespace

// Errors at the end of what is held are of first order, and those of the rest of the body of
// second. Where their signs differ, three coarse meshes agree by chance: drawn notches of eight
// hex27 missed up to 0.03 of the cells' length in widths of what is held.
double beside_ends_of_supports(const SolveConfig& config) {
  if (!config.mesh || !config.contacts.empty()) return 0;
  std::vector<std::string> given;
  for (const SupportConfig& support : config.supports) given.push_back(support.on);
  for (const LoadConfig& load : config.loads)
    if (load.displacement || load.rotation) given.push_back(load.on);
  double width = std::numeric_limits<double>::infinity();
  for (const std::string& name : given) {
    const auto set = config.mesh->sets.find(name);
    if (set == config.mesh->sets.end()) continue;
    if (const auto* part = std::get_if<InBox>(&set->second.within))
      width = std::min(width, narrowest(*part, box(config.mesh->geometry)));
  }
  return std::min(0.5, 0.03 * cell_length(config.mesh->geometry) / width);
}

// Drawn scenes had 16 % beside 44 +- 15 %: where a point lies on the edge is decided by the few
// cells that bend around it.
std::string over_an_edge(const SolveConfig& config, const std::string& quantity) {
  constexpr std::string_view begins = "displacement_";
  if (!config.mesh || !quantity.starts_with(begins)) return "";
  const auto point = config.mesh->points.find(quantity.substr(begins.size()));
  if (point == config.mesh->points.end()) return "";
  for (const auto& [name, contact] : config.contacts) {
    const auto hole = hole_of(contact.rigid.value());
    if (!hole) continue;
    const Vec3 at = vec(point->second);
    const double rho = about(hole->axis, at).rho;
    if (rho >= hole->radius * (1 - 1e-9) && rho <= hole->radius + 2 * hole->edge &&
        shape_at(contact.rigid.value(), at).gap <= hole->edge)
      return fmt::format(
          "the error of {} is not known: the point lies at the edge of the hole of \"{}\", and what slips over it follows no law of the "
          "cells' length",
          quantity, name);
  }
  return "";
}

}  // namespace langer
