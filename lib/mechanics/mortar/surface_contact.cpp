#include "mechanics/mortar/surface_contact.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "core/tensor/principal.hpp"
#include "mechanics/mesh/facets.hpp"
#include "mechanics/mortar/mortar_facet.hpp"

namespace langer {

VecX positions(const std::vector<Vec3>& X, const VecX& u) {
  VecX x = u;
  for (std::size_t i = 0; i < X.size(); ++i) x.segment<3>(3 * static_cast<Eigen::Index>(i)) += X[i];
  return x;
}

VecX positions(const std::vector<Vec3>& X) {
  return positions(X, VecX::Zero(3 * static_cast<Eigen::Index>(X.size())));
}

namespace {

QuadNodes corners(const Mesh& mesh, const Facet& facet) {
  const std::vector<int> nodes = facet_nodes(mesh, facet);
  return {nodes[0], nodes[1], nodes[2], nodes[3]};
}

// what a state of the scene below the rounding of its positions is
double rounding(const VecX& x) {
  return 8 * std::numeric_limits<double>::epsilon() * x.lpNorm<Eigen::Infinity>();
}

}  // namespace

// Contact between two surfaces of deformable bodies, from their facets of four corners. Conditions
// are imposed at the nodes of the own side. The reach limits the search for overlaps to three times
// the longest edge at rest [mm].
SurfaceContact surface_contact(const std::string& name, double mu, const Mesh& mesh,
                               const std::vector<Facet>& own, const std::vector<Facet>& other) {
  SurfaceContact contact;
  contact.name = name;
  contact.mu = mu;
  for (const Facet& facet : own) contact.own.push_back(corners(mesh, facet));
  for (const Facet& facet : other) contact.other.push_back(corners(mesh, facet));
  std::set<int> nodes;
  std::set<int> all;
  double longest = 0;
  for (const auto* side : {&contact.own, &contact.other})
    for (const QuadNodes& facet : *side)
      for (std::size_t k = 0; k < 4; ++k) {
        const auto next = static_cast<std::size_t>(facet[(k + 1) % 4]);
        const auto here = static_cast<std::size_t>(facet[k]);
        longest = std::max(longest, (mesh.X[next] - mesh.X[here]).norm());
        all.insert(facet[k]);
        if (side == &contact.own) nodes.insert(facet[k]);
      }
  contact.nodes.assign(nodes.begin(), nodes.end());
  contact.all_nodes.assign(all.begin(), all.end());
  contact.reach = 3 * longest;
  return contact;
}

bool SurfaceContact::may_pair(int own_facet, int other_facet) const {
  if (!touches_itself()) return true;
  const auto a = static_cast<std::size_t>(own_facet);
  const auto b = static_cast<std::size_t>(other_facet);
  if (rank[a] >= rank[b]) return false;
  return !std::binary_search(neighbours[a].begin(), neighbours[a].end(), other_facet);
}

namespace {

// Facets by their place along the longest direction of the surface.
std::vector<int> ranks_along(const std::vector<QuadNodes>& facets, const Mesh& mesh) {
  std::vector<Vec3> middles;
  for (const QuadNodes& facet : facets) {
    Vec3 sum = Vec3::Zero();
    for (int node : facet) sum += mesh.X[static_cast<std::size_t>(node)];
    middles.push_back(0.25 * sum);
  }
  Vec3 low = middles.front();
  Vec3 high = low;
  for (const Vec3& middle : middles) {
    low = low.cwiseMin(middle);
    high = high.cwiseMax(middle);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  std::vector<int> order(facets.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return middles[static_cast<std::size_t>(a)][axis] < middles[static_cast<std::size_t>(b)][axis];
  });
  std::vector<int> rank(facets.size());
  for (std::size_t place = 0; place < order.size(); ++place)
    rank[static_cast<std::size_t>(order[place])] = static_cast<int>(place);
  return rank;
}

// By facet, those that share a node with it or with one that shares a node with it.
std::vector<std::vector<int>> facets_around(const std::vector<QuadNodes>& facets) {
  std::map<int, std::vector<int>> at_node;
  for (std::size_t f = 0; f < facets.size(); ++f)
    for (int node : facets[f]) at_node[node].push_back(static_cast<int>(f));
  const auto ring = [&](const std::set<int>& of) {
    std::set<int> more;
    for (int f : of)
      for (int node : facets[static_cast<std::size_t>(f)])
        more.insert(at_node[node].begin(), at_node[node].end());
    return more;
  };
  std::vector<std::vector<int>> around;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const std::set<int> near = ring(ring({static_cast<int>(f)}));
    around.emplace_back(near.begin(), near.end());
  }
  return around;
}

}  // namespace

