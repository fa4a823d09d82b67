// The sum of isochoric energy terms at one state, for any number type. Assembly, checks of
// stability, homogeneous tests and fits all evaluate a material through these functions.
//   for_each_term(material, state, on)   on(kind, Energy) for each term in the order of the material: its value and derivatives with
//                                        respect to its invariant; zero, or left out, for fibres that are slack
//   kinds  OfI1, OfI2                    a term of I1_bar, of I2_bar; a term of both comes as one of each
//          result of state.family()      of a fibre family: I_k, and further members for the caller
//          const Ogden&                  the term itself, without a value: a sum over the stretches
// Kinds for which `on` has no overload are left out. matrix_terms() and fibre_terms() are the two
// halves.
// A state has
//   I1_bar(), I2_bar()   the invariants (the latter where `on` takes OfI2)
//   m()                  I3^(-1/3)
//   family(fibre, k)     with the member I = I_k (material.hpp) of the k-th family
// Invariants outside the domain of a term become NaN before it is evaluated (existence.hpp).
#pragma once

#include <concepts>

#include "mechanics/material/existence.hpp"
#include "mechanics/material/fibre_switch.hpp"
#include "mechanics/material/material.hpp"

namespace langer {

struct OfI1 {};
struct OfI2 {};

// one function out of several lambdas
template <class... On>
struct Overloaded : On... {
  using On::operator()...;
};
template <class... On>
Overloaded(On...) -> Overloaded<On...>;

template <class T>
Energy<T> fibre_energy(const Fibre& fibre, const T& I_k) {
  return std::visit([&](const auto& law) { return law(nan_outside_domain(law, I_k)); }, fibre.law);
}

template <class T, class State>
void matrix_terms(const Material& material, const State& state, auto&& on) {
  using On = decltype(on);
  for (const MatrixTerm& term : material.matrix)
    std::visit(
        [&]<class Law>(const Law& law) {
          if constexpr (Law::of == Invariant::I1_bar) {
            on(OfI1{}, law(nan_outside_domain(law, T(state.I1_bar()))));
          } else if constexpr (Law::of == Invariant::squared_stretches) {
            if constexpr (std::invocable<On, const Law&>) on(law);
          } else if constexpr (std::invocable<On, OfI2, Energy<T>>) {
            if constexpr (Law::of == Invariant::I2_bar) {
              on(OfI2{}, law(nan_outside_domain(law, T(state.I2_bar()))));
            } else {
              on(OfI1{}, law.of_I1(T(state.I1_bar())));
              on(OfI2{}, law.of_I2(T(state.I2_bar())));
            }
          }
        },
        term);
}

template <class T, class State>
void fibre_terms(const Material& material, const State& state, auto&& on) {
  for (std::size_t k = 0; k < material.fibres.size(); ++k) {
    const Fibre& fibre = material.fibres[k];
    if (!acts(fibre)) continue;
    const auto family = state.family(fibre, k);
    const T tension = stretched(fibre.tension_switch, T(family.I), T(state.m()));
    if constexpr (std::is_same_v<T, double>) {
      if (!std::isless(tension, 0)) on(family, fibre_energy(fibre, family.I));
    } else {
      const Energy<T> e = fibre_energy(fibre, family.I);
      on(family, Energy<T>{where_not_negative(tension, e.W), where_not_negative(tension, e.dW),
                           where_not_negative(tension, e.ddW)});
    }
  }
}

template <class T, class State>
void for_each_term(const Material& material, const State& state, auto&& on) {
  matrix_terms<T>(material, state, on);
  fibre_terms<T>(material, state, on);
}

}  // namespace langer
