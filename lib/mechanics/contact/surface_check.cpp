#include "mechanics/contact/surface_check.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <set>

#include "core/tensor/principal.hpp"
#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/reference.hpp"
#include "mechanics/mesh/section.hpp"
#include "mechanics/mesh/select.hpp"

namespace langer {

namespace {

// Of a section: the nodes in z = 0 of a facet that joins z = 0 and the plane behind it. The ends
// come in the order of the facet, then the middle.
std::vector<int> front_edge(const ReferenceCell& cell, const std::vector<int>& facet, int n_front) {
  std::vector<int> edge;
  const int sides = cell.facet_corners;
  for (int k = 0; k < sides; ++k) {
    const int a = facet[k];
    const int b = facet[(k + 1) % sides];
    if (a >= n_front || b >= n_front) continue;
    edge = {a, b};
    if (cell.second_order()) edge.push_back(facet[sides + k]);
  }
  return edge;
}

std::vector<std::array<int, 4>> edge_pieces(const std::vector<int>& n) {
  if (n.size() == 2) return {{n[0], n[1], n[1], n[0]}};
  return {{n[0], n[2], n[2], n[0]}, {n[2], n[1], n[1], n[2]}};
}

// The smallest radius of curvature of the surface itself below a point.
double radius_of(const ShapePoint& p) {
  const double curvature = principal_values(p.curvature)[2];
  if (curvature > 0) return std::max(0.0, 1 / curvature - p.gap);
  return std::numeric_limits<double>::infinity();
}

// The signed solid angle of a triangle seen from the origin (van Oosterom, Strackee 1983).
double solid_angle(Vec3 a, Vec3 b, Vec3 c) {
  const double la = a.norm();
  const double lb = b.norm();
  const double lc = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)),
                        la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

}  // namespace

// Collects the facets of the boundary, or the edges in z = 0 of a section, and how far the nodes
// are apart at each node.
SurfaceCheck::SurfaceCheck(const Mesh& mesh) : mesh_(mesh), spacing_(mesh.X.size(), 0) {
  int front = mesh.n_nodes();
  if (mesh.section) front = n_front(mesh);
  std::set<int> nodes;
  for (const Facet& facet : boundary(mesh)) {
    Patch patch{facet_nodes(mesh, facet)};
    if (mesh.section) {
      const bool flat =
          std::all_of(patch.nodes.begin(), patch.nodes.end(), [&](int n) { return n < front; });
      if (flat) continue;
      patch.nodes = front_edge(mesh.cell(), patch.nodes, front);
      if (patch.nodes.empty()) continue;
      patch.axis = mesh.section->of == SectionOf::axisymmetric &&
                   std::all_of(patch.nodes.begin(), patch.nodes.end(),
                               [&](int n) { return mesh.X[n][0] == 0; });
    }
    if (mesh.section)
      quads_.push_back(edge_pieces(patch.nodes));
    else
      quads_.push_back(facet_quads(mesh, facet));
    if (!patch.axis) nodes.insert(patch.nodes.begin(), patch.nodes.end());
    patches_.push_back(std::move(patch));
    const double a = half_diagonal(patches_.back());
    for (int n : patches_.back().nodes) spacing_[n] = std::max(spacing_[n], a);
  }
  nodes_.assign(nodes.begin(), nodes.end());
}

// Half the longest diagonal: how far a point of the facet can be from its middle [mm].
double SurfaceCheck::half_diagonal(const Patch& patch) const {
  double longest = 0;
  for (const auto& q : quads_[static_cast<std::size_t>(&patch - patches_.data())])
    for (const auto& [a, b] : {std::pair{q[0], q[2]}, {q[1], q[3]}, {q[0], q[1]}})
      longest = std::max(longest, (mesh_.X[a] - mesh_.X[b]).norm());
  return 0.5 * longest;
}

// s, t in [-1, 1]; of a triangle in [0, 1] with s + t <= 1
SurfaceCheck::Weights SurfaceCheck::weights(const Patch& patch, double s, double t) const {
  const std::size_t n = patch.nodes.size();
  Weights w(n);
  if (n == 2) {
    w << 0.5 * (1 - s), 0.5 * (1 + s);
  } else if (n == 3) {
    w << 0.5 * s * (s - 1), 0.5 * s * (s + 1), 1 - s * s;
  } else if (n == 4) {
    w << (1 - s) * (1 - t), (1 + s) * (1 - t), (1 + s) * (1 + t), (1 - s) * (1 + t);
    w *= 0.25;
  } else {  // all facets of a cell have the same functions in the order of their nodes
    const ReferenceCell& cell = mesh_.cell();
    const auto& local = cell.facet[0];
    const auto corner = [&](int k) {
      return cell.node[local[k]];
    };
    Vec3 xi;
    if (cell.facet_corners == 3)
      xi = (1 - s - t) * corner(0) + s * corner(1) + t * corner(2);
    else
      xi = 0.25 * ((1 - s) * (1 - t) * corner(0) + (1 + s) * (1 - t) * corner(1) +
                   (1 + s) * (1 + t) * corner(2) + (1 - s) * (1 + t) * corner(3));
    const VecX N = cell.shape(xi);
    for (std::size_t k = 0; k < n; ++k) w[k] = N[local[k]];
  }
  return w;
}

