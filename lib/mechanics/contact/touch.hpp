// The first touch within an increment.
//
// The contact law holds at the end of an increment, for the slip of all of it. A node that touches
// only on the way has slipped since its touch, not since the begin: the error would be of first
// order in the increment. So the slip is measured from the place where the node would touch if it
// went on as in the increment before:
//   gap(u0 + z (u - u0), c0 + z (c - c0)) = 0,   0 <= z <= 1,   origin u0 + z (u - u0)
// The same equation along its own direction gives the travel at which a force-controlled indenter
// touches the body.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "mechanics/contact/contact.hpp"

namespace langer {

// The travel at which a force-controlled indenter touches the first candidate, starting from the
// travel `from` at t [mm]; nothing if it passes all of them. position: of a node [mm].
std::optional<double> travel_to_touch(const RigidContact& contact, double t, double from,
                                      const std::function<Vec3(int node)>& position);
// The derivative of that travel if the nodes move by `moved` and the indenter does not move across
// its direction.
double touch_travel_change(const RigidContact& contact, double t, double travel,
                           const std::function<Vec3(int node)>& position,
                           const std::function<Vec3(int node)>& moved);

// A candidate at X: its displacement u0 and that of the indenter, c0, at the start of an increment;
// the displacements u and c to which the motion of the last increment would lead; the rotation of
// the indenter. A node that is open at the start can slip only after it touches, at the share of
// this motion at which its gap closes. Slip measured from the start would be too long by an error
// of first order in the increment. From its touch on, the node is carried along by a rotating
// indenter.
struct ExpectedMove {
  Vec3 X, u0, u, c0, c;
  double angle = 0;
  double gap0 = 0, gap = 0;  // of a change: what another shape adds to the gaps at u0 and at u
};
// The displacement from which the slip is measured: u0 if the node touches at the start (within
// `tolerance`) and the indenter does not turn.
Vec3 slip_origin(const RigidContact& contact, const ExpectedMove& a, double tolerance);
// Its derivative if u0, u, c0, c and the gaps change by those of `d`.
Vec3 slip_origin_change(const RigidContact& contact, const ExpectedMove& a, const ExpectedMove& d,
                        double tolerance);

// The motion in an increment, for all candidates; refers to its arguments.
struct IncrementMove {
  const std::vector<Vec3>& X;
  const VecX &u0, &expected;  // (3 n): where it began, where the last movement goes on to
  double t0 = 0, travel0 = 0, t = 0, travel = 0;  // of the indenter, under force control
  ExpectedMove of(const RigidContact& contact, int node) const;
};
// by candidate: derivative of slip_origin with respect to the travel of a pushed indenter
std::vector<Vec3> slip_origin_change_with_travel(const RigidContact& contact,
                                                 const IncrementMove& move, double tolerance);

}  // namespace langer
