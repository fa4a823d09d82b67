#include "mechanics/contact/facet_indenter.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

namespace langer {

namespace {

struct OnTriangle {
  Vec3 point;
  int feature;     // 0 face, 1 edge, 2 corner
  Vec3 direction;  // of the edge
};

// Nearest point of a triangle by its Voronoi regions.
OnTriangle nearest_on(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& x) {
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 ax = x - a;
  const Vec3 bx = x - b;
  const Vec3 cx = x - c;
  const double d1 = ab.dot(ax);
  const double d2 = ac.dot(ax);
  const double d3 = ab.dot(bx);
  const double d4 = ac.dot(bx);
  const double d5 = ab.dot(cx);
  const double d6 = ac.dot(cx);
  if (d1 <= 0 && d2 <= 0) return {a, 2, {}};
  if (d3 >= 0 && d4 <= d3) return {b, 2, {}};
  if (d6 >= 0 && d5 <= d6) return {c, 2, {}};
  const double vc = d1 * d4 - d3 * d2;
  const double vb = d5 * d2 - d1 * d6;
  const double va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {a + d1 / (d1 - d3) * ab, 1, ab.normalized()};
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {a + d2 / (d2 - d6) * ac, 1, ac.normalized()};
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return {b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), 1, (c - b).normalized()};
  const double sum = va + vb + vc;
  return {a + vb / sum * ab + vc / sum * ac, 0, {}};
}

// 0 inside the box [mm2].
double squared_distance_to_box(const Vec3& low, const Vec3& high, const Vec3& x) {
  return (low - x).cwiseMax(x - high).cwiseMax(0).squaredNorm();
}

}  // namespace

TriangleTree::TriangleTree(Triangles triangles)
    : t_(std::move(triangles)), order_(t_.corners.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  build(0, static_cast<int>(order_.size()));
}

// Boxes in boxes: the triangles are halved along the longest side of their box until few are left.
// Ties are broken by number, so that the tree is the same on every machine.
int TriangleTree::build(int first, int last) {
  Box box{Vec3::Constant(std::numeric_limits<double>::infinity()),
          Vec3::Constant(-std::numeric_limits<double>::infinity()), first, last};
  for (int i = first; i < last; ++i)
    for (int p : t_.corners[order_[i]]) {
      box.low = box.low.cwiseMin(t_.points[p]);
      box.high = box.high.cwiseMax(t_.points[p]);
    }
  const int index = static_cast<int>(boxes_.size());
  boxes_.push_back(box);
  if (last - first <= 4) return index;
  int axis = 0;
  (box.high - box.low).maxCoeff(&axis);
  const auto centre = [&](int t) {
    const auto& c = t_.corners[t];
    return t_.points[c[0]][axis] + t_.points[c[1]][axis] + t_.points[c[2]][axis];
  };
  const int middle = (first + last) / 2;
  std::nth_element(
      order_.begin() + first, order_.begin() + middle, order_.begin() + last,
      [&](int a, int b) { return centre(a) < centre(b) || (centre(a) == centre(b) && a < b); });
  const int left = build(first, middle);
  const int right = build(middle, last);
  boxes_[index].left = left;
  boxes_[index].right = right;
  return index;
}

// Visits the nearer box first, and leaves out boxes that are farther away than the best triangle.
TriangleTree::Nearest TriangleTree::nearest(const Vec3& x) const {
  double best = std::numeric_limits<double>::infinity();
  Nearest out{};
  double steepest = -1;
  std::vector<int> open{0};
  while (!open.empty()) {
    const Box& box = boxes_[open.back()];
    open.pop_back();
    if (squared_distance_to_box(box.low, box.high, x) > best * (1 + 1e-12)) continue;
    if (box.left >= 0) {
      const bool left_first =
          squared_distance_to_box(boxes_[box.left].low, boxes_[box.left].high, x) <
          squared_distance_to_box(boxes_[box.right].low, boxes_[box.right].high, x);
      open.push_back(left_first ? box.right : box.left);
      open.push_back(left_first ? box.left : box.right);
      continue;
    }
    for (int i = box.first; i < box.last; ++i) {
      const auto& c = t_.corners[order_[i]];
      const Vec3 &p0 = t_.points[c[0]], &p1 = t_.points[c[1]], &p2 = t_.points[c[2]];
      const OnTriangle on = nearest_on(p0, p1, p2, x);
      const double distance = (x - on.point).squaredNorm();
      const Vec3 normal = (p1 - p0).cross(p2 - p0).normalized();
      // triangles that share the nearest point: the one whose plane x stands off most decides
      // inside or outside
      const double stands_off = std::abs((x - on.point).dot(normal));
      const bool same = distance <= best * (1 + 1e-10);
      if (distance < best * (1 - 1e-10) || (same && stands_off > steepest)) {
        best = std::min(best, distance);
        steepest = stands_off;
        out = {on.point, (x - on.point).dot(normal) >= 0 ? 1.0 : -1.0, on.feature,
               on.feature == 0 ? normal : on.direction};
      }
    }
  }
  return out;
}

void Facets::set_file_triangles(Triangles in_file) {
  for (Vec3& p : in_file.points) p = scale * p + vec(move);
  set_triangles(std::move(in_file));
}

void Facets::set_triangles(Triangles in_place) {
  tree = std::make_shared<TriangleTree>(std::move(in_place));
}