SurfaceContact self_contact(const std::string& name, double mu, const Mesh& mesh,
                            const std::vector<Facet>& facets) {
  SurfaceContact contact = surface_contact(name, mu, mesh, facets, facets);
  contact.rank = ranks_along(contact.own, mesh);
  contact.neighbours = facets_around(contact.own);
  return contact;
}

void find_mirrors(SurfaceContact& contact, const Mesh& mesh, const std::vector<char>& held) {
  contact.mirrors.assign(contact.nodes.size(), {});
  bool any = false;
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = [&](int node) {
      return mesh.X[static_cast<std::size_t>(node)][axis];
    };
    const auto ends = std::ranges::minmax(contact.all_nodes, {}, at);
    const double low = at(ends.min);
    const double high = at(ends.max);
    const double near = 1e-6 * contact.reach;
    for (const double plane : {low, high}) {
      const auto is_on_it = [&](int node) {
        return std::abs(at(node) - plane) <= near;
      };
      const auto may_be_mirrored = [&](int node) {
        return !is_on_it(node) || held[static_cast<std::size_t>(3 * node + axis)];
      };
      const auto has_nodes_there = [&](const std::vector<QuadNodes>& side) {
        return std::ranges::any_of(
            side, [&](const QuadNodes& facet) { return std::ranges::any_of(facet, is_on_it); });
      };
      if (high - low <= near || !std::ranges::all_of(contact.all_nodes, may_be_mirrored) ||
          !has_nodes_there(contact.own) || !has_nodes_there(contact.other))
        continue;
      for (std::size_t i = 0; i < contact.nodes.size(); ++i)
        if (is_on_it(contact.nodes[i]))
          any = contact.mirrors[i][static_cast<std::size_t>(axis)] = true;
    }
  }
  if (!any) contact.mirrors.clear();
}

// The weighted difference of the two sides: the own side has positive weights, the other negative
// ones. Of displacements it is the relative motion at this node.
Vec3 MortarNode::average(const VecX& u) const {
  Vec3 sum = Vec3::Zero();
  for (const auto* side : {&own, &other})
    for (const Weight& w : *side) sum += w.of * position(u, w.node);
  return within_mirrors(sum);
}

Vec3 MortarNode::slip(const VecX& u) const {
  const Vec3 v = average(u);
  return v - v.dot(normal) * normal;
}

// A normal at each own node: the mean of the facets around it, weighted with their areas. Half the
// cross product of the diagonals is the area vector of a facet of four corners, plane or not. The
// minus sign turns it into the body.
std::vector<Vec3> mortar_normals(const SurfaceContact& contact, const VecX& x) {
  std::map<int, Vec3> sum;
  for (const QuadNodes& f : contact.own) {
    const Vec3 a = position(x, f[2]) - position(x, f[0]);
    const Vec3 b = position(x, f[3]) - position(x, f[1]);
    const Vec3 inward = -0.5 * a.cross(b);
    for (int node : f) sum.try_emplace(node, Vec3::Zero()).first->second += inward;
  }
  std::vector<Vec3> normals;
  for (std::size_t i = 0; i < contact.nodes.size(); ++i)
    normals.push_back(contact.within_mirrors(i, sum.at(contact.nodes[i])).normalized());
  return normals;
}

std::vector<MortarNode> mortar_nodes(const SurfaceContact& contact, const VecX& x) {
  return mortar_nodes(contact, mortar_facets(contact, x, false), x);
}

