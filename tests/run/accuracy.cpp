// What a wanted accuracy puts into a config.
#include "run/accuracy.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace langer;

namespace {
SolveConfig indentation() {
  SolveConfig config;
  config.mesh.emplace();
  config.mesh->geometry = IndentedBlock{{-15, 0, -15}, {30, 4, 30}, 2.5, 1, 0.3};
  config.contacts["ball"];
  return config;
}
double edge_of(const SolveConfig& config) { return std::get<IndentedBlock>(config.mesh->geometry).edge; }
}  // namespace

TEST_CASE("a percentage is a number above 0 with its sign") {
  CHECK(percent_of("1%") == 1);
  CHECK(percent_of("0.25 %") == 0.25);
  for (const char* wrong : {"1", "%", "0%", "-1%", "nan%", "inf%", "1%%", "one%", ""}) CHECK(!percent_of(wrong));
}

TEST_CASE("the levels come with falling errors, and none costs less cells than the one before") {
  for (bool plain : {false, true}) {
    const auto& rungs = accuracy_rungs(plain);
    REQUIRE(rungs.size() >= 3);
    for (std::size_t i = 1; i < rungs.size(); ++i) {
      CHECK(rungs[i].error < rungs[i - 1].error);
      CHECK(rungs[i].edge <= rungs[i - 1].edge);
    }
  }
}

TEST_CASE("the first level that promises the wanted error is taken, its cells, increments and symmetry with it") {
  for (const auto& [wanted, mu] : {std::pair{5.0, 0.0}, {1.0, 0.0}, {0.2, 0.0}, {5.0, 0.34}, {1.0, 0.34}}) {
    SolveConfig config = indentation();
    config.contacts["ball"].friction = mu;
    config.accuracy = std::to_string(wanted) + "%";
    const auto chosen = choose_accuracy(config, std::nullopt);
    REQUIRE(chosen.has_value());
    CHECK(chosen->met);
    CHECK(chosen->rung.error <= wanted);
    CHECK(edge_of(config) == chosen->rung.edge);
    CHECK(config.path.largest == chosen->rung.step);
    CHECK(config.symmetry == SymmetryChoice::automatic);
    CHECK(config.mesh->cells == chosen->rung.cells);
    for (const AccuracyRung& r : accuracy_rungs(mu == 0))
      if (r.error <= wanted) CHECK(r.edge <= chosen->rung.edge);
  }
}

TEST_CASE("more than the study can promise gives its finest level and says so; nothing wanted changes nothing") {
  SolveConfig config = indentation();
  config.accuracy = "0.0001%";
  const auto finest = choose_accuracy(config, std::nullopt);
  REQUIRE(finest.has_value());
  CHECK(!finest->met);
  CHECK(finest->words.find("finest") != std::string::npos);
  CHECK(edge_of(config) == accuracy_rungs(true).back().edge);

  SolveConfig plain = indentation();
  CHECK(!choose_accuracy(plain, std::nullopt));
  CHECK(edge_of(plain) == 0.3);
  plain.fidelity = Fidelity::draft;
  plain.symmetry = SymmetryChoice::half_turn;
  CHECK(choose_accuracy(plain, std::nullopt)->wanted == 5);
  CHECK(plain.symmetry == SymmetryChoice::half_turn);  // what is asked for by name stays
}

TEST_CASE("what is estimated tells whether an accuracy is reached, whatever the study promised") {
  SolveConfig config = indentation();
  config.accuracy = "1%";
  const ChosenRung chosen = *choose_accuracy(config, std::nullopt);
  REQUIRE(chosen.met);
  const auto of = [](const char* name, const char* unit, double value, double cells) {
    ErrorEstimate e;
    e.of = {name, unit, value}, e.cells = cells;
    return e;
  };
  CHECK(reached(chosen, {}).met);  // nothing was estimated: the promise stands
  CHECK(reached(chosen, {}).percent == chosen.rung.error);
  const ReachedAccuracy good = reached(chosen, {of("force", "N", 10, -0.05), of("von_mises_max", "MPa", 1, 0.4)});
  CHECK(good.met);
  CHECK(good.percent == doctest::Approx(0.5));
  CHECK(good.words.empty());
  // of several indenters the worst, and never a success by the average
  const ReachedAccuracy bad = reached(chosen, {of("force_a", "N", 10, 0.01), of("force_b", "N", -2, 0.19)});
  CHECK(!bad.met);
  CHECK(bad.percent == doctest::Approx(9.5));
  CHECK(bad.words.find("9.5 %") != std::string::npos);
}

TEST_CASE("fibres take the levels of hexahedra with 8 nodes, friction or not, wherever the material comes from") {
  Material fibrous;
  fibrous.fibres.emplace_back();
  SolveConfig config = indentation();
  config.accuracy = "1%";
  choose_accuracy(config, fibrous);
  CHECK(config.mesh->cells == CellType::hex8);
  SolveConfig layered = indentation();
  layered.accuracy = "1%";
  layered.materials["dermis"].material = fibrous;
  choose_accuracy(layered, Material{});
  CHECK(layered.mesh->cells == CellType::hex8);
}

TEST_CASE("half the edge of an indented block halves its cells, and they are even under the indenter") {
  for (double edge : {0.3, 0.2, 0.1}) {
    const IndentedBlock coarse{{-15, 0, -15}, {30, 4, 30}, 2.5, 1, edge}, fine{{-15, 0, -15}, {30, 4, 30}, 2.5, 1, edge / 2};
    const Block a = coarse.block(), b = fine.block();
    CHECK(coarse.contact_radius() == doctest::Approx(2));
    CHECK(a.centre->edge == doctest::Approx(2 * edge));
    CHECK(b.centre->edge == doctest::Approx(edge));
    for (int i = 0; i < 3; ++i) CHECK(std::abs(b.divisions[i] - 2 * a.divisions[i]) <= 4);
    CHECK(contradictions(coarse, {}).empty());
  }
  // a wide thin layer, a thick block, a block hardly wider than the contact
  for (const IndentedBlock& b : {IndentedBlock{{}, {100, 1, 100}, 2.5, 0.3, 0.175}, IndentedBlock{{}, {30, 30, 30}, 2.5, 1, 0.175},
                                 IndentedBlock{{}, {5, 4, 5}, 2.5, 1, 0.35}, IndentedBlock{{}, {30, 4, 60}, 0.5, 0.1, 0.175}}) {
    CAPTURE(b.size[0]);
    CAPTURE(b.size[1]);
    CHECK(b.complaints().empty());
    CHECK(contradictions(b, {}).empty());
  }
  CHECK(!IndentedBlock{{}, {4, 4, 4}, 2.5, 1, 0.175}.complaints().empty());
  CHECK(!IndentedBlock{{}, {30, 1, 30}, 2.5, 1.5, 0.175}.complaints().empty());
}
