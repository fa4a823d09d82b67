// The stiffness of a material at rest. Fibres, however stiff, add nothing to a shear across them:
// only the shear modulus of the matrix does. Without it the tangent of a body at rest is singular,
// and Newton's method has no first step.
#pragma once

#include <string>

#include "mechanics/material/material.hpp"

namespace langer {

enum class AtRest { stiff, without_stiffness, unstable };

// without stiffness: |mu| <= 1e-12 of the largest modulus of the law
AtRest at_rest(const Material& material);

// "no stiffness at rest: the shear modulus of yeoh is 0 MPa"; empty where it is stiff
std::string at_rest_in_words(const Material& material);

// the parameters that would give stiffness: "matrix.yeoh.a1 other than 0; ..."
std::string stiffness_at_rest_cure(const Material& material);

}  // namespace langer
