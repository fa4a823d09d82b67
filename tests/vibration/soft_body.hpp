// A soft neo-Hookean body of the density of skin, for closed forms.
#pragma once

#include <numbers>

namespace langer::test {

inline constexpr double pi = std::numbers::pi;
inline constexpr double rho = 1.1e-9;  // t/mm3
inline constexpr double a1 = 0.01;     // MPa; the shear modulus is 2 a1

}  // namespace langer::test