// Gathers the integrals of the facets at the own nodes and divides them by the area of the node, so
// that weights have no unit. A node whose facets overlap nothing has no area, and no condition.
std::vector<MortarNode> mortar_nodes(const SurfaceContact& contact,
                                     const std::vector<MortarFacet>& facets, const VecX& x) {
  struct Sums {
    double area = 0;
    std::map<int, double> own, other;
  };
  std::map<int, Sums> by_node;
  for (const MortarFacet& facet : facets) {
    const QuadNodes& own = contact.own[static_cast<std::size_t>(facet.own)];
    const Mat4 S = facet.A * facet.M;
    for (int i = 0; i < 4; ++i) {
      Sums& sums = by_node[own[static_cast<std::size_t>(i)]];
      sums.area += facet.D[i];
      for (int j = 0; j < 4; ++j) sums.own[own[static_cast<std::size_t>(j)]] += S(i, j);
      for (const FacetOverlap& o : facet.overlaps) {
        const QuadNodes& other = contact.other[static_cast<std::size_t>(o.other)];
        const Vec4 row = facet.A.row(i) * o.K;
        for (int k = 0; k < 4; ++k) sums.other[other[static_cast<std::size_t>(k)]] -= row[k];
      }
    }
  }
  const std::vector<Vec3> normals = mortar_normals(contact, x);
  std::vector<MortarNode> nodes;
  for (const auto& [node, sums] : by_node) {
    if (!(sums.area > 0)) continue;
    MortarNode out;
    const auto found = std::lower_bound(contact.nodes.begin(), contact.nodes.end(), node);
    out.candidate = static_cast<int>(found - contact.nodes.begin());
    out.area = sums.area;
    out.normal = normals[static_cast<std::size_t>(out.candidate)];
    if (!contact.mirrors.empty())
      out.mirrored = contact.mirrors[static_cast<std::size_t>(out.candidate)];
    for (const auto& [j, w] : sums.own) out.own.push_back({j, w / sums.area});
    for (const auto& [k, w] : sums.other) out.other.push_back({k, w / sums.area});
    // differences of positions, not sums of products with coordinates far from the origin
    const Vec3 middle = position(x, node);
    for (const auto* side : {&out.own, &out.other})
      for (const Weight& w : *side) out.jump += w.of * (position(x, w.node) - middle);
    out.jump = out.within_mirrors(out.jump);
    nodes.push_back(std::move(out));
  }
  return nodes;
}

namespace {

// The inverse of the inertia of masses, in the directions in which they resist a turn: those on a
// line do not resist one about it, and a single one resists none.
Mat3 inverse_inertia(const Mat3& inertia) {
  constexpr double regular = 1e-12;  // of the sum of the principal values, to the third power
  constexpr double resists = 1e-9;   // of their sum
  const double sum = inertia.trace();
  if (inertia.determinant() > regular * sum * sum * sum) return inertia.inverse();
  Mat3 inverse = Mat3::Zero();
  const Principal own = principal(inertia);
  for (int i = 0; i < 3; ++i) {
    const Vec3 axis = own.directions.col(i);
    if (own.values[i] > resists * sum) inverse += axis * axis.transpose() / own.values[i];
  }
  return inverse;
}

}  // namespace

// Forces on the other side: w_k r - q_k a x (x_k - x_mean), with a such that the moment of all is
// zero: J a = jump x r, J the inertia of the masses q_k = |w_k|.
std::vector<NodalForce> force_operator(const MortarNode& node, const VecX& x) {
  std::vector<NodalForce> forces;
  for (const Weight& w : node.own) forces.push_back({w.node, w.of * Mat3::Identity()});
  double mass = 0;
  Vec3 mean = Vec3::Zero();
  for (const Weight& w : node.other) {
    mass += std::abs(w.of);
    mean += std::abs(w.of) * position(x, w.node);
  }
  mean /= mass;
  Mat3 inertia = Mat3::Zero();
  for (const Weight& w : node.other) {
    const Vec3 arm = position(x, w.node) - mean;
    inertia += std::abs(w.of) * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose());
  }
  // With their mirror images, the masses resist turns about the axis of a plane on their own.
  for (int axis = 0; axis < 3; ++axis) {
    if (!node.mirrored[static_cast<std::size_t>(axis)]) continue;
    const double about_it = inertia(axis, axis);
    inertia.row(axis).setZero();
    inertia.col(axis).setZero();
    inertia(axis, axis) = about_it;
  }
  const auto product = [](const Vec3& a) {
    Mat3 P;
    P << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0;
    return P;
  };
  const Mat3 turn = inverse_inertia(inertia) * product(node.jump);
  for (const Weight& w : node.other) {
    const Mat3 couple = std::abs(w.of) * product(position(x, w.node) - mean) * turn;
    forces.push_back({w.node, w.of * Mat3::Identity() + couple});
  }
  for (NodalForce& force : forces)
    for (int axis = 0; axis < 3; ++axis)
      if (node.mirrored[static_cast<std::size_t>(axis)]) force.per_reaction.col(axis).setZero();
  return forces;
}

