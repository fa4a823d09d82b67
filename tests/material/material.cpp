// The law: S and D against differences of the energy, its symmetries, rest, the tension switch.
#include "mechanics/material/material.hpp"

#include <doctest/doctest.h>
#include <Eigen/Geometry>

#include <random>

#include "core/tensor/invariants.hpp"
#include "core/tensor/kinematics.hpp"
#include "core/tensor/stress.hpp"
#include "material/catalogue.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

Mat3 random_gradient(std::mt19937& rng, double size) {
  std::uniform_real_distribution<double> x(-size, size);
  Mat3 H;
  for (int i = 0; i < 9; ++i) H(i / 3, i % 3) = x(rng);
  return H;
}

Mat3 random_rotation(std::mt19937& rng) {
  std::normal_distribution<double> x;
  return Eigen::Quaterniond(x(rng), x(rng), x(rng), x(rng)).normalized().toRotationMatrix();
}

// any fibre close to its switch makes a difference quotient across the kink of D: such samples are
// skipped
bool near_switch(const std::vector<Vec3>& a, const Mat3& C) {
  const double m = std::cbrt(1 / (1 + determinant_minus_1(C - Mat3::Identity())));
  for (const Vec3& d : a)
    for (double I4 : {d.dot(C * d), m * d.dot(C * d)})
      if (std::abs(I4 - 1) < 0.01) return true;
  return false;
}

}  // namespace

TEST_CASE("S is the derivative of W and D the symmetric derivative of S, for every law") {
  std::mt19937 rng(21);
  for (const NamedMaterial& named : catalogue())
    for (int trial = 0; trial < 30; ++trial) {
      CAPTURE(named.name);
      CAPTURE(trial);
      const Mat3 C = right_cauchy_green(deformation_gradient(random_gradient(rng, 0.25)));
      const Mat3 frame = random_rotation(rng);
      const auto a = fibre_directions(named.material, frame);
      if (near_switch(a, C)) continue;
      const Response r = response(named.material, C, a);
      CHECK((r.D - r.D.transpose()).norm() <= 1e-14 * r.D.norm());
      // fourth-order central differences: h^4/30 times a fifth derivative, plus eps W/h
      const double h = 1e-3;
      Vec6 S;
      Mat6 D;
      for (int q = 0; q < 6; ++q) {
        Vec6 step = Vec6::Zero();  // of E, so that C changes by twice as much
        step[q] = q < 3 ? h : h / 2;
        const auto at = [&](double n) {
          return response(named.material, C + 2 * n * tensor(step), a);
        };
        const Response p1 = at(1), m1 = at(-1), p2 = at(2), m2 = at(-2);
        S[q] = (8 * (p1.W - m1.W) - (p2.W - m2.W)) / (12 * h);
        D.col(q) = (8 * (p1.S - m1.S) - (p2.S - m2.S)) / (12 * h);
      }
      CHECK((S - r.S).norm() <= 1e-7 * r.S.norm());
      CHECK((D - r.D).norm() <= 1e-7 * r.D.norm());
    }
}

TEST_CASE("the material at rest is free of stress, in every frame") {
  std::mt19937 rng(22);
  for (const NamedMaterial& named : catalogue())
    for (int trial = 0; trial < 10; ++trial) {
      CAPTURE(named.name);
      const auto a = fibre_directions(named.material, random_rotation(rng));
      const Response r = response(named.material, Mat3::Identity(), a);
      CHECK(r.W == near(0, 0, 1e-15 * r.D.norm()));
      CHECK(r.S.norm() <= 1e-14 * r.D.norm());
    }
}

TEST_CASE(
    "the tangent at rest is that of the moduli: 2 a1 in shear, 2/d in volume, c1 along the fibre") {
  const double a1 = 0.3, c1 = 0.2, d = 0.5;
  const Material material{{NeoHooke{a1}}, {hgo_fibre(c1, 0.3, 0)}, {QuadraticVolume{d}}};
  const Mat6 D = response(material, Mat3::Identity(), fibre_directions(material)).D;
  // shear modulus mu = 2 a1 for S_xy = mu (2 E_xy)
  for (int k = 3; k < 6; ++k) CHECK(D(k, k) == near(2 * a1, 1e-14));
  // trace of D over the normal components: 9 kappa, fibre and matrix being isochoric
  CHECK(D.topLeftCorner<3, 3>().sum() == near(9 * 2 / d, 1e-14));
  // 4 c1 (2/3)^2 + 4/3 mu + kappa
  CHECK(D(0, 0) == near(16. / 9 * c1 + 4. / 3 * 2 * a1 + 2 / d, 1e-14));
}

