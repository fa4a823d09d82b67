#include "results/plot/heat_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "results/plot/map_parts.hpp"

namespace langer {

namespace {

using namespace map_parts;

constexpr Colour pale{0.87, 0.87, 0.87};

// Where the cells of a map are drawn, and their colours. The width of the page is divided among
// the names of the rows, the cells and the scale.
struct Grid {
  const HeatMap& map;
  const Look& look;
  double names = 0;  // width of the widest name of a row
  double page = look.width.value_or(720);
  double left = 150, top = 60;       // of the first cell
  double width = 420, height = 420;  // of all cells
  double w = 0, h = 0;               // of a cell
  bool turned = false;               // the names of the columns are written upwards
  Eigen::Index rows = map.values.rows(), columns = map.values.cols();

  Grid(const HeatMap& of, const Look& with) : map(of), look(with) {
    for (const std::string& name : map.y_names) names = std::max(names, text_width(name, 13));
    const double scale = map.losses ? 20 : 110;
    const bool named = !map.y_names.empty();
    left = std::min(150.0, 0.2 * page);
    if (named) left = names + 20;
    left = std::min(left, 0.55 * page);
    if (!look.titles || map.title.empty()) top = 34;
    width = std::max(60.0, page - left - scale);
    if (!look.width && named)
      width = std::min(width, std::max(420.0, 60.0 * static_cast<double>(columns)));
    if (!look.width && !named) width = 420;
    height = width;
    if (named) height = std::max(60., 42. * static_cast<double>(rows));
    w = width / static_cast<double>(columns);
    h = height / static_cast<double>(rows);
    for (const std::string& name : map.x_names) turned = turned || text_width(name, 13) > 0.95 * w;
  }
  double bottom() const { return top + height; }

  // Height of the names or numbers of the columns.
  double below() const {
    if (map.x_names.empty()) return 20;
    if (!turned) return 18;
    double room = 0;
    for (const std::string& name : map.x_names) room = std::max(room, text_width(name, 13) + 6);
    return room;
  }
  double x_of(Eigen::Index column) const { return left + w * static_cast<double>(column); }
  double y_of(Eigen::Index row) const {
    if (map.first_row_on_top) return top + h * static_cast<double>(row);
    return top + h * static_cast<double>(rows - 1 - row);
  }

  // The position of a value on the scale, -1 to 1.
  double scale_position(double value) const {
    if (map.middle == 0) return std::clamp(value / map.limit, -1., 1.);
    const double s =
        std::log1p(3 * std::abs(value) / map.middle) / std::log1p(3 * map.limit / map.middle);
    return std::copysign(std::min(1., s), value);
  }
  Colour colour_at(double position) const {
    if (map.swap_colours) return signed_colour(-position, look.signed_colours);
    return signed_colour(position, look.signed_colours);
  }

