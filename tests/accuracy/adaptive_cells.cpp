// Cells that are cut where the error comes from, until an accuracy is reached.
#include "accuracy/refinement/adaptive_cells.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numeric>

#include "accuracy/estimate/dual_estimate.hpp"
#include "accuracy/refinement/model_choice.hpp"
#include "scene/run/step_record.hpp"
#include "support/block.hpp"
#include "support/section.hpp"

using namespace langer;

namespace {

struct Found {
  std::vector<int> cells;  // of each level
  std::vector<double> percent, value;
  std::vector<Reduction::Kind> kind;
  Mesh mesh;
};
Found adapted(const std::string& text) {
  const SolveConfig config = test::config_of(text);
  ModelChoice model({"solve", true}, config, "", config.material, test::nowhere, false);
  Found out;
  for (;;) {
    Run run(model.mesh(), model.config(), config.material, test::nowhere);
    const RunEnd end = run.follow();
    REQUIRE(end.path.complete);
    const PathErrors errors = dual_errors(model.config(), run, end.last,
                                          valued(model.config(), run.scene, run.mesh, end.last));
    out.cells.push_back(run.mesh.n_cells()), out.kind.push_back(run.reduction.kind()),
        out.mesh = run.mesh;
    const auto judged = forces_judged(errors.at_end);
    out.percent.push_back(judged.empty() ? 1e9 : judged[0].in_percent(judged[0].total()));
    out.value.push_back(judged.empty() ? 0 : judged[0].of.value);
    REQUIRE(out.cells.size() < 9);
    if (model.decide(errors, run.mesh).action != Decision::Action::refine) return out;
  }
}

const std::string sheared =
    "mesh: {geometry: {block: {size: [10, 4, 6], divisions: [5, 3, 4]}}}\n"
    "material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 1.0e-4}}}\n"
    "supports: [{on: bottom, hold: [x, y, z]}, {on: top, hold: [y, z]}]\nloads: [{on: top, displacement: {x: 1.5}}]\n"
    "path: {steps: 2}\nstability: off\nestimate: dual\n";

}  // namespace

TEST_CASE("the largest parts are marked, as many as it takes, and parts that are alike together") {
  std::vector<double> parts(70);
  for (std::size_t i = 0; i < parts.size(); ++i)
    parts[i] = std::pow(0.9, static_cast<double>(i % 35));  // each twice
  const double sum = std::accumulate(parts.begin(), parts.end(), 0.0);
  for (double wanted : {0.35, 0.5, 0.6}) {
    const std::vector<char> marked = largest_parts(parts, wanted, 2);
    double of_marked = 0, least = 1, most = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (marked[i]) of_marked += parts[i], least = std::min(least, parts[i]);
      if (!marked[i]) most = std::max(most, parts[i]);
      CHECK(marked[i] == marked[(i + 35) % 70]);
    }
    CHECK(most < least);
    CHECK(sum - 0.75 * of_marked <= wanted * sum * (1 + 1e-12));  // cut to a quarter each
    CHECK(sum - 0.75 * (of_marked - 2 * least) > wanted * sum);  // with a pair less it would not do
  }
  const auto n_marked = [&](double wanted, double order) {
    const std::vector<char> marked = largest_parts(parts, wanted, order);
    return std::accumulate(marked.begin(), marked.end(), 0);
  };
  CHECK(n_marked(0.5, 1) > n_marked(0.5, 2));
  CHECK(n_marked(0.999, 2) >= 10);  // a seventh of them
  CHECK(n_marked(0, 2) < 70);       // where nothing is known: not all
  parts.assign(70, 0);
  parts[3] = 1;
  const std::vector<char> one = largest_parts(parts, 0.1, 2);
  CHECK(std::accumulate(one.begin(), one.end(), 0) == 1);  // never those that have no part
}

TEST_CASE(
    "cells are cut until the accuracy is reached, symmetric ones as symmetric, and the force is within it") {
  const Found found = adapted(sheared + "accuracy: 2%\n");
  REQUIRE(found.cells.size() > 2);
  for (std::size_t i = 1; i < found.cells.size(); ++i) {
    CHECK(found.cells[i] >= 2 * found.cells[i - 1] - 7);
    CHECK(found.kind[i] == found.kind[0]);  // half of the body is solved
  }
  CHECK(found.kind[0] == Reduction::Kind::symmetry);
  CHECK(found.percent.back() <= 2);
  CHECK(found.percent[0] > 2);
  CHECK(!found.mesh.hanging.empty());
  double right = 0;  // on cells of second order
  SolveConfig fine = test::config_of(sheared);
  fine.mesh->cells = CellType::hex27;
  std::get<Block>(fine.mesh->geometry).divisions = {10, 8, 8};
  for (const Valued& v : end_of_path(fine, fine.material, test::nowhere))
    if (v.name == "reaction_top") right = v.value;
  const double off = 100 * std::abs(found.value.back() / right - 1);
  CAPTURE(off);
  CHECK(off < found.percent.back());
  CHECK(off < 0.6 * 100 * std::abs(found.value[0] / right - 1));
}

