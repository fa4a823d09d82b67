#include "mechanics/mortar/penetration.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "mechanics/mortar/facet_search.hpp"

namespace langer {

namespace {

// Nodes of plane models lie on edges of facets: rounding does not hide them.
constexpr double on_edge = 1e-9;  // of the length of a facet

// The depth of a point below a facet, along its normal; 0 where it is not over it, or above. A
// facet is two pairs of triangles; the shallower answer of the two is that of the bilinear surface
// between.
double depth_below(const QuadNodes& facet, const VecX& x, const Vec3& point, double reach) {
  double least = 0;
  for (int first : {0, 1}) {
    double here = 0;
    for (int half = 0; half < 2; ++half) {
      const auto corner = [&](int k) {
        return position(x, facet[static_cast<std::size_t>((first + 2 * half + k) % 4)]);
      };
      const Vec3 a = corner(0);
      const Vec3 b = corner(1) - a;
      const Vec3 c = corner(2) - a;
      const Vec3 normal = b.cross(c).normalized();
      const double above = normal.dot(point - a);
      if (above >= 0 || above < -reach) continue;
      const Vec3 p = point - a - above * normal;
      const double area = normal.dot(b.cross(c));
      const double s = normal.dot(p.cross(c)) / area;
      const double t = normal.dot(b.cross(p)) / area;
      if (s < -on_edge || t < -on_edge || s + t > 1 + on_edge) continue;
      here = std::max(here, -above);
    }
    least = first == 0 ? here : std::min(least, here);
  }
  return least;
}

Vec3 outward(const QuadNodes& f, const VecX& x) {
  const Vec3 a = position(x, f[2]) - position(x, f[0]);
  const Vec3 b = position(x, f[3]) - position(x, f[1]);
  return a.cross(b).normalized();
}

// Whether a node may be inside a facet of its own surface: the facet is not around the node, and
// faces every facet at the node.
bool may_be_inside(const SurfaceContact& contact, const std::vector<int>& at_node, int facet,
                   const VecX& x) {
  const Vec3 n = outward(contact.own[static_cast<std::size_t>(facet)], x);
  for (int f : at_node) {
    const auto& near = contact.neighbours[static_cast<std::size_t>(f)];
    if (std::binary_search(near.begin(), near.end(), facet)) return false;
    if (n.dot(outward(contact.own[static_cast<std::size_t>(f)], x)) > -0.2) return false;
  }
  return true;
}

double deepest(const SurfaceContact& contact, const std::vector<QuadNodes>& nodes_of,
               const std::vector<QuadNodes>& facets, const VecX& x, double reach) {
  std::vector<BoundingBox> boxes;
  for (const QuadNodes& facet : facets) {
    BoundingBox box{position(x, facet[0]), position(x, facet[0])};
    for (int node : facet) {
      box.low = box.low.cwiseMin(position(x, node));
      box.high = box.high.cwiseMax(position(x, node));
    }
    boxes.push_back(box);
  }
  const FacetSearch search(boxes);
  std::map<int, std::vector<int>> nodes;
  for (std::size_t f = 0; f < nodes_of.size(); ++f)
    for (int node : nodes_of[f]) nodes[node].push_back(static_cast<int>(f));
  double deep = 0;
  for (const auto& [node, at_node] : nodes) {
    const Vec3 point = position(x, node);
    for (int f : search.meeting({point.array() - reach, point.array() + reach})) {
      if (contact.touches_itself() && !may_be_inside(contact, at_node, f, x)) continue;
      const QuadNodes& facet = facets[static_cast<std::size_t>(f)];
      deep = std::max(deep, depth_below(facet, x, point, reach));
    }
  }
  return deep;
}

}  // namespace

double penetration(const SurfaceContact& contact, const VecX& x) {
  const double reach = contact.reach / 3;
  const double of_own = deepest(contact, contact.own, contact.other, x, reach);
  if (contact.touches_itself()) return of_own;
  return std::max(of_own, deepest(contact, contact.other, contact.own, x, reach));
}

}  // namespace langer
