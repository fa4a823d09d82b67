// Ogden's law of one to three terms [O72]:
//   W = sum_p mu_p/alpha_p (l_1^alpha_p + l_2^alpha_p + l_3^alpha_p - 3),  l_a = J^(-1/3) lambda_a
//   mu_p [MPa], alpha_p [-]; the shear modulus at rest is sum mu_p alpha_p / 2. A term with mu_p = 0 is not there.
// Written in e = l^2, the eigenvalues of I3^(-1/3) C:  W = sum_a g(e_a),  g = sum_p mu_p/alpha_p
// (e^(alpha_p/2) - 1). The tangent needs (g'(e_a) - g'(e_b))/(e_a - e_b), which keeps its digits
// down to equal stretches.
#pragma once

#include <array>
#include <cmath>

#include "core/base/fields.hpp"
#include "core/base/search_bounds.hpp"
#include "mechanics/material/energy.hpp"

namespace langer {

struct Ogden {
  static constexpr const char* key = "ogden";
  static constexpr Invariant of = Invariant::squared_stretches;
  double mu1 = 0, alpha1 = 2, mu2 = 0, alpha2 = 2, mu3 = 0, alpha3 = 2;
  static void fields(auto& v) {
    constexpr SearchBounds powers{-20, 20, 1};
    v(&Ogden::mu1, "mu1", unit::MPa, "modulus of the first term", required, SignOf{"alpha1"});
    v(&Ogden::alpha1, "alpha1", unit::none, "power of the first term", required, powers);
    v(&Ogden::mu2, "mu2", unit::MPa, "modulus of the second term", SignOf{"alpha2"});
    v(&Ogden::alpha2, "alpha2", unit::none, "power of the second term", powers);
    v(&Ogden::mu3, "mu3", unit::MPa, "modulus of the third term", SignOf{"alpha3"});
    v(&Ogden::alpha3, "alpha3", unit::none, "power of the third term", powers);
  }
  struct Part {
    double mu, alpha;
  };
  std::array<Part, 3> parts() const { return {{{mu1, alpha1}, {mu2, alpha2}, {mu3, alpha3}}}; }

  // g, g', g'' at one squared stretch e > 0
  Energy<double> operator()(double e) const {
    Energy<double> s{};
    for (const auto& [mu, alpha] : parts()) {
      if (mu == 0) continue;
      const double log_e = std::log(e);
      const double up = std::expm1(alpha / 2 * log_e);
      const double q = alpha / 2 - 1;
      s.W += mu * (alpha == 0 ? log_e / 2 : up / alpha);
      const double slope = mu / 2 * (1 + up) / e;
      s.dW += slope;
      s.ddW += slope * q / e;
    }
    return s;
  }
  // (g'(e) - g'(f))/(e - f), and g'' where they are equal
  //   (e^q - f^q)/(e - f) = f^(q-1) expm1(q l)/expm1(l),  l = ln(e/f)
  double divided_difference(double e, double f) const {
    const double l = std::log1p((e - f) / f);
    double s = 0;
    for (const auto& [mu, alpha] : parts()) {
      if (mu == 0) continue;
      const double q = alpha / 2 - 1;
      s += mu / 2 * std::pow(f, q - 1) * (l == 0 ? q : std::expm1(q * l) / std::expm1(l));
    }
    return s;
  }
};

}  // namespace langer
