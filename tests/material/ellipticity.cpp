// Strong ellipticity: the modulus at rest, the definition by differences of the energy, and where
// Table 1's law loses it.
#include "mechanics/material/ellipticity.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <random>

#include "core/tensor/kinematics.hpp"
#include "material/catalogue.hpp"
#include "mechanics/material/uniaxial.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

double stiffness(const Material& m, const Mat3& F) {
  return smallest_shear_stiffness(m, F, fibre_directions(m)).value;
}

Mat3 uniaxial_state(const Material& m, double lambda) {
  return uniaxial_incompressible(m, lambda).stretch.asDiagonal();
}

}  // namespace

TEST_CASE(
    "at rest the smallest shear stiffness of the matrix is its shear modulus, in every direction") {
  const Material m{{Yeoh{0.3, 0.7, 0.1}}, {}, {QuadraticVolume{1}}};
  CHECK(stiffness(m, Mat3::Identity()) == near(0.6, 1e-14));
  const Mat3 R = Eigen::AngleAxisd(0.8, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  CHECK(stiffness(m, R) == near(0.6, 1e-14));
}

TEST_CASE(
    "the stiffness is the second derivative of the energy along a shear of the deformed state, and none is smaller") {
  std::mt19937 rng(41);
  std::uniform_real_distribution<double> x(-0.3, 0.3);
  // laws of both invariants, and one of the stretches, whose stiffness is found in another way
  for (const Material& m :
       {table1_hgo_yeoh(30), Material{{MooneyRivlin{0.1, 0.2}}, {}, {QuadraticVolume{1}}},
        Material{{Ogden{0.2, 3, -0.05, -2}}, {}, {QuadraticVolume{1}}}})
    for (int trial = 0; trial < 10; ++trial) {
      const auto a = fibre_directions(m);
      const Mat3 H = Mat3::NullaryExpr([&] { return x(rng); });
      const Mat3 F = deformation_gradient(H) / std::cbrt(deformation_gradient(H).determinant());
      if (!a.empty() && std::abs((F * a[0]).squaredNorm() - 1) < 0.02)
        continue;  // the fibre's switch
      const ShearStiffness s = smallest_shear_stiffness(m, F, a);
      CHECK(std::abs(s.n.dot(s.m)) <= 1e-12);
      const auto second_derivative = [&](const Vec3& n, const Vec3& across) {
        const double h = 1e-3;
        const auto W = [&](double k) {
          const Mat3 G = (Mat3::Identity() + k * across * n.transpose()) * F;
          return isochoric(m, right_cauchy_green(G), a, false).W;
        };
        return (-W(2 * h) + 16 * W(h) - 30 * W(0) + 16 * W(-h) - W(-2 * h)) / (12 * h * h);
      };
      // h^4 times a sixth derivative, and eps/h^2
      CHECK(second_derivative(s.n, s.m) == near(s.value, 1e-7));
      for (int sample = 0; sample < 200; ++sample) {
        const Vec3 n = Vec3::NullaryExpr([&] { return x(rng); }).normalized();
        const Vec3 across = n.cross(Vec3::NullaryExpr([&] { return x(rng); })).normalized();
        CHECK(second_derivative(n, across) >= s.value - 1e-7);
      }
    }
}

TEST_CASE("Table 1's HGO-Yeoh law loses strong ellipticity where c1 < 0 takes over") {
  const auto lost_between = [](double before, double after, const Material& m, const auto& F) {
    CHECK(stiffness(m, F(before)) > 0);
    CHECK(stiffness(m, F(after)) < 0);
  };
  // uniaxial tension; the fit ends at a stretch of 1.60
  const double angle[] = {0, 15, 30, 45}, lambda[] = {1.64, 1.64, 1.81, 2.43};
  for (int i = 0; i < 4; ++i) {
    CAPTURE(angle[i]);
    const Material m = table1_hgo_yeoh(angle[i]);
    lost_between(lambda[i] - 0.01, lambda[i], m, [&](double l) { return uniaxial_state(m, l); });
  }
  lost_between(1.84, 1.85, table1_hgo_yeoh(),
               [](double l) { return Mat3(Vec3(l, 1 / (l * l), l).asDiagonal()); });
  lost_between(1.09, 1.10, table1_hgo_yeoh(45), [](double gamma) {
    Mat3 F = Mat3::Identity();
    F(0, 2) = gamma;
    return F;
  });
}

TEST_CASE("with a positive fibre modulus it is kept up to stretch 3") {
  for (double alpha : {0., 30., 60., 90.}) {
    Material m = table1_hgo_yeoh(alpha);
    std::get<HgoFibre>(m.fibres[0].law).c1 = 0.317;
    for (double l = 1; l <= 3; l += 0.05) CHECK(stiffness(m, uniaxial_state(m, l)) > 0);
  }
}

TEST_CASE("Yeoh's column of Table 1 is unstable at rest") {
  const Material m{{Yeoh{-0.059, 0.291, 0.016}}, {}, {QuadraticVolume{1}}};
  CHECK(stiffness(m, Mat3::Identity()) == near(-0.118, 1e-13));
}

namespace {

// laws with moduli of either sign, one or two families and terms of both invariants
Material any_law(std::mt19937& rng) {
  std::uniform_real_distribution<double> x(-1, 1);
  Material m{{Yeoh{0.2 + 0.3 * x(rng), 0.3 * x(rng), 0.1 * x(rng)}}, {}, {QuadraticVolume{1}}};
  if (x(rng) > 0) m.matrix.push_back(MooneyRivlin{0.1 * x(rng), 0.1 * x(rng)});
  const int families = x(rng) > 0 ? 2 : 1;
  for (int k = 0; k < families; ++k) {
    Fibre fibre{HgoFibre{0.5 * x(rng), 1 + x(rng)}, 90 * x(rng)};
    if (x(rng) > 0) fibre.kappa = 0.15 * (1 + x(rng));
    m.fibres.push_back(fibre);
  }
  return m;
}

Mat3 any_state(std::mt19937& rng) {
  std::uniform_real_distribution<double> x(-0.4, 0.4);
  const Mat3 F = Mat3::Identity() + Mat3::NullaryExpr([&] { return x(rng); });
  return F / std::cbrt(F.determinant());
}

}  // namespace

TEST_CASE(
    "no wave of a dense grid is less stiff than the smallest stiffness, and one is nearly so") {
  std::mt19937 rng(7);
  for (int trial = 0; trial < 40; ++trial) {
    CAPTURE(trial);
    const Material m = any_law(rng);
    const Mat3 F = any_state(rng);
    const auto a = fibre_directions(m);
    const ShearStiffness s = smallest_shear_stiffness(m, F, a);
    const double sampled = sampled_shear_stiffness(m, F, a, 10000);
    CHECK(s.value <= sampled + 1e-12 * s.size);
    // a normal of the grid is at most 0.03 from the best one; a stiffness is a form of degree four
    // in the normal and the polarisation
    CHECK(s.value >= sampled - 16 * 0.03 * 0.03 * s.size);
  }
}

TEST_CASE("the sign of the smallest stiffness needs no smallest stiffness") {
  std::mt19937 rng(11);
  int positive = 0;
  int negative = 0;
  for (int trial = 0; trial < 200; ++trial) {
    CAPTURE(trial);
    const Material m = any_law(rng);
    const Mat3 F = any_state(rng);
    const auto a = fibre_directions(m);
    const double value = smallest_shear_stiffness(m, F, a).value;
    const double sign = sign_of_shear_stiffness(m, F, a);
    CHECK(sign == (value > 0) - (value < 0));
    positive += value > 0;
    negative += value < 0;
  }
  CHECK(positive > 20);
  CHECK(negative > 20);
}
