// What a wanted accuracy puts into a config.
#include "accuracy/refinement/accuracy.hpp"
#include "accuracy/refinement/level_cost.hpp"
#include "scene/run/footprint.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"
#include "support/solved_scene.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>

using namespace langer;

namespace {
ContactConfig ball(double x, double z, double radius = 2.5, double depth = 1) {
  return {"", Sphere{radius, {x, 4 + radius, z}}, 0, {{1, {0, -depth, 0}}}};
}
SolveConfig indentation() {
  SolveConfig config;
  config.mesh.emplace();
  config.mesh->geometry = IndentedBlock{{-15, 0, -15}, {30, 4, 30}, 2.5, 1, 0.3};
  config.contacts["ball"] = ball(0, 0);
  config.supports.push_back({"bottom", {Axis::x, Axis::y, Axis::z}});
  return config;
}
double edge_of(const SolveConfig& config) {
  return std::get<IndentedBlock>(config.mesh->geometry).edge;
}
}  // namespace

TEST_CASE("a percentage is a number above 0 with its sign") {
  CHECK(percent_of("1%") == 1);
  CHECK(percent_of("0.25 %") == 0.25);
  for (const char* wrong : {"1", "%", "0%", "-1%", "nan%", "inf%", "1%%", "one%", ""})
    CHECK(!percent_of(wrong));
}

TEST_CASE(
    "the levels come with falling errors, and of one kind none has fewer cells than the one before") {
  for (bool plain : {false, true}) {
    const auto& levels = accuracy_levels(plain);
    REQUIRE(levels.size() >= 3);
    for (std::size_t i = 1; i < levels.size(); ++i) {
      CHECK(levels[i].error < levels[i - 1].error);
      if (levels[i].cells == levels[i - 1].cells) CHECK(levels[i].edge <= levels[i - 1].edge);
    }
  }
}

TEST_CASE(
    "the first level that promises the wanted error is taken, its cells, increments and symmetry with it") {
  for (const auto& [wanted, mu] :
       {std::pair{5.0, 0.0}, {1.0, 0.0}, {0.2, 0.0}, {5.0, 0.34}, {1.0, 0.34}}) {
    SolveConfig config = indentation();
    config.contacts["ball"].friction = mu;
    config.accuracy = std::to_string(wanted) + "%";
    config.accuracy->answer = AccuracyOf::mesh;
    const auto chosen = choose_accuracy(config, std::nullopt);
    REQUIRE(chosen.has_value());
    CHECK(chosen->met);
    CHECK(chosen->level.error <= wanted);
    CHECK(edge_of(config) == chosen->level.edge);
    CHECK(config.path.largest == chosen->level.step);
    CHECK(config.symmetry == SymmetryChoice::automatic);
    CHECK(config.mesh->cells == chosen->level.cells);
    for (const AccuracyLevel& r : accuracy_levels(mu == 0))
      if (r.error <= wanted && r.cells == chosen->level.cells) CHECK(r.edge <= chosen->level.edge);
  }
}

TEST_CASE(
    "more than the study can promise gives its finest level and says so; nothing wanted changes nothing") {
  SolveConfig config = indentation();
  config.accuracy = "0.0001%";
  const auto finest = choose_accuracy(config, std::nullopt);
  REQUIRE(finest.has_value());
  CHECK(!finest->met);
  CHECK(finest->words.find("finest") != std::string::npos);
  CHECK(edge_of(config) == accuracy_levels(true).back().edge);

  SolveConfig plain = indentation();
  CHECK(!choose_accuracy(plain, std::nullopt));
  CHECK(edge_of(plain) == 0.3);
  plain.fidelity = Fidelity::draft;
  plain.symmetry = SymmetryChoice::half_turn;
  CHECK(choose_accuracy(plain, std::nullopt)->wanted == 5);
  CHECK(plain.symmetry == SymmetryChoice::half_turn);  // what is asked for by name stays
}

