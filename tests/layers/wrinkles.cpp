// First wrinkles of half-spaces and of a stiff film on a soft half-space.
#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "layers/wrinkle.hpp"
#include "mechanics/material/states.hpp"
#include "support/near.hpp"

using namespace langer;

namespace wrinkles_tests {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

Layer neo_hooke(double a1, double thickness) {
  const Material material{.matrix = {NeoHooke{a1}}, .fibres = {}, .volume = QuadraticVolume{1e-6}};
  return {"layer", material, {}, thickness, 1.1e-9};
}

WrinkleProblem half_space(WidthUnderCompression width) {
  WrinkleProblem problem;
  problem.layers = {neo_hooke(0.01, infinite)};
  problem.width = width;
  return problem;
}

// A film of thickness 1 and modulus `contrast` on a half-space of modulus 1, both neo-Hooke, in
// plane strain: motions exp(i k x) f(y), f a sum of exp(s k y) with s = 1 and s = m = lambda^2 for
// the stretches (lambda, 1/lambda). Continuity of both displacements and both tractions, and a free
// surface, are six equations for six amplitudes (Dowaikh and Ogden 1990; Cao and Hutchinson 2012).
// Their determinant is 0 at a wrinkle. The film is h = 1/lambda thick.
double determinant(double contrast, double lambda, double k) {
  const double alpha = lambda * lambda;
  const double gamma = 1 / alpha;
  const double m = alpha;  // lambda_1 / lambda_2
  const double kh = k / lambda;
  using Row4 = Eigen::Vector4d;
  // displacements f' and f, tractions along x and y over the modulus
  const auto wave = [&](double s) {
    return Row4(s, 1, gamma * (s * s + 1), (alpha + 2 * gamma) * s - gamma * s * s * s);
  };
  Eigen::Matrix<double, 6, 6> A = Eigen::Matrix<double, 6, 6>::Zero();
  const double exponents[4] = {1, -1, m, -m};
  for (int j = 0; j < 4; ++j) {
    const double s = exponents[j];
    const Row4 w = wave(s);
    // growing ones are scaled to 1 at the surface, falling ones at the interface
    const double at_surface = s > 0 ? 1 : std::exp(s * kh);
    const double at_interface = s > 0 ? std::exp(-s * kh) : 1;
    A.block<2, 1>(0, j) = at_surface * w.tail<2>();
    A.block<2, 1>(2, j) = at_interface * w.head<2>();
    A.block<2, 1>(4, j) = at_interface * contrast * w.tail<2>();
  }
  for (int j = 0; j < 2; ++j) {
    const Row4 w = wave(j == 0 ? 1 : m);
    A.block<2, 1>(2, 4 + j) = -w.head<2>();
    A.block<2, 1>(4, 4 + j) = -w.tail<2>();
  }
  return A.determinant();
}

struct Exact {
  double strain = 1, wavelength = 0;  // in film thicknesses, deformed
};

// The compression of a wave: the first change of sign of the determinant.
double exact_strain(double contrast, double k) {
  constexpr double step = 2e-4;
  double before = determinant(contrast, 1 - step, k);
  for (double strain = 2 * step; strain < 0.6; strain += step) {
    const double here = determinant(contrast, 1 - strain, k);
    if ((here < 0) != (before < 0)) {
      double low = strain - step;
      double high = strain;
      for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (low + high);
        const bool after = (determinant(contrast, 1 - middle, k) < 0) != (before < 0);
        (after ? high : low) = middle;
      }
      return 0.5 * (low + high);
    }
    before = here;
  }
  return 1;
}

Exact exact_film(double contrast) {
  // k of the film's thickness at rest
  const auto strain = [&](double log_k) {
    return exact_strain(contrast, std::exp(log_k));
  };
  const double guess = std::log(std::cbrt(3 / contrast));
  double low = guess - 1;
  double high = std::min(guess + 1, std::log(5.0));
  for (int i = 0; i < 40; ++i) {
    const double a = low + (high - low) / 3;
    const double b = high - (high - low) / 3;
    if (strain(a) < strain(b)) {
      high = b;
    } else {
      low = a;
    }
  }
  const double k = std::exp(0.5 * (low + high));
  const double e = exact_strain(contrast, k);
  // over the deformed thickness 1 / lambda
  return {e, 2 * std::numbers::pi / k * (1 - e)};
}

}  // namespace

TEST_CASE("a half-space loses its flat surface where Biot says") {
  // the ratio of the stretches along and through the depth is the root of x^3 + x^2 + 3 x - 1
  const double root = 0.29559774252208393;
  CHECK(first_wrinkle(half_space(WidthUnderCompression::held), 0).s == near(std::sqrt(root), 1e-6));
  CHECK(first_wrinkle(half_space(WidthUnderCompression::equal), 0.3).s ==
        near(std::cbrt(root), 1e-6));
  CHECK(first_wrinkle(half_space(WidthUnderCompression::free), 0).s ==
        near(std::cbrt(root * root), 1e-6));
  const Wrinkle any = first_wrinkle(half_space(WidthUnderCompression::held), 0);
  CHECK(any.kind == Wrinkle::Kind::surface);
  CHECK(std::isnan(any.wavelength));
}

TEST_CASE("a sheared half-space wrinkles across its shortest direction") {
  WrinkleProblem problem = half_space(WidthUnderCompression::held);
  problem.load = WrinkleLoad::shear;
  const Wrinkle found = first_wrinkle(problem, 0);
  // the smallest stretch in the plane over that through the depth, 1, is the root of Biot's cubic
  const double root = 0.29559774252208393;
  CHECK(found.s == near(1 / root - root, 1e-5));
  CHECK(std::tan(found.wave_angle) == near(-1 / root, 1e-3));
}

TEST_CASE("a film of the law of its base has no wavelength of its own") {
  WrinkleProblem problem;
  problem.layers = {neo_hooke(0.01, 1), neo_hooke(0.01, infinite)};
  const Wrinkle found = first_wrinkle(problem, 0);
  CHECK(found.kind == Wrinkle::Kind::surface);
  CHECK(std::isnan(found.wavelength));
  CHECK(found.s == near(std::sqrt(0.29559774252208393), 1e-5));
}

TEST_CASE("a layer that is unstable before the pinch is told from one that never wrinkles") {
  WrinkleProblem problem = half_space(WidthUnderCompression::held);
  problem.prestretch(0, 0) = 0.5;
  CHECK(first_wrinkle(problem, 0).kind == Wrinkle::Kind::at_once);
  problem.prestretch(0, 0) = 1;
  problem.limit = 0.6;
  CHECK(first_wrinkle(problem, 0).kind == Wrinkle::Kind::none);
}

TEST_CASE("a stiff film wrinkles as the exact solution of two layers says") {
  for (const double contrast : {2.0, 5.0, 30.0, 100.0, 1000.0}) {
    CAPTURE(contrast);
    WrinkleProblem problem;
    problem.layers = {neo_hooke(0.01 * contrast, 1), neo_hooke(0.01, infinite)};
    const Wrinkle found = first_wrinkle(problem, 0);
    const Exact exact = exact_film(contrast);
    CHECK(found.kind == Wrinkle::Kind::wavy);
    CHECK(1 - found.s == near(exact.strain, 1e-5));
    CHECK(found.wavelength * found.s == near(exact.wavelength, 1e-4));
  }
}

}  // namespace wrinkles_tests
