// The contact law linearised where an increment stands, on the compliance of the body: the reactions after the next movement.
//                                                                                      [A23] eqs 22-32
// The body's last factor gives what forces on the candidates move them; the law on those that may close is condensed to them
// (contact/local_problem.hpp), and where springs hold the body they are taken out again (contact/supported_problem.hpp).
#pragma once

#include <optional>
#include <vector>

#include "contact/contact.hpp"
#include "solve/tangent_factor.hpp"

namespace langer {

// per contact, per candidate: reaction on the body [N], global
using Reactions = std::vector<std::vector<Vec3>>;

struct ContactState {
  const std::vector<RigidContact>& contacts;
  const std::vector<Vec3>& X;
  const VecX& u;                        // (3 n) of the trial
  const std::vector<VecX>& u_start;     // by contact: what the increment's slip is measured from
  const std::vector<Vec3>&c, &c_start;  // by contact: displacement of the indenter, and where the increment began
  const Reactions& r;
  // of the contact under force control, if there is one
  int controlled = -1;
  double force = 0;  // sum of its reactions along its direction [N]
};

struct ContactChange {
  VecX force;         // change of the contact forces on the rows of factor.last() [N]
  Reactions r;        // after the movement, in the frames before it
  double travel = 0;  // of the indenter under force control, in this movement [mm]
  int sweeps = 0;
};

// move: of the rows of factor.last() without any change of reaction [mm]. Nothing where no finite answer is found.
std::optional<ContactChange> linearised_contact(const ContactState& state, const TangentFactor& factor, const VecX& move);

}  // namespace langer