  Colour colour(double value) const {
    if (!std::isfinite(value)) return grey;
    if (map.losses)
      return signed_colour(1 - 0.9 * std::clamp(value / map.limit, 0., 1.), look.signed_colours);
    return colour_at(scale_position(value));
  }
};

// Cells without numbers get a border that covers the seams between them.
void add_cells(Drawing& d, const Grid& g) {
  double border_width = 0.5;
  if (g.map.numbers) border_width = 0;
  for (Eigen::Index i = 0; i < g.rows; ++i)
    for (Eigen::Index j = 0; j < g.columns; ++j)
      d.marks.push_back(
          box(g.x_of(j), g.y_of(i), g.w, g.h, g.colour(g.map.values(i, j)), border_width));
}

// The text of a value in a cell of a given width. Correlations have as many digits as fit; exact
// ones have none, and close to 1 a third digit shows that they are not exact.
std::string cell_text(const HeatMap& map, double value, double width) {
  if (value == 0) return "0";
  if (std::isinf(value)) return "none";
  if (std::isnan(value)) return "–";
  if (map.losses) return fmt::format("{:.3g}", value);
  if (std::abs(value) >= 1 - 1e-12) return fmt::format("{:.0f}", value);
  int digits = 1;
  if (width > 34) digits = 2;
  if (width > 50 && std::abs(value) > 0.99) digits = 3;
  return fmt::format("{:.{}f}", value, digits);
}

// Writes the values into the cells, white on dark colours. Cells that are too narrow for readable
// numbers stay empty.
void add_numbers(Drawing& d, const Grid& g) {
  for (Eigen::Index i = 0; i < g.rows; ++i)
    for (Eigen::Index j = 0; j < g.columns; ++j) {
      const double value = g.map.values(i, j);
      const double size = std::min(13.0, g.w / 3.2);  // so that -0.99 fits
      if (size < 5) continue;
      const std::string text = cell_text(g.map, value, g.w);
      Label number = label(g.x_of(j) + g.w / 2, g.y_of(i) + g.h / 2 + 0.32 * size, text, size);
      const Colour ground = g.colour(value);
      // Numbers are white on cells with a luminance below 0.4.
      number.white = 0.21 * ground.r + 0.72 * ground.g + 0.07 * ground.b < 0.4;  // luminance
      d.marks.push_back(number);
    }
}

// Draws the edges between neighbouring cells of different sign.
void add_zero_line(Drawing& d, const Grid& g) {
  const MatX& values = g.map.values;
  const auto differ = [](double a, double b) {
    return std::isfinite(a) && std::isfinite(b) && (a < 0) != (b < 0);
  };
  for (Eigen::Index i = 0; i < g.rows; ++i)
    for (Eigen::Index j = 0; j < g.columns; ++j) {
      const double x = g.x_of(j);
      const double y = g.y_of(i);
      if (j + 1 < g.columns && differ(values(i, j), values(i, j + 1)))
        d.marks.push_back(Stroke{{{x + g.w, y}, {x + g.w, y + g.h}}, ink, 1.5, 1});
      if (i + 1 < g.rows && differ(values(i, j), values(i + 1, j))) {
        double edge = y;
        if (g.map.first_row_on_top) edge = y + g.h;
        d.marks.push_back(Stroke{{{x, edge}, {x + g.w, edge}}, ink, 1.5, 1});
      }
    }
}

// The names of the columns, or numbers at the centres of cells. Names that are too wide for their
// column are written upwards.
void add_x_axis(Drawing& d, const Grid& g) {
  for (std::size_t j = 0; j < g.map.x_names.size(); ++j) {
    const double x = g.x_of(static_cast<Eigen::Index>(j)) + g.w / 2;
    Label name = label(x, g.bottom() + 18, g.map.x_names[j], 13);
    if (g.turned) {
      name.size = std::min(13.0, g.w);  // not higher than the column is wide
      name.at = {x + 0.3 * name.size, g.bottom() + 8};
      name.turned = 90;
      name.anchor = Label::Anchor::end;
    }
    d.marks.push_back(name);
  }
  if (!g.map.x_names.empty()) return;
  const std::vector<double> at = ticks(g.map.x_from, g.map.x_to);
  const std::vector<std::string> texts = tick_texts(at);
  for (std::size_t k = 0; k < at.size(); ++k) {
    const double x =
        g.left + g.w / 2 + (g.width - g.w) * (at[k] - g.map.x_from) / (g.map.x_to - g.map.x_from);
    d.marks.push_back(Stroke{{{x, g.bottom()}, {x, g.bottom() + 5}}, ink, 1, 1});
    d.marks.push_back(label(x, g.bottom() + 20, texts[k]));
  }
}

// The names of the rows, or numbers at the centres of cells.
void add_y_axis(Drawing& d, const Grid& g) {
  for (std::size_t i = 0; i < g.map.y_names.size(); ++i)
    d.marks.push_back(label(g.left - 8, g.y_of(static_cast<Eigen::Index>(i)) + g.h / 2 + 4,
                            g.map.y_names[i], 13, Label::Anchor::end));
  if (!g.map.y_names.empty()) return;
  const std::vector<double> at = ticks(g.map.y_from, g.map.y_to);
  const std::vector<std::string> texts = tick_texts(at);
  for (std::size_t k = 0; k < at.size(); ++k) {
    const double y = g.bottom() - g.h / 2 -
                     (g.height - g.h) * (at[k] - g.map.y_from) / (g.map.y_to - g.map.y_from);
    d.marks.push_back(Stroke{{{g.left - 5, y}, {g.left, y}}, ink, 1, 1});
    d.marks.push_back(label(g.left - 9, y + 4, texts[k], 13, Label::Anchor::end));
  }
}

// Round values (1, 2 and 5 times powers of ten) of a scale that is logarithmic away from zero. A
// value too close to the one before is left out.
std::vector<double> logarithmic_ticks(const Grid& g, double from, double to) {
  std::vector<double> at{0};
  const double least_distance = 0.07;  // relative to half of the scale
  for (const double sign : {1.0, -1.0}) {
    double last = 0;
    for (double decade = std::pow(10, std::floor(std::log10(g.map.middle)) - 1);
         decade <= g.map.limit; decade *= 10)
      for (const double digit : {1.0, 2.0, 5.0}) {
        const double value = sign * digit * decade;
        const double position = g.scale_position(value);
        const bool outside = value < from || value > to || std::abs(value) > g.map.limit;
        if (outside || std::abs(position - last) < least_distance) continue;
        at.push_back(value);
        last = position;
      }
  }
  return at;
}

// Draws the scale. It covers the colours in the map and zero; a linear scale is always -limit to
// limit.
void add_scale(Drawing& d, const Grid& g) {
  double low = 0;
  double high = 0;
  for (const double value : g.map.values.reshaped()) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (g.map.middle == 0 || high - low == 0) {
    low = -g.map.limit;
    high = g.map.limit;
  }
  low = std::max(low, -g.map.limit);
  high = std::min(high, g.map.limit);
  const double from = g.scale_position(low);
  const double to = g.scale_position(high);
  const double x = g.left + g.width + 30;
  const double cells = 40;
  // The scale has at least 90 units of height, also next to a map of one row.
  const double tall = std::max(g.height, 90.0);
  const double step = tall / cells;
  const double foot = std::max(g.bottom(), g.top + tall);
  for (int k = 0; k < cells; ++k)
    d.marks.push_back(box(x, foot - step * (k + 1), 16, step,
                          g.colour_at(from + (to - from) * (k + 0.5) / cells), 0.5));
  std::vector<double> at;
  std::vector<std::string> texts;
  if (g.map.middle == 0) {
    at = ticks(low, high, 4);
    texts = tick_texts(at);
  } else {
    at = logarithmic_ticks(g, low, high);
    for (double value : at) texts.push_back(fmt::format("{:g}", value));
  }
  for (std::size_t k = 0; k < at.size(); ++k) {
    const double y = foot - tall * (g.scale_position(at[k]) - from) / (to - from);
    d.marks.push_back(label(x + 22, y + 4, texts[k], 12, Label::Anchor::start));
  }
  if (!g.map.value_label.empty())
    d.marks.push_back(label(x, g.top - 14, g.map.value_label, 13, Label::Anchor::start));
}

}  // namespace

// Cells first, then numbers, lines and axes, which must not be covered. A long title is made
// smaller so that it fits the page.
Drawing heat_map(const HeatMap& map, const Look& look) {
  const Grid g(map, look);
  Drawing d;
  double x_label = 28;  // room of the label below
  if (map.x_label.empty()) x_label = 0;
  d.width = g.page;
  d.height = std::max(g.bottom() + g.below() + x_label, g.top + 90) + 14;
  if (look.titles && !map.title.empty())
    d.marks.push_back(
        label(d.width / 2, 26, map.title,
              std::min(16.0, 1.55 * d.width / static_cast<double>(map.title.size()))));
  add_cells(d, g);
  if (map.numbers) add_numbers(d, g);
  if (map.zero_line) add_zero_line(d, g);
  add_x_axis(d, g);
  add_y_axis(d, g);
  if (x_label > 0)
    d.marks.push_back(
        label(g.left + g.width / 2, g.bottom() + g.below() + x_label, map.x_label, 14));
  if (!map.y_label.empty()) {
    double x = 16;
    if (g.map.y_names.empty()) x = std::max(16.0, g.left - 56);  // next to the numbers
    Label y = label(x, g.top + g.height / 2, map.y_label, 14);
    y.turned = 90;
    d.marks.push_back(y);
  }
  if (!map.losses) add_scale(d, g);
  return d;
}

namespace {

// The greatest value, at the least the greatest upper end of an error bar; 1 if none is positive.
double greatest_value(const Bars& b) {
  double most = 0;
  const MatX* tall = &b.values;
  if (b.high.size() > 0) tall = &b.high;
  for (const double value : tall->reshaped()) {
    if (std::isfinite(value)) most = std::max(most, value);
  }
  if (most > 0) return most;
  return 1;
}

// An error bar with its two caps, at the middle c of a bar.
void add_error_bar(Drawing& d, double c, double low, double high, double cap) {
  d.marks.push_back(Stroke{{{c, low}, {c, high}}, ink, 1.2, 1});
  for (double y : {low, high}) d.marks.push_back(Stroke{{{c - cap, y}, {c + cap, y}}, ink, 1.2, 1});
}

}  // namespace

// From top to bottom: title, legend, bars over a grid of horizontal lines, names of the groups.
Drawing bars(const Bars& b, const Look& look) {
  // The set of colours of Okabe and Ito.
  constexpr Colour colours[] = {{0, 0.447, 0.698},   {0.835, 0.369, 0}, {0, 0.62, 0.451},
                                {0.8, 0.475, 0.655}, {0.902, 0.624, 0}, {0.337, 0.706, 0.914},
                                {0.2, 0.2, 0.2}};
  Drawing d;
  d.width = look.width.value_or(720);
  // The legend is above the bars, in as many rows as it needs.
  const double left = 76;
  const double right = 20;
  const double width = d.width - left - right;
  const bool titled = look.titles && !b.title.empty();
  double first = 14;
  if (titled) first = 44;
  const double row = 18;
  double x = left;
  double legend = first;
  std::vector<PagePoint> places;
  for (const std::string& name : b.series) {
    const double needed = 34 + text_width(name, 13);
    if (x > left && x + needed > d.width - 8) {
      x = left;
      legend += row;
    }
    places.push_back({x, legend});
    x += needed;
  }
  const double top = legend + 36;
  double height = 330;
  if (look.width) height = 0.5 * d.width;
  const double bottom = top + height;
  d.height = bottom + 40;
  const double most = greatest_value(b);
  const auto y_of = [&](double value) {
    return bottom - height * std::clamp(value / (1.05 * most), 0., 1.);
  };
  if (titled)
    d.marks.push_back(label(d.width / 2, 28, b.title,
                            std::min(16.0, 1.6 * d.width / static_cast<double>(b.title.size()))));
  d.marks.push_back(label(14, top - 12, b.y_label, 13, Label::Anchor::start));
  // Horizontal lines at round values, with their numbers at the left.
  const std::vector<double> at = ticks(0, most);
  const std::vector<std::string> texts = tick_texts(at);
  for (std::size_t k = 0; k < at.size(); ++k) {
    d.marks.push_back(Stroke{{{left, y_of(at[k])}, {left + width, y_of(at[k])}}, pale, 1, 1});
    d.marks.push_back(label(left - 8, y_of(at[k]) + 4, texts[k], 13, Label::Anchor::end));
  }
  // A group of bars takes 0.8 of its share of the width, so that groups are separated.
  const auto n = b.values.rows();
  const double group = width / static_cast<double>(b.values.cols());
  const double bar = 0.8 * group / static_cast<double>(n);
  for (Eigen::Index j = 0; j < b.values.cols(); ++j) {
    for (Eigen::Index i = 0; i < n; ++i) {
      const double x = left + group * (static_cast<double>(j) + 0.1) + bar * static_cast<double>(i);
      const double value = b.values(i, j);
      if (!std::isfinite(value)) continue;
      d.marks.push_back(box(x, y_of(value), 0.9 * bar, bottom - y_of(value), colours[i % 7]));
      if (b.low.size() == 0 || !std::isfinite(b.low(i, j))) continue;
      if (b.high(i, j) - b.low(i, j) < 1e-3 * most) continue;  // not visible
      add_error_bar(d, x + 0.45 * bar, y_of(b.low(i, j)), y_of(b.high(i, j)), 0.2 * bar);
    }
    const std::string& name = b.groups[static_cast<std::size_t>(j)];
    d.marks.push_back(label(left + group * (static_cast<double>(j) + 0.5), bottom + 22, name,
                            std::min(14.0, 14 * 0.95 * group / text_width(name, 14))));
  }
  d.marks.push_back(Stroke{{{left, bottom}, {left + width, bottom}}, ink, 1.2, 1});
  for (std::size_t i = 0; i < b.series.size(); ++i) {
    d.marks.push_back(box(places[i][0], places[i][1], 14, 12, colours[i % 7]));
    d.marks.push_back(
        label(places[i][0] + 20, places[i][1] + 11, b.series[i], 13, Label::Anchor::start));
  }
  return d;
}

}  // namespace langer
