// Effects of a design as text. All tables and charts take their numbers from values(), so a method
// that a design lacks is missing everywhere in the same way.
#include "pipeline/sweep/design_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string_view>

#include "core/base/text.hpp"
#include "pipeline/sweep/table_cell.hpp"
#include "results/store/curves_file.hpp"

namespace langer {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

// One effect with its 95 % interval; share: a part of the variance, without a unit.
struct Value {
  const char* name;
  bool share;
  double value, low, high;
};

// Interval estimates need at least two samples that could be evaluated.
bool has_one_at_a_time(const QuantityEffects& e) {
  return e.one_at_a_time && e.one_at_a_time->complete;
}
bool has_morris(const QuantityEffects& e) { return e.morris && e.morris->trajectories >= 2; }
bool has_sobol(const QuantityEffects& e) { return e.sobol && e.sobol->rows >= 2; }

Value value_of(const char* name, bool share, const Estimate& x, Eigen::Index i) {
  return {name, share, x.value(i, 0), x.low(i, 0), x.high(i, 0)};
}

// The effects of one parameter by every method, always in the same order; NaN if the design does
// not have the method, or too few of its samples could be evaluated.
std::vector<Value> values(const QuantityEffects& e, Eigen::Index i) {
  std::vector<Value> all{{"one_at_a_time", false, none, none, none},
                         {"one_at_a_time_spread", false, none, none, none},
                         {"morris_mu_star", false, none, none, none},
                         {"morris_sigma", false, none, none, none},
                         {"sobol_first", true, none, none, none},
                         {"sobol_total", true, none, none, none}};
  if (has_one_at_a_time(e)) {
    all[0].value = e.one_at_a_time->mu_star(i, 0);
    all[1].value = e.one_at_a_time->spread(i, 0);
  }
  if (has_morris(e)) {
    all[2] = value_of("morris_mu_star", false, e.morris->mu_star, i);
    all[3] = value_of("morris_sigma", false, e.morris->sigma, i);
  }
  if (has_sobol(e)) {
    all[4] = value_of("sobol_first", true, e.sobol->first, i);
    all[5] = value_of("sobol_total", true, e.sobol->total, i);
  }
  return all;
}

const Value& named(const std::vector<Value>& all, std::string_view name) {
  return *std::ranges::find(all, name, &Value::name);
}

// Bars of some effects: a group for each parameter, with one bar for each effect. series: name of
// the effect, and its name in the legend.
Bars bars_of(const Design& design, const QuantityEffects& e,
             const std::vector<std::pair<std::string, std::string>>& series) {
  Bars b;
  const auto k = static_cast<Eigen::Index>(design.parameters.size());
  const auto n = static_cast<Eigen::Index>(series.size());
  // A value without an interval has an error bar of length 0.
  b.values = b.low = b.high = MatX::Constant(n, k, none);
  for (const DesignParameter& p : design.parameters) b.groups.push_back(short_name(p));
  for (Eigen::Index s = 0; s < n; ++s) {
    b.series.push_back(series[static_cast<std::size_t>(s)].second);
    for (Eigen::Index i = 0; i < k; ++i) {
      const std::vector<Value> all = values(e, i);
      const Value& v = named(all, series[static_cast<std::size_t>(s)].first);
      b.values(s, i) = v.value;
      b.low(s, i) = v.value;
      b.high(s, i) = v.value;
      if (!std::isnan(v.low)) b.low(s, i) = v.low;
      if (!std::isnan(v.high)) b.high(s, i) = v.high;
    }
  }
  return b;
}

}  // namespace

// The head is the same for all quantities, so it is made from the first one. Effects of one
// parameter at a time have no interval.
std::string effects_csv(const Design& design, const std::vector<QuantityEffects>& effects) {
  std::string text = "quantity,unit,parameter,parameter_unit,lower,upper";

  bool headed = false;
  std::string rows;
  for (const QuantityEffects& e : effects)
    for (std::size_t i = 0; i < design.parameters.size(); ++i) {
      const DesignParameter& p = design.parameters[i];
      rows += fmt::format("{},{},{},{},{},{}", csv_cell(e.name), csv_cell(e.unit),
                          csv_cell(short_name(p)), csv_cell(p.unit), number_text(p.lower),
                          number_text(p.upper));
      for (const Value& v : values(e, static_cast<Eigen::Index>(i))) {
        const bool interval = !std::string(v.name).starts_with("one_at_a_time");
        if (!headed) {
          if (interval) {
            text += fmt::format(",{0},{0}_low,{0}_high", v.name);
          } else {
            text += fmt::format(",{}", v.name);
          }
        }
        rows += "," + table_cell(v.value);
        if (interval) rows += "," + table_cell(v.low) + "," + table_cell(v.high);
      }
      headed = true;
      rows += "\n";
    }
  return text + "\n" + rows;
}

