#include "mechanics/mortar/penetration.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <set>

#include "mechanics/mortar/facet_search.hpp"

namespace langer {

namespace {

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
      if (s < 0 || t < 0 || s + t > 1) continue;
      here = std::max(here, -above);
    }
    least = first == 0 ? here : std::min(least, here);
  }
  return least;
}

double deepest(const std::vector<QuadNodes>& nodes_of, const std::vector<QuadNodes>& facets,
               const VecX& x, double reach) {
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
  std::set<int> nodes;
  for (const QuadNodes& facet : nodes_of) nodes.insert(facet.begin(), facet.end());
  double deep = 0;
  for (int node : nodes) {
    const Vec3 point = position(x, node);
    for (int f : search.meeting({point.array() - reach, point.array() + reach})) {
      const QuadNodes& facet = facets[static_cast<std::size_t>(f)];
      deep = std::max(deep, depth_below(facet, x, point, reach));
    }
  }
  return deep;
}

}  // namespace

double penetration(const SurfaceContact& contact, const VecX& x) {
  const double reach = contact.reach / 3;
  return std::max(deepest(contact.own, contact.other, x, reach),
                  deepest(contact.other, contact.own, x, reach));
}

}  // namespace langer
