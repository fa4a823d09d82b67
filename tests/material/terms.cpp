// Every energy term: its two derivatives against central differences.
#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "mechanics/material/existence.hpp"
#include "mechanics/material/material.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

template <class Term>
struct Samples;
template <>
struct Samples<NeoHooke> {
  static std::vector<NeoHooke> terms() { return {{0.3}, {-0.1}}; }
  static std::vector<double> at() { return {3, 3.2, 5, 12}; }
};
template <>
struct Samples<Yeoh> {
  static std::vector<Yeoh> terms() {
    return {{0.269, 0.376, 0.415}, {-0.059, 0.291, 0.016}, {0.1, 0, 0}};
  }
  static std::vector<double> at() { return {3, 3.2, 5, 12}; }
};
template <>
struct Samples<YeohI2> {
  static std::vector<YeohI2> terms() { return {{0.2, 0.1, -0.05}}; }
  static std::vector<double> at() { return {3, 3.2, 5, 12}; }
};
template <>
struct Samples<ArrudaBoyce> {
  static std::vector<ArrudaBoyce> terms() { return {{0.3, 1.2}, {-0.1, 5}}; }
  static std::vector<double> at() { return {3, 3.2, 5, 12}; }
};
template <>
struct Samples<Gent> {
  static std::vector<Gent> terms() { return {{0.3, 12}, {-0.1, 80}}; }
  static std::vector<double> at() { return {3, 3.2, 5, 12}; }
};
template <>
struct Samples<Ogden> {
  static std::vector<Ogden> terms() {
    return {{0.63, 1.3, 0.0012, 5, -0.01, -2}, {0.2, 1e-9}, {0.1, 2}, {0.1, 0}};
  }
  static std::vector<double> at() { return {0.3, 1, 1.05, 4}; }
};
template <>
struct Samples<HgoFibre> {
  static std::vector<HgoFibre> terms() {
    return {{0.1, 0.3}, {-0.317, 0.319}, {0.2, 0}, {0.2, 1e-9}, {0.2, 20}};
  }
  static std::vector<double> at() { return {0.8, 1, 1.05, 1.4, 2}; }
};
template <>
struct Samples<ExpPowFibre> {  // away from 1, where a power that is no whole number has no fourth
                               // derivative
  static std::vector<ExpPowFibre> terms() {
    return {{0.1, 0.3, 2}, {0.2, 0, 3.5}, {0.3, 4, 2.5}, {0.2, 1e-9, 4}, {5, 20, 3}};
  }
  static std::vector<double> at() { return {0.8, 1.05, 1.4, 2}; }
};
template <>
struct Samples<PowLinearFibre> {  // and from lam0^2
  static std::vector<PowLinearFibre> terms() {
    return {{1, 1.1, 2}, {100, 1.05, 3}, {0.3, 1.3, 4.5}};
  }
  static std::vector<double> at() { return {0.6, 0.95, 1.05, 1.3, 1.8, 4}; }
};
template <>
struct Samples<LogarithmicVolume> {
  static std::vector<LogarithmicVolume> terms() { return {{4}, {1e3}, {2e6}}; }
  static std::vector<double> at() { return {0.3, 0.7, 1, 1.001, 1.4, 4}; }
};
template <>
struct Samples<SimoTaylorVolume> {
  static std::vector<SimoTaylorVolume> terms() { return {{4}, {1e3}, {2e6}}; }
  static std::vector<double> at() { return {0.3, 0.7, 1, 1.001, 1.4, 4}; }
};
template <>
struct Samples<QuadraticVolume> {
  static std::vector<QuadraticVolume> terms() { return {{0.5}, {2e-3}, {1e-6}}; }
  static std::vector<double> at() { return {0.7, 1, 1.001, 1.4}; }
};

}  // namespace

