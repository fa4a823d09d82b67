// The shear modulus at rest if the tests hardly determine it (docs/identification.md).
//
// Fits to J-shaped curves often put it at 0, or so close that noise decides. A body of such a
// material cannot be solved: its tangent at rest is singular. Moduli that the tests cannot
// distinguish from 0 describe them equally well, so the smallest distinguishable one is used:
//   least  = noise / |s|,  s_i = w_i (stress of a neo-Hookean matrix of mu = 1 MPa at point i)
// the standard error that mu would have if the tests were to find nothing else. All values together
// move by one standard deviation of the noise: chi-square rises by 1, by less where other
// parameters follow.
#pragma once

#include <optional>
#include <string>

#include "identification/fit/fit.hpp"
#include "mechanics/material/raised_stiffness.hpp"

namespace langer {

std::string in_words(const StiffnessAtRest& s);

// standard deviation of a residual: what the fit misses by, and no less than `part` of the largest
// stress
double residual_noise(const FitProblem& problem, const FitResult& fit, double part);

// infinity where the tests do not strain the matrix at all
double least_shear_modulus(const FitProblem& problem, double noise);

// Where the law's shear modulus is below the least one: raises the lower bound of one number of the
// matrix (of those with FreeParameter::preset the one that costs least), fits again and changes
// `problem` and `fit`. Nothing where the modulus is above, or no bound may be raised.
std::optional<StiffnessAtRest> stiffen_at_rest(FitProblem& problem, FitResult& fit,
                                               const FitOptions& options, double part);

}  // namespace langer
