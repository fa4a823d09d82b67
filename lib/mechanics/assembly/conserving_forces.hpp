// Internal forces of a body over an increment that keep energy and angular momentum
// (element/conserving_solid.hpp), in the place of those of one state.
//
// The unknown of such an increment is u_m = (u0 + u1) / 2. The symmetric part of an element's
// derivative goes to the tangent. The skew part is kept by elements; its products with movements
// make the corrections of Newton's method exact.
#pragma once

#include <vector>

#include "mechanics/assembly/body_model.hpp"
#include "mechanics/assembly/element_packets.hpp"
#include "mechanics/assembly/pressure_field.hpp"

namespace langer {

class ConservingForces {
 public:
  explicit ConservingForces(const BodyModel& body) : body_(body) {}  // refers to the body

  // An increment from u0; assemblies are those of increments from now on.
  void begin(const VecX& u0);
  bool active() const { return u0_.size() > 0; }

  // Block b at u_m, as ElementPackets::evaluate() has it at u: force, energy at the end, mean
  // dilatations, and with_tangent the symmetric part of the stiffness.
  void evaluate(const ElementPackets::Block& block, const VecX& u_m, const PressureField& pressures,
                bool with_tangent, PacketElement& out);

  // The skew part of the last tangent times a movement du of u_m, (3 n) [N].
  VecX skew_times(const VecX& du) const;

 private:
  const BodyModel& body_;
  VecX u0_;                 // empty: not active
  std::vector<MatX> skew_;  // by element
};

}  // namespace langer
