// The overlap of two facets, and the integrals of their shape functions over it.
//
// The facets of two meshes that touch do not match. To average a gap over them, their common part
// has to be known:
//   1. both facets are projected onto the plane of the first: its normal n0 is that of the product
//      of its diagonals, the projection goes along n0. Where an edge of the first is on a plane of
//      symmetry, it goes along the part of n0 within that plane, so that the edges of both stay on it
//   2. the second polygon is clipped by the edges of the first                (Sutherland-Hodgman)
//   3. what is left is divided into triangles about its middle, with Gauss points in each
//   4. each Gauss point is found in both facets (inverse of the bilinear map)
// The number type T is double, or Jet (mortar/jet.hpp) where derivatives with respect to the
// corners are computed as well.                                                  [PL04], [PGGW10]
#pragma once

#include <array>
#include <cmath>

#include "mechanics/mortar/jet.hpp"

namespace langer {

template <class T>
using Corner = std::array<T, 3>;
template <class T>
using Quad = std::array<Corner<T>, 4>;  // counter-clockwise from outside

template <class T>
struct Overlap {
  std::array<std::array<T, 4>, 4> own{};    // integral of N_i N_j, both of the first facet [mm^2]
  std::array<std::array<T, 4>, 4> other{};  // integral of N_i N_k, the latter of the second [mm^2]
};

namespace overlap_detail {

template <class T>
struct Point {
  T x, y;
};

template <class T>
Corner<T> minus(const Corner<T>& a, const Corner<T>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class T>
T dot(const Corner<T>& a, const Corner<T>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class T>
Corner<T> cross(const Corner<T>& a, const Corner<T>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <class T>
Corner<T> of_length_1(const Corner<T>& a) {
  const T size = root(dot(a, a));
  return {a[0] / size, a[1] / size, a[2] / size};
}

// a convex polygon of at most 8 corners
template <class T>
struct Polygon {
  std::array<Point<T>, 10> corner;
  int n = 0;
  void add(const Point<T>& p) {
    if (n < 10) corner[static_cast<std::size_t>(n++)] = p;
  }
};

// twice the area of a, b, c
template <class T>
T twice_area(const Point<T>& a, const Point<T>& b, const Point<T>& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// What of `subject` is to the left of the line from a to b. Corners within `slack` of the line
// are moved onto it, and follow it: of two edges that lie on each other, the integrals depend on
// the one that clips.
template <class T>
Polygon<T> clipped(const Polygon<T>& subject, const Point<T>& a, const Point<T>& b, double slack) {
  Polygon<T> out;
  const Point<T> along{b.x - a.x, b.y - a.y};
  std::array<T, 10> side;
  for (int i = 0; i < subject.n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    side[k] = twice_area(a, b, subject.corner[k]);
  }
  for (int i = 0; i < subject.n; ++i) {
    const auto from = static_cast<std::size_t>(i);
    const auto to = static_cast<std::size_t>((i + 1) % subject.n);
    const bool from_in = value(side[from]) >= -slack;
    const bool to_in = value(side[to]) >= -slack;
    if (from_in && std::abs(value(side[from])) <= slack) {
      const T share = side[from] / (along.x * along.x + along.y * along.y);
      const Point<T>& p = subject.corner[from];
      out.add({p.x + share * along.y, p.y - share * along.x});
    } else if (from_in) {
      out.add(subject.corner[from]);
    }
    if (from_in == to_in) continue;
    // both near the line: the corner that was kept stands for the intersection
    if (std::abs(value(side[from]) - value(side[to])) < 4 * slack) continue;
    const T share = side[from] / (side[from] - side[to]);
    const Point<T>& p = subject.corner[from];
    const Point<T>& q = subject.corner[to];
    out.add({p.x + share * (q.x - p.x), p.y + share * (q.y - p.y)});
  }
  return out;
}

template <class T>
std::array<T, 4> shape_functions(const T& s, const T& t) {
  const T one(1.0);
  return {0.25 * (one - s) * (one - t), 0.25 * (one + s) * (one - t), 0.25 * (one + s) * (one + t),
          0.25 * (one - s) * (one + t)};
}

// Shape functions of a plane quadrilateral at a point. Newton's method finds the place with plain
// numbers; one more step with T brings its derivatives.
template <class T>
bool shape_functions_at(const std::array<Point<T>, 4>& quad, const Point<T>& p,
                        std::array<T, 4>& shape) {
  double s = 0;
  double t = 0;
  double J[4] = {1, 0, 0, 1};
  const double px = value(p.x);
  const double py = value(p.y);
  bool found = false;
  for (int i = 0; i < 30; ++i) {
    const double N[4] = {0.25 * (1 - s) * (1 - t), 0.25 * (1 + s) * (1 - t),
                         0.25 * (1 + s) * (1 + t), 0.25 * (1 - s) * (1 + t)};
    const double N_s[4] = {-0.25 * (1 - t), 0.25 * (1 - t), 0.25 * (1 + t), -0.25 * (1 + t)};
    const double N_t[4] = {-0.25 * (1 - s), -0.25 * (1 + s), 0.25 * (1 + s), 0.25 * (1 - s)};
    double rx = -px;
    double ry = -py;
    J[0] = J[1] = J[2] = J[3] = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const double x = value(quad[k].x);
      const double y = value(quad[k].y);
      rx += N[k] * x;
      ry += N[k] * y;
      J[0] += N_s[k] * x;
      J[1] += N_t[k] * x;
      J[2] += N_s[k] * y;
      J[3] += N_t[k] * y;
    }
    const double det = J[0] * J[3] - J[1] * J[2];
    if (!(std::abs(det) > 0)) return false;
    const double ds = (-J[3] * rx + J[1] * ry) / det;
    const double dt = (J[2] * rx - J[0] * ry) / det;
    if (found) break;
    s += ds;
    t += dt;
    if (!(std::abs(s) < 20 && std::abs(t) < 20)) return false;
    found = std::abs(ds) + std::abs(dt) < 1e-13;
  }
  const double det = J[0] * J[3] - J[1] * J[2];
  const std::array<double, 4> N = shape_functions(s, t);
  T rx = -p.x;
  T ry = -p.y;
  for (std::size_t k = 0; k < 4; ++k) {
    rx += N[k] * quad[k].x;
    ry += N[k] * quad[k].y;
  }
  const T s_t = T(s) + (-J[3] / det) * rx + (J[1] / det) * ry;
  const T t_t = T(t) + (J[2] / det) * rx + (-J[0] / det) * ry;
  shape = shape_functions(s_t, t_t);
  return true;
}

// seven points of degree 5 in a triangle
struct TrianglePoint {
  double a, b, weight;
};
inline constexpr std::array<TrianglePoint, 7> triangle_points{{
    {1.0 / 3, 1.0 / 3, 0.225},
    {0.470142064105115, 0.470142064105115, 0.132394152788506},
    {0.05971587178977, 0.470142064105115, 0.132394152788506},
    {0.470142064105115, 0.05971587178977, 0.132394152788506},
    {0.101286507323456, 0.101286507323456, 0.125939180544827},
    {0.797426985353087, 0.101286507323456, 0.125939180544827},
    {0.101286507323456, 0.797426985353087, 0.125939180544827},
}};

}  // namespace overlap_detail

// Adds the integrals over the common part of two facets that face each other; false where there is
// none. mirrored: axes across a plane of symmetry that has an edge of the first facet.
template <class T>
bool add_overlap(const Quad<T>& first, const Quad<T>& second, const std::array<bool, 3>& mirrored,
                 Overlap<T>& out) {
  using namespace overlap_detail;
  const Corner<T> diagonal = minus(first[2], first[0]);
  const Corner<T> normal = of_length_1(cross(diagonal, minus(first[3], first[1])));
  Corner<T> along = normal;  // the direction of the projection
  Corner<T> within = normal;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (mirrored[axis]) within[axis] = T(0.0);
  if (value(dot(within, within)) > 0.01) along = of_length_1(within);
  const T stretch = T(1.0) / dot(normal, along);  // area of the first facet over its projection
  const T high = dot(diagonal, along);
  const Corner<T> e1 =
      of_length_1(minus(diagonal, {high * along[0], high * along[1], high * along[2]}));
  const Corner<T> e2 = cross(along, e1);
  const auto projected = [&](const Quad<T>& quad) {
    std::array<Point<T>, 4> points;
    for (std::size_t k = 0; k < 4; ++k) {
      const Corner<T> from = minus(quad[k], first[0]);
      points[k] = {dot(from, e1), dot(from, e2)};
    }
    return points;
  };
  const std::array<Point<T>, 4> a = projected(first);
  const std::array<Point<T>, 4> b = projected(second);
  const double size =
      std::abs(value(twice_area(a[0], a[1], a[2]))) + std::abs(value(twice_area(a[0], a[2], a[3])));
  Polygon<T> common;
  for (const Point<T>& p : b) common.add(p);
  for (std::size_t k = 0; k < 4 && common.n > 2; ++k)
    common = clipped(common, a[k], a[(k + 1) % 4], 1e-10 * size);
  if (common.n < 3) return false;
  Point<T> middle{T(0.0), T(0.0)};
  for (int i = 0; i < common.n; ++i) {
    const Point<T>& p = common.corner[static_cast<std::size_t>(i)];
    middle.x = middle.x + (1.0 / common.n) * p.x;
    middle.y = middle.y + (1.0 / common.n) * p.y;
  }
  double whole = 0;
  for (int i = 1; i + 1 < common.n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    whole += 0.5 * value(twice_area(common.corner[0], common.corner[k + 1], common.corner[k]));
  }
  if (!(whole > 1e-10 * size)) return false;
  bool any = false;
  // Triangles without area count, too: where two corners become one, they change as fast as their
  // neighbours.
  for (int i = 0; i < common.n; ++i) {
    // the second facet faces the first: its corners go clockwise
    const Point<T>& p = common.corner[static_cast<std::size_t>((i + 1) % common.n)];
    const Point<T>& q = common.corner[static_cast<std::size_t>(i)];
    const T area = 0.5 * twice_area(middle, p, q);
    for (const TrianglePoint& g : triangle_points) {
      const Point<T> x{middle.x + g.a * (p.x - middle.x) + g.b * (q.x - middle.x),
                       middle.y + g.a * (p.y - middle.y) + g.b * (q.y - middle.y)};
      std::array<T, 4> N;
      std::array<T, 4> N_other;
      if (!shape_functions_at(a, x, N) || !shape_functions_at(b, x, N_other)) continue;
      any = true;
      const T weight = g.weight * area * stretch;
      for (std::size_t k = 0; k < 4; ++k) {
        const T weighted = weight * N[k];
        for (std::size_t l = 0; l < 4; ++l) {
          if (l >= k) out.own[k][l] += weighted * N[l];
          out.other[k][l] += weighted * N_other[l];
        }
      }
    }
  }
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t l = 0; l < k; ++l) out.own[k][l] = out.own[l][k];
  return any;
}

}  // namespace langer
