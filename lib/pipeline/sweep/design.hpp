// A design of experiments on whole runs: the values of a few keys in a sweep are chosen so that the
// effect of each key on any collected quantity can be computed from the members.
//   sweep:
//     sample:
//       design:
//         parameters: [{key: "material.fibres[0].hgo.c1", lower: -0.4, upper: -0.2, unit: MPa}, ...]
//         morris: {trajectories: 6, levels: 4}
// The methods are those of lib/identification/sensitivity: one at a time, Morris' elementary
// effects [M91], Sobol' indices [S10]. They evaluate a function at points that do not depend on its
// values. So they run twice: first on a function that only records the points, which become the
// members of the sweep; then, when the members are solved, on the function that returns their
// results.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/fields.hpp"
#include "identification/sensitivity/morris.hpp"
#include "identification/sensitivity/sensitivity_config.hpp"
#include "identification/sensitivity/sobol.hpp"

namespace langer {

// One parameter of a design: a key of a node's config with its range.
struct DesignParameter {
  std::string key, name, unit = unit::none;
  double lower = 0, upper = 0;
  std::optional<double> value;
  static void fields(auto& v) {
    v(&DesignParameter::key, "key", unit::none,
      "path of the key that varies, such as fibre_angles[0]", required);
    v(&DesignParameter::name, "name", unit::none,
      "name in tables; by default the last word of the key");
    v(&DesignParameter::unit, "unit", unit::none, "of the value, for tables");
    v(&DesignParameter::lower, "lower", unit::none, "lower bound", required);
    v(&DesignParameter::upper, "upper", unit::none, "upper bound", required);
    v(&DesignParameter::value, "value", unit::none,
      "value while other parameters vary one at a time; by default the middle of the bounds");
  }
};

// Steps of a single parameter from the lower to the upper bound.
struct OneAtATimeChoice {
  int steps = 4;
  static void fields(auto& v) {
    v(&OneAtATimeChoice::steps, "steps", unit::none,
      "from the lower to the upper bound; k (steps + 1) members", between(2, 1000));
  }
};

// The key `design` of an axis: the parameters, one or more methods, and their options.
struct Design {
  std::vector<DesignParameter> parameters;
  std::optional<OneAtATimeChoice> one_at_a_time;
  std::optional<MorrisChoice> morris;
  std::optional<SobolChoice> sobol;
  int seed = 1, resamples = 500;
  bool figures = false;
  static void fields(auto& v) {
    v(&Design::parameters, "parameters", unit::none, "what varies, all of one node", required);
    v(&Design::one_at_a_time, "one_at_a_time", unit::none,
      "the paper's method: one parameter varies, the others are constant");
    v(&Design::morris, "morris", unit::none,
      "trajectories (k + 1) members; repeated points are solved once");
    v(&Design::sobol, "sobol", unit::none, "samples (k + 2) + 1 members");
    v(&Design::seed, "seed", unit::none, "of the random points", at_least(0));
    v(&Design::resamples, "resamples", unit::none, "of the bootstrap behind each 95 % interval",
      between(50, 100000));
    v(&Design::figures, "figures", unit::none, "draw the effects on each quantity");
  }
  std::vector<Complaint> complaints() const;
};

// The name in tables: `name`, or the last word of the key.
std::string short_name(const DesignParameter& p);

// The points of the design, which are the members of the sweep in order. A point has one value for
// each parameter.
std::vector<VecX> design_points(const Design& design);

// The effects of the parameters on one quantity. Rows are parameters, and there is one column.
// Effects are in the unit of the quantity, for a change over the whole range of the parameter.
struct QuantityEffects {
  std::string name, unit;
  std::optional<OneAtATime> one_at_a_time;  // mu_star, s, spread times (upper - lower)
  std::optional<Morris> morris;
  std::optional<Sobol> sobol;
};

// values: the quantity at each point; NaN for a member without it. Samples that need such a point
// are left out.
QuantityEffects effects_of(const Design& design, const std::string& name, const std::string& unit,
                           const std::vector<double>& values);

}  // namespace langer
