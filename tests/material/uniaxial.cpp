// The uniaxial state: free lateral faces, limits, symmetries, and the loss of it.
#include "mechanics/material/uniaxial.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "core/tensor/stress.hpp"
#include "material/catalogue.hpp"
#include "support/near.hpp"

using namespace langer;

TEST_CASE("the lateral faces are free, for every law, compressed and stretched") {
  for (const NamedMaterial& named : catalogue())
    for (double lambda : {0.5, 0.9, 0.999, 1., 1.001, 1.2, 1.6}) {
      CAPTURE(named.name);
      CAPTURE(lambda);
      const Uniaxial u = uniaxial(named.material, lambda);
      REQUIRE(u.converged);
      // the product of three stretches is rounded to some eps of 1, whatever J - 1 is
      CHECK(u.stretch.prod() - 1 == near(u.J_minus_1, 1e-12, 2e-15));
      const Mat3 F = u.stretch.asDiagonal();
      const Mat3 sigma = cauchy(
          F, response(named.material, F * F, u.J_minus_1, fibre_directions(named.material)).S);
      // the sum of iso- and volumetric stress of an order of 1 MPa
      CHECK(std::abs(sigma(1, 1)) <= 1e-13);
      CHECK(std::abs(sigma(2, 2)) <= 1e-13);
      CHECK(std::abs(sigma(0, 0) - u.sigma) <= 1e-13 * std::max(1., std::abs(u.sigma)));
      if (lambda == 1) CHECK(std::abs(u.sigma) <= 1e-15);
    }
}

TEST_CASE("small strains give Young's modulus and Poisson's ratio") {
  const double a1 = 0.3, d = 0.5, mu = 2 * a1, kappa = 2 / d;
  const Material m{{NeoHooke{a1}}, {}, {QuadraticVolume{d}}};
  const double e = 1e-7;  // the error is of the order of the strain
  const Uniaxial u = uniaxial(m, 1 + e);
  CHECK(u.sigma / e == near(9 * kappa * mu / (3 * kappa + mu), 5e-7));
  CHECK((1 - u.stretch[1]) / e == near((3 * kappa - 2 * mu) / (2 * (3 * kappa + mu)), 1e-6));
  CHECK(u.stretch[1] == near(u.stretch[2], 1e-15));
}

TEST_CASE(
    "the incompressible stress is the limit of the compressible one, with an error proportional to d") {
  for (double alpha : {0., 30., 60.}) {
    const double limit = uniaxial_incompressible(positive_hgo_yeoh(alpha), 1.4).sigma;
    double before = 0;
    for (double d : {1e-3, 1e-4, 1e-5, 1e-6}) {
      const double error = std::abs(uniaxial(positive_hgo_yeoh(alpha, d), 1.4).sigma - limit);
      if (before > 0) CHECK(before / error == near(10, 0.02));
      before = error;
    }
    CHECK(before <= 1e-6 * limit);
  }
}

TEST_CASE(
    "fibres at alpha and at -alpha pull alike, and an isotropic material does not know alpha") {
  for (double alpha : {20., 45., 80.}) {
    const Uniaxial plus = uniaxial(positive_hgo_yeoh(alpha), 1.3),
                   minus = uniaxial(positive_hgo_yeoh(-alpha), 1.3);
    CHECK(plus.sigma == near(minus.sigma, 1e-13));
    CHECK(plus.stretch[2] == near(minus.stretch[2], 1e-13));
  }
}

TEST_CASE("a slack fibre leaves the matrix: along the fibre in compression, across it in tension") {
  Material matrix = positive_hgo_yeoh();
  matrix.fibres.clear();
  CHECK(uniaxial(positive_hgo_yeoh(0), 0.7).sigma == near(uniaxial(matrix, 0.7).sigma, 1e-14));
  CHECK(uniaxial(positive_hgo_yeoh(90), 1.4).sigma == near(uniaxial(matrix, 1.4).sigma, 1e-14));
}

TEST_CASE("the switch on I4 agrees with the switch on I4_bar where the volume does not change") {
  Material m = positive_hgo_yeoh(30, 1e-6);
  const double sigma = uniaxial(m, 1.3).sigma;
  m.fibres[0].tension_switch = FibreSwitch::I4;
  CHECK(uniaxial(m, 1.3).sigma == near(sigma, 1e-13));
}

TEST_CASE("the stress is the slope of the energy stored along the pull") {
  //   dW/dlnlambda = tau_x = J sigma,  the lateral faces doing no work
  for (double lambda : {0.8, 1.2, 1.5}) {
    const Material m = positive_hgo_yeoh(30, 0.5);
    const auto energy = [&](double l) {
      const Mat3 F = uniaxial(m, l).stretch.asDiagonal();
      return response(m, F * F, fibre_directions(m)).W;
    };
    const double h = 1e-4,
                 slope = (energy(lambda * std::exp(h)) - energy(lambda * std::exp(-h))) / (2 * h);
    const Uniaxial u = uniaxial(m, lambda);
    CHECK(slope == near((1 + u.J_minus_1) * u.sigma, 1e-6));
  }
}

TEST_CASE(
    "a state that does not exist is reported: impossible stretches, and an energy without lowest value") {
  CHECK(!uniaxial(positive_hgo_yeoh(), 0).converged);
  CHECK(!uniaxial(positive_hgo_yeoh(), -1).converged);
  CHECK(!uniaxial(positive_hgo_yeoh(), std::nan("")).converged);
  CHECK(!uniaxial(positive_hgo_yeoh(), 1e200).converged);
  // c1 < 0: beyond a stretch the fibre turned across lowers the energy without end
  CHECK(uniaxial(table1_hgo_yeoh(30, 0.5), 1.6).converged);
  CHECK(!uniaxial(table1_hgo_yeoh(30, 0.5), 2.5).converged);
}

TEST_CASE(
    "the negative fibre modulus of Table 1 lets the stress peak at stretch 1.627 with 1.091 MPa and vanish at 1.73") {
  double peak = 0, at = 0, vanishes = 0;
  for (double l = 1.5; l < 1.8 && vanishes == 0; l += 1e-4) {
    const double sigma = uniaxial_incompressible(table1_hgo_yeoh(), l).sigma;
    if (sigma > peak) peak = sigma, at = l;
    if (sigma < 0) vanishes = l;
  }
  CHECK(std::abs(peak - 1.091) <= 5e-4);
  CHECK(std::abs(at - 1.627) <= 5e-4);
  CHECK(std::abs(vanishes - 1.73) <= 5e-3);
}