TEST_CASE_TEMPLATE("an energy term gives its own derivatives", Term, NeoHooke, Yeoh, YeohI2,
                   ArrudaBoyce, Gent, Ogden, HgoFibre, ExpPowFibre, PowLinearFibre, QuadraticVolume,
                   LogarithmicVolume, SimoTaylorVolume) {
  static_assert(EnergyTerm<Term>);
  for (const Term& term : Samples<Term>::terms())
    for (double x : Samples<Term>::at()) {
      CAPTURE(x);
      const double h = 1e-4;
      const Energy<double> e = term(x), p = term(x + h), m = term(x - h), p2 = term(x + 2 * h),
                           m2 = term(x - 2 * h);
      // fourth order: h^4 is 1e-16, so what remains is eps W/h
      const double dW = (8 * (p.W - m.W) - (p2.W - m2.W)) / (12 * h),
                   ddW = (8 * (p.dW - m.dW) - (p2.dW - m2.dW)) / (12 * h);
      const double size = std::abs(e.W) + std::abs(e.dW) + std::abs(e.ddW);
      CHECK(std::abs(dW - e.dW) <= 1e-9 * size);
      CHECK(std::abs(ddW - e.ddW) <= 1e-9 * size);
    }
}

TEST_CASE("a term costs no energy in the undeformed state") {
  CHECK(NeoHooke{0.3}(3.).W == 0);
  CHECK(Yeoh{0.269, 0.376, 0.415}(3.).W == 0);
  CHECK(YeohI2{0.269, 0.376, 0.415}(3.).W == 0);
  CHECK(ArrudaBoyce{0.3, 1.2}(3.).W == 0);
  CHECK(Gent{0.3, 12}(3.).W == 0);
  CHECK(Ogden{0.63, 1.3, 0.0012, 5, -0.01, -2}(1.).W == 0);
  CHECK(HgoFibre{0.1, 0.3}(1.).W == 0);
  CHECK(HgoFibre{0.1, 0.3}(1.).dW == 0);
  CHECK(QuadraticVolume{1e-6}(1.).W == 0);
  CHECK(ExpPowFibre{0.1, 0.3, 2.5}(1.).W == 0);
  CHECK(ExpPowFibre{0.1, 0.3, 2.5}(1.).dW == 0);
  CHECK(PowLinearFibre{0.1, 1.2, 2.5}(1.).W == 0);
  CHECK(PowLinearFibre{0.1, 1.2, 2.5}(1.).dW == 0);
  for (const Volume& law : {Volume(QuadraticVolume{1e-6}), Volume(LogarithmicVolume{2e6}),
                            Volume(SimoTaylorVolume{2e6})}) {
    CHECK(volume_energy(law, 0.).W == 0);
    CHECK(volume_energy(law, 0.).dW == 0);
    CHECK(bulk_modulus(law) == 2e6);
    CHECK(linear_pressure(law) == std::holds_alternative<QuadraticVolume>(law));
  }
}

TEST_CASE("the fibre energy tends to its quadratic limit as c2 goes to zero") {
  for (double c2 : {1e-7, 1.1e-8, 1e-9}) {
    const double x =
        0.4;  // W = c1/2 x^2 (1 + c2 x^2/2 + ...), and exp(y) - 1 keeps eps/y of its digits
    CHECK(HgoFibre{0.2, c2}(1 + x).W ==
          near(HgoFibre{0.2, 0}(1 + x).W, c2 * x * x + 2e-16 / (c2 * x * x)));
  }
}

TEST_CASE("Ogden's divided difference joins the derivative as the stretches meet") {
  const Ogden law{0.63, 1.3, 0.0012, 5, -0.01, -2};
  for (double f : {0.4, 1., 3.}) {
    CHECK(law.divided_difference(f, f) == near(law(f).ddW, 1e-14));
    for (double gap : {1e-14, 1e-10, 1e-6, 1e-3}) {
      // the derivative in the middle is the divided difference up to gap^2 times a third derivative
      // over 24
      const double e = f * (1 + gap);
      CHECK(law.divided_difference(e, f) == near(law((e + f) / 2).ddW, 1e-13 + 10 * gap * gap));
    }
    const double e = 2 * f;
    CHECK(law.divided_difference(e, f) == near((law(e).dW - law(f).dW) / (e - f), 1e-13));
  }
}

