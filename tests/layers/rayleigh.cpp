// Waves on a half-space and body waves against closed forms.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "layers/guided_wave.hpp"
#include "mechanics/material/states.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double a1 = 0.02;         // MPa
constexpr double density = 1.1e-9;  // t/mm3

Material neo_hooke() {
  return {.matrix = {NeoHooke{a1}}, .fibres = {}, .volume = QuadraticVolume{1e-6}};
}

LayerStack half_space(const Material& material, double along, double across,
                      Dilatation dilatation = Dilatation::incompressible) {
  Layer layer{"skin", material, specimen_fibres(material, 0), infinite, density};
  PlaneDeformation F = PlaneDeformation::Zero();
  F(0, 0) = along;
  F(1, 1) = across;
  return {{layer_state(layer, F, dilatation)}};
}

// rho c^2 / (2 a1) of a Rayleigh wave along a principal direction: Dowaikh and Ogden (1990)
double rayleigh(double along, double depth) {
  // real root of x^3 + x^2 + 3 x - 1
  double eta = 0.3;
  for (int i = 0; i < 50; ++i) {
    eta -= (eta * eta * eta + eta * eta + 3 * eta - 1) / (3 * eta * eta + 2 * eta + 3);
  }
  return along * along - eta * eta * depth * depth;
}

double square_over_modulus(const GuidedWave& wave) {
  return density * wave.speed * wave.speed / (2 * a1);
}

}  // namespace

TEST_CASE("a Rayleigh wave on stretched neo-Hooke has the speed of Dowaikh and Ogden") {
  for (const double stretch : {1.0, 1.2, 0.8}) {
    for (const double across : {1.0, 1.1}) {
      const LayerStack body = half_space(neo_hooke(), stretch, across);
      const double depth = 1 / (stretch * across);
      const GuidedWave along = guided_wave(body, {.angle = 0});
      REQUIRE(along.exists);
      CHECK(std::sqrt(square_over_modulus(along)) ==
            near(std::sqrt(rayleigh(stretch, depth)), 1e-6));
      const GuidedWave beside = guided_wave(body, {.angle = std::numbers::pi / 2});
      CHECK(std::sqrt(square_over_modulus(beside)) ==
            near(std::sqrt(rayleigh(across, depth)), 1e-6));
    }
  }
}