// The smallest gap of a facet, by branch and bound. The gap is a distance, so within a piece of
// radius r it is at least that of the middle minus r. Pieces that may contain a smaller gap are
// halved until the indenter is smooth across them; a pattern search then refines the best point.
SurfaceCheck::Deepest SurfaceCheck::deepest(const Patch& patch, const RigidContact& contact,
                                            const std::vector<Vec3>& x, const Vec3& c) const {
  const bool line = mesh_.section.has_value();
  const bool triangle = mesh_.cell().facet_corners == 3;
  const double low = triangle ? 0 : -1;
  const double width = half_width(contact.shape);
  double size = 0;
  for (int n : patch.nodes) size = std::max(size, (x[n] - x[patch.nodes[0]]).norm());
  double best_s = low;
  double best_t = low;
  double best = std::numeric_limits<double>::infinity();
  const auto at = [&](double s, double t) {
    const Weights w = weights(patch, s, t);
    Vec3 p = Vec3::Zero();
    for (std::size_t k = 0; k < patch.nodes.size(); ++k) p += w[k] * x[patch.nodes[k]];
    return shape_at(contact.shape, p - c);
  };
  const auto allowed = [&](double& s, double& t) {
    s = std::clamp(s, low, 1.0);
    t = line ? 0 : std::clamp(t, low, 1.0);
    if (triangle && s + t > 1) {
      const double over = 0.5 * (s + t - 1);
      s = std::clamp(s - over, 0.0, 1.0);
      t = 1 - s;
    }
  };
  const auto visit = [&](double s, double t) {
    allowed(s, t);
    const ShapePoint p = at(s, t);
    if (p.gap < best) {
      best = p.gap;
      best_s = s;
      best_t = t;
    }
    return p;
  };
  const std::function<void(double, double, double, int)> piece = [&](double s, double t,
                                                                     double half, int level) {
    const ShapePoint p = visit(s, t);
    // an upper bound of the radius of the piece
    double reach = half * size;
    if (triangle) reach *= 2;
    if (p.gap - reach > best) return;
    const double smooth = std::max(0.0, p.gap) + std::min(radius_of(p), width);
    if (level >= 6 || (level >= 2 && reach < 0.5 * smooth)) return;
    for (double ds : {-0.5, 0.5})
      for (double dt : {-0.5, 0.5})
        if (!line || dt < 0) {
          const double a = s + ds * half;
          double b = 0;
          if (!line) b = t + dt * half;
          if (!triangle || a + b < 1 + half) piece(a, b, 0.5 * half, level + 1);
        }
  };
  for (double s : {low, 1.0})
    for (double t : {low, 1.0}) visit(s, t);
  if (triangle)
    piece(0.5, 0.5, 0.5, 0);
  else
    piece(0, 0, 1, 0);
  for (double step = triangle ? 0.06 : 0.12; step > 1e-3;) {
    const double s = best_s;
    const double t = best_t;
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j) visit(s + i * step, t + j * step);
    if (best_s == s && best_t == t) step *= 0.5;
  }
  const Weights w = weights(patch, best_s, best_t);
  Vec3 X = Vec3::Zero();
  for (std::size_t k = 0; k < patch.nodes.size(); ++k) X += w[k] * mesh_.X[patch.nodes[k]];
  return {best, X};
}

// The nodes near the way of the indenter: it is followed in steps of half the smallest distance of
// nodes, and the surface may come towards it by `moves`.
std::vector<int> SurfaceCheck::reached(const RigidContact& contact, double moves) const {
  double shortest = std::numeric_limits<double>::infinity();
  double step = 0;
  for (int n : nodes_) shortest = std::min(shortest, spacing_[n]);
  std::vector<Vec3> way{Vec3::Zero()};
  for (const Waypoint& w : contact.motion) {
    const Vec3 from = way.back();
    const double length = (w.to - from).norm();
    const int parts =
        static_cast<int>(std::clamp(std::ceil(length / (0.5 * shortest)), 1.0, 400.0));
    step = std::max(step, length / parts);
    for (int k = 1; k <= parts; ++k)
      way.push_back(from + (static_cast<double>(k) / parts) * (w.to - from));
  }
  std::vector<double> least;
  double depth = 0;
  for (int n : nodes_) {
    double gap = std::numeric_limits<double>::infinity();
    for (const Vec3& c : way) gap = std::min(gap, shape_at(contact.shape, mesh_.X[n] - c).gap);
    least.push_back(gap);
    depth = std::max(depth, -gap);
  }
  std::vector<int> nodes;
  // the factors are not round, so that no node of a regular mesh is exactly on the limit
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    if (least[i] <= 0.2517 * depth + 2.0013 * spacing_[nodes_[i]] + 0.5 * step + moves)
      nodes.push_back(nodes_[i]);
  return nodes;
}

