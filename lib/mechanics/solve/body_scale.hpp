// What is large and what is nothing for a body: a length and a force that grow with it.
//
// Limits of an iteration in mm and N would hold for a body of some mm only: in metres or
// micrometres, or of stone, the same scene would take other iterations. So they follow from the
// body: its largest extent, and a force that its stiffness resists without a visible movement.
#pragma once

#include "mechanics/assembly/assembler.hpp"

namespace langer {

struct BodyScale {
  double length = 1;       // largest extent [mm]
  double least_force = 0;  // 1e-14 of the largest shear modulus times length^2 [N]
};
BodyScale scale_of(const Assembler& body);

}  // namespace langer
