#include "pipeline/sweep/design.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace langer {

namespace {

// Base value and bounds of each parameter.
struct Box {
  VecX value, lower, upper;
  explicit Box(const Design& design) {
    const auto k = static_cast<Eigen::Index>(design.parameters.size());
    value.resize(k);
    lower.resize(k);
    upper.resize(k);
    for (Eigen::Index i = 0; i < k; ++i) {
      const DesignParameter& p = design.parameters[static_cast<std::size_t>(i)];
      lower[i] = p.lower;
      upper[i] = p.upper;
      value[i] = p.value.value_or(0.5 * (p.lower + p.upper));
    }
  }
};

// Runs all methods of a design on a function phi of the parameters. The results of
// one_at_a_time() are per unit of the parameter, so they are multiplied by the ranges.
QuantityEffects effects(const Design& design, const ParametricCurve& phi) {
  const Box box(design);
  QuantityEffects e;
  SamplingOptions options;
  options.seed = static_cast<std::uint64_t>(design.seed);
  options.resamples = design.resamples;
  const CurveMaker maker = [&] {
    return phi;
  };
  if (design.one_at_a_time)
    e.one_at_a_time =
        one_at_a_time(phi, box.value, box.lower, box.upper, design.one_at_a_time->steps);
  if (design.morris)
    e.morris = morris(maker, box.lower, box.upper, design.morris->trajectories,
                      design.morris->levels, options);
  if (design.sobol) {
    options.sequence = design.sobol->sequence;
    e.sobol = sobol(maker, box.lower, box.upper, design.sobol->samples, options);
  }
  if (e.one_at_a_time && e.one_at_a_time->complete)
    for (MatX* A : {&e.one_at_a_time->mu_star, &e.one_at_a_time->s, &e.one_at_a_time->spread})
      *A = (box.upper - box.lower).asDiagonal() * *A;
  return e;
}

std::vector<double> list(const VecX& p) { return {p.data(), p.data() + p.size()}; }

}  // namespace

// Bounds must be in order, names must differ, and Morris' grid needs an even number of levels: its
// step is levels / (2 (levels - 1)) of the range, so that all levels are equally likely [M91].
std::vector<Complaint> Design::complaints() const {
  std::vector<Complaint> all;
  if (parameters.empty()) all.push_back({"parameters", "an empty list", "one key at least", ""});
  if (!one_at_a_time && !morris && !sobol)
    all.push_back({"", "no method", "one_at_a_time, morris or sobol",
                   "for example morris: {trajectories: 6, levels: 4}"});
  if (morris && (morris->levels % 2 || morris->levels < 4))
    all.push_back({"morris.levels", "found " + std::to_string(morris->levels),
                   "an even number from 4 on", ""});
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const DesignParameter& p = parameters[i];
    const std::string at = "parameters[" + std::to_string(i) + "].";
    if (split_path(p.key).empty())
      all.push_back(
          {at + "key", "found \"" + p.key + "\"", "a path like contacts[0].friction", ""});
    if (!(p.lower < p.upper))
      all.push_back({at + "upper", "found " + number_text(p.upper),
                     "more than lower, " + number_text(p.lower), ""});
    else if (p.value && (*p.value < p.lower || *p.value > p.upper))
      all.push_back(
          {at + "value", "found " + number_text(*p.value), "a value between the bounds", ""});
    for (std::size_t j = 0; j < i; ++j)
      if (short_name(parameters[j]) == short_name(p))
        all.push_back({at + "name", "\"" + short_name(p) + "\" a second time", "another name", ""});
  }
  return all;
}

// The last part of the key without brackets: fibre_angles[0] is fibre_angles0.
std::string short_name(const DesignParameter& p) {
  if (!p.name.empty()) return p.name;
  std::string name;
  for (const char c : p.key.substr(p.key.rfind('.') + 1))
    if (c != '[' && c != ']') name += c;
  return name;
}

// Several methods may use the same point, for example the base value; it is solved once.
std::vector<VecX> design_points(const Design& design) {
  std::vector<VecX> points;
  std::map<std::vector<double>, bool> seen;
  Design recorded = design;
  recorded.resamples = 0;
  effects(recorded, [&](const VecX& p, VecX& y) {
    if (!std::exchange(seen[list(p)], true)) points.push_back(p);
    y = VecX::Zero(1);
    return true;
  });
  return points;
}

// The methods meet the same points in the same order as in design_points(), because the seed is the
// same; each point is looked up by its exact values.
QuantityEffects effects_of(const Design& design, const std::string& name, const std::string& unit,
                           const std::vector<double>& values) {
  const std::vector<VecX> points = design_points(design);
  std::map<std::vector<double>, double> results;
  for (std::size_t i = 0; i < points.size(); ++i) results[list(points[i])] = values.at(i);
  QuantityEffects e = effects(design, [&](const VecX& p, VecX& y) {
    y = VecX::Constant(1, results.at(list(p)));
    return true;
  });
  e.name = name;
  e.unit = unit;
  return e;
}

}  // namespace langer