// The boundary of a body fills the whole solid angle around a point inside, and a total of zero
// around a point outside; of a section, the same in the plane.
bool SurfaceCheck::inside_body(const Vec3& p, const std::vector<Vec3>& x) const {
  double angle = 0;
  for (const auto& quads : quads_)
    for (const auto& q : quads) {
      const Vec3 a = x[q[0]] - p;
      const Vec3 b = x[q[1]] - p;
      const Vec3 d = x[q[2]] - p;
      const Vec3 e = x[q[3]] - p;
      if (mesh_.section)
        angle += std::atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
      else
        angle += solid_angle(a, b, d) + solid_angle(a, d, e);
    }
  const double half_of_all = mesh_.section ? std::numbers::pi : 2 * std::numbers::pi;
  return std::abs(angle) > half_of_all;
}

// How far the surface is pressed in a direction: the largest displacement of its nodes minus the
// smallest one [mm].
double SurfaceCheck::pressed_along(Vec3 along, const std::vector<Vec3>& u) const {
  if (mesh_.section) {  // components that vanish by the symmetry of the section
    along[2] = 0;
    if (mesh_.section->of == SectionOf::axisymmetric) along[0] = 0;
  }
  if (along.isZero(0)) return 0;
  along.normalize();
  double most = -std::numeric_limits<double>::infinity();
  double fewest = -most;
  for (int n : nodes_) {
    most = std::max(most, along.dot(u[n]));
    fewest = std::min(fewest, along.dot(u[n]));
  }
  return most - fewest;
}

SurfaceLook SurfaceCheck::look(const RigidContact& contact, const std::vector<Vec3>& u,
                               const Vec3& c, const std::vector<Vec3>& r) const {
  SurfaceLook found;
  std::vector<Vec3> x = mesh_.X;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += u[i];
  std::vector<char> candidate(x.size(), 0), touches(x.size(), 0);
  Vec3 along = Vec3::Zero();
  for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
    candidate[contact.nodes[i]] = 1;
    if (r.empty() || r[i].isZero(0)) continue;
    touches[contact.nodes[i]] = 1;
    ++found.touching;
    along += r[i];
  }
  for (const HangingNode& h : mesh_.hanging) candidate[h.node] = 1;  // a point of a facet
  std::vector<double> gap(x.size(), std::numeric_limits<double>::infinity());
  for (int n : nodes_) {
    const double g = gap[n] = shape_at(contact.shape, x[n] - c).gap;
    if (g < found.distance) {
      found.distance = g;
      found.nearest = mesh_.X[n];
    }
    if (!candidate[n] && -g > found.node.depth) found.node = {-g, mesh_.X[n]};
  }
  const double width = half_width(contact.shape);
  for (std::size_t k = 0; k < patches_.size(); ++k) {
    const Patch& patch = patches_[k];
    if (patch.axis) continue;
    double size = 0;
    double least = std::numeric_limits<double>::infinity();
    bool touched = false;
    for (int n : patch.nodes) {
      size = std::max(size, (x[n] - x[patch.nodes[0]]).norm());
      least = std::min(least, gap[n]);
      touched = touched || touches[n];
    }
    const double a = half_diagonal(patch);
    if (touched) found.spacing = std::min(found.spacing, a);
    for (const auto& q : quads_[k])
      found.whole_facet =
          found.whole_facet || std::all_of(q.begin(), q.end(), [&](int n) { return touches[n]; });
    // every point of the facet is within its diameter of each node
    if (!touched && least - size > std::max(0.0, found.distance)) continue;
    const Deepest d = deepest(patch, contact, x, c);
    if (d.gap < found.distance) {
      found.distance = d.gap;
      found.nearest = d.X;
    }
    if (!(d.gap < -1e-9)) continue;
    found.spacing = std::min(found.spacing, a);
    if (-d.gap > found.facet.depth) found.facet = {-d.gap, d.X};
    const double ratio = -d.gap / std::min(a, width);
    if (ratio > found.unresolved_ratio) {
      found.unresolved_ratio = ratio;
      found.unresolved = {-d.gap, d.X};
    }
  }
  if (found.touching == 0 && found.distance > -1e-9)
    if (const auto p = point_inside(contact.shape)) found.swallowed = inside_body(*p + c, x);
  if (along.isZero(0) && found.distance < 0) {
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      if ((mesh_.X[i] - found.nearest).norm() < (mesh_.X[nearest] - found.nearest).norm())
        nearest = i;
    along = shape_at(contact.shape, x[nearest] - c).normal;
  }
  found.pressed = pressed_along(along, u);
  return found;
}

}  // namespace langer
