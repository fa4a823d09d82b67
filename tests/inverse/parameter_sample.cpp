// Sets of parameters that a fit leaves open: those of its bootstrap, or drawn by its covariance
// within the bounds; ties follow.
#include "identification/inverse/parameter_sample.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "identification/inverse/forward_run.hpp"
#include "identification/inverse/uncertainty.hpp"
#include "scene/model/solve_config_io.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"

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

namespace {

// Yeoh's law of a population: a1 and a2 scatter by 30 and 40 %, a3 is shared and known to 10 %.
MaterialFile population_of_skin() {
  MaterialFile file;
  file.material.matrix = {Yeoh{0.012, 0.03, 0.01}};
  file.material.volume = QuadraticVolume{1e-2};
  FitRecord fit;
  fit.parameters = {{"a1", "MPa", 0.012, 0, 1, 0.001},
                    {"a2", "MPa", 0.03, 0, 1, 0.002},
                    {"a3", "MPa", 0.01, 0, 1, 0.001}};
  fit.covariance = MatX::Zero(3, 3);
  PopulationRecord population;
  population.names = {"a1", "a2", "a3"};
  population.keys = {"matrix.yeoh.a1", "matrix.yeoh.a2", "matrix.yeoh.a3"};
  population.units = {"MPa", "MPa", "MPa"};
  population.links = {"log", "log", "log"};
  population.lower = {0, 0, 0};
  population.upper = {1, 1, 1};
  population.median = Vec3(std::log(0.012), std::log(0.03), std::log(0.01));
  population.scatter = MatX::Zero(3, 3);
  population.scatter.topLeftCorner(2, 2) << 0.09, 0.06, 0.06, 0.16;
  population.median_covariance = Vec3(0.003, 0.005, 0.01).asDiagonal();
  fit.population = population;
  file.fit = fit;
  return file;
}

// The force of a section of skin under a sphere; with derivatives where keys are given.
ForwardPath pressed(const Material& law, const std::vector<std::string>& keys) {
  auto loaded = read_config<SolveConfig>(parse_yaml(
      "mesh: {geometry: {section: {of: axisymmetric, size: [6, 3], divisions: [10, 4], centre: {edge: 0.3, within: 1.5}}}}\n"
      "supports: [{on: bottom, hold: [x, y]}]\n"
      "contacts: {sphere: {on: top, rigid: {sphere: {radius: 2.5, centre: [0, 5.5, 0]}},\n"
      "  motion: [{t: 1, to: [0, -0.8, 0]}]}}\n"
      "stability: off\npath: {steps: 5}\n",
      "solve.yaml"));
  ForwardRun run(loaded.config, loaded.where, 0);
  run.observe({Observation{}}, {});
  return run.solve({.law = law, .slopes = keys});
}

}  // namespace

TEST_CASE("forces of specimens that are drawn lie in the interval that their scatter foretells") {
  MaterialFile file = population_of_skin();
  const ParameterKnowledge known = knowledge_of(file);
  REQUIRE(known.specimens.rows() > 0);
  // the median of a number that is shared is not known either
  REQUIRE(known.names == std::vector<std::string>{"a1", "a2", "a3"});
  CHECK(std::sqrt(known.covariance(2, 2)) == near(0.1 * 0.01, 1e-9));

  REQUIRE(known.keys ==
          std::vector<std::string>{"matrix.yeoh.a1", "matrix.yeoh.a2", "matrix.yeoh.a3"});
  const ForwardPath median = pressed(file.material, known.keys);
  REQUIRE(median.complete);
  const Eigen::Index last = median.values.rows() - 1;
  const double force = median.values(last, 0);
  VecX g(3);
  for (Eigen::Index i = 0; i < 3; ++i) g[i] = median.slopes[static_cast<std::size_t>(i)](last, 0);
  const ForceUncertainty by_derivatives = uncertainty_of(known, force, g);
  REQUIRE(by_derivatives.specimens);
  const auto [low, high] = *by_derivatives.specimens;

  constexpr int n = 300;
  int below = 0;
  int above = 0;
  int below_symmetric = 0;  // of force -+ 1.96 deviations
  int above_symmetric = 0;
  VecX logarithm(n);
  for (int k = 1; k <= n; ++k) {
    const ForwardPath path = pressed(sample_of(file, k).law, {});
    REQUIRE_MESSAGE(path.complete, path.why);
    const double one = path.values(path.values.rows() - 1, 0);
    logarithm[k - 1] = std::log(one);
    below += one < low ? 1 : 0;
    above += one > high ? 1 : 0;
    below_symmetric += one < force - 1.96 * by_derivatives.deviation ? 1 : 0;
    above_symmetric += one > force + 1.96 * by_derivatives.deviation ? 1 : 0;
  }
  // 7.5 are expected on either side, with a standard deviation of 2.7
  CHECK(below <= 15);
  CHECK(above <= 15);
  CHECK(below >= 1);
  CHECK(above >= 1);
  // the symmetric band of a skewed force is too low on both sides
  CHECK(below_symmetric < below);
  CHECK(above_symmetric > above + 8);
  const double mean = logarithm.mean();
  const double deviation = std::sqrt((logarithm.array() - mean).square().sum() / (n - 1));
  // the standard error of a deviation of 300 values is 4 %
  CHECK(deviation == near(by_derivatives.deviation / force, 0.12));
  MESSAGE(below, " below, ", above, " above, of the symmetric band ", below_symmetric, " and ",
          above_symmetric, "; deviation of ln F ", deviation, " by samples, ",
          by_derivatives.deviation / force, " by derivatives");
}

TEST_CASE("the words of a force name the scatter of specimens, and those of a fit do not") {
  ForceUncertainty force;
  force.name = "force";
  force.value = 10;
  force.deviation = 3;
  force.parts = {{"a1", 1}};
  CHECK(in_words(force, std::nullopt) == "force 10 N +- 30 % (parameters; 10 % if a1 were known)");
  force.specimens = {6, 19};
  CHECK(in_words(force, std::nullopt) ==
        "force 10 N +- 30 % (between specimens; 10 % if a1 were known), 95 % of specimens between "
        "6 and 19 N");
  const std::vector<Summary> summary = summary_of({force});
  REQUIRE(summary.size() == 4);
  CHECK(summary[1].name == "force_specimens_lower_95");
  CHECK(summary[1].value == 6);
  CHECK(summary[2].name == "force_specimens_upper_95");
  CHECK(summary[2].value == 19);
}
