// J - 1 without cancellation, and stress measures.
#include "core/tensor/kinematics.hpp"

#include <doctest/doctest.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "core/tensor/stress.hpp"
#include "support/near.hpp"

using namespace langer;

TEST_CASE("J - 1 keeps its digits where det F - 1 has lost them") {
  // F = I + H with H = diag(t, -t, s): det F - 1 = -t^2 + s - s t^2
  const double t = 0x1p-20;
  const double s = 0x1p-60;
  const double exact = -t * t + s;
  Mat3 H = Mat3::Zero();
  H(0, 0) = t;
  H(1, 1) = -t;
  H(2, 2) = s;
  CHECK_FALSE(deformation_gradient(H).determinant() - 1 == near(exact, 1e-7));
  CHECK(volume_change(H) == near(exact, 1e-15));
  // a pure dilatation of the size of rounding
  CHECK(volume_change(1e-17 * Mat3::Identity()) == near(3e-17, 1e-15));
}

TEST_CASE("J - 1 and E agree with F for large strains") {
  Mat3 H;
  H << 0.3, -0.2, 0.1, 0.4, -0.1, 0.25, -0.3, 0.2, 0.15;
  const Mat3 F = deformation_gradient(H);
  CHECK(volume_change(H) == near(F.determinant() - 1, 1e-14));
  CHECK((2 * green_lagrange(H) + Mat3::Identity() - right_cauchy_green(F)).norm() <= 1e-15);
}

TEST_CASE(
    "von Mises of uniaxial stress is its size, of pressure nothing, and rotations change neither") {
  const Mat3 R = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const Mat3 uniaxial = Vec3(-2.5, 0, 0).asDiagonal();
  CHECK(von_mises(uniaxial) == near(2.5, 1e-15));
  CHECK(von_mises(R * uniaxial * R.transpose() + 7 * Mat3::Identity()) == near(2.5, 1e-14));
  CHECK(von_mises(7 * Mat3::Identity()) == 0);
  Mat3 shear = Mat3::Zero();
  shear(0, 2) = shear(2, 0) = 1;
  CHECK(von_mises(shear) == near(std::sqrt(3.), 1e-15));
  const Vec3 p = principal_stresses(R * shear * R.transpose());
  CHECK((p - Vec3(1, 0, -1)).norm() <= 1e-14);
}

TEST_CASE("Cauchy stress turns with the body") {
  const Mat3 R = Eigen::AngleAxisd(1.1, Vec3(0, 1, 1).normalized()).toRotationMatrix();
  Mat3 F;
  F << 1.2, 0.1, 0, 0, 0.9, 0.2, 0.1, 0, 1.1;
  const Vec6 S = (Vec6() << 1, 2, 3, 0.4, 0.5, 0.6).finished();
  CHECK((cauchy(R * F, S) - R * cauchy(F, S) * R.transpose()).norm() <= 1e-14);
}
