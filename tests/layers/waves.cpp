// Waves against closed forms: any incompressible law, layers, branches, compressible solids.
#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>
#include <complex>
#include <numbers>

#include "layers/guided_wave.hpp"
#include "mechanics/material/states.hpp"
#include "support/near.hpp"

using namespace langer;

namespace waves_tests {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double pi = std::numbers::pi;
constexpr double density = 1.1e-9;  // t/mm3

Material fibrous() {
  Material material{
      .matrix = {Yeoh{0.02, 0.02, 0.01}}, .fibres = {}, .volume = QuadraticVolume{1e-6}};
  material.fibres = {Fibre{.law = HgoFibre{0.05, 0.6}}};
  return material;
}

Material neo_hooke(double a1) {
  return {.matrix = {NeoHooke{a1}}, .fibres = {}, .volume = QuadraticVolume{1e-6}};
}

LayerState stretched(const Material& material, double along, double across, double thickness,
                     Dilatation dilatation = Dilatation::incompressible) {
  PlaneDeformation F = PlaneDeformation::Zero();
  F(0, 0) = along;
  F(1, 1) = across;
  return layer_state({"skin", material, specimen_fibres(material, 0), thickness, density}, F,
                     dilatation);
}

// rho c^2 of a surface wave along the principal direction i, depth y: Dowaikh and Ogden (1990).
// alpha = A_iyiy and gamma = A_yiyi are those without the pressure, which the free surface fixes.
double dowaikh_ogden(const LayerState& state, int i) {
  const int y = 1;
  const auto A = [&](int a, int p, int b, int q) {
    return state.A(3 * a + p, 3 * b + q);
  };
  const double alpha = A(y, i, y, i);  // u_y,i
  const double gamma = A(i, y, i, y);  // u_i,y
  const double two_beta = A(i, i, i, i) + A(y, y, y, y) - 2 * A(i, i, y, y) - 2 * A(i, y, y, i);
  double low = 0;
  double high = 1;
  const double factor = (two_beta + 2 * gamma - alpha) / gamma;
  const auto cubic = [&](double eta) {
    return eta * eta * eta + eta * eta + factor * eta - 1;
  };
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high);
    (cubic(middle) < 0 ? low : high) = middle;
  }
  return alpha - gamma * low * low;
}

}  // namespace

TEST_CASE("a surface wave in a fibrous law has the speed of Dowaikh and Ogden's cubic") {
  for (const double along : {1.0, 1.1, 1.25}) {
    for (const double across : {0.95, 1.15}) {
      const LayerState state = stretched(fibrous(), along, across, infinite);
      for (const int axis : {0, 2}) {
        const GuidedWave wave = guided_wave({{state}}, {.angle = axis == 0 ? 0 : pi / 2});
        REQUIRE(wave.exists);
        CAPTURE(along);
        CAPTURE(across);
        CAPTURE(axis);
        CHECK(density * wave.speed * wave.speed == near(dowaikh_ogden(state, axis), 2e-6));
      }
    }
  }
}

TEST_CASE("moduli of a stretched layer are the second derivative of its energy") {
  Material material = fibrous();
  material.volume = QuadraticVolume{20};
  const std::vector<Vec3> a = specimen_fibres(material, 25);
  PlaneDeformation F2;
  F2 << 1.15, 0.04, -0.02, 1.05;
  const Layer layer{"skin", material, a, infinite, density};
  const LayerState state = layer_state(layer, F2, Dilatation::compressible);
  REQUIRE(state.exists);
  CHECK(std::abs(state.sigma(1, 1)) < 1e-12);
  const auto energy = [&](const Mat3& H) {
    const Mat3 F = (Mat3::Identity() + H) * state.F;
    return response(material, F.transpose() * F, a).W / state.F.determinant();
  };
  // the bulk modulus is left out of A: it belongs to div u
  const double h = 1e-4;
  for (const auto& [m, n] : {std::pair(1, 1), {1, 3}, {3, 3}, {2, 6}, {5, 7}, {2, 2}, {0, 2}}) {
    Mat3 M = Mat3::Zero();
    Mat3 N = Mat3::Zero();
    M(m / 3, m % 3) = h;
    N(n / 3, n % 3) = h;
    const double second =
        (energy(M + N) - energy(M - N) - energy(N - M) + energy(-M - N)) / (4 * h * h);
    const bool has_volume = m % 4 == 0 && n % 4 == 0;
    CHECK_FALSE(has_volume);
    CHECK(state.A(m, n) == near(second, 1e-4, 3e-4));
  }
}

