// The branches at one point: closed forms of relaxation, order in time, limits, tangent,
// objectivity. Random branches each.
#include "mechanics/material/viscous.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <random>

#include "core/tensor/kinematics.hpp"
#include "core/tensor/voigt.hpp"
#include "material/catalogue.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

std::vector<ViscousBranch> some_branches(std::mt19937& random, int n) {
  std::uniform_real_distribution<double> decade(-2, 2), gamma(0.05, 0.8);
  std::vector<ViscousBranch> branches;
  for (int i = 0; i < n; ++i)
    branches.push_back({std::pow(10, decade(random)), gamma(random), static_cast<BranchOf>(i % 3)});
  return branches;
}

Mat3 some_gradient(std::mt19937& random, double size = 0.25) {
  std::uniform_real_distribution<double> entry(-size, size);
  Mat3 F = Mat3::Identity();
  for (int i = 0; i < 9; ++i) F(i / 3, i % 3) += entry(random);
  return F;
}

Vec6 stress_of(const Material& m, const Mat3& F, std::span<const Vec3> a, BranchOf of) {
  return isochoric(m, right_cauchy_green(F), a, only(of), false).S;
}

// a point that is led through states, by the update alone
struct Point {
  const Material& material;
  std::span<const Vec3> a;
  std::vector<ViscousBranch> branches;
  std::vector<Vec6> Q, S;
  Point(const Material& m, std::span<const Vec3> fibres, std::vector<ViscousBranch> b)
      : material(m), a(fibres), branches(std::move(b)), Q(branches.size(), Vec6::Zero()), S(Q) {}
  Vec6 H(double seconds) const {
    Vec6 h = Vec6::Zero();
    for (std::size_t i = 0; i < branches.size(); ++i) {
      const BranchStep step = branch_step(branches[i], seconds);
      h += step.keep * Q[i] - step.follow * S[i];
    }
    return h;
  }
  Amplified amplified(double seconds) const {
    Amplified out;
    for (const ViscousBranch& branch : branches)
      amplify(out, branch.of, branch_step(branch, seconds).follow);
    return out;
  }
  Vec6 stress(const Mat3& F, double seconds) const {
    return isochoric(material, right_cauchy_green(F), a, amplified(seconds), false).S + H(seconds);
  }
  void move(const Mat3& F, double seconds) {
    for (std::size_t i = 0; i < branches.size(); ++i) {
      const BranchStep step = branch_step(branches[i], seconds);
      const Vec6 now = stress_of(material, F, a, branches[i].of);
      Q[i] = step.keep * Q[i] + step.follow * (now - S[i]);
      S[i] = now;
    }
  }
  Vec6 total(const Mat3& F) const {
    Vec6 sum = isochoric(material, right_cauchy_green(F), a, false).S;
    for (const Vec6& q : Q) sum += q;
    return sum;
  }
};

}  // namespace

TEST_CASE(
    "viscous: a step relaxes as the sum of its exponentials, whatever the increments of the hold") {
  std::mt19937 random(4);
  for (const NamedMaterial& named : catalogue()) {
    const auto a = fibre_directions(named.material);
    const auto branches = some_branches(random, 3);
    const Mat3 F = some_gradient(random);
    Point point(named.material, a, branches);
    point.move(F, 0);  // at once
    double t = 0;
    for (double seconds : {1e-3, 0.02, 0.5, 0.5, 40., 1e3}) {
      point.move(F, seconds), t += seconds;
      Vec6 exact = stress_of(named.material, F, a, BranchOf::all);
      for (const ViscousBranch& b : branches)
        exact += b.gamma * std::exp(-t / b.tau) * stress_of(named.material, F, a, b.of);
      CAPTURE(named.name);
      CAPTURE(t);
      CHECK((point.total(F) - exact).norm() <= 1e-13 * exact.norm());
    }
  }
}