TEST_CASE("a rotation of the deformed body changes no energy and turns the stress with it") {
  std::mt19937 rng(23);
  for (const NamedMaterial& named : catalogue())
    for (int trial = 0; trial < 10; ++trial) {
      CAPTURE(named.name);
      const Mat3 F = deformation_gradient(random_gradient(rng, 0.25)), R = random_rotation(rng);
      const auto a = fibre_directions(named.material);
      if (near_switch(a, right_cauchy_green(F))) continue;
      const Response r = response(named.material, right_cauchy_green(F), a);
      const Response turned = response(named.material, right_cauchy_green(R * F), a);
      CHECK(turned.W == near(r.W, 1e-12));
      CHECK((cauchy(R * F, turned.S) - R * cauchy(F, r.S) * R.transpose()).norm() <=
            1e-12 * cauchy(F, r.S).norm());
    }
}

TEST_CASE(
    "rotations about the fibre and half turns across it are symmetries of the material, others are not") {
  std::mt19937 rng(24);
  const Material material = positive_hgo_yeoh(30, 0.5);
  const auto a = fibre_directions(material);
  const Vec3 across = a[0].cross(Vec3::UnitY());
  int seen = 0;
  while (seen < 10) {
    const Mat3 F = deformation_gradient(random_gradient(rng, 0.25));
    const Mat3 C = right_cauchy_green(F);
    if (near_switch(a, C) || linear_bar(invariants(C), structural_tensor(a[0])) < 1) continue;
    ++seen;
    const Response r = response(material, C, a);
    const auto turned = [&](const Mat3& Q) {
      return response(material, right_cauchy_green(F * Q), a);
    };
    for (const Mat3& Q : {Eigen::AngleAxisd(0.1 + seen, a[0]).toRotationMatrix(),
                          Eigen::AngleAxisd(std::acos(-1), across).toRotationMatrix()}) {
      CHECK(turned(Q).W == near(r.W, 1e-12));
      CHECK((cauchy(F * Q, turned(Q).S) - cauchy(F, r.S)).norm() <= 1e-12 * cauchy(F, r.S).norm());
    }
    CHECK(std::abs(turned(Eigen::AngleAxisd(0.5, across).toRotationMatrix()).W - r.W) > 1e-6 * r.W);
  }
}

TEST_CASE("turning the specimen with its fibres turns the stress") {
  std::mt19937 rng(25);
  const Mat3 Q = random_rotation(rng), F = deformation_gradient(random_gradient(rng, 0.2));
  const Material material = positive_hgo_yeoh(20, 0.5);
  const Response r = response(material, right_cauchy_green(F), fibre_directions(material));
  const Response q =
      response(material, Q * right_cauchy_green(F) * Q.transpose(), fibre_directions(material, Q));
  CHECK((tensor(q.S) - Q * tensor(r.S) * Q.transpose()).norm() <= 1e-13 * r.S.norm());
}

TEST_CASE("a shortened fibre bears nothing, with the switch off it does") {
  Material material = positive_hgo_yeoh(0, 0.5);
  Material matrix = material;
  matrix.fibres.clear();
  const Mat3 C = Vec3(0.8, 1.1, 1.2).asDiagonal();
  const Response alone = response(matrix, C, {});
  for (FibreSwitch s : {FibreSwitch::I4_bar, FibreSwitch::I4}) {
    material.fibres[0].tension_switch = s;
    const Response r = response(material, C, fibre_directions(material));
    CHECK(r.W == alone.W);
    CHECK((r.S - alone.S).norm() == 0);
    CHECK((r.D - alone.D).norm() == 0);
  }
  material.fibres[0].tension_switch = FibreSwitch::off;
  CHECK(response(material, C, fibre_directions(material)).S[0] < alone.S[0]);
}

