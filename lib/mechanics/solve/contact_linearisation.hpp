// The contact law, linearised where an increment stands and condensed to the candidates.
//
// New reactions move the body, and the movement changes the reactions. Both follow from one small
// problem over the candidates that may close. In their frames (n, t1, t2), s is a change of the
// contact forces:
//   d = move + W s           movement; move: without s, W: compliance, from the body's last factor
//   r = present + s - E d    reaction; E: present reactions turn with the indenter; bonds; springs
//   x = q + T d              gap and slip that the law sees
// With A = 1 - E W this is r = b + A s. Where A is regular, s is eliminated:
//   x = W_r r + q_r,  W_r = T W A^-1       solved by contact/local_problem.hpp
// Where A is singular, as of a body that only contact holds, contact/supported_problem.hpp finds s.
// The travel of an indenter under force control is one more unknown, found by secants within
// bounds. The law of the cone holds exactly at each trial travel.            [A23] eqs 22-32
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "mechanics/solve/contact_state.hpp"
#include "mechanics/solve/tangent_factor.hpp"

namespace langer {

struct ContactChange {
  VecX force;         // change of the contact forces on the rows of factor.last() [N]
  Reactions r;        // after the movement, in the frames before it
  double travel = 0;  // of the indenter under force control, in this movement [mm]
  int sweeps = 0;
  // A level of candidates above that of the factor, one of which might close: then there is no
  // answer yet.
  std::optional<int> level = {};
};

// move: of a node without any change of reaction [mm], zero for those that the factor does not keep
// apart. Nothing where no finite answer is found.
using MoveOfNode = std::function<Vec3(int node)>;
std::optional<ContactChange> linearised_contact(const ContactState& state,
                                                const TangentFactor& factor,
                                                const MoveOfNode& move);

}  // namespace langer
