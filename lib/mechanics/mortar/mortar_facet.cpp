#include "mechanics/mortar/mortar_facet.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>

#include "mechanics/mortar/facet_search.hpp"

namespace langer {

namespace {

// shares of a facet that is covered, between which the dual functions come in
constexpr double little = 0.1;
constexpr double much = 0.6;
// facets face each other where the cosine of their normals is below this
constexpr double facing = -0.2;

BoundingBox box_of(const QuadNodes& facet, const VecX& x, double more) {
  BoundingBox box{position(x, facet[0]), position(x, facet[0])};
  for (int node : facet) {
    box.low = box.low.cwiseMin(position(x, node));
    box.high = box.high.cwiseMax(position(x, node));
  }
  box.low.array() -= more;
  box.high.array() += more;
  return box;
}

Vec3 area_vector(const QuadNodes& f, const VecX& x) {
  const Vec3 a = position(x, f[2]) - position(x, f[0]);
  const Vec3 b = position(x, f[3]) - position(x, f[1]);
  return 0.5 * a.cross(b);
}

template <class T>
T coordinate(double x, int index) {
  if constexpr (std::is_same_v<T, double>) {
    return x;
  } else {
    return T(x, index);
  }
}

template <class T>
Quad<T> quad_of(const QuadNodes& facet, const VecX& x, int first) {
  Quad<T> quad;
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 3; ++j)
      quad[static_cast<std::size_t>(k)][static_cast<std::size_t>(j)] =
          coordinate<T>(x[3 * facet[static_cast<std::size_t>(k)] + j], first + 3 * k + j);
  return quad;
}

template <class T>
bool overlap_of(const QuadNodes& own, const QuadNodes& other, const std::array<bool, 3>& mirrored,
                const VecX& x, FacetOverlap& out) {
  Overlap<T> integrals;
  if (!add_overlap(quad_of<T>(own, x, 0), quad_of<T>(other, x, 12), mirrored, integrals))
    return false;
  if constexpr (!std::is_same_v<T, double>) {
    out.dM.resize(24);
    out.dK.resize(24);
  }
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      const T& M = integrals.own[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
      const T& K = integrals.other[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
      out.M(i, j) = value(M);
      out.K(i, j) = value(K);
      if constexpr (!std::is_same_v<T, double>) {
        for (std::size_t c = 0; c < 24; ++c) {
          out.dM[c](i, j) = M.d[static_cast<Eigen::Index>(c)];
          out.dK[c](i, j) = K.d[static_cast<Eigen::Index>(c)];
        }
      }
    }
  return true;
}

// Whether two facets may touch at all: they face each other, and are near. Two places of one
// surface touch from outside only: what is far behind a facet is the other side of a thin body.
bool may_touch(const SurfaceContact& contact, int own, int other, const VecX& x) {
  const QuadNodes& a = contact.own[static_cast<std::size_t>(own)];
  const QuadNodes& b = contact.other[static_cast<std::size_t>(other)];
  const Vec3 na = area_vector(a, x);
  const Vec3 nb = area_vector(b, x);
  if (na.dot(nb) > facing * na.norm() * nb.norm()) return false;
  // along the outward normal of the first: from -reach to reach
  const Vec3 n = na.normalized();
  double low = contact.reach;
  double high = -contact.reach;
  for (int node : b) {
    const double away = n.dot(position(x, node) - position(x, a[0]));
    low = std::min(low, away);
    high = std::max(high, away);
  }
  const double behind = contact.touches_itself() ? contact.reach / 6 : contact.reach;
  return low < contact.reach && high > -behind;
}

// Axes across a plane of symmetry that has an edge of the facet.
std::array<bool, 3> mirrored_edges(const SurfaceContact& contact, const QuadNodes& facet) {
  std::array<bool, 3> mirrored{};
  if (contact.mirrors.empty()) return mirrored;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto is_on_plane = [&](int node) {
      const auto at = std::ranges::lower_bound(contact.nodes, node) - contact.nodes.begin();
      return contact.mirrors[static_cast<std::size_t>(at)][axis];
    };
    mirrored[axis] = std::ranges::count_if(facet, is_on_plane) > 1;
  }
  return mirrored;
}

void set_weights(MortarFacet& facet) {
  facet.M.setZero();
  for (const FacetOverlap& o : facet.overlaps) facet.M += o.M;
  facet.D = facet.M.rowwise().sum();
  const double s = (facet.D.sum() / facet.area - little) / (much - little);
  if (s > 0 && s < 1) {
    facet.beta = s * s * (3 - 2 * s);
    facet.beta_slope = 6 * s * (1 - s) / (much - little);
  } else {
    facet.beta = s >= 1 ? 1 : 0;
  }
  facet.A = (1 - facet.beta) * Mat4::Identity();
  if (facet.beta > 0) facet.A += facet.beta * (facet.D.asDiagonal() * facet.M.inverse());
}

}  // namespace

std::vector<MortarFacet> mortar_facets(const SurfaceContact& contact, const VecX& x,
                                       bool with_derivatives) {
  std::vector<BoundingBox> boxes;
  boxes.reserve(contact.other.size());
  for (const QuadNodes& facet : contact.other) boxes.push_back(box_of(facet, x, 0));
  const FacetSearch search(boxes);
  std::vector<MortarFacet> facets;
  for (std::size_t e = 0; e < contact.own.size(); ++e) {
    const QuadNodes& own = contact.own[e];
    MortarFacet facet;
    facet.own = static_cast<int>(e);
    const std::array<bool, 3> mirrored = mirrored_edges(contact, own);
    for (int m : search.meeting(box_of(own, x, contact.reach))) {
      if (!contact.may_pair(facet.own, m) || !may_touch(contact, facet.own, m, x)) continue;
      FacetOverlap overlap;
      overlap.other = m;
      const QuadNodes& other = contact.other[static_cast<std::size_t>(m)];
      const bool any = with_derivatives ? overlap_of<Jet<24>>(own, other, mirrored, x, overlap)
                                        : overlap_of<double>(own, other, mirrored, x, overlap);
      if (any) facet.overlaps.push_back(std::move(overlap));
    }
    if (facet.overlaps.empty()) continue;
    facet.area = area_vector(own, x).norm();
    set_weights(facet);
    facets.push_back(std::move(facet));
  }
  return facets;
}

}  // namespace langer
