// States of a thin incompressible sheet: closed forms, work, and what is left free carries no
// stress.
#include "mechanics/material/states.hpp"

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>

#include "core/tensor/invariants.hpp"
#include "core/tensor/voigt.hpp"
#include "material/catalogue.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

constexpr TestKind all_kinds[] = {TestKind::uniaxial, TestKind::equibiaxial, TestKind::biaxial,
                                  TestKind::pure_shear, TestKind::simple_shear};

PlaneState state(const Material& m, TestKind kind, double first, double second = 1,
                 OffAxisShear shear = OffAxisShear::held, double angle = 0) {
  return plane_state(m, specimen_fibres(m, angle), kind, first, second, shear);
}

// a fibre near its switch has no second derivative there
bool smooth(const Material& m, const PlaneState& s, double angle) {
  const auto a = specimen_fibres(m, angle);
  for (std::size_t k = 0; k < a.size(); ++k)
    if (std::abs(contraction(fibre_tensor(m.fibres[k], a[k]), voigt(s.F.transpose() * s.F)) - 1) <
        0.02)
      return false;
  return true;
}

}  // namespace

TEST_CASE("held uniaxial states are those of the uniaxial solver, for every law") {
  for (const auto& [name, m] : catalogue())
    for (double l : {0.8, 1.05, 1.3}) {
      const auto named = name;
      CAPTURE(named);
      const PlaneState s = state(m, TestKind::uniaxial, l);
      const Uniaxial u = uniaxial_incompressible(m, l);
      REQUIRE(s.converged);
      CHECK(std::abs(s.sigma(0, 0) - u.sigma) <= 1e-10 * (std::abs(u.sigma) + 0.1));
      CHECK(s.F(2, 2) == near(u.stretch[2], 1e-10));
    }
}

TEST_CASE(
    "the nominal stress is the derivative of the energy along the test, for every law and kind, held and free") {
  for (const auto& law : catalogue())
    for (TestKind kind : all_kinds)
      for (OffAxisShear shear : {OffAxisShear::held, OffAxisShear::free}) {
        const std::string& name = law.name;
        const Material& m = law.material;
        CAPTURE(name);
        CAPTURE(names(kind)[static_cast<std::size_t>(kind)]);
        const double first = kind == TestKind::simple_shear ? 0.3 : 1.2, second = 1.15, h = 1e-3,
                     angle = 12;
        const PlaneState s = state(m, kind, first, second, shear, angle);
        REQUIRE(s.converged);
        if (!smooth(m, s, angle)) continue;
        const auto W = [&](double step) {
          return state(m, kind, first + step, second, shear, angle).W;
        };
        const double slope = (8 * (W(h) - W(-h)) - (W(2 * h) - W(-2 * h))) / (12 * h);
        const auto P = measured_stress(s, kind, StressMeasure::nominal);
        // both sides pull in an equibiaxial test
        const double work = kind == TestKind::equibiaxial ? P[0] + P[1] : P[0];
        CHECK(work == near(slope, 1e-8));
        CHECK(std::abs(s.F.determinant() - 1) <= 1e-14);
        if (kind == TestKind::uniaxial) CHECK(std::abs(s.sigma(2, 2)) <= 1e-9);
        if (shear == OffAxisShear::free && kind != TestKind::simple_shear)
          CHECK(std::abs(s.sigma(0, 2)) <= 1e-9);
      }
}

TEST_CASE("off-axis fibres shear a free sheet and not a held one") {
  const Material m = positive_hgo_yeoh(30);
  const PlaneState held = state(m, TestKind::uniaxial, 1.3),
                   free = state(m, TestKind::uniaxial, 1.3, 1, OffAxisShear::free);
  CHECK(held.F(0, 2) == 0);
  CHECK(std::abs(held.sigma(0, 2)) > 1e-3);
  CHECK(std::abs(free.F(0, 2)) > 1e-2);
  CHECK(free.sigma(0, 0) < held.sigma(0, 0));
  // the mirrored specimen shears the other way
  const PlaneState mirrored =
      state(positive_hgo_yeoh(-30), TestKind::uniaxial, 1.3, 1, OffAxisShear::free);
  CHECK(mirrored.F(0, 2) == near(-free.F(0, 2), 1e-9));
}

TEST_CASE("exact values of equibiaxial tension and simple shear") {
  const Material m = positive_hgo_yeoh();
  CHECK(std::abs(state(m, TestKind::equibiaxial, 1.3).sigma(0, 0) - 0.684382) <= 5.01e-7);
  CHECK(std::abs(state(m, TestKind::biaxial, 1.3, 1.3).sigma(2, 2) - 0.415355) <= 5.01e-7);
  const double alpha[] = {0, 45, 90}, sigma[] = {0.078750, 0.184156, 0.104223};
  for (int i = 0; i < 3; ++i)
    CHECK(std::abs(
              state(m, TestKind::simple_shear, 0.5, 1, OffAxisShear::held, alpha[i]).sigma(0, 2) -
              sigma[i]) <= 5.01e-7);
}

TEST_CASE("stress measures are F's, also in a sheared state") {
  const Material m = positive_hgo_yeoh(30);
  for (TestKind kind : all_kinds) {
    const PlaneState s =
        state(m, kind, kind == TestKind::simple_shear ? 0.4 : 1.3, 1.1, OffAxisShear::free);
    const Mat3 P = s.sigma * s.F.inverse().transpose(), S = s.F.inverse() * P;
    const int column = kind == TestKind::simple_shear ? 2 : 0;
    CHECK(measured_stress(s, kind, StressMeasure::cauchy)[0] == near(s.sigma(0, column), 1e-13));
    CHECK(measured_stress(s, kind, StressMeasure::nominal)[0] == near(P(0, column), 1e-12));
    CHECK(measured_stress(s, kind, StressMeasure::second_piola)[0] == near(S(0, column), 1e-12));
    if (kind == TestKind::simple_shear) continue;
    // 0 in a uniaxial test: rounding of stresses of about 1 MPa
    CHECK(measured_stress(s, kind, StressMeasure::nominal)[1] == near(P(2, 2), 1e-12, 1e-15));
    CHECK(measured_stress(s, kind, StressMeasure::second_piola)[1] == near(S(2, 2), 1e-12, 1e-15));
  }
}

TEST_CASE("impossible stretches and laws without a state are told, not thrown") {
  const Material m = positive_hgo_yeoh(30);
  for (double l : {0., -1., std::nan(""), 1e300}) CHECK(!state(m, TestKind::uniaxial, l).converged);
  CHECK(!state({{Gent{0.3, 2}}, {}, {QuadraticVolume{1}}}, TestKind::equibiaxial, 3).converged);
}
