// The stiffness of a law at rest. Fibres add none to a shear across them, however stiff: only the
// matrix does, its shear modulus. Without it the tangent of a body at rest is singular, and no
// first step can be found.
#pragma once

#include <string>

#include "mechanics/material/material.hpp"

namespace langer {

enum class AtRest { stiff, without_stiffness, unstable };

// without stiffness: |mu| <= 1e-12 of the largest modulus of the law
AtRest at_rest(const Material& material);

// "no stiffness at rest: the shear modulus of yeoh is 0 MPa"; empty where it is stiff
std::string at_rest_in_words(const Material& material);

// the numbers that would give stiffness, and what does: "matrix.yeoh.a1 above 0; ..."
std::string stiffness_at_rest_cure(const Material& material);

}  // namespace langer
