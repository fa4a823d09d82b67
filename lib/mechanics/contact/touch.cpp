#include "mechanics/contact/touch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace langer {

// Sphere tracing: the gap is a distance, so a step of that length cannot cross the surface.
// Repeated steps converge to the first touch, or pass the body by.
std::optional<double> travel_to_touch(const RigidContact& contact, double t, double from,
                                      const std::function<Vec3(int node)>& position) {
  const auto gap = [&](double travel) {
    const Vec3 c = indenter_displacement(contact, t, travel);
    double least = std::numeric_limits<double>::infinity();
    for (int node : contact.nodes)
      least = std::min(least, shape_at(contact.shape, position(node) - c).gap);
    return least;
  };
  if (contact.nodes.empty()) return std::nullopt;
  const double size = 1 + std::abs(gap(from));
  double travel = from;
  for (int i = 0; i < 10000 && std::abs(travel - from) < 1e6 * size; ++i) {
    const double g = gap(travel);
    if (std::abs(g) <= 1e-12 * size) return travel;
    travel += g;
  }
  return std::nullopt;
}

double touch_travel_change(const RigidContact& contact, double t, double travel,
                           const std::function<Vec3(int node)>& position,
                           const std::function<Vec3(int node)>& moved) {
  const Vec3 c = indenter_displacement(contact, t, travel);
  double least = std::numeric_limits<double>::infinity();
  double change = 0;
  for (int node : contact.nodes) {
    const ShapePoint shape = shape_at(contact.shape, position(node) - c);
    if (shape.gap < least) {
      least = shape.gap;
      change = moved(node).dot(shape.normal) / contact.control->along.dot(shape.normal);
    }
  }
  return change;
}

Vec3 slip_origin(const RigidContact& contact, const ExpectedMove& a, double tolerance) {
  const double gap = shape_at(contact.shape, a.X + a.u0 - a.c0).gap;
  double touches = 0;  // at this share of the increment
  Vec3 start = a.u0;
  if (gap > tolerance) {
    const double closed = gap - shape_at(contact.shape, a.X + a.u - a.c).gap;
    touches = 1;
    if (closed > gap) touches = gap / closed;
    start = a.u0 + touches * (a.u - a.u0 - (a.c - a.c0));
  }
  if (contact.rotation) start += carried(contact, (1 - touches) * a.angle, a.X + start, a.c0);
  return start;
}

Vec3 slip_origin_change(const RigidContact& contact, const ExpectedMove& a, const ExpectedMove& d,
                        double tolerance) {
  const ShapePoint from = shape_at(contact.shape, a.X + a.u0 - a.c0);
  double touches = 0, d_touches = 0;
  Vec3 start = a.u0;
  Vec3 d_start = d.u0;
  if (from.gap > tolerance) {
    const ShapePoint to = shape_at(contact.shape, a.X + a.u - a.c);
    const Vec3 way = a.u - a.u0 - (a.c - a.c0);
    const Vec3 d_way = d.u - d.u0 - (d.c - d.c0);
    const double closed = from.gap - to.gap;
    const double d_gap = from.normal.dot(d.u0 - d.c0) + d.gap0;
    const double d_closed = d_gap - to.normal.dot(d.u - d.c) - d.gap;
    touches = 1;
    if (closed > from.gap) {
      touches = from.gap / closed;
      d_touches = (d_gap - touches * d_closed) / closed;
    }
    start += touches * way;
    d_start += d_touches * way + touches * d_way;
  }
  if (!contact.rotation) return d_start;
  // (R - 1) q and the derivative of R q with respect to the angle, along x R q
  const Vec3& along = contact.rotation->axis.along;
  const Vec3 q = a.X + start - a.c0 - contact.rotation->axis.point;
  const double angle = (1 - touches) * a.angle;
  const Vec3 turned = q + turned_by(along, angle, q);
  return d_start + turned_by(along, angle, d_start - d.c0) -
         d_touches * a.angle * cross(along, turned);
}

ExpectedMove IncrementMove::of(const RigidContact& contact, int node) const {
  double angle = 0;
  if (contact.rotation) angle = contact.rotation->angle.at(t) - contact.rotation->angle.at(t0);
  return {X[static_cast<std::size_t>(node)],
          u0.segment<3>(3 * node),
          expected.segment<3>(3 * node),
          indenter_displacement(contact, t0, travel0),
          indenter_displacement(contact, t, travel),
          angle};
}

std::vector<Vec3> slip_origin_change_with_travel(const RigidContact& contact,
                                                 const IncrementMove& move, double tolerance) {
  const Vec3 none = Vec3::Zero();
  std::vector<Vec3> out;
  for (int node : contact.nodes)
    out.push_back(slip_origin_change(contact, move.of(contact, node),
                                     {none, none, none, none, contact.control->along}, tolerance));
  return out;
}

}  // namespace langer
