// How far an indenter that is pushed along a direction goes until it touches, and from where a node
// slips that it touches.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "mechanics/contact/contact.hpp"

namespace langer {

// Travel at which the nearest candidate is touched, t and `from` to begin with [mm]; nothing where
// it passes all of them by. position: of a node [mm]. Under force control.
std::optional<double> travel_to_touch(const RigidContact& contact, double t, double from,
                                      const std::function<Vec3(int node)>& position);
// Derivative of that travel where the nodes there move by `moved` and the indenter, across its
// direction, stands still.
double change_of_touch(const RigidContact& contact, double t, double travel,
                       const std::function<Vec3(int node)>& position,
                       const std::function<Vec3(int node)>& moved);

// A candidate at X from the start of an increment (displacement u0 of the node, c0 of the indenter)
// to where the last movement goes on to (u, c), while the indenter turns by `angle`. A node that is
// open at the start slips only from where it touches: at the share of that movement that its gap
// takes to close. Without this its reaction is that of a slip it never made, an error of first
// order in the increment. What touches an indenter that turns is carried along from there.
struct Approach {
  Vec3 X, u0, u, c0, c;
  double angle = 0;
};
// displacement from which its slip is measured; u0 where the node touches (within `tolerance`) an
// indenter that does not turn
Vec3 slips_from(const RigidContact& contact, const Approach& a, double tolerance);
// derivative where u0, u, c0, c change by those of `d`
Vec3 change_of_slips_from(const RigidContact& contact, const Approach& a, const Approach& d,
                          double tolerance);

// An increment as the start of slip sees it; refers to its arguments.
struct IncrementMove {
  const std::vector<Vec3>& X;
  const VecX &u0, &expected;  // (3 n): where it began, where the last movement goes on to
  double t0 = 0, travel0 = 0, t = 0, travel = 0;  // of the indenter, under force control
  Approach of(const RigidContact& contact, int node) const;
};
// by candidate: derivative of slips_from with respect to the travel of a pushed indenter
std::vector<Vec3> change_of_slips_with_travel(const RigidContact& contact,
                                              const IncrementMove& move, double tolerance);

}  // namespace langer
