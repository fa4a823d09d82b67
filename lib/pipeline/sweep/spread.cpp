// Statistics over the members of a sweep that samples fitted parameters. The formulas are those of
// samples: n - 1 in variances, and percentiles by interpolation between ordered values.
#include "pipeline/sweep/spread.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/quantile.hpp"
#include "core/base/text.hpp"
#include "core/config/writer.hpp"
#include "pipeline/sweep/table_cell.hpp"

namespace langer {

namespace {

constexpr const char* prefix = "parameter_";

double mean_of(const std::vector<double>& v) {
  return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
}

// The covariance: sum of (a - mean a)(b - mean b) over n - 1.
double covariance_of(const std::vector<double>& a, const std::vector<double>& b) {
  const double ma = mean_of(a);
  const double mb = mean_of(b);
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - ma) * (b[i] - mb);
  return sum / static_cast<double>(a.size() - 1);
}

double percentile(std::vector<double> v, double part) {
  std::sort(v.begin(), v.end());
  return quantile(v, part);
}

// The value of a curve at x = `at`, linear between its rows, constant beyond them.
double interpolate(const Column& x, const Column& y, double at) {
  const std::size_t n = std::min(x.values.size(), y.values.size());
  // The first pair of rows with x between them; x need not rise, as in a cycle.
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double a = x.values[i];
    const double b = x.values[i + 1];
    if (a == b || (at - a) * (at - b) > 0) continue;
    return y.values[i] + (at - a) / (b - a) * (y.values[i + 1] - y.values[i]);
  }
  if (std::abs(at - x.values[0]) < std::abs(at - x.values[n - 1])) return y.values[0];
  return y.values[n - 1];
}

// Elements of a column, by their index.
std::vector<double> selected(const std::vector<double>& all, const std::vector<std::size_t>& rows) {
  std::vector<double> some;
  for (std::size_t i : rows) some.push_back(all[i]);
  return some;
}

// A quantity of a summary; NaN if it does not have it.
double value_in(const std::vector<Summary>& summary, const std::string& name) {
  const auto found = std::ranges::find(summary, name, &Summary::name);
  if (found == summary.end()) return std::nan("");
  return found->value;
}

// The 95 % intervals as pairs (low, high).
void write_interval(const h5::Group& group, const std::vector<double>& low,
                    const std::vector<double>& high, const std::string& unit) {
  std::vector<double> both;
  for (std::size_t i = 0; i < low.size(); ++i) {
    both.push_back(low[i]);
    both.push_back(high[i]);
  }
  group.write<double>("interval", {low.size(), 2}, both, unit);
}

}  // namespace

std::vector<SweepColumn> sampled_parameters(const std::vector<std::vector<Summary>>& sets) {
  std::vector<SweepColumn> all;
  if (sets.empty()) return all;
  for (const Summary& first : sets[0]) {
    SweepColumn column{first.name, first.unit, {}};
    bool varies = false;
    for (const std::vector<Summary>& set : sets) {
      column.values.push_back(value_in(set, first.name));
      varies = varies || column.values.back() != column.values[0];
    }
    if (varies) all.push_back(std::move(column));
  }
  return all;
}

// The part of the variance that a parameter explains is the squared correlation r², so (1 - r²) of
// it remains if that parameter is known.
Spread spread_of(const SweepColumn& column, const std::vector<SweepColumn>& parameters) {
  std::vector<std::size_t> rows;  // members that have the quantity
  for (std::size_t i = 0; i < column.values.size(); ++i)
    if (std::isfinite(column.values[i])) rows.push_back(i);
  // A spread of less than two values is not defined.
  const double none = std::nan("");
  Spread spread{column.name, column.unit, none, none, none, none};
  if (rows.size() < 2) return spread;
  const std::vector<double> v = selected(column.values, rows);
  spread.mean = mean_of(v);
  spread.deviation = std::sqrt(covariance_of(v, v));
  spread.low = percentile(v, 0.025);
  spread.high = percentile(v, 0.975);
  for (const SweepColumn& p : parameters) {
    const std::vector<double> q = selected(p.values, rows);
    const double variance = covariance_of(q, q);
    const double covariance = covariance_of(v, q);
    double part = 0;  // the squared correlation
    if (variance > 0 && spread.deviation > 0) {
      part = covariance * covariance / (variance * spread.deviation * spread.deviation);
    }
    spread.parts.push_back({p.name.substr(std::string(prefix).size()),
                            spread.deviation * std::sqrt(std::max(0.0, 1 - part))});
  }
  std::ranges::stable_sort(spread.parts, {}, &Spread::Part::without);
  return spread;
}

