// A matrix material that is a polynomial of the invariants, with all its terms added up:
//   W = sum I1[i-1] (I1_bar - 3)^i + sum I2[i-1] (I2_bar - 3)^i,  i = 1, 2, 3;  coefficients in MPa
#pragma once

#include <optional>
#include <string>

#include "core/base/text.hpp"
#include "mechanics/material/material.hpp"

namespace langer {

struct Polynomial {
  double I1[3] = {}, I2[3] = {};

  // Adds a term; false if it is not a polynomial.
  bool add(const MatrixTerm& term) {
    if (const auto* t = std::get_if<NeoHooke>(&term)) {
      I1[0] += t->a1;
    } else if (const auto* t = std::get_if<Yeoh>(&term)) {
      I1[0] += t->a1;
      I1[1] += t->a2;
      I1[2] += t->a3;
    } else if (const auto* t = std::get_if<YeohI2>(&term)) {
      I2[0] += t->b1;
      I2[1] += t->b2;
      I2[2] += t->b3;
    } else if (const auto* t = std::get_if<MooneyRivlin>(&term)) {
      I1[0] += t->c10;
      I2[0] += t->c01;
    } else if (const auto* t = std::get_if<Signorini>(&term)) {
      I1[0] += t->c10;
      I1[1] += t->c20;
      I2[0] += t->c01;
    } else {
      return false;
    }
    return true;
  }
  bool of_I1() const { return I2[0] == 0 && I2[1] == 0 && I2[2] == 0; }
  bool linear() const { return I1[1] == 0 && I1[2] == 0 && I2[1] == 0 && I2[2] == 0; }
  bool neo_hookean() const { return of_I1() && linear(); }
};

// The matrix as a polynomial; nothing if one of its terms is not.
inline std::optional<Polynomial> polynomial(const Material& material) {
  Polynomial p;
  for (const MatrixTerm& term : material.matrix)
    if (!p.add(term)) return std::nullopt;
  return p;
}

// The names of its terms.
inline std::string matrix_words(const Material& material) {
  std::string words;
  for (const MatrixTerm& term : material.matrix)
    append(words, " + ", std::visit([](const auto& t) -> std::string { return t.key; }, term));
  return words;
}

}  // namespace langer