TEST_CASE(
    "the stress is continuous where the switch looks at I4_bar, and jumps where it looks at I4 while J is not 1") {
  Material material = positive_hgo_yeoh(0, 0.5);
  const auto a = fibre_directions(material);
  const double J = 1.1;
  const auto jump = [&](double I4) {  // of S across I4
    const auto S = [&](double x) {
      return response(material, Vec3(x, J * J / x, 1).asDiagonal(), a).S;
    };
    return (S(I4 * (1 + 1e-9)) - S(I4 * (1 - 1e-9))).norm();
  };
  CHECK(jump(std::pow(J, 2. / 3)) <= 1e-7);
  material.fibres[0].tension_switch = FibreSwitch::I4;
  // 2 c1 x exp(c2 x^2) |dI4_bar/dC|,  x = I4_bar - 1 = J^(-2/3) - 1
  const double x = std::pow(J, -2. / 3) - 1;
  const Invariants v = invariants(Vec3(1, J * J, 1).asDiagonal());
  const double expected = 2 * 0.1 * std::abs(x) * std::exp(0.3 * x * x) *
                          dlinear_bar_dC(v, structural_tensor(a[0])).norm();
  CHECK(jump(1) == near(expected, 1e-6));
}

TEST_CASE(
    "the isochoric part has no mean Cauchy stress, and its stress alone equals that with tangent") {
  std::mt19937 rng(26);
  for (const NamedMaterial& named : catalogue()) {
    CAPTURE(named.name);
    const Mat3 F = deformation_gradient(random_gradient(rng, 0.25)), C = right_cauchy_green(F);
    const auto a = fibre_directions(named.material);
    const Response r = isochoric(named.material, C, a),
                   stress_only = isochoric(named.material, C, a, false);
    CHECK(std::abs(mean_stress(cauchy(F, r.S))) <= 1e-14 * von_mises(cauchy(F, r.S)) + 1e-16);
    CHECK((r.S - stress_only.S).norm() <= 1e-15 * r.S.norm());
    CHECK(stress_only.D.norm() == 0);
  }
}

TEST_CASE(
    "a fibre modulus of zero is the matrix alone, and two equal families are one of twice the modulus") {
  std::mt19937 rng(27);
  const Mat3 C = right_cauchy_green(deformation_gradient(random_gradient(rng, 0.25)));
  const auto of = [&](const Material& m) {
    return response(m, C, fibre_directions(m));
  };
  const Volume volume{QuadraticVolume{0.5}};
  const Material matrix{{Yeoh{0.1, 0.1, 0.1}}, {}, volume},
      none{matrix.matrix, {hgo_fibre(0, 0.3, 10)}, volume};
  CHECK((of(none).D - of(matrix).D).norm() == 0);
  const Material two{matrix.matrix, {hgo_fibre(0.1, 0.3, 10), hgo_fibre(0.1, 0.3, 10)}, volume};
  const Material one{matrix.matrix, {hgo_fibre(0.2, 0.3, 10)}, volume};
  CHECK((of(two).S - of(one).S).norm() <= 1e-14 * of(one).S.norm());
  CHECK((of(two).D - of(one).D).norm() <= 1e-14 * of(one).D.norm());
}

TEST_CASE("J - 1 given by the caller carries the pressure of a nearly incompressible state") {
  const Material material = table1_hgo_yeoh(0, 1e-6);
  // dilatation of 1e-13 in a large shear: kappa (J - 1) = 2e-7 MPa, three digits of which det C - 1
  // would lose
  Mat3 H = Mat3::Zero();
  H(0, 2) = 0.5, H(1, 1) = 1e-13;
  const Mat3 F = deformation_gradient(H);
  const auto a = fibre_directions(material);
  const Vec6 with = response(material, right_cauchy_green(F), volume_change(H), a).S;
  const Vec6 without = isochoric(material, right_cauchy_green(F), a).S;
  // the difference of two stresses of about 0.3 MPa, each rounded
  CHECK(mean_stress(cauchy(F, with - without)) == near(2e6 * 1e-13, 1e-12, 1e-16));
}
