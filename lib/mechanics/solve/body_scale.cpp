#include "mechanics/solve/body_scale.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/mesh/bounding_box.hpp"

namespace langer {

BodyScale scale_of(const Assembler& body) {
  constexpr double negligible = 1e-14;
  BodyScale scale;
  scale.length = bounding_box(body.mesh().X).size().maxCoeff();
  double stiffest = 0;
  for (const Material& material : body.materials())
    stiffest = std::max(stiffest, std::abs(shear_modulus(material)));
  scale.least_force = negligible * stiffest * scale.length * scale.length;
  return scale;
}

}  // namespace langer