// Adds the nodal forces of the reactions [N]. A node without a reaction is open and adds nothing.
void add_mortar_forces(const std::vector<MortarNode>& nodes, const VecX& x,
                       const std::vector<Vec3>& reactions, VecX& f) {
  for (const MortarNode& node : nodes) {
    const Vec3& r = reactions[static_cast<std::size_t>(node.candidate)];
    if (r.isZero(0)) continue;
    for (const NodalForce& force : force_operator(node, x))
      f.segment<3>(3 * static_cast<Eigen::Index>(force.node)) += force.per_reaction * r;
  }
}

// How far a state is from a solution of the contact problem, node by node. Open nodes must not
// penetrate, closed nodes must have no gap. Reactions must be inside the friction cone |r_t| <= mu
// r_n, with r_n >= 0. The products of gap and reaction, and of slip and distance to the cone, must
// be zero. These are made relative by the largest reaction and the largest motion.
ContactDefect mortar_defect(const SurfaceContact& contact, const std::vector<MortarNode>& nodes,
                            const VecX& x, const VecX& x0, const std::vector<Vec3>& reactions,
                            double motion) {
  ContactDefect defect;
  defect.status.assign(contact.nodes.size(), ContactStatus::open);
  // A node with nothing opposite is further away than the search reaches.
  defect.gap.assign(contact.nodes.size(), contact.reach);
  const VecX moved = x - x0;
  double largest = 0;
  for (const Vec3& r : reactions) largest = std::max(largest, r.norm());
  for (const MortarNode& node : nodes) motion = std::max(motion, node.average(moved).norm());
  const double tiny = std::numeric_limits<double>::min();
  for (const MortarNode& node : nodes) {
    const auto i = static_cast<std::size_t>(node.candidate);
    const Vec3& r = reactions[i];
    const double g = node.gap();
    defect.gap[i] = g;
    const bool closed = !r.isZero(0);
    const double violation = closed ? std::abs(g) : -g;
    defect.penetration = std::max(defect.penetration, violation);
    if (!closed) continue;
    const Vec3& n = node.normal;
    const Vec3 slip = node.slip(moved);
    const double r_n = r.dot(n);
    const double r_t = (r - r_n * n).norm();
    double seen = 0;
    // A gap below the rounding of the positions is no gap: with a large reaction it would otherwise
    // seem to do work.
    if (std::abs(g) > rounding(x)) seen = g;
    defect.cone = std::max({defect.cone, (r_t - contact.mu * r_n) / largest, -r_n / largest});
    double power = r_n * seen;
    if (contact.mu > 0) power = r.dot(slip) + r_n * (seen + contact.mu * slip.norm());
    defect.complementarity =
        std::max(defect.complementarity, std::abs(power) / std::max(largest * motion, tiny));
    // A reaction strictly inside the cone means that the node sticks; on the cone it slips.
    const bool sticks = contact.mu > 0 && r_t < contact.mu * r_n * (1 - 1e-9);
    defect.status[i] = sticks ? ContactStatus::stick : ContactStatus::slip;
    defect.force += r;
  }
  for (ContactStatus status : defect.status) {
    if (status == ContactStatus::open) ++defect.open;
    if (status == ContactStatus::stick) ++defect.stick;
    if (status == ContactStatus::slip) ++defect.slip;
  }
  return defect;
}

}  // namespace langer
