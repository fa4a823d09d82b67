// What the sensitivity stage's YAML may say.
//   parameters: [{key: matrix.yeoh.a1, lower: 0.1, upper: 0.4}, {key: "fibres[0].hgo.c2", around: 0.5}]
//   morris: {trajectories: 200}
//   sobol: {samples: 8192}
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/base/fields.hpp"
#include "core/config/writer.hpp"
#include "identification/sensitivity/sampling.hpp"
#include "mechanics/material/path.hpp"
#include "results/plot/figure_style.hpp"

namespace langer {

struct RankedParameter {
  std::string key;
  std::optional<double> lower, upper, around;
  static void fields(auto& v) {
    v(&RankedParameter::key, "key", unit::none,
      "path of a number of the material, such as matrix.yeoh.a1", required);
    v(&RankedParameter::lower, "lower", unit::none, "lower bound, in the unit of the number");
    v(&RankedParameter::upper, "upper", unit::none, "upper bound");
    v(&RankedParameter::around, "around", unit::none,
      "instead of bounds: the value minus and plus this fraction of its size; with neither, the bounds of the fit",
      positive);
  }
};

struct StrainRange {
  double from = 0, to = 0.6;
  int points = 61;
  static void fields(auto& v) {
    constexpr Range above_minus_one{-1, std::numeric_limits<double>::infinity(), false, true};
    v(&StrainRange::from, "from", unit::none, "first engineering strain", above_minus_one);
    v(&StrainRange::to, "to", unit::none, "last engineering strain", above_minus_one);
    v(&StrainRange::points, "points", unit::none, "number of strains, evenly spaced",
      between(2, 100000));
  }
};

struct MorrisChoice {
  int trajectories = 100, levels = 8;
  static void fields(auto& v) {
    v(&MorrisChoice::trajectories, "trajectories", unit::none,
      "random paths through the box; each costs k + 1 curves", between(2, 1000000));
    v(&MorrisChoice::levels, "levels", unit::none,
      "values of each parameter on the grid, an even number", between(2, 1000));
  }
};

struct SobolChoice {
  int samples = 8192;
  Sequence sequence = Sequence::sobol;
  static void fields(auto& v) {
    v(&SobolChoice::samples, "samples", unit::none,
      "rows of the two samples; each costs k + 2 curves", between(64, 100000000));
    v(&SobolChoice::sequence, "sequence", unit::none,
      "where the samples lie: sobol, a low-discrepancy sequence, evenly (best where samples are a power of 2), or random");
  }
};

struct SensitivityConfig {
  std::vector<RankedParameter> parameters;
  StrainRange strain;
  int steps = 1000;
  std::vector<std::array<double, 2>> zones = {{0, 0.2}, {0.2, 0.4}, {0.4, 0.6}};
  Dilatation dilatation = Dilatation::incompressible;
  StressMeasure stress = StressMeasure::cauchy;
  Path test = Path::uniaxial;
  double turn = 0;
  std::optional<MorrisChoice> morris;
  std::optional<SobolChoice> sobol;
  int seed = 1;
  int resamples = 500;
  int threads = 1;
  bool figures = false;
  FigureStyle figure_style;
  static void fields(auto& v) {
    v(&SensitivityConfig::parameters, "parameters", unit::none,
      "the numbers to rank; none means those of the fit, between the fit's bounds");
    v(&SensitivityConfig::strain, "strain", unit::none,
      "where the stress is looked at; in simple shear the shear");
    v(&SensitivityConfig::steps, "steps", unit::none,
      "steps from the lower to the upper bound, n of eq. 40", between(2, 1000000));
    v(&SensitivityConfig::zones, "zones", unit::none,
      "ranges of strain over which effects are averaged");
    v(&SensitivityConfig::dilatation, "dilatation", unit::none,
      "state of the specimen: the volume term left out (incompressible) or counted");
    v(&SensitivityConfig::stress, "stress", unit::none, "stress that is looked at");
    v(&SensitivityConfig::test, "test", unit::none,
      "how the sheet is loaded; along x, and z in equibiaxial tension");
    v(&SensitivityConfig::turn, "turn", unit::deg,
      "added to the fibre angles: the sheet is cut in another direction", between(-360, 360));
    v(&SensitivityConfig::morris, "morris", unit::none,
      "Morris' trajectories as well: what curvature and interactions do");
    v(&SensitivityConfig::sobol, "sobol", unit::none,
      "Sobol's shares of variance as well: first and total");
    v(&SensitivityConfig::seed, "seed", unit::none, "of the random samples", at_least(0));
    v(&SensitivityConfig::resamples, "resamples", unit::none,
      "of the bootstrap behind each 95 % interval", between(50, 100000));
    v(&SensitivityConfig::threads, "threads", unit::none,
      "processor cores; the results do not depend on it", between(1, 1024));
    v(&SensitivityConfig::figures, "figures", unit::none, "draw effects over strain and by zone");
    v(&SensitivityConfig::figure_style, "figure_style", unit::none, "how figures are made");
  }
  std::vector<Complaint> complaints() const {
    std::vector<Complaint> all;
    if (!(strain.from < strain.to))
      all.push_back({"strain.to", "found " + number_text(strain.to),
                     "more than from, " + number_text(strain.from), ""});
    if (dilatation == Dilatation::compressible && test != Path::uniaxial)
      all.push_back(
          {"dilatation", "compressible in a test that is not uniaxial", "incompressible", ""});
    if (morris && morris->levels % 2)
      all.push_back(
          {"morris.levels", "found " + std::to_string(morris->levels), "an even number", ""});
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      const RankedParameter& p = parameters[i];
      const std::string at = "parameters[" + std::to_string(i) + "]";
      if (p.lower.has_value() != p.upper.has_value())
        all.push_back(
            {at, p.lower ? "lower without upper" : "upper without lower", "both or neither", ""});
      else if (p.lower && p.around)
        all.push_back(
            {at + ".around", "around together with lower and upper", "one of the two", ""});
      else if (p.lower && !(*p.lower < *p.upper))
        all.push_back({at + ".upper", "found " + number_text(*p.upper),
                       "more than lower, " + number_text(*p.lower), ""});
      for (std::size_t j = 0; j < i; ++j)
        if (parameters[j].key == p.key)
          all.push_back({at + ".key", "\"" + p.key + "\" a second time", "each number once", ""});
    }
    for (std::size_t z = 0; z < zones.size(); ++z)
      if (!(zones[z][0] < zones[z][1]))
        all.push_back(
            {"zones[" + std::to_string(z) + "]", "an empty zone", "[from, to] with from < to", ""});
    return all;
  }
};

}  // namespace langer
