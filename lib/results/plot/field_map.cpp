#include "results/plot/field_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "results/plot/map_parts.hpp"

namespace langer {

namespace {

using namespace map_parts;

// The range of coordinates. A range without width is widened by 0.5 on both sides.
struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  explicit Extent(const std::vector<double>& all) {
    for (double one : all) {
      low = std::min(low, one);
      high = std::max(high, one);
    }
    if (!(high > low)) {
      low -= 0.5;
      high += 0.5;
    }
  }
  double size() const { return high - low; }
};

// Where the places of a panel are drawn. y points upwards and has the scale of x unless the panel
// would become too flat or too high.
struct Panel {
  Extent x, y;
  double left = 90;
  double top = 0;
  double width = 500;
  double height = 0;
  double side = 0;  // of a square
  Panel(const FieldMap& map, double begin) : x(map.x), y(map.y), top(begin) {
    height = std::clamp(width * y.size() / x.size(), 60.0, 500.0);
    // The squares together cover about the area of the panel.
    const double n = static_cast<double>(std::max<std::size_t>(map.x.size(), 1));
    side = std::clamp(std::sqrt(width * height / n), 3.0, 24.0);
  }
  double x_of(double value) const { return left + width * (value - x.low) / x.size(); }
  double y_of(double value) const { return top + height * (1 - (value - y.low) / y.size()); }
  double bottom() const { return top + height + side / 2; }
};

// Draws the numbers of both axes; the x axis is shown below the last panel only.
void add_axes(Drawing& d, const FieldMap& map, const Panel& p, bool last) {
  const double left = p.left - p.side / 2 - 4;
  std::vector<double> at = ticks(p.y.low, p.y.high);
  std::vector<std::string> texts = tick_texts(at);
  for (std::size_t k = 0; k < at.size(); ++k) {
    d.marks.push_back(Stroke{{{left - 5, p.y_of(at[k])}, {left, p.y_of(at[k])}}, ink, 1, 1});
    d.marks.push_back(label(left - 9, p.y_of(at[k]) + 4, texts[k], 12, Label::Anchor::end));
  }
  d.marks.push_back(label(12, p.top - 10, map.y_label, 13, Label::Anchor::start));
  if (!last) return;
  at = ticks(p.x.low, p.x.high);
  texts = tick_texts(at);
  for (std::size_t k = 0; k < at.size(); ++k) {
    d.marks.push_back(
        Stroke{{{p.x_of(at[k]), p.bottom() + 4}, {p.x_of(at[k]), p.bottom() + 9}}, ink, 1, 1});
    d.marks.push_back(label(p.x_of(at[k]), p.bottom() + 24, texts[k], 12));
  }
  d.marks.push_back(label(p.left + p.width / 2, p.bottom() + 44, map.x_label));
}

// Draws the colours from -limit to limit at the right of a panel.
void add_scale(Drawing& d, const Panel& p, const FieldPanel& panel) {
  constexpr int cells = 20;
  const double x = p.left + p.width + p.side / 2 + 18;
  const double height = std::max(p.height, 60.0);
  const double step = height / cells;
  for (int k = 0; k < cells; ++k)
    d.marks.push_back(box(x, p.top + height - step * (k + 1), 14, step,
                          signed_colour(2 * (k + 0.5) / cells - 1)));
  // Numbers at the right of the scale.
  const std::vector<double> at = ticks(-panel.limit, panel.limit, 6);
  const std::vector<std::string> texts = tick_texts(at);
  for (std::size_t k = 0; k < at.size(); ++k)
    d.marks.push_back(label(x + 20, p.top + height * (0.5 - at[k] / panel.limit / 2) + 4, texts[k],
                            12, Label::Anchor::start));
}

}  // namespace

// The panels are placed from top to bottom; the height of the page follows from them.
Drawing field_map(const FieldMap& map) {
  Drawing d;
  d.width = 720;
  d.marks.push_back(label(d.width / 2, 26, map.title, 16));
  double top = 76;
  for (std::size_t k = 0; k < map.panels.size(); ++k) {
    const FieldPanel& panel = map.panels[k];
    const Panel p(map, top);
    d.marks.push_back(
        label(p.left + p.width / 2, top - p.side / 2 - 8, panel.title + " (" + map.unit + ")"));
    for (std::size_t i = 0; i < map.x.size(); ++i) {
      const double value = panel.values[i];
      Colour colour = grey;
      if (std::isfinite(value)) {
        colour = signed_colour(std::clamp(value / panel.limit, -1.0, 1.0));
      }
      d.marks.push_back(box(p.x_of(map.x[i]) - p.side / 2, p.y_of(map.y[i]) - p.side / 2, p.side,
                            p.side, colour));
    }
    const bool last = k + 1 == map.panels.size();
    add_axes(d, map, p, last);
    add_scale(d, p, panel);
    top = p.bottom() + 44;
    if (last) top += 16;
  }
  d.height = top;
  return d;
}

}  // namespace langer