// The numbers of one parameter as a line shows them.
using ValueText = std::string (*)(const std::vector<Value>&);

std::string one_at_a_time_text(const std::vector<Value>& all) {
  return fmt::format("{:.3g}", named(all, "one_at_a_time").value);
}

// mu* with its 95 % interval, and sigma: "0.12 (0.1 to 0.14; 0.02)".
std::string morris_text(const std::vector<Value>& all) {
  const Value& m = named(all, "morris_mu_star");
  return fmt::format("{:.3g} ({:.3g} to {:.3g}; {:.2g})", m.value, m.low, m.high,
                     named(all, "morris_sigma").value);
}

// The total share and the share of the parameter alone: "70 % (65 %)".
std::string sobol_text(const std::vector<Value>& all) {
  return fmt::format("{:.0f} % ({:.0f} %)", 100 * named(all, "sobol_total").value,
                     100 * named(all, "sobol_first").value);
}

// All parameters with their numbers, the largest effect first.
std::string ranked_parameters(const Design& design, const QuantityEffects& e,
                              const std::string& effect, ValueText text) {
  std::vector<std::pair<double, std::string>> ranked;
  for (std::size_t i = 0; i < design.parameters.size(); ++i) {
    const std::vector<Value> all = values(e, static_cast<Eigen::Index>(i));
    ranked.push_back(
        {-named(all, effect).value, short_name(design.parameters[i]) + " " + text(all)});
  }
  std::ranges::stable_sort(ranked, {}, &std::pair<double, std::string>::first);
  std::string line;
  for (const auto& [rank, parameter] : ranked) append(line, ", ", parameter);
  return line;
}

// One line for each method that the design has.
std::vector<std::string> effects_lines(const Design& design, const QuantityEffects& e) {
  std::vector<std::string> lines;
  std::string unit;
  if (e.unit != "-") unit = ", " + e.unit;
  if (has_one_at_a_time(e))
    lines.push_back(fmt::format("{}: one at a time{}: {}", e.name, unit,
                                ranked_parameters(design, e, "one_at_a_time", one_at_a_time_text)));
  if (has_morris(e))
    lines.push_back(fmt::format("{}: Morris mu* (95 %; sigma){}: {}", e.name, unit,
                                ranked_parameters(design, e, "morris_mu_star", morris_text)));
  if (has_sobol(e))
    lines.push_back(fmt::format("{}: Sobol total (alone): {}", e.name,
                                ranked_parameters(design, e, "sobol_total", sobol_text)));
  int without = 0;
  if (e.morris) without += e.morris->without_curve;
  if (e.sobol) without += static_cast<int>(e.sobol->without_curve);
  if (without > 0)
    lines.push_back(
        fmt::format("warning: {}: {} samples without it are left out", e.name, without));
  return lines;
}

Bars effects_bars(const Design& design, const QuantityEffects& e) {
  std::vector<std::pair<std::string, std::string>> series;
  if (e.one_at_a_time) series.push_back({"one_at_a_time", "one at a time: μ*"});
  if (e.morris) {
    series.push_back({"morris_mu_star", "Morris: μ*"});
    series.push_back({"morris_sigma", "Morris: σ"});
  }
  Bars b = bars_of(design, e, series);
  b.title = fmt::format("effect of the parameters on {} over their ranges", e.name);
  b.y_label = e.name;
  if (e.unit != "-") b.y_label = fmt::format("{} ({})", e.name, e.unit);
  return b;
}

Bars share_bars(const Design& design, const QuantityEffects& e) {
  Bars b = bars_of(design, e, {{"sobol_first", "alone"}, {"sobol_total", "in all"}});
  b.title = "Sobol: shares of the variance of " + e.name;
  b.y_label = "share";
  return b;
}

}  // namespace langer
