#include "mechanics/contact/outline.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

namespace langer {

std::vector<std::array<double, 2>> half_circle(double radius, int parts) {
  std::vector<std::array<double, 2>> profile;
  for (int i = 0; i <= parts; ++i) {
    const double theta = std::numbers::pi * i / parts;
    profile.push_back({-radius * std::cos(theta), i % parts == 0 ? 0 : radius * std::sin(theta)});
  }
  return profile;
}

Outline revolved(const Vec3& origin, const Vec3& axis,
                 const std::vector<std::array<double, 2>>& profile, int sectors, bool closed) {
  int least = 0;
  for (int k = 1; k < 3; ++k)
    if (std::abs(axis[k]) < std::abs(axis[least])) least = k;
  const Vec3 s = (Vec3::Unit(least) - axis[least] * axis).normalized();
  const Vec3 t = axis.cross(s);
  Outline out;
  std::vector<std::vector<int>> rings;
  for (const auto& [along, radius] : profile) {
    const Vec3 centre = origin + along * axis;
    std::vector<int>& ring = rings.emplace_back(static_cast<std::size_t>(sectors));
    for (int j = 0; j < sectors; ++j) {
      const double phi = 2 * std::numbers::pi * j / sectors;
      ring[j] = static_cast<int>(out.points.size());
      if (radius == 0 && j > 0)
        ring[j] = ring[0];
      else
        out.points.push_back(centre + radius * (std::cos(phi) * s + std::sin(phi) * t));
    }
  }
  for (std::size_t i = 0; i + 1 < rings.size(); ++i)
    for (int j = 0; j < sectors; ++j) {
      std::vector<int> face;
      const int next = (j + 1) % sectors;
      for (int p : {rings[i][j], rings[i][next], rings[i + 1][next], rings[i + 1][j]})
        if (face.empty() || (face.back() != p && face.front() != p)) face.push_back(p);
      out.faces.push_back(face);
    }
  if (!closed) return out;
  if (profile.front()[1] > 0) out.faces.emplace_back(rings.front().rbegin(), rings.front().rend());
  if (profile.back()[1] > 0) out.faces.push_back(rings.back());
  return out;
}

namespace {

using Key = std::tuple<double, double, double>;
Key key(const Vec3& x) { return {x[0], x[1], x[2]}; }

// where the line between them meets the plane; the same to the last digit from both ends
Vec3 crossing(const Vec3& a, const Vec3& b, int axis, double at) {
  if (key(b) < key(a)) return crossing(b, a, axis, at);
  if (a[axis] == at) return a;  // faces that meet in a corner on the plane agree there
  if (b[axis] == at) return b;
  Vec3 x = a + (at - a[axis]) / (b[axis] - a[axis]) * (b - a);
  x[axis] = at;
  return x;
}

// the part of a polygon on one side; where it is cut, `from` and `to` are the ends of the new side
std::vector<Vec3> clipped(const std::vector<Vec3>& face, int axis, double at, double side,
                          std::vector<Vec3>& from, std::vector<Vec3>& to) {
  std::vector<Vec3> kept;
  for (std::size_t k = 0; k < face.size(); ++k) {
    const Vec3 &a = face[k], &b = face[(k + 1) % face.size()];
    const bool in = side * (a[axis] - at) > 0, next_in = side * (b[axis] - at) > 0;
    if (in) kept.push_back(a);
    if (in == next_in) continue;
    kept.push_back(crossing(a, b, axis, at));
    (in ? from : to).push_back(kept.back());
  }
  return kept;
}

// Appends points; the numbers they get.
std::vector<int> add_points(Outline& out, const std::vector<Vec3>& places) {
  std::vector<int> numbers;
  for (const Vec3& x : places) {
    numbers.push_back(static_cast<int>(out.points.size()));
    out.points.push_back(x);
  }
  return numbers;
}

void add_line(Outline& out, const std::vector<Vec3>& corners) {
  out.lines.push_back(add_points(out, corners));
}

}  // namespace

void add_face(Outline& out, const std::vector<Vec3>& corners) {
  out.faces.push_back(add_points(out, corners));
}

namespace {

// Follows the sides of a cut from one of them on.
std::vector<Vec3> chain_from(std::map<Key, Vec3>::iterator link, std::map<Key, Vec3>& next,
                             const Vec3& begin) {
  std::vector<Vec3> chain{begin};
  for (; link != next.end(); link = next.find(key(chain.back()))) {
    chain.push_back(link->second);
    next.erase(link);
  }
  return chain;
}

// but for a facet or two that an STL file lacks
bool is_closed(const std::vector<Vec3>& chain) {
  double length = 0;
  for (std::size_t i = 1; i < chain.size(); ++i) length += (chain[i] - chain[i - 1]).norm();
  return (chain.front() - chain.back()).norm() < 0.1 * length;
}

}  // namespace

OpenedOutline cut_open(const Outline& outline, int axis, double at, double side) {
  OpenedOutline out;
  std::map<Key, Vec3>
      next;  // along the border of the cap, which goes against the new sides of the faces
  for (const auto& face : outline.faces) {
    std::vector<Vec3> corners, from, to;
    for (int p : face) corners.push_back(outline.points[p]);
    const std::vector<Vec3> kept = clipped(corners, axis, at, side, from, to);
    if (kept.size() > 2) add_face(out.kept, kept);
    for (std::size_t k = 0; k < std::min(from.size(), to.size()); ++k)
      if (to[k] != from[k])
        next[key(to[k])] =
            from[k];  // else the plane goes through a corner, or the face is a strip without width
  }
  std::map<Key, Vec3> begins;  // of open lines: nothing leads there
  for (const auto& [from, to] : next)
    begins.emplace(from, Vec3(std::get<0>(from), std::get<1>(from), std::get<2>(from)));
  for (const auto& [from, to] : next) begins.erase(key(to));
  for (const auto& [from, begin] : begins) {
    const std::vector<Vec3> chain = chain_from(next.find(from), next, begin);
    if (is_closed(chain))
      add_face(out.cap, chain);
    else
      add_line(out.kept, chain);
  }
  while (!next.empty()) {
    const std::vector<Vec3> chain = chain_from(next.begin(), next, next.begin()->second);
    if (chain.size() > 3) add_face(out.cap, {chain.begin() + 1, chain.end()});
  }
  for (const auto& line : outline.lines) {
    std::vector<int>& copy = out.kept.lines.emplace_back();
    for (int p : line)
      copy.push_back(static_cast<int>(out.kept.points.size())),
          out.kept.points.push_back(outline.points[p]);
  }
  return out;
}

}  // namespace langer
