#include "pipeline/sweep/design_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string_view>

#include "results/store/curves_file.hpp"

namespace langer {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

struct Value {
  const char* name;
  bool share;
  double value, low, high;
};

// of one parameter, by every method; NaN where it was not asked for or could not be told
std::vector<Value> values(const QuantityEffects& e, Eigen::Index i) {
  std::vector<Value> all;
  const bool complete = e.one_at_a_time && e.one_at_a_time->complete;
  all.push_back(
      {"one_at_a_time", false, complete ? e.one_at_a_time->mu_star(i, 0) : none, none, none});
  all.push_back(
      {"one_at_a_time_spread", false, complete ? e.one_at_a_time->spread(i, 0) : none, none, none});
  const auto add = [&](const char* name, bool share, bool there, const auto& estimate) {
    if (!there) return all.push_back({name, share, none, none, none});
    const Estimate& x = estimate();
    all.push_back({name, share, x.value(i, 0), x.low(i, 0), x.high(i, 0)});
  };
  const bool morris = e.morris && e.morris->trajectories >= 2;
  const bool sobol = e.sobol && e.sobol->rows >= 2;
  add("morris_mu_star", false, morris, [&]() -> const Estimate& { return e.morris->mu_star; });
  add("morris_sigma", false, morris, [&]() -> const Estimate& { return e.morris->sigma; });
  add("sobol_first", true, sobol, [&]() -> const Estimate& { return e.sobol->first; });
  add("sobol_total", true, sobol, [&]() -> const Estimate& { return e.sobol->total; });
  return all;
}

const Value& named(const std::vector<Value>& all, std::string_view name) {
  return *std::find_if(all.begin(), all.end(), [&](const Value& v) { return v.name == name; });
}

Bars bars_of(const Design& design, const QuantityEffects& e,
             const std::vector<std::pair<std::string, std::string>>& series) {
  Bars b;
  const auto k = static_cast<Eigen::Index>(design.parameters.size());
  const auto n = static_cast<Eigen::Index>(series.size());
  b.values = b.low = b.high = MatX::Constant(n, k, none);
  for (const DesignParameter& p : design.parameters) b.groups.push_back(short_name(p));
  for (Eigen::Index s = 0; s < n; ++s) {
    b.series.push_back(series[static_cast<std::size_t>(s)].second);
    for (Eigen::Index i = 0; i < k; ++i) {
      const std::vector<Value> all = values(e, i);
      const Value& v = named(all, series[static_cast<std::size_t>(s)].first);
      b.values(s, i) = v.value;
      b.low(s, i) = std::isnan(v.low) ? v.value : v.low;
      b.high(s, i) = std::isnan(v.high) ? v.value : v.high;
    }
  }
  return b;
}

}  // namespace

std::string effects_csv(const Design& design, const std::vector<QuantityEffects>& effects) {
  std::string text = "quantity,unit,parameter,parameter_unit,lower,upper";
  const auto cell = [](double x) {
    return std::isnan(x) ? std::string() : number_text(x);
  };
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
        rows += "," + cell(v.value);
        if (interval) rows += "," + cell(v.low) + "," + cell(v.high);
      }
      headed = true;
      rows += "\n";
    }
  return text + "\n" + rows;
}

std::vector<std::string> effects_lines(const Design& design, const QuantityEffects& e) {
  std::vector<std::string> lines;
  const auto ranked = [&](const std::string& by, auto&& text) {
    std::vector<std::pair<double, std::string>> words;
    for (std::size_t i = 0; i < design.parameters.size(); ++i) {
      const std::vector<Value> all = values(e, static_cast<Eigen::Index>(i));
      words.push_back({-named(all, by).value, short_name(design.parameters[i]) + " " + text(all)});
    }
    std::stable_sort(words.begin(), words.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<std::string> said;
    for (const auto& [key, word] : words) said.push_back(word);
    return fmt::format("{}", fmt::join(said, ", "));
  };
  std::string unit;
  if (e.unit == "-") {
    unit = "";
  } else {
    unit = ", " + e.unit;
  }
  if (e.one_at_a_time && e.one_at_a_time->complete)
    lines.push_back(fmt::format("{}: one at a time{}: {}", e.name, unit,
                                ranked("one_at_a_time", [](const auto& all) {
                                  return fmt::format("{:.3g}", named(all, "one_at_a_time").value);
                                })));
  if (e.morris && e.morris->trajectories >= 2)
    lines.push_back(fmt::format("{}: Morris mu* (95 %; sigma){}: {}", e.name, unit,
                                ranked("morris_mu_star", [](const auto& all) {
                                  const Value& m = named(all, "morris_mu_star");
                                  return fmt::format("{:.3g} ({:.3g} to {:.3g}; {:.2g})", m.value,
                                                     m.low, m.high,
                                                     named(all, "morris_sigma").value);
                                })));
  if (e.sobol && e.sobol->rows >= 2)
    lines.push_back(fmt::format(
        "{}: Sobol total (alone): {}", e.name, ranked("sobol_total", [](const auto& all) {
          return fmt::format("{:.0f} % ({:.0f} %)", 100 * named(all, "sobol_total").value,
                             100 * named(all, "sobol_first").value);
        })));
  const int without = (e.morris ? e.morris->without_curve : 0) +
                      static_cast<int>(e.sobol ? e.sobol->without_curve : 0);
  if (without > 0)
    lines.push_back(
        fmt::format("warning: {}: {} samples lack it and are left out", e.name, without));
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
  b.title = fmt::format("what the parameters do to {} over their ranges", e.name);
  if (e.unit == "-") {
    b.y_label = e.name;
  } else {
    b.y_label = fmt::format("{} ({})", e.name, e.unit);
  }
  return b;
}

Bars share_bars(const Design& design, const QuantityEffects& e) {
  Bars b = bars_of(design, e, {{"sobol_first", "alone"}, {"sobol_total", "in all"}});
  b.title = "Sobol: shares of the variance of " + e.name;
  b.y_label = "share";
  return b;
}

}  // namespace langer