// The gap to the rounded surface. Inside a closed surface it is negative; the sign follows from the
// normal of the nearest triangle, edge or corner.
ShapePoint Facets::at(const Vec3& x) const {
  const TriangleTree::Nearest near = tree->nearest(x);
  const Vec3 away = near.sign * (x - near.point);
  const double distance = away.norm();
  ShapePoint p;
  if (distance < 1e-12)
    return {-rounding, near.feature == 0 ? near.direction : Vec3(Vec3::UnitY()), Mat3::Zero()};
  p.normal = away / distance;
  p.gap = near.sign * distance - rounding;
  if (near.feature == 2)
    p.curvature = tangent_projection(p.normal) / (near.sign * distance);
  else if (near.feature == 1)
    p.curvature = (tangent_projection(p.normal) - near.direction * near.direction.transpose()) /
                  (near.sign * distance);
  return p;
}

// Half of the second largest extent along the axes [mm]; the nearest point seen from far away is
// the farthest one in that direction.
double Facets::half_width() const {
  std::array<double, 3> width;
  for (int k = 0; k < 3; ++k) {  // what is nearest from far away is the farthest in that direction
    const Vec3 far = 1e9 * Vec3::Unit(k);
    width[k] = 0.5 * (tree->nearest(far).point - tree->nearest(-far).point)[k];
  }
  std::sort(width.begin(), width.end());
  return width[1] + rounding;
}

namespace {

// Normal to the triangle; its length is twice the area.
Vec3 twice_the_area(const Triangles& t, const std::array<int, 3>& c) {
  return (t.points[c[1]] - t.points[c[0]]).cross(t.points[c[2]] - t.points[c[0]]);
}

// for each box of a grid, so many along the longest side, the mean of the points in it; triangles
// that this leaves without area, or turned over, are gone
Triangles coarser(const Triangles& t, int boxes) {
  Eigen::AlignedBox3d all;
  for (const Vec3& x : t.points) all.extend(x);
  const double length = all.sizes().maxCoeff() / boxes;
  if (!(length > 0)) return t;
  Triangles out;
  std::map<std::array<int, 3>, int> point_of;
  std::vector<int> place, count;
  for (const Vec3& x : t.points) {
    std::array<int, 3> box;
    for (int k = 0; k < 3; ++k)
      box[static_cast<std::size_t>(k)] =
          static_cast<int>(std::floor((x[k] - all.min()[k]) / length));
    const auto [entry, is_new] = point_of.try_emplace(box, static_cast<int>(out.points.size()));
    if (is_new) {
      out.points.push_back(Vec3::Zero());
      count.push_back(0);
    }
    place.push_back(entry->second);
    out.points[place.back()] += x;
    ++count[place.back()];
  }
  for (std::size_t p = 0; p < count.size(); ++p) out.points[p] /= count[p];
  std::set<std::array<int, 3>> known;
  for (const auto& c : t.corners) {
    const std::array<int, 3> moved{place[c[0]], place[c[1]], place[c[2]]};
    auto key = moved;
    std::sort(key.begin(), key.end());
    if (key[0] == key[1] || key[1] == key[2] ||
        !(twice_the_area(out, moved).dot(twice_the_area(t, c)) > 0))
      continue;
    if (known.insert(key).second) out.corners.push_back(moved);
  }
  return out;
}

// its points moved out along the mean normals
Outline swollen(const Triangles& t, double by) {
  Outline out;
  std::vector<Vec3> normal(t.points.size(), Vec3::Zero());
  for (const auto& c : t.corners) {
    for (int p : c) normal[static_cast<std::size_t>(p)] += twice_the_area(t, c);
    out.faces.push_back({c[0], c[1], c[2]});
  }
  for (std::size_t p = 0; p < t.points.size(); ++p)
    out.points.push_back(t.points[p] + by * normal[p].stableNormalized());
  return out;
}

// Triangles moved out by the rounding, between them strips along edges and polygons at corners, all
// with their corners on the surface.
Outline with_rounded_edges(const Triangles& t, double rounding) {
  Outline out;
  std::map<std::array<int, 2>, std::array<int, 2>>
      ends_of;  // of a side, as its triangle goes round: the moved ends
  std::vector<std::vector<int>> at_corner(t.points.size());
  for (const auto& c : t.corners) {
    const Vec3 n = twice_the_area(t, c).normalized();
    const int first = static_cast<int>(out.points.size());
    for (int k = 0; k < 3; ++k) {
      out.points.push_back(t.points[c[k]] + rounding * n);
      at_corner[c[k]].push_back(first + k);
      ends_of[{c[k], c[(k + 1) % 3]}] = {first + k, first + (k + 1) % 3};
    }
    out.faces.push_back({first, first + 1, first + 2});
  }
  for (const auto& [side, ends] : ends_of)
    if (const auto other = ends_of.find({side[1], side[0]});
        side[0] < side[1] && other != ends_of.end())
      out.faces.push_back({ends[1], ends[0], other->second[1], other->second[0]});
  for (std::size_t p = 0; p < t.points.size(); ++p) {
    std::vector<int>& moved = at_corner[p];
    Vec3 out_of = Vec3::Zero();
    for (int i : moved) out_of += out.points[i] - t.points[p];
    if (moved.size() < 3 || out_of.norm() < 1e-9 * rounding) continue;
    const Vec3 a = out_of.unitOrthogonal();
    const Vec3 b = out_of.normalized().cross(a);
    const auto angle = [&](int i) {
      return std::atan2(b.dot(out.points[i] - t.points[p]), a.dot(out.points[i] - t.points[p]));
    };
    std::sort(moved.begin(), moved.end(), [&](int i, int j) { return angle(i) < angle(j); });
    out.faces.push_back(moved);
  }
  return out;
}

}  // namespace

Outline Facets::outline(const Shown& shown) const {
  const Triangles& t = tree->triangles();
  const auto parts = static_cast<std::size_t>(shown.parts);
  if (t.corners.size() <= 2 * parts * parts) return with_rounded_edges(t, rounding);
  return swollen(t.corners.size() <= 8 * parts * parts ? t : coarser(t, shown.parts), rounding);
}

}  // namespace langer