TEST_CASE(
    "cells of which dual solutions or hanging nodes know nothing are not cut, and the reason is told") {
  SolveConfig config = test::config_of(sheared);
  CHECK(reason_not_refinable(config).empty());
  config.estimate = EstimateBy::recovery;
  CHECK(reason_not_refinable(config).empty());
  config.mesh->geometry = IndentedBlock{{0, 0, 0}, {10, 4, 10}, 2.5, 0.5};
  CHECK(reason_not_refinable(config) == "recovery judges graded lines as they are");
  config.estimate = EstimateBy::refinement;
  CHECK(!reason_not_refinable(config).empty());
  config = test::config_of(sheared);
  config.sensitivity = {"matrix.neo_hooke.a1"};
  CHECK(reason_not_refinable(config) == "found derivatives");
  Mesh mesh = test::cube(2);
  CHECK(reason_not_refinable(mesh).empty());
  mesh.type = CellType::hex27;
  CHECK(!reason_not_refinable(mesh).empty());
}

TEST_CASE(
    "where a next level finds no equilibrium the one before it is the last, and the accuracy that it reached is told") {
  const SolveConfig config = test::config_of(sheared + "accuracy: 1%\n");
  ModelChoice model({"solve", true}, config, "", config.material, test::nowhere, false);
  const Failure stuck(Exit::not_converged, Error{{}, "", "stopped at t = 0.5", "", ""});
  CHECK(!model.retry_after(stuck));  // of the first level nothing is known
  const Mesh first = model.mesh();
  PathErrors errors;
  errors.at_end = {{{"reaction_top", "N", 2.0}, 0.06}};  // 3 %
  errors.of_cells.assign(static_cast<std::size_t>(first.n_cells()), 1);
  REQUIRE(model.decide(errors, first).action == Decision::Action::refine);
  CHECK(model.mesh().n_cells() > first.n_cells());
  REQUIRE(model.retry_after(stuck));
  CHECK(model.mesh().n_cells() == first.n_cells());
  CHECK(model.decide(errors, first).action == Decision::Action::stop);
  CHECK(!model.retry_after(stuck));
  try {
    model.require_accuracy(errors.at_end, "out.h5");
    FAIL("3 % are taken for 1 %");
  } catch (const Failure& failure) {
    CHECK(failure.code() == Exit::not_accurate);
    CHECK(
        failure.errors()[0].found ==
        "asked for 1 %, and the error of the force is estimated at 3 %; a next level found no equilibrium: stopped at t = 0.5");
  }
}

TEST_CASE("a layer of one cell is cut everywhere before its error is asked for") {
  std::string thin = sheared;
  thin.replace(thin.find("[5, 3, 4]"), 9, "[5, 1, 4]");
  const Found found = adapted(thin + "accuracy: 8%\n");
  REQUIRE(found.cells.size() >= 2);
  CHECK(found.cells[1] == 160);
  CHECK(found.percent.back() <= 8);
}

TEST_CASE(
    "under an indenter that is small beside the cells these are cut before the first solution, and nowhere else") {
  const std::string text =
      "mesh: {geometry: {block: {origin: [-10, 0, -10], size: [20, 6, 20], divisions: [5, 3, 5]}}}\n"
      "material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 1.0e-3}}}\n"
      "supports: [{on: bottom, hold: [x, y, z]}]\npath: {steps: 2}\nstability: off\nestimate: dual\n"
      "contacts: {ball: {rigid: {sphere: {radius: 1, centre: [3, 7, -2]}}, friction: 0, motion: [{t: 1, to: [0, -0.4, 0]}]}}\n";
  const SolveConfig config = test::config_of(text);
  CutMesh cells(test::mesh_in(config));
  CHECK(shorten_under(config, cells) == 4);  // 4 mm to 0.25; half of what touches is 0.8 mm wide
  const Mesh& mesh = cells.mesh();
  const auto longest_at = [&](double x, double z) {
    for (int e = 0; e < mesh.n_cells(); ++e) {
      Vec3 low = mesh.X[static_cast<std::size_t>(mesh.cell(e)[0])], high = low;
      for (int n : mesh.cell(e))
        low = low.cwiseMin(mesh.X[static_cast<std::size_t>(n)]),
        high = high.cwiseMax(mesh.X[static_cast<std::size_t>(n)]);
      if (high[1] == 6 && low[0] <= x && x <= high[0] && low[2] <= z && z <= high[2])
        return high[0] - low[0];
    }
    return 0.0;
  };
  for (const auto& [x, z] :
       {std::pair(3.0, -2.0), {3.75, -2.0}, {2.25, -2.0}, {3.0, -1.25}, {3.5, -2.5}})
    CHECK(longest_at(x, z) == 0.25);
  CHECK(longest_at(-9, 9) == 4);
  CHECK(mesh.n_cells() < 3000);
  CHECK(shorten_under(config, cells) == 0);
  const Found found = adapted(text + "accuracy: 25%\n");  // nothing refuses it
  CHECK(found.percent.back() <= 25);
}
