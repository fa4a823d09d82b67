// From a curve of one's own to an indentation: the starter's fit and scene, with curves of many
// shapes.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "accuracy/estimate/error_estimate.hpp"
#include "accuracy/refinement/accuracy.hpp"
#include "core/base/random.hpp"
#include "identification/fit/stiffness_at_rest.hpp"
#include "identification/setup/fit_config_io.hpp"
#include "mechanics/material/at_rest.hpp"
#include "scene/model/solve_config_io.hpp"
#include "support/solved_scene.hpp"

using namespace langer;
namespace fs = std::filesystem;

namespace {

const std::string starter = SOURCE_DIR "/share/new/indentation/";

using Curve = double (*)(double e);  // nominal stress over the engineering strain, of any unit

struct Pair {
  const char* name;
  Curve along, across;
  double reach;   // largest strain along; across a quarter more
  double stress;  // largest along [kPa]
  double noise;   // of that
  int points;
};

const Pair pairs[] = {
    {"exponential, slow", [](double e) { return std::exp(3 * e) - 1; },
     [](double e) { return 0.5 * (std::exp(2 * e) - 1); }, 0.5, 300, 0.01, 16},
    {"exponential, fast", [](double e) { return std::exp(25 * e) - 1; },
     [](double e) { return 40 * (std::exp(12 * e) - 1); }, 0.4, 2000, 0.02, 16},
    {"Fung", [](double e) { return e * std::exp(14 * e * e); },
     [](double e) { return e * std::exp(6 * e * e); }, 0.5, 800, 0.02, 20},
    {"sigmoidal toe", [](double e) { return std::log1p(std::exp(30 * (e - 0.25))); },
     [](double e) { return 0.3 * std::log1p(std::exp(20 * (e - 0.35))); }, 0.45, 5000, 0.01, 18},
    {"nearly linear", [](double e) { return e; }, [](double e) { return 0.6 * e; }, 0.4, 100, 0.01,
     12},
    {"fourth power", [](double e) { return std::pow(e, 4); },
     [](double e) { return 0.4 * std::pow(e, 4); }, 0.5, 1000, 0, 16},
    {"no stress up to 25 %", [](double e) { return std::max(0., e - 0.25); },
     [](double e) { return 0.5 * std::max(0., e - 0.3); }, 0.5, 1500, 0, 25},
    {"concave", [](double e) { return std::tanh(6 * e); },
     [](double e) { return 0.7 * std::tanh(5 * e); }, 0.4, 60, 0.01, 14},
    {"convex, then concave", [](double e) { return std::pow(std::sin(3 * e), 2); },
     [](double e) { return 0.5 * std::pow(std::sin(2.4 * e), 2); }, 0.5, 400, 0.02, 16},
    {"softer than 1 kPa", [](double e) { return std::exp(6 * e) - 1; },
     [](double e) { return 0.4 * (std::exp(5 * e) - 1); }, 0.5, 0.8, 0.02, 16},
    {"stiffer than 20 MPa", [](double e) { return std::exp(18 * e) - 1; },
     [](double e) { return 0.05 * (std::exp(10 * e) - 1); }, 0.2, 25000, 0.01, 16},
    {"five points", [](double e) { return std::exp(9 * e) - 1; },
     [](double e) { return 0.3 * (std::exp(7 * e) - 1); }, 0.4, 500, 0.03, 5},
    {"noise of 5 %", [](double e) { return std::exp(10 * e) - 1; },
     [](double e) { return 0.2 * (std::exp(8 * e) - 1); }, 0.45, 900, 0.05, 16},
};

void write_curve(const fs::path& file, const Pair& pair, bool across, std::uint64_t stream) {
  Random random(23, stream);
  const double reach = across ? 1.25 * pair.reach : pair.reach,
               size = pair.stress / pair.along(pair.reach);
  const Curve curve = across ? pair.across : pair.along;
  std::ofstream out(file);
  out << "stretch,nominal_stress_kPa\n";
  for (int i = 0; i < pair.points; ++i) {
    const double e = reach * i / (pair.points - 1);
    out << fmt::format("{},{}\n", 1 + e,
                       i == 0 ? 0. : size * curve(e) + pair.noise * pair.stress * random.normal());
  }
}

struct Fitted {
  FitResult fit;
  std::optional<StiffnessAtRest> at_rest;
};

Fitted fitted(const std::string& along, const std::string& across) {
  FitConfig config = read_config<FitConfig>(load_yaml(starter + "fit.yaml")).config;
  config.data[0].file.path = along, config.data[1].file.path = across;
  FitProblem problem = fit_problem(config);
  const FitOptions options{config.searches(), static_cast<unsigned>(config.seed), {}};
  Fitted one{fit(problem, options), {}};
  REQUIRE(one.fit.best.converged);
  one.at_rest = stiffen_at_rest(problem, one.fit, options, 0.01);
  return one;
}

// the starter's scene with such a law: what stands at the end of its path
double force_of(const Material& material) {
  SolveConfig config = read_config<SolveConfig>(load_yaml(starter + "solve.yaml")).config;
  const auto level = choose_accuracy(config, material);
  REQUIRE(level);
  config.stability = StabilityCheck::off;
  for (const Valued& v : end_of_path(config, material, test::nowhere))
    if (v.name == "force") return v.value;
  return 0;
}

void journey(const std::string& along, const std::string& across) {
  const Fitted one = fitted(along, across);
  CHECK(at_rest(one.fit.material) == AtRest::stiff);
  if (one.at_rest) {
    CHECK(one.at_rest->taken >= one.at_rest->least * (1 - 1e-9));
    CHECK(one.at_rest->fitted < one.at_rest->least);
    // what is taken is not more than one standard deviation of the noise where the tests do not
    // speak against it
    if (one.at_rest->taken <= one.at_rest->allowed)
      CHECK(in_words(*one.at_rest).find("more than they allow") == std::string::npos);
    MESSAGE(in_words(*one.at_rest));
  }
  const double force = force_of(one.fit.material);
  MESSAGE("force ", force, " N, mean error ", one.fit.quality.mean_error_percent, " %");
  CHECK(force > 0);
}

}  // namespace

TEST_CASE("curves of thirteen shapes each lead to a force") {
  const fs::path folder = fs::path(BINARY_DIR) / "first_journey";
  fs::create_directories(folder);
  for (std::size_t i = 0; i < std::size(pairs); ++i) {
    const std::string name = pairs[i].name;
    CAPTURE(name);
    MESSAGE(name);
    write_curve(folder / "along.csv", pairs[i], false, 2 * i);
    write_curve(folder / "across.csv", pairs[i], true, 2 * i + 1);
    journey((folder / "along.csv").string(), (folder / "across.csv").string());
  }
}

TEST_CASE("curves that came from outside each lead to a force") {
  const fs::path curves = fs::path(SOURCE_DIR) / "../shared/cases/curves";
  if (!fs::exists(curves)) {
    MESSAGE("skipped: no ../shared/cases/curves");
    return;
  }
  for (const std::string name : {"exp12_8", "exp8_5", "fung2", "neo_like", "toe_human"}) {
    CAPTURE(name);
    MESSAGE(name);
    journey((curves / name / "along.csv").string(), (curves / name / "across.csv").string());
  }
}
