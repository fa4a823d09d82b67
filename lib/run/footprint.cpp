#include "run/footprint.hpp"

#include <algorithm>
#include <cmath>

namespace langer {

namespace {

constexpr int samples = 100;  // along x and z, of the whole top and then of what was found there
constexpr int places = 8;     // between two waypoints

struct Top {
  std::array<double, 2> low, high;
  double y;
};

void add(std::optional<Footprint>& all, const Indenter& shape, const Vec3& u, double x, double y, double z) {
  const double gap = shape_at(shape, Vec3(x, y, z) - u).gap;
  if (!(gap < 0)) return;
  if (!all) all = Footprint{{x, z}, {x, z}, 0};
  all->low = {std::min(all->low[0], x), std::min(all->low[1], z)};
  all->high = {std::max(all->high[0], x), std::max(all->high[1], z)};
  all->deepest = std::max(all->deepest, -gap);
}

// of one indenter at one place
std::optional<Footprint> print_of(const Indenter& shape, const Vec3& u, const Top& top) {
  std::optional<Footprint> found;
  if (const auto inside = point_inside(shape)) {  // one that is smaller than the distance of the samples
    const double x = (*inside + u)[0], z = (*inside + u)[2];
    if (x >= top.low[0] && x <= top.high[0] && z >= top.low[1] && z <= top.high[1]) add(found, shape, u, x, top.y, z);
  }
  Top part = top;
  for (int look = 0; look < 3; ++look) {
    const double dx = (part.high[0] - part.low[0]) / samples, dz = (part.high[1] - part.low[1]) / samples;
    for (int i = 0; i <= samples; ++i)
      for (int j = 0; j <= samples; ++j) add(found, shape, u, part.low[0] + i * dx, top.y, part.low[1] + j * dz);
    if (!found) return found;
    part.low = {std::max(top.low[0], found->low[0] - dx), std::max(top.low[1], found->low[1] - dz)};
    part.high = {std::min(top.high[0], found->high[0] + dx), std::min(top.high[1], found->high[1] + dz)};
  }
  return found;
}

}  // namespace

std::optional<Footprint> footprint(const SolveConfig& config, const Box& body) {
  const Top top{{body.origin[0], body.origin[2]},
                {body.origin[0] + body.size[0], body.origin[2] + body.size[2]},
                body.origin[1] + body.size[1]};
  std::optional<Footprint> found;
  for (const auto& [name, contact] : config.contacts) {
    if (std::holds_alternative<Facets>(contact.rigid)) continue;
    Vec3 before = Vec3::Zero();
    for (const WaypointConfig& waypoint : contact.motion) {
      const Vec3 to = vec(waypoint.to);
      for (int i = 1; i <= places; ++i) {
        const auto print = print_of(contact.rigid, before + (to - before) * (1.0 * i / places), top);
        if (!print) continue;
        if (!found) found = print;
        for (std::size_t k : {0u, 1u})
          found->low[k] = std::min(found->low[k], print->low[k]), found->high[k] = std::max(found->high[k], print->high[k]);
        found->deepest = std::max(found->deepest, print->deepest);
      }
      before = to;
    }
  }
  return found;
}

}  // namespace langer