TEST_CASE("viscous: ramp and hold against the convolution, error of second order, below 1e-6") {
  std::mt19937 random(5);
  const double ramp = 0.7, hold = 1.1;
  for (const NamedMaterial& named : catalogue()) {
    const auto a = fibre_directions(named.material);
    auto branches = some_branches(random, 3);
    for (ViscousBranch& b : branches) b.tau = std::max(b.tau, 0.05);
    const Mat3 G = some_gradient(random, 0.15) - Mat3::Identity();
    const auto F = [&](double t) -> Mat3 {
      return Mat3::Identity() + std::min(t / ramp, 1.) * G;
    };
    // Q = gamma integral of exp(-(T - s)/tau) S'(s): by parts, Gauss-Legendre of three points on
    // 400 pieces
    const double T = ramp + hold;
    Vec6 exact = stress_of(named.material, F(T), a, BranchOf::all);
    for (const ViscousBranch& b : branches) {
      Vec6 Q = b.gamma * std::exp(-hold / b.tau) * stress_of(named.material, F(ramp), a, b.of);
      const int pieces = 400;
      for (int k = 0; k < pieces; ++k)
        for (const auto& [x, w] :
             {std::pair{-std::sqrt(0.6), 5. / 18}, {0., 8. / 18}, {std::sqrt(0.6), 5. / 18}}) {
          const double s = ramp * (k + 0.5 + 0.5 * x) / pieces;
          Q -= b.gamma / b.tau * std::exp(-(T - s) / b.tau) * (w * ramp / pieces) *
               stress_of(named.material, F(s), a, b.of);
        }
      exact += Q;
    }
    const auto error = [&](int n) {
      Point point(named.material, a, branches);
      for (int i = 1; i <= n; ++i) point.move(F(ramp * i / n), ramp / n);
      for (int i = 1; i <= 3; ++i) point.move(F(T), hold / 3);
      return (point.total(F(T)) - exact).norm() / exact.norm();
    };
    CAPTURE(named.name);
    const double coarse = error(100), fine = error(200), finest = error(800);
    CHECK(finest < 1e-6);
    // a fibre that comes under tension within an increment has a kink there
    const bool smooth =
        std::all_of(named.material.fibres.begin(), named.material.fibres.end(),
                    [](const Fibre& f) { return f.tension_switch == FibreSwitch::off; });
    if (smooth && coarse > 1e-9) CHECK(std::log2(coarse / fine) == near(2, 0.02));
  }
}

TEST_CASE(
    "viscous: increments without time have the instantaneous law, endless ones the law, stress and tangent") {
  std::mt19937 random(6);
  for (const NamedMaterial& named : catalogue()) {
    const auto a = fibre_directions(named.material);
    const auto branches = some_branches(random, 4);
    Amplified at_once;
    for (const ViscousBranch& b : branches) amplify(at_once, b.of, b.gamma);
    const Mat3 F = some_gradient(random), C = right_cauchy_green(F);
    const Response instantaneous = isochoric(named.material, C, a, at_once),
                   law = isochoric(named.material, C, a);
    for (const double seconds : {1e-13, 1e13}) {
      const Response* expected = seconds < 1 ? &instantaneous : &law;
      Point point(named.material, a, branches);
      const Response found = isochoric(named.material, C, a, point.amplified(seconds));
      CAPTURE(named.name);
      CAPTURE(seconds);
      CHECK((found.S + point.H(seconds) - expected->S).norm() <= 1e-10 * expected->S.norm());
      CHECK((found.D - expected->D).norm() <= 1e-10 * expected->D.norm());
      point.move(F, seconds);
      CHECK((point.total(F) - expected->S).norm() <= 1e-10 * expected->S.norm());
    }
  }
}

TEST_CASE("viscous: the tangent is the derivative of the stress through the update") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> decade(-2, 2);
  for (const NamedMaterial& named : catalogue()) {
    const auto a = fibre_directions(named.material);
    Point point(named.material, a, some_branches(random, 3));
    point.move(some_gradient(random), 0.3);
    const double seconds = std::pow(10, decade(random)), h = 1e-5;
    const Mat3 F = some_gradient(random);
    const Mat3 C = right_cauchy_green(F);
    const Mat6 D = isochoric(named.material, C, a, point.amplified(seconds)).D;
    Mat6 differences;
    for (int q = 0; q < 6; ++q) {
      const auto at = [&](double step) -> Vec6 {
        Mat3 moved = C;  // dC = 2 dE; engineering shear
        moved(voigt_i[q], voigt_j[q]) += q < 3 ? 2 * step : step;
        if (q >= 3) moved(voigt_j[q], voigt_i[q]) += step;
        return isochoric(named.material, moved, a, point.amplified(seconds), false).S +
               point.H(seconds);
      };
      differences.col(q) = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
    }
    CAPTURE(named.name);
    CHECK((D - differences).norm() <= 1e-7 * D.norm());
    CHECK((D - D.transpose()).norm() <= 1e-13 * D.norm());
  }
}

