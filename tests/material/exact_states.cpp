// Homogeneous states of an incompressible material, against values computed independently and
// against closed forms.
#include <doctest/doctest.h>

#include <cmath>

#include "core/tensor/kinematics.hpp"
#include "core/tensor/stress.hpp"
#include "material/catalogue.hpp"
#include "mechanics/material/material.hpp"
#include "mechanics/material/uniaxial.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

constexpr double half_last_digit = 5.01e-7;  // of values given with six decimals

// Cauchy stress with the pressure that frees the y faces
Mat3 stress_free_in_y(const Material& material, const Mat3& F) {
  const Mat3 sigma =
      cauchy(F, isochoric(material, right_cauchy_green(F), fibre_directions(material)).S, 1);
  return sigma - sigma(1, 1) * Mat3::Identity();
}

void check(double value, double expected) { CHECK(std::abs(value - expected) <= half_last_digit); }

}  // namespace

TEST_CASE("uniaxial tension along the fibre") {
  const double lambda[] = {1.1, 1.2, 1.3, 1.4}, sigma[] = {0.083312, 0.208735, 0.408943, 0.740122};
  for (int i = 0; i < 4; ++i)
    check(uniaxial_incompressible(positive_hgo_yeoh(), lambda[i]).sigma, sigma[i]);
}

TEST_CASE("equibiaxial tension, one direction along the fibre") {
  const double lambda[] = {1.1, 1.2, 1.3, 1.4};
  const double sigma_x[] = {0.115724, 0.314544, 0.684382, 1.351518},
               sigma_z[] = {0.064227, 0.180246, 0.415355, 0.855348};
  for (int i = 0; i < 4; ++i) {
    const double l = lambda[i];
    const Mat3 sigma = stress_free_in_y(positive_hgo_yeoh(), Vec3(l, 1 / (l * l), l).asDiagonal());
    check(sigma(0, 0), sigma_x[i]);
    check(sigma(2, 2), sigma_z[i]);
  }
}

TEST_CASE("tension off the fibre with F diagonal and free lateral faces") {
  const double alpha[] = {15, 30, 45, 60};
  const double sigma[] = {0.641678, 0.443926, 0.297223, 0.244924},
               lambda_z[] = {0.829974, 0.810661, 0.813910, 0.841729};
  for (int i = 0; i < 4; ++i) {
    const Uniaxial u = uniaxial_incompressible(positive_hgo_yeoh(alpha[i]), 1.4);
    check(u.sigma, sigma[i]);
    check(u.stretch[2], lambda_z[i]);
    const Mat3 stress = stress_free_in_y(positive_hgo_yeoh(alpha[i]), u.stretch.asDiagonal());
    CHECK(std::abs(stress(2, 2)) <= 1e-14);
    CHECK(stress(0, 0) == near(u.sigma, 1e-13));
  }
}

TEST_CASE("simple shear along x in planes z") {
  const double alpha[] = {0, 45, 90}, sigma[] = {0.078750, 0.184156, 0.104223};
  for (int i = 0; i < 3; ++i) {
    Mat3 F = Mat3::Identity();
    F(0, 2) = 0.5;
    check(stress_free_in_y(positive_hgo_yeoh(alpha[i]), F)(0, 2), sigma[i]);
  }
}

TEST_CASE("Table 1's HGO-Yeoh material: along the fibre, and off it at 60 percent strain") {
  const double sigma[] = {0.0119, 0.0136, 0.0709, 0.2659, 0.6472, 1.0564};
  for (int i = 0; i < 6; ++i)
    CHECK(std::abs(uniaxial_incompressible(table1_hgo_yeoh(), 1.1 + 0.1 * i).sigma - sigma[i]) <=
          5.01e-5);
  const double alpha[] = {30, 45, 60, 90}, off_axis[] = {4.7342, 6.0854, 6.5310, 6.5595};
  for (int i = 0; i < 4; ++i)
    CHECK(std::abs(uniaxial_incompressible(table1_hgo_yeoh(alpha[i]), 1.6).sigma - off_axis[i]) <=
          5.01e-5);
}

TEST_CASE("uniaxial tension along the fibre is the closed form") {
  //   sigma = 2 (lambda^2 - 1/lambda) W_1 + 2 lambda^2 W_4
  for (const Material& m : {positive_hgo_yeoh(), table1_hgo_yeoh()})
    for (double l : {1.001, 1.1, 1.3, 1.6}) {
      const double W_1 = std::get<Yeoh>(m.matrix[0])(l * l + 2 / l).dW,
                   W_4 = std::get<HgoFibre>(m.fibres[0].law)(l * l).dW;
      const double first = 2 * (l * l - 1 / l) * W_1, second = 2 * l * l * W_4;
      CHECK(std::abs(uniaxial_incompressible(m, l).sigma - first - second) <=
            1e-13 * (first + std::abs(second)));
    }
}
