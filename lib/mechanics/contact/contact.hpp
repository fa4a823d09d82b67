// A rigid indenter against nodes of the body: kinematics, linearisation, and the error with which a
// state satisfies the contact law.
//                                                                                      [A23] section 2.4
// At a candidate with position x and start-of-increment position x0, the indenter displaced by c
// (c0 at the start):
//   gap g and normal n of the shape at x - c;   v = (x - x0) - (c - c0);   slip x_t = v - (v.n) n
// The law holds at the END of the increment: x_n is the gap there, x_t the slip of the whole
// increment. An indenter that turns about its axis of revolution keeps its shape; only the slip
// changes. A point of its surface at x0 moves to
//   x0 + (R - 1)(x0 - c0 - p),  p a point of the axis, R the rotation of the increment,
// and the slip is measured from there (Increment::begin).
// Reactions r are global vectors acting on the body; r_n = r.n >= 0.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/history.hpp"
#include "mechanics/contact/adhesion.hpp"
#include "mechanics/contact/local_problem.hpp"
#include "mechanics/contact/rigid.hpp"

namespace langer {

using Waypoint = HistoryPoint<Vec3>;  // displacement of the indenter [mm]

// Force control: the travel of the indenter along a direction is unknown, the sum of its reactions
// along it is given.
struct ForceControl {
  Vec3 along = -Vec3::UnitY();  // of length 1
  History force;                // [N] on the body, not negative
  // With a mass its force follows from its own motion (dynamics/inertia.hpp); `force` is 0.
  double mass = 0;      // [t]
  double velocity = 0;  // along its direction at the beginning [mm/s]
  bool free() const { return mass > 0; }
};

struct Rotation {
  Line axis;      // of the shape before it moves
  History angle;  // [rad]
};

struct RigidContact {
  std::string name;
  Indenter shape;
  double mu = 0;
  std::vector<int> nodes;        // candidates
  std::vector<Waypoint> motion;  // ascending t; under force control what is across its direction
  std::optional<ForceControl> control = {};
  bool in_proportion = false;  // its displacement is t times the only waypoint, also beyond it
  std::optional<Rotation> rotation = {};
  std::optional<Adhesion> adhesion = {};
  std::vector<double> area =
      {};  // with adhesion: what each candidate has of the surface at rest [mm^2]
};

// travel: along the direction of its control [mm]
Vec3 indenter_displacement(const RigidContact& contact, double t, double travel = 0);

// The displacement of a point at x that sticks to an indenter while this turns by `angle`; c is the
// displacement of the indenter [mm].
inline Vec3 carried(const RigidContact& contact, double angle, const Vec3& x, const Vec3& c) {
  if (!contact.rotation || angle == 0) return Vec3::Zero();
  return turned_by(contact.rotation->axis.along, angle, x - c - contact.rotation->axis.point);
}

// Orthonormal columns n, t1, t2.
Mat3 contact_frame(const Vec3& n);

// The contact of one candidate, linearised for a movement d of the node, in local components (n,
// t1, t2):
//   position  x = q + T d,   reaction force  r + D d  (it turns with the frame)
struct LinearisedContact {
  Mat3 frame;  // columns n, t1, t2
  Vec3 q;
  Mat3 T;
  Mat3 D;
};
LinearisedContact linearise(const RigidContact& contact, const Vec3& x, const Vec3& x0,
                            const Vec3& c, const Vec3& c0, const Vec3& r);

// r turned by the smallest rotation that takes n_old to n_new
Vec3 turn_with_normal(const Vec3& r, const Vec3& n_old, const Vec3& n_new);

// How well a state satisfies the contact law: each measure is zero if it does so exactly.
struct ContactDefect {
  double penetration = 0;  // largest -gap, or |gap| where there is a reaction [mm]
  double cone = 0;         // largest of |r_t| - mu r_n and -r_n, relative to the largest reaction
  double complementarity =
      0;  // largest |r.(x_t + (x_n + mu |x_t|) n)|, relative to largest reaction times motion
  int open = 0, stick = 0, slip = 0;
  Vec3 force = Vec3::Zero();  // sum of the reactions on the body [N]
  std::vector<ContactStatus> status;
  std::vector<double> gap;  // [mm]
};
// The torque of the indenter, displaced by c, on the body about its axis [N mm]. x: position of the
// candidates
double torque(const RigidContact& contact, const std::function<Vec3(int node)>& x, const Vec3& c,
              const std::vector<Vec3>& r);

// u, u0: (3 n) displacements now and at the start of the increment; r: one per candidate;
// motion: what moves the scene in this increment [mm], for the relative measure where nothing slips
ContactDefect contact_defect(const RigidContact& contact, const std::vector<Vec3>& X, const VecX& u,
                             const VecX& u0, const Vec3& c, const Vec3& c0,
                             const std::vector<Vec3>& r, double motion);

}  // namespace langer
