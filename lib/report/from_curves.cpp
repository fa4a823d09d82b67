// The charts of curves.h5. A reader compares places in one solution, or the same curve of several
// solutions; so with one file curves share a chart by quantity, with several files by name. Error
// bands are curves of their own in the file, and are drawn around the curve they belong to.
#include <algorithm>
#include <cctype>
#include <map>

#include "core/base/text.hpp"
#include "report/labels.hpp"
#include "report/sources.hpp"
#include "results/post/curves.hpp"
#include "results/store/curves_file.hpp"

namespace langer::report {

namespace {

bool is_capital_or_digit(unsigned char c) { return std::isupper(c) || std::isdigit(c); }

// The name without its place: u_y_A and u_y_B are u_y at two places and share a chart.
std::string stem(const std::string& name) {
  const auto cut = name.rfind('_');
  if (cut == std::string::npos || cut == 0) return name;
  const std::string place = name.substr(cut + 1);
  if (!place.empty() && std::ranges::all_of(place, is_capital_or_digit)) return name.substr(0, cut);
  return name;
}

// A curve by its name; nullptr if the file does not have it.
const NamedCurve* find_curve(const Curves& curves, const std::string& name) {
  const auto found = std::ranges::find(curves.curves, name, &NamedCurve::name);
  if (found == curves.curves.end()) return nullptr;
  return &*found;
}

// Whether a curve is the error band of another one. It is then drawn with that curve.
bool is_band(const Curves& curves, const std::string& name) {
  for (const NamedCurve& c : curves.curves) {
    const auto bands = bands_of(c.name);
    if (std::ranges::find(bands, name) != bands.end()) return true;
  }
  return false;
}

// The curves except error bands, in the order of the file's columns.
std::vector<const NamedCurve*> sorted_curves(const Curves& curves) {
  std::map<std::string, std::size_t> place;
  for (const Column& c : curves.columns) place.emplace(c.name, place.size());
  std::vector<const NamedCurve*> sorted;
  for (const NamedCurve& c : curves.curves)
    if (!is_band(curves, c.name)) sorted.push_back(&c);
  const auto rank = [&](const NamedCurve* c) {
    return value_or(place, c->name, place.size());
  };
  std::ranges::stable_sort(sorted, {}, rank);
  return sorted;
}

// The name of a curve in the legend: the file among several, or else the place.
std::string series_name(const Source& source, bool several, const std::string& curve,
                        const std::string& title) {
  if (several) return source.label;
  if (curve == title) return curve;
  return curve.substr(title.size() + 1);
}

}  // namespace

// With one file curves of one quantity share a chart; with several files each curve has its own
// chart, in which the files are compared.
void add_curves(ReportPage& page, const std::vector<Source>& sources) {
  std::vector<std::string> order;  // of the titles: the order of the columns
  std::map<std::string, Chart> charts;
  for (const Source& source : sources) {
    const Curves curves = read_curves(source.path).curves;
    for (const NamedCurve* c : sorted_curves(curves)) {
      std::string title = c->name;
      if (sources.size() == 1) title = stem(c->name);
      auto [it, is_new] = charts.try_emplace(title);
      Chart& chart = it->second;
      if (is_new) {
        order.push_back(title);
        chart = {"curves",  in_words(title),   in_words(c->x_label),
                 c->x_unit, in_words(title),   c->y_unit,
                 {},        sources.size() > 1};
      }
      chart.ordered = chart.ordered && source.numbered;
      chart.series.push_back(
          {series_name(source, sources.size() > 1, c->name, title), c->x, c->y, false});
      for (const std::string& name : bands_of(c->name)) {
        const NamedCurve* band = find_curve(curves, name);
        if (band && chart.series.back().error.empty()) chart.series.back().error = band->y;
      }
    }
  }
  for (const std::string& title : order) page.charts.push_back(std::move(charts.at(title)));
}

}  // namespace langer::report
