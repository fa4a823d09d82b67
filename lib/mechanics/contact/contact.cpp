#include "mechanics/contact/contact.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace langer {

Vec3 indenter_displacement(const RigidContact& contact, double t, double travel) {
  Vec3 moved = Vec3::Zero();
  if (contact.in_proportion && !contact.motion.empty())
    moved = t * contact.motion.back().to;
  else if (!contact.motion.empty())
    moved = value_at(contact.motion, t);
  if (contact.control) return Vec3(moved + travel * contact.control->along);
  return moved;
}

Mat3 contact_frame(const Vec3& n) {
  // the axis that is least aligned with n: the cross product never vanishes
  int axis = 0;
  n.cwiseAbs().minCoeff(&axis);
  Mat3 frame;
  frame.col(0) = n;
  frame.col(1) = Vec3::Unit(axis).cross(n).normalized();
  frame.col(2) = n.cross(frame.col(1));
  return frame;
}

// Derivatives of gap and slip, and of a reaction that turns with the frame, for a movement d of the
// node. Both follow from the curvature of the shape.
LinearisedContact linearise(const RigidContact& contact, const Vec3& x, const Vec3& x0,
                            const Vec3& c, const Vec3& c0, const Vec3& r) {
  LinearisedContact out;
  const ShapePoint shape = shape_at(contact.shape, x - c);
  out.frame = contact_frame(shape.normal);
  const Vec3 v = out.frame.transpose() * ((x - x0) - (c - c0));
  out.q = Vec3(shape.gap, v[1], v[2]);
  const auto tangents = out.frame.rightCols<2>();
  const Eigen::Matrix2d curvature = tangents.transpose() * shape.curvature * tangents;
  // d(t.v) = (1 - v_n curvature) d_t, since dt = -(t.dn) n
  out.T = Mat3::Identity();
  out.T.bottomRightCorner<2, 2>() -= v[0] * curvature;
  // dn = curvature d, dt = -(t.dn) n:   d(frame r) = r_n curvature d - n (r_t.curvature d)
  const Vec3 r_local = out.frame.transpose() * r;
  out.D.setZero();
  out.D.topRightCorner<1, 2>() = -r_local.tail<2>().transpose() * curvature;
  out.D.bottomRightCorner<2, 2>() = r_local[0] * curvature;
  return out;
}

Vec3 turn_with_normal(const Vec3& r, const Vec3& n_old, const Vec3& n_new) {
  const Vec3 axis = n_old.cross(n_new);
  const double cosine = n_old.dot(n_new);
  // A node that has jumped across the indenter has no meaningful rotation: the next iteration
  // decides.
  if (cosine <= -0.5) return r;
  return cosine * r + axis.cross(r) + axis * (axis.dot(r) / (1 + cosine));
}

double torque(const RigidContact& contact, const std::function<Vec3(int node)>& x, const Vec3& c,
              const std::vector<Vec3>& r) {
  const Line& axis = contact.rotation.value().axis;
  double sum = 0;
  for (std::size_t i = 0; i < r.size(); ++i)
    if (!r[i].isZero(0)) sum += axis.along.dot(cross(x(contact.nodes[i]) - c - axis.point, r[i]));
  return sum;
}

ContactDefect contact_defect(const RigidContact& contact, const std::vector<Vec3>& X, const VecX& u,
                             const VecX& u0, const Vec3& c, const Vec3& c0,
                             const std::vector<Vec3>& r, double motion) {
  ContactDefect defect;
  double largest = 0, moved = 0;
  for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
    const int node = contact.nodes[i];
    largest = std::max(largest, r[i].norm());
    motion = std::max(motion, (u.segment<3>(3 * node) - u0.segment<3>(3 * node) - (c - c0)).norm());
    moved = std::max(moved, u.segment<3>(3 * node).norm());
  }
  // If nothing moves in the increment, the measured motion is rounding: then the displacements
  // give the scale.
  motion = std::max(motion, 1e-2 * moved);
  const double tiny = std::numeric_limits<double>::min();
  for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
    const int node = contact.nodes[i];
    const Vec3 x = X[node] + u.segment<3>(3 * node);
    const ShapePoint shape = shape_at(contact.shape, x - c);
    const double g = shape.gap;
    defect.gap.push_back(g);
    const bool closed = r[i].squaredNorm() > 0;
    const double violation = closed ? std::abs(g) : -g;
    defect.penetration = std::max(defect.penetration, violation);
    if (!closed) {
      defect.status.push_back(ContactStatus::open);
      ++defect.open;
      continue;
    }
    const Vec3& n = shape.normal;
    const Vec3 v = u.segment<3>(3 * node) - u0.segment<3>(3 * node) - (c - c0);
    const Vec3 x_t = v - v.dot(n) * n;
    // A gap below the rounding of the positions counts as zero. For a sphere of 1e5 mm that is
    // 1e-11 mm.
    const double curved = shape.curvature.norm();
    double radius = 0;
    if (curved > 0) radius = 1 / curved;
    const double far = x.norm() + c.norm() + radius;
    double seen = 0;
    if (std::abs(g) > 8 * std::numeric_limits<double>::epsilon() * far) seen = g;
    const double r_n = r[i].dot(n);
    const double r_t = (r[i] - r_n * n).norm();
    const double slip = x_t.norm();
    defect.cone = std::max({defect.cone, (r_t - contact.mu * r_n) / largest, -r_n / largest});
    // the complementarity product; without friction only its normal part
    double power = r_n * seen;
    if (contact.mu > 0) power = r[i].dot(x_t) + r_n * (seen + contact.mu * slip);
    defect.complementarity =
        std::max(defect.complementarity, std::abs(power) / std::max(largest * motion, tiny));
    const bool sticks = contact.mu > 0 && r_t < contact.mu * r_n * (1 - 1e-9);
    if (sticks) {
      defect.status.push_back(ContactStatus::stick);
      ++defect.stick;
    } else {
      defect.status.push_back(ContactStatus::slip);
      ++defect.slip;
    }
    defect.force += r[i];
  }
  return defect;
}

}  // namespace langer