TEST_CASE("laws meet where one is a special case of another") {
  const Vec3 stretch(1.3, 0.9, 0.95);
  const Mat3 C = stretch.cwiseAbs2().asDiagonal();
  const auto same = [&](const MatrixTerm& a, const MatrixTerm& b, double tolerance) {
    const Volume volume{QuadraticVolume{1}};
    const Response x = response({{a}, {}, volume}, C, {}), y = response({{b}, {}, volume}, C, {});
    CHECK((x.S - y.S).norm() <= tolerance * y.S.norm());
    CHECK((x.D - y.D).norm() <= tolerance * y.D.norm());
    CHECK(shear_modulus(a) == near(shear_modulus(b), tolerance));
  };
  same(Ogden{0.6, 2}, NeoHooke{0.3}, 1e-13);
  same(Ogden{0.6, 2, -0.2, -2}, MooneyRivlin{0.3, 0.1}, 1e-13);
  same(Ogden{-0.2, -2}, YeohI2{0.1, 0, 0}, 1e-13);
  same(Signorini{0.3, 0.1, 0}, MooneyRivlin{0.3, 0.1}, 1e-15);
  same(Signorini{0.3, 0, 0.05}, Yeoh{0.3, 0.05, 0}, 1e-15);
  same(Gent{0.6, 1e9}, NeoHooke{0.3}, 1e-8);
  same(ArrudaBoyce{0.6, 1e5}, NeoHooke{0.3}, 1e-9);
}

TEST_CASE(
    "an exponential of a fibre that leaves the range of forces is no number, alone and eight at once, and changes nothing else") {
  const HgoFibre fibre{0.1, 1000};  // exp(300) at I4_bar = 1.5477
  for (double I4 : {0.5, 1., 1.21, 1.547}) CHECK(nan_outside_domain(fibre, I4) == I4);
  for (double I4 : {1.548, 2., 1e200}) CHECK(std::isnan(fibre(nan_outside_domain(fibre, I4)).ddW));
  Packet all(1.2);
  all.set(3, 2), all.set(5, -1);
  const Energy<Packet> e = fibre(nan_outside_domain(fibre, all));
  for (int i = 0; i < Packet::lanes; ++i) CHECK(std::isnan(e.W[i]) == (i == 3 || i == 5));
}

TEST_CASE("beyond its limit Gent's law has no energy, and says so") {
  for (double I1 : {3 + 12.001, 20., 1e3}) {
    const Gent law{0.3, 12};
    const Energy<double> e = law(nan_outside_domain(law, I1));
    CHECK(std::isnan(e.W));
    CHECK(std::isnan(e.dW));
    CHECK(std::isnan(e.ddW));
  }
}

TEST_CASE("exp_pow of the second power is HGO's energy, and a power law without its exponent") {
  for (double I4 : {0.7, 1., 1.2, 1.9}) {
    const Energy<double> a = ExpPowFibre{0.3, 0.8, 2}(I4), b = HgoFibre{0.3, 0.8}(I4);
    CHECK(a.W == near(b.W, 1e-13));
    CHECK(a.dW == near(b.dW, 1e-13));
    CHECK(a.ddW == near(b.ddW, 1e-13));
    const double y = std::abs(I4 - 1);
    CHECK(ExpPowFibre{0.3, 0, 3}(I4).W == near(0.1 * y * y * y));
    CHECK(ExpPowFibre{0.3, 1e-12, 3}(I4).W == near(0.1 * y * y * y));
  }
}

