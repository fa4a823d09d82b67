#include <algorithm>
#include <map>

#include "report/labels.hpp"
#include "report/sources.hpp"
#include "results/post/curves.hpp"
#include "results/store/curves_file.hpp"

namespace langer::report {

namespace {

// u_y_A and u_y_B are u_y at two places: they share a chart
std::string stem(const std::string& name) {
  const auto cut = name.rfind('_');
  if (cut == std::string::npos || cut == 0) return name;
  const std::string place = name.substr(cut + 1);
  const bool is_place =
      !place.empty() && std::all_of(place.begin(), place.end(), [](unsigned char c) {
        return std::isupper(c) || std::isdigit(c);
      });
  if (is_place) return name.substr(0, cut);
  return name;
}

}  // namespace

void add_curves(ReportPage& page, const std::vector<Source>& sources) {
  std::vector<std::string> order;  // of titles, as the columns stand
  std::map<std::string, Chart> charts;
  for (const Source& source : sources) {
    const Curves curves = read_curves(source.path).curves;
    std::map<std::string, std::size_t> place;
    for (const Column& c : curves.columns) place.emplace(c.name, place.size());
    std::vector<const NamedCurve*> sorted;
    const auto curve_called = [&](const std::string& name) {
      const auto found = std::find_if(curves.curves.begin(), curves.curves.end(),
                                      [&](const NamedCurve& c) { return c.name == name; });
      return found == curves.curves.end() ? nullptr : &*found;
    };
    const auto is_band = [&](const std::string& name) {  // of another curve
      return std::any_of(curves.curves.begin(), curves.curves.end(), [&](const NamedCurve& c) {
        const auto bands = bands_of(c.name);
        return std::find(bands.begin(), bands.end(), name) != bands.end();
      });
    };
    for (const NamedCurve& c : curves.curves)
      if (!is_band(c.name)) sorted.push_back(&c);
    const auto rank = [&](const NamedCurve* c) {
      return place.count(c->name) ? place.at(c->name) : place.size();
    };
    std::stable_sort(sorted.begin(), sorted.end(),
                     [&](const auto* a, const auto* b) { return rank(a) < rank(b); });
    for (const NamedCurve* c : sorted) {
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
      chart.series.push_back({sources.size() > 1 ? source.label
                              : c->name == title ? c->name
                                                 : c->name.substr(title.size() + 1),
                              c->x, c->y, false});
      for (const std::string& name : bands_of(c->name))
        if (const NamedCurve* band = curve_called(name); band && chart.series.back().error.empty())
          chart.series.back().error = band->y;
    }
  }
  for (const std::string& title : order) page.charts.push_back(std::move(charts.at(title)));
}

}  // namespace langer::report
