// The stresses of states that a test imposes, by coefficients that are computed once.
#include "identification/fit/imposed_states.hpp"

#include <doctest/doctest.h>

#include <random>

#include "identification/fit/fit.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

Material law(double alpha, double kappa, double c1) {
  Fibre fibre{HgoFibre{c1, 0.8}, alpha};
  fibre.kappa = kappa;
  return {{Yeoh{0.2, 0.1, -0.05}, MooneyRivlin{0.1, 0.3}},
          {fibre, Fibre{HgoFibre{0.2, 0.3}, -alpha}},
          {QuadraticVolume{1e-3}}};
}

Test test_of(TestKind kind, StressMeasure measure) {
  Test test;
  test.kind = kind;
  test.measure = measure;
  for (int i = 0; i < 11; ++i) {  // more than eight, and no multiple of it
    const double strain = -0.2 + 0.05 * i;
    test.first.push_back(deformation_at(kind, strain));
    test.stress_x.push_back(0);
    if (kind == TestKind::biaxial) test.second.push_back(1 + 0.4 * strain);
    if (kind == TestKind::biaxial || kind == TestKind::equibiaxial) test.stress_z.push_back(0);
  }
  return test;
}

// largest difference between both ways, relative to the largest stress
double difference(const ImposedStates& states, const Material& m, const Test& test) {
  VecX by_states = VecX::Zero(static_cast<Eigen::Index>(test.values()));
  VecX by_model = by_states;
  REQUIRE(states.stress(m, by_states.data()));
  REQUIRE(model_stress(m, test, Dilatation::incompressible, by_model.data()));
  return (by_states - by_model).lpNorm<Eigen::Infinity>() / by_model.lpNorm<Eigen::Infinity>();
}

}  // namespace

TEST_CASE("imposed states give the stresses of the model, for other parameters than the first") {
  for (TestKind kind : {TestKind::uniaxial, TestKind::equibiaxial, TestKind::biaxial,
                        TestKind::pure_shear, TestKind::simple_shear})
    for (StressMeasure measure :
         {StressMeasure::cauchy, StressMeasure::nominal, StressMeasure::second_piola}) {
      double alpha = 35;
      if (kind == TestKind::uniaxial) alpha = 0;
      const Test test = test_of(kind, measure);
      const auto states = ImposedStates::of(law(alpha, 0, 0.3), test);
      REQUIRE(states);
      CHECK(difference(*states, law(alpha, 0, 0.3), test) <= 1e-13);
      const Material other = law(alpha, 0.2, -0.4);
      CHECK(states->hold_for(other));
      CHECK(difference(*states, other, test) <= 1e-13);
      CHECK_FALSE(states->hold_for(law(alpha + 1, 0, 0.3)));
    }
}

TEST_CASE("states that follow from the law are not imposed") {
  const Material off_axis = law(35, 0, 0.3);
  CHECK_FALSE(ImposedStates::of(off_axis, test_of(TestKind::uniaxial, StressMeasure::cauchy)));
  Test free = test_of(TestKind::pure_shear, StressMeasure::cauchy);
  free.shear = OffAxisShear::free;
  CHECK_FALSE(ImposedStates::of(off_axis, free));
  CHECK(ImposedStates::of(law(0, 0, 0.3), free));
  // laws of the stretches have no derivatives of invariants
  const Material ogden{{Ogden{0.2, 3, -0.05, -2}}, {}, {QuadraticVolume{1}}};
  CHECK_FALSE(ImposedStates::of(ogden, test_of(TestKind::uniaxial, StressMeasure::cauchy)));
}

TEST_CASE("imposed states without a stress are refused as the model refuses them") {
  Material m = law(0, 0, 0.3);
  Test test = test_of(TestKind::uniaxial, StressMeasure::cauchy);
  const auto states = ImposedStates::of(m, test);
  REQUIRE(states);
  std::get<HgoFibre>(m.fibres[0].law).c2 = 1e4;  // the exponential leaves the range of numbers
  VecX stress(static_cast<Eigen::Index>(test.values()));
  CHECK_FALSE(states->stress(m, stress.data()));
  CHECK_FALSE(model_stress(m, test, Dilatation::incompressible, stress.data()));
  test.first.back() = 0;  // no stretch
  const auto impossible = ImposedStates::of(law(0, 0, 0.3), test);
  REQUIRE(impossible);
  CHECK_FALSE(impossible->stress(law(0, 0, 0.3), stress.data()));
}
