// An energy term: a scalar function of one scalar invariant, with two derivatives.    [A23] eqs
// 13-15 Laws are written once for any number type T (double, packets of doubles); `exp` and friends
// are found by lookup. Two kinds of matrix terms are more than that: sums of a function of I1_bar
// and one of I2_bar (Mooney-Rivlin), and sums over the principal stretches (Ogden).
#pragma once

#include <concepts>

namespace langer {

template <class T>
struct Energy {
  T W;    // [MPa]
  T dW;   // first derivative with respect to the invariant [MPa]
  T ddW;  // second derivative [MPa]
};

// what a matrix term is a function of
enum class Invariant { I1_bar, I2_bar, I1_bar_and_I2_bar, squared_stretches };

// An energy term gives the energy and its derivatives at a value of its invariant.
template <class Term>
concept EnergyTerm = requires(const Term& term, double x) {
  { term(x) } -> std::same_as<Energy<double>>;
};

}  // namespace langer