TEST_CASE("where the limit may answer, a coarser level is taken, with friction up to 0.14 radii") {
  const auto edge = [](double mu, const char* wanted, auto change) {
    SolveConfig config = indentation();
    config.contacts["ball"].friction = mu;
    config.accuracy = wanted;
    change(config);
    return choose_accuracy(config, std::nullopt, true)->level.edge;
  };
  const auto as_it_is = [](SolveConfig&) {
  };
  const auto of_mesh = [](SolveConfig& config) {
    config.accuracy->answer = AccuracyOf::mesh;
  };
  const auto unjudged = [](SolveConfig& config) {
    config.estimate = EstimateBy::none;
  };
  CHECK(edge(0.34, "1%", as_it_is) == 0.14);
  CHECK(edge(0.34, "1%", of_mesh) == 0.11);
  CHECK(edge(0.34, "1%", unjudged) == 0.11);
  CHECK(edge(0.34, "1%",
             [](SolveConfig& config) { config.accuracy->at = AccuracyAt::every_step; }) == 0.11);
  CHECK(edge(0.34, "2%", as_it_is) == edge(0.34, "2%", of_mesh));
  // a fit solves the level and takes its value
  SolveConfig of_fit = indentation();
  of_fit.contacts["ball"].friction = 0.34;
  of_fit.accuracy = "1%";
  CHECK(choose_accuracy(of_fit, std::nullopt)->level.edge == 0.11);
  CHECK(edge(0, "1%", as_it_is) == 0.175);
  CHECK(edge(0, "1%", of_mesh) == 0.15);
  CHECK(edge(0, "0.9%", as_it_is) == 0.15);
}

TEST_CASE(
    "the limit answers where it alone is accurate enough, and only for what has been measured") {
  ErrorEstimate e;
  e.of = {"force", "N", 10};
  e.cells = 0.12;
  e.increments = -0.01;
  e.scatter = 0.01;
  CHECK(e.total() == near(0.15));
  CHECK(e.limit_bar() == near(0.09));
  CHECK(e.limit_percent() == near(100 * 0.09 / 9.89));
  CHECK(e.percent() == near(1.5));  // without a bar of its limit
  const auto answers = [](ErrorEstimate estimate, const char* wanted) {
    SolveConfig config = indentation();
    config.accuracy = wanted;
    const Accuracy accuracy({"solve", true}, config, std::nullopt, test::nowhere, false);
    std::vector<ErrorEstimate> all{std::move(estimate)};
    accuracy.name_answers(all);
    return all[0].limit_answers;
  };
  CHECK(!answers(e, "1%"));
  e.limit_has_bar = true;
  CHECK(e.percent() == e.limit_percent());
  CHECK(answers(e, "1%"));
  CHECK(!answers(e, "1.6%"));  // the value itself is accurate enough
  CHECK(!answers(e, "0.8%"));  // neither is
  // of several indenters also their sum
  ErrorEstimate left = e;
  left.of.name = "force_left";
  ErrorEstimate sum = e;
  sum.of.value = 20;
  const auto several = [&](const char* wanted) {
    SolveConfig config = indentation();
    config.accuracy = wanted;
    std::vector<ErrorEstimate> all{sum, left};
    Accuracy({"solve", true}, config, std::nullopt, test::nowhere, false).name_answers(all);
    return std::pair{all[0].limit_answers, all[1].limit_answers};
  };
  CHECK(several("1%") == std::pair{true, true});
  CHECK(several("1.6%") == std::pair{false, false});
  e.limit_answers = true;
  CHECK(in_words(e) ==
        "force 9.89 N +- 0.91 %, the limit of the meshes; on this one 10 N +- 1.5 % (cells +1.2, "
        "increments -0.1, scatter 0.1, solver 0 %)");
  const std::vector<Summary> summary = summary_of({e});
  const auto number = [&](const char* name) {
    return std::ranges::find(summary, name, &Summary::name)->value;
  };
  CHECK(number("force_error") == near(0.09));
  CHECK(number("force_of_mesh") == 10);
  CHECK(number("force_limit") == near(9.89));
  PathErrors errors;
  errors.at_end = {e};
  errors.limits["force"].shares = {1.1, 1.02};
  const std::vector<Summary> answers_in =
      with_answers({{"t", 1, "-"}, {"force", -10, "N"}}, errors);
  CHECK(answers_in[1].value == near(-9.89));
  // of a force that is judged before the end, the last state has a share of its own
  errors.at_end[0].t = 0.5;
  CHECK(with_answers({{"force", 2, "N"}}, errors)[0].value == near(2.04));
  const std::vector<Summary> judged = summary_of(errors.at_end);
  CHECK(std::ranges::find(judged, "force_judged", &Summary::name)->value == near(9.89));
  CHECK(std::ranges::find(judged, "force_judged_of_mesh", &Summary::name)->value == 10);
  errors.at_end[0].limit_answers = false;
  CHECK(with_answers({{"force", -10, "N"}}, errors)[0].value == -10);
}

