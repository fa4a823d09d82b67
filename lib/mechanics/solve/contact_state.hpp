// Where an increment with contact stands: positions, indenters, reactions, and what the slip is
// measured from. The contact law is linearised at this state (solve/contact_linearisation.hpp).
#pragma once

#include <vector>

#include "mechanics/contact/contact.hpp"
#include "mechanics/solve/bonds.hpp"

namespace langer {

// per contact, per candidate: reaction on the body [N], global
using Reactions = std::vector<std::vector<Vec3>>;

struct ContactState {
  const std::vector<RigidContact>& contacts;
  const std::vector<Vec3>& X;
  const VecX& u;                     // (3 n) of the trial
  const std::vector<VecX>& u_start;  // by contact: what the increment's slip is measured from
  const std::vector<Vec3>&c,
      &c_start;  // by contact: displacement of the indenter, and where the increment began
  const Reactions& r;
  // of the contact under force control, if there is one
  int controlled = -1;
  double force = 0;  // sum of its reactions along its direction [N]
  std::vector<Vec3> start_moves =
      {};  // by candidate: what its slip is measured from, per travel; empty without friction
  const Bonds* bonds = nullptr;  // of indenters that adhere
  double force_falls = 0;        // of an indenter with mass: what `force` loses per travel [N/mm]
};

}  // namespace langer
