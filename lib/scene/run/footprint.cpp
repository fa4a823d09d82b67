#include "scene/run/footprint.hpp"

#include <algorithm>
#include <cmath>

namespace langer {

namespace {

constexpr int samples = 100;  // along x and z, of the whole top
constexpr int places = 8;     // between two waypoints

struct Top {
  std::array<double, 2> low, high;
  double y;
};

// Returns the gap there.
double add(std::optional<Footprint>& all, const Indenter& shape, const Vec3& u, double x, double y,
           double z) {
  const double gap = shape_at(shape, Vec3(x, y, z) - u).gap;
  if (!(gap < 0)) return gap;
  if (!all) all = Footprint{{x, z}, {x, z}, 0};
  all->low = {std::min(all->low[0], x), std::min(all->low[1], z)};
  all->high = {std::max(all->high[0], x), std::max(all->high[1], z)};
  all->deepest = std::max(all->deepest, -gap);
  return gap;
}

// A gap is a distance: how many of the next samples are too near to be inside.
int outside_next(double gap, double spacing) {
  if (!(gap > 0 && spacing > 0)) return 0;
  return static_cast<int>(std::min(gap / spacing, 1e6));
}

// whether the line at this x (k = 0) or z comes inside, near what is known of the print
bool enters(const Indenter& shape, const Vec3& u, const Footprint& near, int k, double value,
            const Top& top) {
  const int other = 1 - k;
  const double slack = (top.high[other] - top.low[other]) / samples;
  const double low = near.low[other] - slack;
  const double high = near.high[other] + slack;
  for (int i = 0; i <= 4 * samples; ++i) {
    const double across =
        std::clamp(low + (high - low) * i / (4 * samples), top.low[other], top.high[other]);
    const Vec3 x = k == 0 ? Vec3(value, top.y, across) : Vec3(across, top.y, value);
    const double gap = shape_at(shape, x - u).gap;
    if (gap < 0) return true;
    i += outside_next(gap, (high - low) / (4 * samples));
  }
  return false;
}

// of one indenter at one place
std::optional<Footprint> print_of(const Indenter& shape, const Vec3& u, const Top& top) {
  std::optional<Footprint> found;
  if (const auto inside =
          point_inside(shape)) {  // one that is smaller than the distance of the samples
    const double x = (*inside + u)[0];
    const double z = (*inside + u)[2];
    if (x >= top.low[0] && x <= top.high[0] && z >= top.low[1] && z <= top.high[1])
      add(found, shape, u, x, top.y, z);
  }
  const auto at = [&](int k, int i) {
    return top.low[k] + (top.high[k] - top.low[k]) * i / samples;
  };
  const double spacing = (top.high[1] - top.low[1]) / samples;
  for (int i = 0; i <= samples; ++i)
    for (int j = 0; j <= samples; ++j)
      j += outside_next(add(found, shape, u, at(0, i), top.y, at(1, j)), spacing);
  if (!found) return found;
  for (int k : {0, 1, 0, 1})
    for (double* end : {&found->low[k], &found->high[k]}) {
      const double step = (top.high[k] - top.low[k]) / samples;
      const double side = end == &found->low[k] ? -1 : 1;
      double in = *end;
      double out = std::clamp(*end + side * step, top.low[k], top.high[k]);
      if (enters(shape, u, *found, k, out, top)) in = out;
      while (std::abs(out - in) > 1e-6 * step) {
        const double between = 0.5 * (in + out);
        (enters(shape, u, *found, k, between, top) ? in : out) = between;
      }
      *end = in;
    }
  return found;
}

void add(std::optional<Footprint>& all, const Footprint& print) {
  if (!all) all = print;
  for (std::size_t k : {0u, 1u}) {
    all->low[k] = std::min(all->low[k], print.low[k]);
    all->high[k] = std::max(all->high[k], print.high[k]);
  }
  all->deepest = std::max(all->deepest, print.deepest);
}

}  // namespace

std::vector<Footprint> footprints(const SolveConfig& config, const Box& body) {
  const Top top{{body.origin[0], body.origin[2]},
                {body.origin[0] + body.size[0], body.origin[2] + body.size[2]},
                body.origin[1] + body.size[1]};
  std::vector<Footprint> out;
  for (const auto& [name, contact] : config.contacts) {
    if (is_from_file(contact.rigid.value())) continue;
    std::optional<Footprint> found;
    Vec3 before = Vec3::Zero();
    for (const WaypointConfig& waypoint : contact.motion) {
      const Vec3 to = vec(waypoint.to);
      for (int i = 1; i <= places; ++i)
        if (const auto print =
                print_of(contact.rigid.value(), before + (to - before) * (1.0 * i / places), top))
          add(found, *print);
      before = to;
    }
    if (found) out.push_back(*found);
  }
  return out;
}

std::optional<Footprint> footprint(const SolveConfig& config, const Box& body) {
  std::optional<Footprint> all;
  for (const Footprint& print : footprints(config, body)) add(all, print);
  return all;
}

}  // namespace langer