TEST_CASE("what is estimated tells whether an accuracy is reached, whatever the study promised") {
  SolveConfig config = indentation();
  config.accuracy = "1%";
  const ChosenLevel chosen = *choose_accuracy(config, std::nullopt);
  REQUIRE(chosen.met);
  const auto of = [](const char* name, const char* unit, double value, double cells) {
    ErrorEstimate e;
    e.of = {name, unit, value}, e.cells = cells;
    return e;
  };
  CHECK(chosen.shown);
  CHECK(reached(chosen, {}).met);  // nothing was estimated: the promise stands
  CHECK(reached(chosen, {}).percent == chosen.level.error);
  const ReachedAccuracy good =
      reached(chosen, {of("force", "N", 10, -0.05), of("von_mises_max", "MPa", 1, 0.4)});
  CHECK(good.met);
  CHECK(good.percent == near(0.5));
  CHECK(good.words.empty());
  // of several indenters the worst, and never a success by the average
  const ReachedAccuracy bad =
      reached(chosen, {of("force_a", "N", 10, 0.01), of("force_b", "N", -2, 0.19)});
  CHECK(!bad.met);
  CHECK(bad.percent == near(9.5));
  CHECK(bad.words.find("9.5 %") != std::string::npos);
}

TEST_CASE("what symmetry leaves out does not count as cells of a finer level") {
  const SolveConfig config = test::config_of(
      "mesh: {geometry: {block: {size: [10, 10, 10], divisions: [40, 40, 40]}}}\n"
      "supports: [{on: bottom, hold: [x, y, z]}]\n"
      "loads: [{on: top, displacement: {x: 0, y: 1, z: 0}}]\n"
      "material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 1.0e-3}}}\n"
      "formulation: mean_dilatation\n"
      "accuracy: 1%\n");
  ErrorEstimate reaction;
  reaction.of = {"reaction_top", "N", 10};
  reaction.cells = 0.15;
  const auto action = [&](double share) {
    Accuracy accuracy({"solve", true}, config, config.material, test::nowhere, false);
    accuracy.solves_part(share);
    return accuracy.decide({reaction}).action;
  };
  CHECK(action(1) == Decision::Action::stop);
  CHECK(action(0.125) == Decision::Action::refine);
}