TEST_CASE("body waves in stretched neo-Hooke do not depend on their polarisation") {
  const LayerState state = stretched(neo_hooke(0.02), 1.3, 0.9, infinite);
  const double stretch[3] = {1.3, 1 / (1.3 * 0.9), 0.9};
  for (int axis = 0; axis < 3; ++axis) {
    for (const double rho_c2 : body_waves(state, Vec3::Unit(axis))) {
      CHECK(rho_c2 == near(2 * 0.02 * stretch[axis] * stretch[axis], 1e-12));
    }
  }
}

TEST_CASE("a layer on a fixed base carries Love's wave as its slowest at long wavelengths") {
  const double thickness = 2;
  const double k = 0.05;
  const LayerState state = stretched(neo_hooke(0.02), 1.2, 1, thickness);
  const GuidedWave wave =
      guided_wave({{state}}, {.angle = 0, .wavenumber = k, .mode = WaveMode::slowest});
  REQUIRE(wave.exists);
  const double quarter = pi / (2 * state.thickness);
  const double w2 = 0.04 * (1.2 * 1.2 * k * k + quarter * quarter / (1.2 * 1.2)) / density;
  CHECK(wave.frequency == near(std::sqrt(w2), 1e-6));
  CHECK(wave.group_speed == near(0.04 * 1.2 * 1.2 * k / (density * std::sqrt(w2)), 1e-5));
  const GuidedWave back =
      guided_wave({{state}}, {.angle = 0, .frequency = wave.frequency, .mode = WaveMode::slowest});
  REQUIRE(back.exists);
  CHECK(back.wavenumber == near(k, 1e-5));
}

TEST_CASE("a Rayleigh wave on a viscous half-space has the complex modulus of its branches") {
  Material material = neo_hooke(0.02);
  material.viscous = {{.tau = 1e-3, .gamma = 0.6}, {.tau = 1e-2, .gamma = 0.3}};
  const double w = 2 * pi * 150;
  const GuidedWave wave =
      guided_wave({{stretched(material, 1, 1, infinite)}}, {.angle = 0.4, .frequency = w});
  REQUIRE(wave.exists);
  std::complex<double> modulus = 0.04;
  for (const ViscousBranch& branch : *material.viscous) {
    const std::complex<double> x(0, -w * branch.tau);
    modulus += 0.04 * branch.gamma * x / (1. + x);
  }
  const double root = 0.29559774252208393;
  const std::complex<double> k = w / std::sqrt((1 - root * root) * modulus / density);
  CHECK(wave.wavenumber == near(k.real(), 1e-5));
  CHECK(wave.attenuation == near(k.imag(), 1e-5));
}

TEST_CASE("a compressible half-space at rest has Rayleigh's speed for its Poisson ratio") {
  Material material = neo_hooke(0.02);
  material.volume = QuadraticVolume{20};  // bulk modulus 0.1 MPa, shear modulus 0.04 MPa
  const LayerState state = stretched(material, 1, 1, infinite, Dilatation::compressible);
  CHECK(state.bulk == near(0.1));
  const double ratio = 0.04 / (0.1 + 4 * 0.04 / 3);  // of the squares of the body waves
  double low = 0.5;
  double high = 1;
  const auto equation = [&](double x) {
    return (2 - x) * (2 - x) - 4 * std::sqrt(1 - x) * std::sqrt(1 - ratio * x);
  };
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (equation(middle) < 0 ? low : high) = middle;
  }
  const GuidedWave wave = guided_wave({{state}}, {.angle = 1});
  REQUIRE(wave.exists);
  CHECK(wave.speed == near(std::sqrt(low * 0.04 / density), 1e-6));
}

