#include "identification/laws/law_comparison.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "identification/setup/fit_config_io.hpp"
#include "identification/setup/law_catalogue.hpp"
#include "mechanics/material/parameters.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

FitConfig read(const std::string& yaml) {
  return read_config<FitConfig>(parse_yaml(yaml, "fit.yaml", SOURCE_DIR "/configs/fit")).config;
}

const std::string biaxial =
    "data: [{file: ../../data/synthetic_biaxial.csv}]\nnoise: white\nstarts: 4\n";

std::string refusal(const std::string& yaml) {
  try {
    read(yaml);
  } catch (const Failure& failure) {
    return failure.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("every law of the catalogue is a whole config with numbers that it has") {
  for (const std::string& name : catalogue_names()) {
    INFO(name);
    const FitConfig config = read(biaxial + "laws: [" + name + "]\n");
    CHECK(config.laws.size() == 1);
    CHECK(!config.parameters.empty());
    CHECK(config.bounds == Bounds::admissible);
  }
  for (const std::string& name : term_names()) {
    INFO(name);
    const auto law = law_of_terms({name});
    REQUIRE(law);
    Material material = law->law;
    for (const FitParameter& p : law->parameters) {
      bool known = false;
      for (const MaterialParameter& number : parameters(material))
        known = known || number.key == p.key;
      CHECK(known);
    }
  }
}

TEST_CASE("the law that made the data predicts left-out protocols best") {
  const LawComparison found =
      compare_laws(read(biaxial + "laws: [neo_hooke, yeoh, goh, hgo_yeoh, goh_yeoh]\n"));
  CHECK(found.by_prediction);
  // dispersed fibres contain those that are not: the two are the same law here
  const bool first = found.laws[0].name == "hgo_yeoh" || found.laws[0].name == "goh_yeoh";
  CHECK(first);
  CHECK((found.laws[1].name == "hgo_yeoh" || found.laws[1].name == "goh_yeoh"));
  CHECK(found.laws[1].indistinguishable);
  CHECK(found.laws[2].name == "goh");
  CHECK(!found.laws[2].indistinguishable);
  CHECK(found.laws[4].name == "neo_hooke");
  for (std::size_t i = 1; i < found.laws.size(); ++i)
    CHECK(found.laws[i - 1].left_out_error <= found.laws[i].left_out_error);
  const RecordTable table = law_table(found);
  CHECK(csv(table).starts_with("law,parameters,aicc,left_out_error,elliptic"));
  CHECK(table.rows.size() == 5);
}

TEST_CASE("a test that separates two laws is one in which they differ") {
  const LawComparison found = compare_laws(read(biaxial + "laws: [hgo, hgo_yeoh]\n"));
  REQUIRE(!found.separations.empty());
  for (std::size_t i = 1; i < found.separations.size(); ++i)
    CHECK(found.separations[i - 1].deviations >= found.separations[i].deviations);
  CHECK(found.separations.front().deviations > 3);
}

TEST_CASE("a law that loses ellipticity within the data is marked") {
  // with signs free, Yeoh's law of this curve begins with a negative shear modulus
  const std::string abdomen =
      "data: [{file: ../../data/abdomen_socci2007_reconstructed.csv, strain_to: 0.6}]\n"
      "noise: white\nstarts: 2\nlaws: [yeoh]\nbounds: ";
  const LawComparison free = compare_laws(read(abdomen + "paper\n"));
  CHECK(!free.laws.front().elliptic);
  CHECK(!free.by_prediction);
  CHECK(std::isnan(free.laws.front().left_out_error));
  const LawComparison admissible = compare_laws(read(abdomen + "admissible\n"));
  CHECK(admissible.laws.front().elliptic);
}

TEST_CASE("the terms that made the data are discovered") {
  const LawComparison found = discover_terms(
      read(biaxial + "discover: {terms: [I1, I1^2, I2, I2^2, exp_fibre], most: 3}\n"));
  REQUIRE(found.laws.size() == 3);
  CHECK(found.laws.front().name == "I1 + I1^2 + exp_fibre");
  const RecordTable front = term_table(found);
  RecordTable copy = front;
  const std::vector<double>& aicc = copy.column("aicc").values;
  CHECK(aicc[2] < aicc[1]);
  CHECK(aicc[1] < aicc[0]);
}

TEST_CASE("unknown laws and terms are named at their place") {
  CHECK(refusal(biaxial + "laws: [yeoh, hgo_yeo]\n")
            .find("fit.yaml:4:14: laws[1]: found \"hgo_yeo\"") != std::string::npos);
  CHECK(refusal(biaxial + "laws: [yeoh, yeoh]\n").find("laws[1]: \"yeoh\" a second time") !=
        std::string::npos);
  CHECK(
      refusal(biaxial + "discover: {terms: [I1, I3]}\n").find("discover.terms[1]: found \"I3\"") !=
      std::string::npos);
  CHECK(refusal(biaxial +
                "laws: [yeoh]\nlaw: {matrix: {neo_hooke: {a1: 1}}, volume: {quadratic: {d: "
                "1e-6}}}\nparameters: [{key: matrix.neo_hooke.a1, lower: 0, upper: 1}]\n")
            .find("law: found together with laws") != std::string::npos);
}
