// A design of experiments on whole runs: which values of a few keys a sweep takes, so that
// one-at-a-time effects, Morris' trajectories or Sobol's shares of any collected quantity can be
// told from its members.
//   sweep:
//     sample:
//       design:
//         parameters: [{key: "material.fibres[0].hgo.c1", lower: -0.4, upper: -0.2, unit: MPa}, ...]
//         morris: {trajectories: 6, levels: 4}
// The points are those at which the methods of lib/sensitivity ask for their curve, each once: what
// they ask does not depend on the answers, so the same methods, given the members' values, make the
// effects.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/fields.hpp"
#include "identification/sensitivity/morris.hpp"
#include "identification/sensitivity/sensitivity_config.hpp"
#include "identification/sensitivity/sobol.hpp"

namespace langer {

struct DesignParameter {
  std::string key, name, unit = unit::none;
  double lower = 0, upper = 0;
  std::optional<double> value;
  static void fields(auto& v) {
    v(&DesignParameter::key, "key", unit::none,
      "path of the key that varies, such as fibre_angles[0]", required);
    v(&DesignParameter::name, "name", unit::none, "in tables; by default the last word of the key");
    v(&DesignParameter::unit, "unit", unit::none, "of the value, for tables");
    v(&DesignParameter::lower, "lower", unit::none, "lower bound", required);
    v(&DesignParameter::upper, "upper", unit::none, "upper bound", required);
    v(&DesignParameter::value, "value", unit::none,
      "where it stays while others move one at a time; by default the middle");
  }
};

struct OneAtATimeChoice {
  int steps = 4;
  static void fields(auto& v) {
    v(&OneAtATimeChoice::steps, "steps", unit::none,
      "from the lower to the upper bound; k (steps + 1) members", between(2, 1000));
  }
};

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
      "the paper's way: one moves, the others stay");
    v(&Design::morris, "morris", unit::none,
      "trajectories (k + 1) members, places that come again counted once");
    v(&Design::sobol, "sobol", unit::none, "samples (k + 2) + 1 members");
    v(&Design::seed, "seed", unit::none, "of the random places", at_least(0));
    v(&Design::resamples, "resamples", unit::none, "of the bootstrap behind each 95 % interval",
      between(50, 100000));
    v(&Design::figures, "figures", unit::none, "draw the effects on each quantity");
  }
  std::vector<Complaint> complaints() const;
};

std::string short_name(const DesignParameter& p);

// members of the sweep in order, one value for each parameter
std::vector<VecX> design_points(const Design& design);

// What the parameters do to one quantity: rows are parameters, there is one column; in units of the
// quantity over the range.
struct QuantityEffects {
  std::string name, unit;
  std::optional<OneAtATime> one_at_a_time;  // mu_star, s, spread times (upper - lower)
  std::optional<Morris> morris;
  std::optional<Sobol> sobol;
};

// values: of each point; NaN where a member lacks it: what needs it is left out
QuantityEffects effects_of(const Design& design, const std::string& name, const std::string& unit,
                           const std::vector<double>& values);

}  // namespace langer