TEST_CASE("a layer of two equal halves is one layer") {
  const LayerState whole = stretched(fibrous(), 1.1, 1, 2);
  const LayerState half = stretched(fibrous(), 1.1, 1, 1);
  const WaveQuery query{.angle = 0.5, .frequency = 2 * pi * 800};
  const GuidedWave one = guided_wave({{whole}}, query);
  const GuidedWave two = guided_wave({{half, half}}, query);
  REQUIRE(one.exists);
  REQUIRE(two.exists);
  CHECK(one.speed == near(two.speed, 1e-5));
  CHECK(one.mode == two.mode);
}

TEST_CASE("surface tension speeds up short waves as the capillary Rayleigh equation says") {
  const double tension = 5e-4;  // N/mm
  const double k = 20;
  LayerStack body{{stretched(neo_hooke(0.02), 1, 1, infinite)}};
  body.surface_tension = tension;
  // (2 - x)^2 - 4 sqrt(1 - x) = (tension k / mu) x,  x = rho c^2 / mu
  double low = 0.5;
  double high = 1;
  for (int i = 0; i < 100; ++i) {
    const double x = 0.5 * (low + high);
    const double left = (2 - x) * (2 - x) - 4 * std::sqrt(1 - x);
    (left < tension * k / 0.04 * x ? low : high) = x;
  }
  const GuidedWave wave = guided_wave(body, {.angle = 0, .wavenumber = k});
  REQUIRE(wave.exists);
  CHECK(wave.speed == near(std::sqrt(low * 0.04 / density), 1e-6));
}

TEST_CASE("body waves of a stretched half-space are no waves of the stiff layer on it") {
  for (const Dilatation dilatation : {Dilatation::incompressible, Dilatation::compressible}) {
    const LayerStack body{{stretched(fibrous(), 1.15, 1, 1.5, dilatation),
                           stretched(neo_hooke(0.002), 1.15, 1, infinite, dilatation)}};
    for (const double degrees : {0.0, 10.0, 20.0, 30.0, 45.0, 90.0}) {
      CAPTURE(degrees);
      const GuidedWave wave =
          guided_wave(body, {.angle = degrees * pi / 180, .frequency = 2 * pi * 500});
      CHECK(!wave.exists);
      CHECK(wave.reason.find("leaks") != std::string::npos);
    }
  }
}

TEST_CASE("waves askew to fibres and stretch have the speeds that the Stroh formalism gives") {
  // data/synthetic_waves.py without its noise: moduli by differences of the energy, three decaying
  // waves, singular stiffness of the surface
  Material material = neo_hooke(0.010);
  material.fibres = {Fibre{.law = HgoFibre{0.030, 0.9}}};
  PlaneDeformation F = PlaneDeformation::Identity();
  F(0, 0) = 1.12;
  const LayerStack body{
      {layer_state({"skin", material, specimen_fibres(material, 20), infinite, density}, F,
                   Dilatation::incompressible)}};
  const std::pair<double, double> speeds[] = {
      {0, 6049.433260},  {10, 6150.330452}, {20, 6151.130865},  {40, 5822.875411},
      {70, 4861.322886}, {90, 4294.550618}, {120, 4331.038908}, {160, 5586.817809}};
  for (const auto& [degrees, speed] : speeds) {
    const GuidedWave wave = guided_wave(body, {.angle = degrees * pi / 180});
    const auto shown = degrees;
    CAPTURE(shown);
    REQUIRE(wave.exists);
    CHECK(wave.speed == near(speed, 1e-6));
  }
}

}  // namespace waves_tests