TEST_CASE("a pow_linear fibre is smooth where its toe ends, and its nominal stress linear beyond") {
  for (const PowLinearFibre& law : {PowLinearFibre{2, 1.1, 2}, PowLinearFibre{300, 1.03, 3.5}}) {
    const double I0 = law.lam0 * law.lam0;
    const Energy<double> before = law(I0 * (1 - 1e-12)), after = law(I0 * (1 + 1e-12));
    CHECK(before.W == near(after.W, 1e-9));
    CHECK(before.dW == near(after.dW, 1e-9));
    CHECK(before.ddW == near(after.ddW, 1e-9));
    const auto nominal = [&](double stretch) {
      return 2 * stretch * law(stretch * stretch).dW;
    };
    const double slope = law.E * (1 / law.lam0 + (I0 - 1) / (2 * (law.beta - 1) * I0 * law.lam0));
    for (double stretch : {law.lam0 + 0.01, law.lam0 + 0.3, 3.})
      CHECK((nominal(stretch + 0.1) - nominal(stretch)) / 0.1 == near(slope, 1e-10));
    CHECK(nominal(law.lam0 - 0.001) - nominal(law.lam0 - 0.002) < 0.001 * slope);
  }
}

TEST_CASE(
    "energies of volume change keep their digits near rest, have no number without volume, and are one for eight at once") {
  const LogarithmicVolume logarithmic{2e6};
  const SimoTaylorVolume simo_taylor{2e6};
  for (double x : {1e-12, -1e-9, 3e-7, -1e-4}) {
    CHECK(logarithmic.at_volume_change(x).W == near(1e6 * x * x * (1 - x), 2 * x * x + 1e-15));
    CHECK(simo_taylor.at_volume_change(x).W == near(1e6 * x * x * (1 - x / 3), 2 * x * x + 1e-15));
  }
  for (double x : {0.0999999, 0.1000001, -0.0999999, -0.1000001})
    CHECK(minus_its_logarithm(x) == near(x - std::log1p(x), 1e-13));
  Packet all(0.0);
  for (int i = 0; i < Packet::lanes; ++i) all.set(i, -0.35 + 0.1 * i);
  for (const Volume& law :
       {Volume(QuadraticVolume{1e-3}), Volume(logarithmic), Volume(simo_taylor)}) {
    const Energy<Packet> e = volume_energy(law, all);
    for (int i = 0; i < Packet::lanes; ++i) {
      const Energy<double> one = volume_energy(law, all[i]);
      CHECK(e.W[i] == near(one.W, 1e-13));
      CHECK(e.dW[i] == near(one.dW, 1e-13));
      CHECK(e.ddW[i] == near(one.ddW, 1e-13));
    }
  }
  for (double x : {-1., -1.5})
    for (const Volume& law : {Volume(logarithmic), Volume(simo_taylor)})
      CHECK(std::isnan(volume_energy(law, x).W));
}

TEST_CASE(
    "fibres of every law: eight at once are eight alone, and an exponential beyond the range of forces is no number") {
  Packet all(0.0);
  for (int i = 0; i < Packet::lanes; ++i) all.set(i, 0.75 + 0.15 * i);
  const auto same = [&](const auto& law) {
    const Energy<Packet> e = law(all);
    for (int i = 0; i < Packet::lanes; ++i) {
      const Energy<double> one = law(all[i]);
      CHECK(e.W[i] == near(one.W, 1e-13));
      CHECK(e.dW[i] == near(one.dW, 1e-13));
      CHECK(e.ddW[i] == near(one.ddW, 1e-13));
    }
  };
  for (const auto& law : Samples<ExpPowFibre>::terms()) same(law);
  for (const auto& law : Samples<PowLinearFibre>::terms()) same(law);
  const ExpPowFibre steep{0.1, 1000, 3};  // exp(300) at a cube of 0.3
  for (double I4 : {0.5, 1., 1.3, 1.66}) CHECK(nan_outside_domain(steep, I4) == I4);
  for (double I4 : {1.68, 2., 1e200}) CHECK(std::isnan(steep(nan_outside_domain(steep, I4)).ddW));
  const Energy<double> far = PowLinearFibre{1, 1.1, 20}(1e30);
  CHECK(std::isfinite(far.W));
  CHECK(far.ddW > 0);
}