// Parameters are sorted by name, so that the columns do not depend on which one matters most.
std::string spread_csv(const std::vector<Spread>& all) {
  std::vector<std::string> names;
  for (const Spread& one : all)
    for (const Spread::Part& part : one.parts)
      if (std::ranges::find(names, part.name) == names.end()) names.push_back(part.name);
  std::sort(names.begin(), names.end());
  std::string text = "quantity,unit,mean,standard_deviation,lower_95,upper_95";
  for (const std::string& name : names) text += "," + csv_cell("without_" + name);
  text += "\n";
  for (const Spread& one : all) {
    text += fmt::format("{},{},{},{},{},{}", csv_cell(one.name), csv_cell(one.unit),
                        table_cell(one.mean), table_cell(one.deviation), table_cell(one.low),
                        table_cell(one.high));
    for (const std::string& name : names) {
      const auto part = std::ranges::find(one.parts, name, &Spread::Part::name);
      text += ",";
      if (part != one.parts.end()) text += table_cell(part->without);
    }
    text += "\n";
  }
  return text;
}

// Names at most three parameters, and only those whose knowledge would reduce the deviation by more
// than a tenth.
std::string in_words(const Spread& s) {
  const auto percent = [&](double part) {
    return fmt::format("{:.2g} %", 100 * part / std::max(std::abs(s.mean), 1e-300));
  };
  std::string unit;
  if (s.unit != "-") unit = " " + s.unit;
  std::string words = fmt::format("{} {:.4g}{} +- {} (parameters), 95 % in {:.4g} to {:.4g}",
                                  s.name, s.mean, unit, percent(s.deviation), s.low, s.high);
  std::string reductions;
  int n = 0;
  for (const Spread::Part& part : s.parts) {
    if (!(part.without < 0.9 * s.deviation) || n == 3) continue;
    append(reductions, ", ", fmt::format("{} if {} were known", percent(part.without), part.name));
    ++n;
  }
  if (n > 0) words += "; " + reductions;
  return words;
}

// The statistics are computed at each x separately: a band is no curve of any sample.
Band band_of(const std::string& figure, const std::vector<const Column*>& x,
             const std::vector<const Column*>& y) {
  Band band{figure, *x[0], *y[0], *y[0], *y[0], *y[0]};
  for (std::size_t row = 0; row < x[0]->values.size(); ++row) {
    std::vector<double> at;
    for (std::size_t k = 0; k < x.size(); ++k)
      at.push_back(interpolate(*x[k], *y[k], x[0]->values[row]));
    band.mean.values[row] = mean_of(at);
    band.deviation.values[row] = std::sqrt(covariance_of(at, at));
    band.low.values[row] = percentile(at, 0.025);
    band.high.values[row] = percentile(at, 0.975);
  }
  return band;
}

// Parameters of a quantity are in the order of their importance, which the attribute `order`
// records.
void write_spread(const h5::Group& root, const std::vector<Spread>& all,
                  const std::vector<Band>& bands) {
  const h5::Group spreads = root.make_group("spread");
  for (const Spread& one : all) {
    const h5::Group group = spreads.make_group(one.name);
    group.write_scalar("mean", one.mean, one.unit);
    group.write_scalar("deviation", one.deviation, one.unit);
    write_interval(group, {one.low}, {one.high}, one.unit);
    std::vector<double> without;
    std::vector<std::string> order;
    for (const Spread::Part& part : one.parts) {
      without.push_back(part.without);
      order.push_back(part.name);
    }
    group.write<double>("without", {without.size()}, without, one.unit);
    group.attribute("order", fmt::format("{}", fmt::join(order, " ")));
  }
  const h5::Group curves = root.make_group("bands");
  for (const Band& band : bands) {
    const h5::Group group = curves.make_group(band.figure + "_" + band.mean.name);
    const std::size_t n = band.x.values.size();
    group.write<double>("x", {n}, band.x.values, band.x.unit);
    group.write<double>("mean", {n}, band.mean.values, band.mean.unit);
    group.write<double>("deviation", {n}, band.deviation.values, band.mean.unit);
    write_interval(group, band.low.values, band.high.values, band.mean.unit);
    group.attribute("x", band.x.name);
    group.attribute("y", band.mean.name);
  }
}

}  // namespace langer
