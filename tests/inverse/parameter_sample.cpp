// Sets of parameters that a fit leaves open: those of its bootstrap, or drawn by its covariance
// within the bounds; ties follow.
#include "identification/inverse/parameter_sample.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "identification/inverse/uncertainty.hpp"
#include "support/laws.hpp"

using namespace langer;

namespace {

// a1 and c1, correlated; a2 follows a1
MaterialFile fitted() {
  MaterialFile file;
  file.material = test::stable(0, 1e-3);
  FitRecord fit;
  fit.parameters = {{"a1", "MPa", 0.05, 0.001, 1, 0.005}, {"c1", "MPa", 0.1, 0, 1, 0.02}};
  fit.covariance.resize(2, 2);
  fit.covariance << 0.005 * 0.005, -0.8 * 0.005 * 0.02, -0.8 * 0.005 * 0.02, 0.02 * 0.02;
  fit.ties = {{"matrix.yeoh.a2", "matrix.yeoh.a1", 2, 0}};
  file.fit = fit;
  return file;
}

const Yeoh& yeoh(const ParameterSample& sample) { return std::get<Yeoh>(sample.law.matrix[0]); }

}  // namespace

TEST_CASE("sets drawn by a covariance have it, the same number is the same set, and ties follow") {
  const MaterialFile file = fitted();
  MatX sum = MatX::Zero(2, 2);
  Eigen::Vector2d mean(0, 0);
  constexpr int n = 3000;
  for (int k = 1; k <= n; ++k) {
    REQUIRE(reason_without_samples(file, k).empty());
    const ParameterSample sample = sample_of(file, k);
    const Eigen::Vector2d d(yeoh(sample).a1 - 0.05,
                            std::get<HgoFibre>(sample.law.fibres[0].law).c1 - 0.1);
    sum += d * d.transpose(), mean += d;
    CHECK(yeoh(sample).a2 == 2 * yeoh(sample).a1);
    CHECK(yeoh(sample).a3 == 0.02);
  }
  CHECK((sum / n - file.fit->covariance).norm() < 0.06 * file.fit->covariance.norm());
  CHECK((mean / n).norm() < 0.002);
  const ParameterSample again = sample_of(file, 17);
  CHECK(yeoh(again).a1 == yeoh(sample_of(file, 17)).a1);
  REQUIRE(again.values.size() == 2);
  CHECK(again.values[0].name == "parameter_a1");
  CHECK(again.values[0].value == yeoh(again).a1);
}

TEST_CASE("sets stay within bounds, a bootstrap gives its own, and what has no set says why") {
  MaterialFile file = fitted();
  file.fit->parameters[1].lower = 0.095;
  for (int k = 1; k <= 50; ++k)
    CHECK(std::get<HgoFibre>(sample_of(file, k).law.fibres[0].law).c1 >= 0.095);
  file.fit->sets.resize(2, 2);
  file.fit->sets << 0.04, 0.11, 0.06, 0.09;
  CHECK(yeoh(sample_of(file, 2)).a1 == 0.06);
  CHECK(reason_without_samples(file, 2).empty());
  CHECK(reason_without_samples(file, 3) == "2 sets");
  file.fit->sets.resize(0, 0);
  file.fit->covariance.setConstant(std::nan(""));
  CHECK(reason_without_samples(file, 1) == "a fit without standard errors of its parameters");
  CHECK(reason_without_samples(MaterialFile{}, 1) == "no fit");
}

TEST_CASE(
    "what a force is not known to because people differ follows from the scatter of a population") {
  MaterialFile file = fitted();
  PopulationRecord population;
  population.names = {"a1", "c1"};
  population.keys = {"matrix.yeoh.a1", "fibres[0].hgo.c1"};
  population.units = {"MPa", "MPa"};
  population.links = {"log", "log"};
  population.lower = {0, 0};
  population.upper = {1, 1};
  population.median = Eigen::Vector2d(std::log(0.05), std::log(0.1));
  population.scatter.resize(2, 2);
  population.scatter << 0.0025, 0.001, 0.001, 0.0016;
  population.median_covariance = MatX::Zero(2, 2);
  file.fit->population = population;
  const ParameterKnowledge known = knowledge_of(file);
  REQUIRE(known.names == std::vector<std::string>{"a1", "c1"});
  // people who are drawn have it, to first order in a scatter of 5 %
  MatX sum = MatX::Zero(2, 2);
  constexpr int n = 3000;
  for (int k = 1; k <= n; ++k) {
    const ParameterSample person = sample_of(file, k);
    const Eigen::Vector2d d(yeoh(person).a1 - 0.05,
                            std::get<HgoFibre>(person.law.fibres[0].law).c1 - 0.1);
    sum += d * d.transpose();
  }
  CHECK((sum / n - known.covariance).norm() < 0.06 * known.covariance.norm());
  // the error of the median adds to it
  population.median_covariance = population.scatter;
  file.fit->population = population;
  CHECK((knowledge_of(file).covariance - 2 * known.covariance).norm() <
        1e-12 * known.covariance.norm());
  // and a number that follows a parameter follows it from person to person
  CHECK(known.keys.size() == 3);
}
