#include "mechanics/solve/edge_slip.hpp"

namespace langer {

std::optional<int> node_past_edge(const IndenterIncrement& increment) {
  constexpr double cosine = 0.5;  // of 60 degrees
  const RigidContact& contact = increment.contact;
  for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
    if (increment.r[i].isZero(0)) continue;
    const int node = contact.nodes[i];
    const Vec3 begin = increment.X[node] + increment.u0.segment<3>(3 * node) - increment.c0;
    const Vec3 end = increment.X[node] + increment.u.segment<3>(3 * node) - increment.c;
    const Vec3 before = shape_at(contact.shape, begin).normal;
    const Vec3 now = shape_at(contact.shape, end).normal;
    if (before.dot(now) < cosine) return node;
  }
  return std::nullopt;
}

}  // namespace langer