TEST_CASE(
    "fibres take the levels of hexahedra with 8 nodes, friction or not, wherever the material comes from") {
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

TEST_CASE("scenes unlike the study's are known as such, and begin coarse without a promise") {
  const auto shown = [](const auto& change) {
    SolveConfig config = indentation();
    config.accuracy = "1%";
    change(config);
    const ChosenLevel chosen = *choose_accuracy(config, std::nullopt);
    CHECK(chosen.met == chosen.shown);
    if (!chosen.shown) {
      CHECK(edge_of(config) <= 0.175);
      CHECK(config.mesh->cells == CellType::hex8);
      CHECK(!reached(chosen, {}).met);
    }
    return chosen.shown;
  };
  CHECK(shown([](SolveConfig&) {}));
  CHECK(!shown([](SolveConfig& c) { c.contacts["ball"] = ball(3, 0); }));  // beside the middle
  CHECK(!shown([](SolveConfig& c) {
    c.contacts["ball"] = ball(0, 0, 20);
  }));  // wider than the layer is thick
  CHECK(!shown([](SolveConfig& c) { c.contacts["other"] = ball(8, 0); }));  // two
  CHECK(!shown([](SolveConfig& c) {
    c.contacts["ball"].motion.push_back({2, {4, -1, 0}});
  }));  // goes aside
  CHECK(!shown([](SolveConfig& c) {
    c.contacts["ball"].rigid = Cylinder{1, 0.1, {0, 4, 0}, {0, 1, 0}};
  }));
  CHECK(!shown([](SolveConfig& c) { c.contacts["ball"].rigid = Plane{{0, 4, 0}, {0, -1, 0}}; }));
  CHECK(!shown([](SolveConfig& c) { c.contacts["ball"].rigid = Ellipsoid{{3, 1, 2}, {0, 5, 0}}; }));
  CHECK(!shown([](SolveConfig& c) { c.mesh->bodies = {{"fat", 2}, {"dermis", 2}}; }));
  CHECK(!shown([](SolveConfig& c) {
    c.loads.push_back({"x_max", Displacement{HistoryConfig{0.1}, {}, {}}});
  }));
}

TEST_CASE("what is moved at its faces gets hexahedra with 27 nodes, of many cells as many nodes") {
  const auto chosen = [](std::array<int, 3> divisions, const auto& change) {
    SolveConfig config;
    config.mesh.emplace();
    Block block;
    block.size = {8, 4, 8}, block.divisions = divisions;
    config.mesh->geometry = block;
    config.loads.push_back({"x_max", Displacement{HistoryConfig{0.1}, {}, {}}});
    config.accuracy = "1%";
    change(config);
    const ChosenLevel level = *choose_accuracy(config, std::nullopt, true);
    CHECK((config.mesh->cells == CellType::hex27) == (level.level.cells == CellType::hex27));
    if (level.level.cells == CellType::hex27) {
      CHECK(level.words.find("instead of the config's hex8") != std::string::npos);
      for (std::size_t i = 0; i < 3; ++i)
        CHECK(level.level.edge * numbers_of_cells(config.mesh->geometry)[i] == divisions[i]);
    }
    return level.level;
  };
  const auto press = [](double friction) {
    return [friction](SolveConfig& c) {
      c.loads.clear();
      c.contacts["press"] = {"", Plane{{0, 4, 0}, {0, -1, 0}}, friction, {{1, {0, -1, 0}}}};
    };
  };
  const auto as_it_is = [](SolveConfig&) {
  };
  CHECK(chosen({8, 4, 8}, as_it_is).cells == CellType::hex27);
  CHECK(chosen({8, 4, 8}, as_it_is).edge ==
        1);  // four cells at least, from which longer ones can be made
  CHECK(chosen({16, 8, 16}, as_it_is).edge == 2);
  CHECK(chosen({8, 4, 8}, press(0)).cells == CellType::hex27);
  CHECK(chosen({8, 4, 8}, press(0.3)).cells == CellType::hex8);
  CHECK(chosen({8, 4, 8}, [](SolveConfig& c) { c.contacts["ball"] = ball(4, 4); }).cells ==
        CellType::hex8);
  CHECK(chosen({8, 4, 8}, [](SolveConfig& c) {
          c.formulation = Formulation::mean_dilatation;
        }).cells == CellType::hex8);
  CHECK(chosen({8, 4, 8}, [](SolveConfig& c) { c.estimate = EstimateBy::dual; }).cells ==
        CellType::hex8);  // to be cut
}

TEST_CASE("the footprint of indenters is where they cut the top") {
  const SolveConfig config = indentation();
  const Box body = box(config.mesh->geometry);
  SUBCASE("of a sphere, wherever it is and however small") {
    for (const auto& [x, z, R, d] :
         {std::tuple{0., 0., 2.5, 1.}, {5., -3., 2.5, 1.}, {-11.3, 7.1, 0.2, 0.02}}) {
      SolveConfig c = config;
      c.contacts["ball"] = ball(x, z, R, d);
      const auto print = footprint(c, body);
      REQUIRE(print.has_value());
      const double a = std::sqrt(d * (2 * R - d));
      CHECK(print->middle(0) == near(x, 1e-3));
      CHECK(print->middle(1) == near(z, 1e-3));
      CHECK(print->half(0) == near(a, 0.01));
      CHECK(print->half(1) == near(a, 0.01));
      CHECK(print->deepest == near(d, 1e-3));
    }
  }
  SUBCASE("of two, of one on its way, of one over the side, of none") {
    SolveConfig c = config;
    c.contacts["other"] = ball(8, 0);
    CHECK(footprint(c, body)->low[0] == near(-2, 0.01));
    CHECK(footprint(c, body)->high[0] == near(10, 0.01));
    c = config;
    c.contacts["ball"].motion.push_back({2, {4, -1, 0}});
    CHECK(footprint(c, body)->high[0] == near(6, 0.01));
    CHECK(footprint(c, body)->half(1) == near(2, 0.01));
    c.contacts["ball"] = ball(14.5, 0);
    CHECK(footprint(c, body)->high[0] == 15);
    c.contacts["ball"] = ball(40, 0);
    CHECK(!footprint(c, body));
  }
}

TEST_CASE("cells go where the indenters are, unless the config says where") {
  SolveConfig config = indentation();
  config.accuracy = "1%";
  config.contacts["ball"] = ball(5, -2);
  SolveConfig told = config;
  choose_accuracy(config, std::nullopt);
  const auto& block = std::get<IndentedBlock>(config.mesh->geometry);
  REQUIRE(block.under.has_value());
  CHECK((*block.under)[0] == near(5, 1e-3));
  CHECK((*block.under)[1] == near(-2, 1e-3));
  std::get<IndentedBlock>(told.mesh->geometry).under = {1, 1};
  choose_accuracy(told, std::nullopt);
  CHECK((*std::get<IndentedBlock>(told.mesh->geometry).under)[0] == 1);
}

TEST_CASE(
    "the next level follows from the error of the one before: cells by their order, increments by its square") {
  ChosenLevel chosen{{CellType::hex8, 0.16, 0.25, 0}, 1, false, false, "", 0.04};
  chosen.written = IndentedBlock{{-15, 0, -15}, {30, 4, 30}, 2.5, 1, 0.16};
  const auto of = [](double cells, double increments, double scatter = 0, double order = 2) {
    return ErrorEstimate{{"force", "N", 100}, cells, increments, scatter, 0, order};
  };
  const auto by_cells = finer_level(chosen, {of(2.2, 0)});
  REQUIRE(by_cells.has_value());
  CHECK(by_cells->edge == near(0.16 * std::sqrt(0.8 / 2.2), 0.05));
  CHECK(by_cells->step == 0.25);
  CHECK(finer_level(chosen, {of(1, 0, 0, 1)})->edge == near(0.16 * 0.8 / 1.25, 0.05));
  const auto by_step = finer_level(chosen, {of(0.3, 2)});
  REQUIRE(by_step.has_value());
  CHECK(by_step->step == near(0.25 * std::sqrt(0.15), 0.01));
  CHECK(by_step->edge > 0.15);
  // where both matter, shorter increments cost less than as much by cells alone
  const auto by_both = finer_level(chosen, {of(0.48, -0.39, 0.16)});
  REQUIRE(by_both.has_value());
  const double edge = by_both->edge / 0.16;
  const double step = by_both->step / 0.25;
  CHECK(0.8 * edge * edge + 0.39 * step * step <= 0.8);
  const double with_usual_step = std::sqrt((0.8 - 0.3) / 0.8);  // 0.35 % and more are cut to 0.3 %
  CHECK(std::pow(edge, -5) / step < 0.8 * std::pow(with_usual_step, -5) / std::sqrt(0.3 / 0.39));
  // with the order that was seen
  CHECK(finer_level(chosen, {of(1.25, 0)}, {{"force", 1}})->edge == near(0.16 * 0.8 / 1.25, 0.05));
  CHECK(!finer_level(chosen, {of(20, 0, 0, 1)}));  // not even the finest
  chosen.level.edge = 0.04;
  CHECK(!finer_level(chosen, {of(3.2, 0)}));  // the finest there is
}

TEST_CASE(
    "a level has at most eight times the cells of the one before, whatever its error, and three times the increments") {
  const auto from = [](const Geometry& written, double edge, double finest) {
    ChosenLevel chosen{{CellType::hex8, edge, 0.25, 0}, 0.1, false, false, "", finest};
    chosen.written = written;
    SolveConfig before, after;
    before.mesh.emplace(), after.mesh.emplace();
    before.mesh->geometry = after.mesh->geometry = written;
    put(chosen, before);
    for (double cells : {0.3, 3.0, 30.0}) {
      CAPTURE(cells);
      const auto next =
          finer_level(chosen, {ErrorEstimate{{"force", "N", 1000}, cells, cells, 0, 0, 2}});
      if (!next) continue;
      ChosenLevel other = chosen;
      other.level = *next;
      put(other, after);
      CHECK(n_cells(after.mesh->geometry) <= 8 * n_cells(before.mesh->geometry));
      if (cells > 1)
        CHECK(n_cells(after.mesh->geometry) >
              n_cells(before.mesh->geometry));  // 0.3: increments alone
      CHECK(next->step < 0.25);
      CHECK(next->step >= 0.25 / 3 - 1e-12);
    }
    CHECK(finest_at_once(chosen).edge < 0.8 * edge);
    CHECK(finest_at_once(chosen).edge >= finest - 1e-12);
  };
  from(IndentedBlock{{-15, 0, -15}, {30, 4, 30}, 2.5, 1, 0.175}, 0.175, 0.04);
  from(IndentedDisc{{15, 4}, 0, 2.5, 1, 0.07}, 0.07, 0.01);
  Block block;
  block.size = {10, 2, 10}, block.divisions = {10, 4, 10};
  from(block, 1, 0.2);
}

TEST_CASE(
    "what a level would take is held against memory and time, and the limits of both are known") {
  CHECK(limit_exceeded({10, 1e9, 2e9}, 20).empty());
  CHECK(limit_exceeded({10, 3e9, 2e9}, 20).find("3.0 GB") != std::string::npos);
  CHECK(limit_exceeded({30, 1e9, 2e9}, 20).find("30 s") != std::string::npos);
  CHECK(!limit_exceeded({30, 1e9, 2e9}, -5).empty());
  setenv("SLURM_JOB_END_TIME", std::to_string(std::time(nullptr) + 100).c_str(), 1);
  CHECK(seconds_left() <= 101);
  CHECK(seconds_left() > 50);
  unsetenv("SLURM_JOB_END_TIME");
  SolveConfig coarse = indentation(), fine = indentation();
  for (SolveConfig* config : {&coarse, &fine}) {
    config->supports = {{"bottom", {Axis::x, Axis::y, Axis::z}}};
    config->material = test::neo_hooke(0.1, 1e-3);
  }
  std::get<IndentedBlock>(fine.mesh->geometry).edge = 0.15;
  const auto nowhere = [](const std::string&) {
    return Place{};
  };
  const LevelCost less = level_cost(coarse, coarse.material, nowhere),
                  more = level_cost(fine, fine.material, nowhere);
  CHECK(less.seconds > 0);
  CHECK(more.seconds > 2 * less.seconds);
  CHECK(more.bytes > less.bytes);
  CHECK(more.free > more.bytes);
}

TEST_CASE("an indenter that touches nothing has a force of 0 and no percent") {
  const ErrorEstimate none{{"force", "N", 0}};
  CHECK(in_words(none) == "force 0 N: nothing is touched");
  CHECK(in_words(ErrorEstimate{{"force", "N", 0}, 0.01}).find("%") == std::string::npos);
  SolveConfig config = indentation();
  config.accuracy = "1%";
  const Accuracy accuracy(
      Voice{"solve", true}, config, std::nullopt, [](const std::string&) { return Place{}; },
      false);
  CHECK(accuracy.summary({none}).empty());
  accuracy.require({none}, "out.h5");
  REQUIRE(accuracy.summary({none, ErrorEstimate{{"force", "N", 2}, 0.01}}).size() == 1);
  CHECK(accuracy.summary({none, ErrorEstimate{{"force", "N", 2}, 0.01}})[0].value == near(0.5));
}

TEST_CASE(
    "cells around a place beside the middle: a line through it, even cells around it, all of them halved by half the edge") {
  for (const auto& [x, z] : {std::pair{5., -3.}, {13., 13.}, {14.9, 0.}, {15., 15.}, {0., 2.}}) {
    const auto at = x;
    CAPTURE(at);
    IndentedBlock b{{-15, 0, -15}, {30, 4, 30}, 2.5, 1, 0.175};
    b.under = {x, z};
    CHECK(b.complaints().empty());
    CHECK(contradictions(b, {}).empty());
    std::vector<std::string> notes;
    const Mesh mesh = mesh_of(b, {}, notes);
    double nearest = 1e9;
    for (const Vec3& X : mesh.X) nearest = std::min(nearest, (X - Vec3(x, 4, z)).norm());
    CHECK(nearest < 1e-9);
    IndentedBlock longer = b;
    longer.longer = 1.5;
    const Mesh coarse = mesh_of(longer, {}, notes);
    CHECK(coarse.n_cells() < 0.6 * mesh.n_cells());
    nearest = 1e9;
    for (const Vec3& X : coarse.X) nearest = std::min(nearest, (X - Vec3(x, 4, z)).norm());
    CHECK(nearest < 1e-9);
    IndentedBlock fine = b;
    fine.edge = 0.0875;
    CHECK(mesh_of(fine, {}, notes).n_cells() == near(8 * mesh.n_cells(), 0.35));
  }
  IndentedBlock outside{{-15, 0, -15}, {30, 4, 30}, 2.5, 1, 0.175};
  outside.under = {16, 0};
  CHECK(!outside.complaints().empty());
  IndentedBlock middle{{-15, 0, -15}, {30, 4, 30}, 2.5, 1, 0.175};
  const Block usual = middle.block();
  middle.under = {0, 0};
  CHECK(middle.block().divisions == usual.divisions);
  CHECK(!middle.block().around);
}

TEST_CASE(
    "half the edge of an indented block halves its cells, and they are even under the indenter") {
  for (double edge : {0.3, 0.2, 0.1}) {
    const IndentedBlock coarse{{-15, 0, -15}, {30, 4, 30}, 2.5, 1, edge},
        fine{{-15, 0, -15}, {30, 4, 30}, 2.5, 1, edge / 2};
    const Block a = coarse.block(), b = fine.block();
    CHECK(coarse.contact_radius() == near(2));
    CHECK(a.centre->edge == near(2 * edge));
    CHECK(b.centre->edge == near(edge));
    for (int i = 0; i < 3; ++i) CHECK(std::abs(b.divisions[i] - 2 * a.divisions[i]) <= 4);
    CHECK(contradictions(coarse, {}).empty());
  }
  // a wide thin layer, a thick block, a block hardly wider than the contact
  for (const IndentedBlock& b :
       {IndentedBlock{{}, {100, 1, 100}, 2.5, 0.3, 0.175},
        IndentedBlock{{}, {30, 30, 30}, 2.5, 1, 0.175}, IndentedBlock{{}, {5, 4, 5}, 2.5, 1, 0.35},
        IndentedBlock{{}, {30, 4, 60}, 0.5, 0.1, 0.175}}) {
    CAPTURE(b.size[0]);
    CAPTURE(b.size[1]);
    CHECK(b.complaints().empty());
    CHECK(contradictions(b, {}).empty());
  }
  CHECK(!IndentedBlock{{}, {4, 4, 4}, 2.5, 1, 0.175}.complaints().empty());
  CHECK(!IndentedBlock{{}, {30, 1, 30}, 2.5, 1.5, 0.175}.complaints().empty());
}
