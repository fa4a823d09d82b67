// Nodes of the body that passed an edge of an indenter within one increment.
//
// Contact is a law of the end of an increment: a node must not be inside the indenter there, and
// nothing asks how it came to its place. In a long increment a node under the face of a punch can
// so come to lie against its side wall. The law holds at every node, but the punch lost a part of
// its face: an equilibrium that no slow movement reaches.
//
// Such a node is known by the normals of the indenter. Where its increment begins the nearest point
// of the indenter is on the face, where it ends on the side wall, and the two normals differ by far
// more than those of a node that slides or comes to touch. In shorter increments the node touches
// the face first and stays there.
#pragma once

#include <optional>

#include "mechanics/contact/contact.hpp"

namespace langer {

// An increment of one indenter, displaced from c0 to c. u0, u: (3 n) displacements of the body.
struct IndenterIncrement {
  const RigidContact& contact;
  const std::vector<Vec3>& X;
  const VecX &u0, &u;
  Vec3 c0, c;
  const std::vector<Vec3>& r;  // by candidate: reaction at the end
};

// The first node that is pressed where the normal is another by more than 60 degrees than where the
// increment begins; nothing where there is none.
std::optional<int> node_past_edge(const IndenterIncrement& increment);

}  // namespace langer
