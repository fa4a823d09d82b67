// What looks doubtful in a material as a whole: Poisson's ratio, fibres that change the volume.
#include <doctest/doctest.h>

#include <cmath>

#include "mechanics/material/review.hpp"

using namespace langer;

namespace {

Material neo_hooke(double a1, Volume volume) { return {{NeoHooke{a1}}, {}, volume}; }

std::string words(const Material& material) {
  std::string all;
  for (const MaterialFinding& finding : review(material)) {
    all += finding.key + ": " + finding.words + "\n";
  }
  return all;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("Poisson's ratio follows from the moduli at rest") {
  // mu = 2 a1, K = 2/d
  CHECK(std::abs(poisson_ratio(neo_hooke(0.5, QuadraticVolume{3})) - 0) < 1e-15);
  CHECK(std::abs(poisson_ratio(neo_hooke(0.3, QuadraticVolume{2. / 1.3})) - 0.3) < 1e-15);
  CHECK(std::abs(poisson_ratio(neo_hooke(0.1, SimoTaylorVolume{1e9})) - 0.5) < 1e-9);
  CHECK(std::abs(poisson_ratio(neo_hooke(1.923077, QuadraticVolume{1000})) + 0.998) < 1e-3);
  // the linear relation between sideways and axial strain of a bar: E = 9 K mu / (3 K + mu)
  for (const double bulk : {0.1, 0.7, 3.0}) {
    const double mu = 0.6;
    const double E = 9 * bulk * mu / (3 * bulk + mu);
    CHECK(std::abs(poisson_ratio(bulk, mu) - (E / (2 * mu) - 1)) < 1e-14);
  }
}

TEST_CASE("a bulk modulus that was typed for d is found, with the value of d that was meant") {
  const std::string of_d = words(neo_hooke(0.05, QuadraticVolume{1000}));
  CHECK(of_d.starts_with("volume.quadratic.d: Poisson's ratio is -0.9"));
  CHECK(contains(of_d, "if 1000 MPa is the bulk modulus K, write volume.quadratic.d: 0.002"));
  // the other way round, in each of the laws that have a bulk modulus
  CHECK(contains(words(neo_hooke(0.05, SimoTaylorVolume{1e-3})),
                 "if 0.001 is d = 2/K in 1/MPa, write volume.simo_taylor.bulk_modulus: 2000"));
  CHECK(contains(words(neo_hooke(0.05, LogarithmicVolume{1e-3})),
                 "volume.logarithmic.bulk_modulus: 2000"));
  // what is advised is accepted
  CHECK(words(neo_hooke(0.05, QuadraticVolume{0.002})) == "");
  CHECK(words(neo_hooke(0.05, SimoTaylorVolume{2000})) == "");
  // the limit is a Poisson's ratio of 0: K = 2/3 mu
  const double limit = 2 / (2. / 3 * 0.1);
  CHECK(words(neo_hooke(0.05, QuadraticVolume{0.999 * limit})) == "");
  CHECK(words(neo_hooke(0.05, QuadraticVolume{1.001 * limit})) != "");
}

TEST_CASE("branches count where the law at once after a step has a negative Poisson's ratio") {
  Material material = neo_hooke(0.05, QuadraticVolume{2});
  CHECK(words(material) == "");
  material.viscous = std::vector<ViscousBranch>{{1, 20}};
  CHECK(contains(words(material),
                 "at once after a step: the bulk modulus of 1 MPa is less than "
                 "2/3 of the shear modulus of 2.1 MPa"));
  (*material.viscous)[0].of = BranchOf::fibres;
  CHECK(words(material) == "");
}

TEST_CASE("fibres that are as stiff as the bulk modulus are found, whatever their law") {
  Material material = neo_hooke(0.012, QuadraticVolume{1});
  material.fibres = {{HgoFibre{0.5, 1}}};
  CHECK(std::abs(fibre_stiffness(material) - 2) < 1e-14);
  const std::string found = words(material);
  CHECK(found.starts_with("volume.quadratic.d: the bulk modulus of 2 MPa is only 1 times"));
  CHECK(contains(found, "under equal tension from all sides they carry nothing"));
  CHECK(contains(found, "volume.quadratic.d: 0.01 keeps the volume"));
  material.volume = QuadraticVolume{0.01};
  CHECK(words(material) == "");
  material.volume = SimoTaylorVolume{2};
  CHECK(contains(words(material), "volume.simo_taylor.bulk_modulus: 200 keeps the volume"));
  for (const FibreLaw law :
       {FibreLaw(ExpPowFibre{0.5, 1, 2}), FibreLaw(PowLinearFibre{2, 1.2, 2})}) {
    material.fibres = {{law}};
    CHECK(words(material) != "");
  }
  // without direction, or without a modulus, they are no fibres
  material.fibres = {{HgoFibre{0.5, 1}, 0, FibreSwitch::I4_bar, 1. / 3}};
  CHECK(words(material) == "");
  material.fibres = {{HgoFibre{0, 1}}};
  CHECK(words(material) == "");
}

TEST_CASE("a bulk modulus that leaves no digits of the stress is found") {
  CHECK(words(neo_hooke(0.05, QuadraticVolume{1e-8})) == "");
  const std::string found = words(neo_hooke(0.05, QuadraticVolume{1e-11}));
  CHECK(contains(found, "the bulk modulus is 2e+12 times the shear modulus"));
  CHECK(contains(found, "volume.quadratic.d: 2e-05 is as good as incompressible"));
}

TEST_CASE("a law that is unstable at rest has no finding about its volume") {
  CHECK(words(neo_hooke(0, QuadraticVolume{1000})) == "");
  CHECK(words(neo_hooke(-0.1, QuadraticVolume{1000})) == "");
}