TEST_CASE("viscous: a rotation of the space at any time turns the stress and nothing else") {
  std::mt19937 random(8);
  for (const NamedMaterial& named : catalogue()) {
    const auto a = fibre_directions(named.material);
    const auto branches = some_branches(random, 3);
    Point still(named.material, a, branches), turned(named.material, a, branches);
    Mat3 F = Mat3::Identity(), R = F;
    for (int i = 0; i < 5; ++i) {
      F = some_gradient(random);
      R = Eigen::AngleAxisd(1.3 * i, Vec3(1, 2 * i, 3).normalized()).toRotationMatrix();
      still.move(F, 0.1 * i), turned.move(R * F, 0.1 * i);
    }
    const Mat3 tau = F * tensor(still.total(F)) * F.transpose(),
               tau_turned = R * F * tensor(turned.total(R * F)) * F.transpose() * R.transpose();
    CAPTURE(named.name);
    CHECK((tau_turned - R * tau * R.transpose()).norm() <= 1e-12 * tau.norm());
  }
}

TEST_CASE("viscous: storage and loss of a small cycle are those of the spectrum") {
  std::mt19937 random(9);
  const Material m{{NeoHooke{0.3}}, {}, QuadraticVolume{0.5}};
  const double mu = 2 * 0.3, strain = 1e-5, pi = std::acos(-1.);
  for (int draw = 0; draw < 6; ++draw) {
    const double omega = std::pow(10, std::uniform_real_distribution<double>(-1, 1)(random)),
                 period = 2 * pi / omega;
    auto branches = some_branches(random, 3);
    double expected_storage = 1, expected_loss = 0;
    for (ViscousBranch& b : branches) {
      b.of = BranchOf::all,
      b.tau = std::min(b.tau, 3 * period);  // 40 cycles are then as good as endless ones: exp(-13)
      const double x = omega * b.tau;
      expected_storage += b.gamma * x * x / (1 + x * x), expected_loss += b.gamma * x / (1 + x * x);
    }
    Point point(m, {}, branches);
    const int n = 1000, cycles = 40;
    double storage = 0, loss = 0;
    for (int i = 1; i <= cycles * n; ++i) {
      const double phase = 2 * pi * i / n;
      Mat3 F = Mat3::Identity();
      F(0, 1) = strain * std::sin(phase);
      point.move(F, period / n);
      if (i <= (cycles - 1) * n) continue;
      const double tau = point.total(F)[3] / (mu * strain);
      storage += 2. / n * tau * std::sin(phase), loss += 2. / n * tau * std::cos(phase);
    }
    CAPTURE(draw);
    CHECK(storage == near(expected_storage, 3e-5));
    CHECK(loss == near(expected_loss, 3e-5));
  }
}

TEST_CASE("viscous: one branch a decade follows a continuous spectrum") {
  for (const auto& [tau1, tau2] : {std::pair{0.01, 100.}, {0.1, 3.}, {1., 1000.}}) {
    const Spectrum spectrum{0.3, tau1, tau2};
    const auto branches = branches_of(spectrum);
    double sum = 0;
    for (const ViscousBranch& b : branches) sum += b.gamma;
    CHECK(sum == near(0.3 * std::log(tau2 / tau1), 1e-13));
    for (double t = tau1 / 10; t < 10 * tau2; t *= 1.3) {
      double discrete = 0, exact = 0;
      for (const ViscousBranch& b : branches) discrete += b.gamma * std::exp(-t / b.tau);
      const int n = 4000;
      for (int k = 0; k < n; ++k) {
        const double tau = tau1 * std::pow(tau2 / tau1, (k + 0.5) / n);
        exact += 0.3 * std::log(tau2 / tau1) / n * std::exp(-t / tau);
      }
      CAPTURE(t);
      // half a decade off at most: a few percent of c times ln 10
      CHECK(std::abs(discrete - exact) < 0.13 * 0.3 * std::log(10.));
    }
  }
  CHECK(branches_of(Spectrum{0.1, 1e-300, 1e300}).size() ==
        600);  // the quotient of the times is no number
}
