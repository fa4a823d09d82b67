// The contact law linearised where an increment stands, on the compliance of the body: the
// reactions after the next movement.
//                                                                                      [A23] eqs 22-32
// The body's last factor gives what forces on the candidates move them; the law on those that may
// close is condensed to them (contact/local_problem.hpp), and where springs hold the body they are
// taken out again (contact/supported_problem.hpp).
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

// move: of a node without any change of reaction [mm]. Nothing where no finite answer is found.
using MoveOfNode = std::function<Vec3(int node)>;
std::optional<ContactChange> linearised_contact(const ContactState& state,
                                                const TangentFactor& factor,
                                                const MoveOfNode& move);

}  // namespace langer
