// Estimated errors against true ones.
#include "scene/error_estimate.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "config/reader.hpp"
#include "config/tree.hpp"

using namespace langer;

namespace {

const auto nowhere = [](const std::string&) { return Place{}; };

SolveConfig rung(const std::string& scene, double edge, double step) {
  const std::string folder = std::string(SOURCE_DIR) + "/configs/solve";
  const std::string text = "include: trade_" + scene + ".yaml\nmesh: {include: ../mesh/trade.yaml}\n";
  SolveConfig config = read_config<SolveConfig>(parse_yaml(text, folder + "/rung.yaml", folder)).config;
  config.mesh->cells = CellType::hex27;
  std::get<IndentedBlock>(config.mesh->geometry).edge = edge;
  config.path.first = config.path.largest = step;
  return config;
}

const Valued& of(const std::vector<Valued>& all, const std::string& name) {
  return *std::find_if(all.begin(), all.end(), [&](const Valued& v) { return v.name == name; });
}

}  // namespace

TEST_CASE("the estimated error of the force is within a factor of three of the true one") {
  struct Case {
    const char* scene;
    double edge, step, right;  // right: pipelines/trade.yaml, the limit of meshes of either kind
  };
  for (const Case& c : {Case{"isotropic", 0.3536, 0.25, 10.7676}, {"isotropic", 0.25, 0.25, 10.7676}}) {
    CAPTURE(c.scene);
    CAPTURE(c.edge);
    const SolveConfig config = rung(c.scene, c.edge, c.step);
    const std::vector<Valued> found = end_of_path(config, config.material, nowhere);
    const std::vector<ErrorEstimate> estimates = estimate_errors(config, config.material, nowhere, found, 1e-9);
    REQUIRE(estimates.size() == found.size());
    CHECK(estimates[0].of.name == "force");
    const double error = std::abs(of(found, "force").value - c.right);
    CHECK(estimates[0].total() < 3 * error);
    CHECK(estimates[0].total() > error / 3);
    CHECK(estimates[0].solver < 1e-7);
    if (c.edge < 0.3) CHECK(std::abs(estimates[0].extrapolated - c.right) < error);  // coarser ones do not approach a limit yet
    CHECK(estimates[0].increments == 0);  // no friction
  }
}

TEST_CASE("two meshes that agree by chance do not pass for right") {
  const SolveConfig config = rung("isotropic", 0.5, 0.25);  // 0.06 % off
  const auto estimates = estimate_errors(config, config.material, nowhere, end_of_path(config, config.material, nowhere), 0);
  CHECK(estimates[0].cells > 0.005 * 10.7676);
}

TEST_CASE("with friction the increments have an error, which falls with them") {
  double last = 1e300;
  for (double step : {1.0, 0.5, 0.25}) {
    const SolveConfig config = rung("table1", 0.8, step);
    const auto estimates = estimate_errors(config, config.material, nowhere, end_of_path(config, config.material, nowhere), 0);
    CHECK(estimates[0].increments > 0);
    CHECK(estimates[0].increments < last);
    last = estimates[0].increments;
  }
}

TEST_CASE("a mesh whose cells no number scales has no second rung") {
  SolveConfig config = rung("isotropic", 0.8, 1);
  config.mesh->geometry = Block{};
  CHECK_THROWS_AS(estimate_errors(config, config.material, nowhere, {}, 0), Failure);
}
