#include "results/plot/heat_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "results/plot/map_parts.hpp"

namespace langer {

namespace {

using namespace map_parts;

constexpr Colour pale{0.87, 0.87, 0.87};

// Where the cells of a map are drawn.
struct Grid {
  const HeatMap& map;
  const Look& look;
  double names = 0;  // the widest of the rows
  double page = look.width.value_or(720), left = 150, top = 60, width = 420, height = 420, w = 0,
         h = 0;
  bool turned = false;  // the names of the columns stand upright
  Eigen::Index rows = map.values.rows(), columns = map.values.cols();

  Grid(const HeatMap& of, const Look& with) : map(of), look(with) {
    for (const std::string& name : map.y_names) names = std::max(names, text_width(name, 13));
    const double scale = map.losses ? 20 : 110;
    if (map.y_names.empty()) {
      left = std::min(150.0, 0.2 * page);
    } else {
      left = names + 20;
    }
    if (left > 0.55 * page) left = 0.55 * page;
    if (!look.titles || map.title.empty()) top = 34;
    width = std::max(60.0, page - left - scale);
    if (!look.width) {
      if (map.y_names.empty()) {
        width = 420;
      } else {
        width = std::min(width, std::max(420.0, 60.0 * static_cast<double>(columns)));
      }
    }
    if (map.y_names.empty()) {
      height = width;
    } else {
      height = std::max(60., 42. * static_cast<double>(rows));
    }
    w = width / static_cast<double>(columns);
    h = height / static_cast<double>(rows);
    for (const std::string& name : map.x_names) turned = turned || text_width(name, 13) > 0.95 * w;
  }
  double bottom() const { return top + height; }
  double below() const {  // room of the names of the columns
    double room = 0;
    for (const std::string& name : map.x_names)
      room = std::max(room, turned ? text_width(name, 13) + 6 : 18);
    return map.x_names.empty() ? 20 : room;
  }
  double x_of(Eigen::Index column) const { return left + w * static_cast<double>(column); }
  double y_of(Eigen::Index row) const {
    return top + h * static_cast<double>(map.first_row_on_top ? row : rows - 1 - row);
  }
  // of the scale, -1 to 1
  double place(double value) const {
    if (map.middle == 0) return std::clamp(value / map.limit, -1., 1.);
    const double s =
        std::log1p(3 * std::abs(value) / map.middle) / std::log1p(3 * map.limit / map.middle);
    return std::copysign(std::min(1., s), value);
  }
  Colour of_place(double place) const {
    return signed_colour((map.swap_colours ? -1 : 1) * place, look.signed_colours);
  }
  Colour colour(double value) const {
    if (!std::isfinite(value)) return grey;
    if (map.losses)
      return signed_colour(1 - 0.9 * std::clamp(value / map.limit, 0., 1.), look.signed_colours);
    return of_place(place(value));
  }
};

void add_cells(Drawing& d, const Grid& g) {
  for (Eigen::Index i = 0; i < g.rows; ++i)
    for (Eigen::Index j = 0; j < g.columns; ++j)
      d.marks.push_back(box(g.x_of(j), g.y_of(i), g.w, g.h, g.colour(g.map.values(i, j)),
                            g.map.numbers ? 0 : 0.5));
}

void add_numbers(Drawing& d, const Grid& g) {
  for (Eigen::Index i = 0; i < g.rows; ++i)
    for (Eigen::Index j = 0; j < g.columns; ++j) {
      const double value = g.map.values(i, j);
      const double size = std::min(13.0, g.w / 3.2);  // of -0.99 in a cell
      if (size < 5) continue;                         // a colour says more
      std::string text;
      if (std::isfinite(value)) {
        text = fmt::format("{:.{}f}", value,
                           g.w > 50 && std::abs(value) > 0.99 ? 3
                           : g.w > 34                         ? 2
                                                              : 1);
      } else if (std::isinf(value)) {
        text = "none";
      } else {
        text = "–";
      }
      if (g.map.losses && std::isfinite(value)) text = fmt::format("{:.3g}", value);
      if (std::isfinite(value) && !g.map.losses && std::abs(value) >= 1 - 1e-12)
        text = fmt::format("{:.0f}", value);
      if (value == 0) text = "0";
      Label number = label(g.x_of(j) + g.w / 2, g.y_of(i) + g.h / 2 + 0.32 * size, text, size);
      const Colour ground = g.colour(value);
      number.white = 0.21 * ground.r + 0.72 * ground.g + 0.07 * ground.b < 0.4;  // luminance
      d.marks.push_back(number);
    }
}

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

// names of the columns, or numbers at the middles of cells
void add_x_axis(Drawing& d, const Grid& g) {
  for (std::size_t j = 0; j < g.map.x_names.size(); ++j) {
    const double x = g.x_of(static_cast<Eigen::Index>(j)) + g.w / 2;
    // as high as a narrow cell is wide
    double size = 13;
    if (g.turned) size = std::min(13.0, g.w);
    Label name = label(g.turned ? x + 0.3 * size : x, g.bottom() + (g.turned ? 8 : 18),
                       g.map.x_names[j], size);
    if (g.turned) {
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

// round values of a scale that is logarithmic away from zero, not too near to each other
std::vector<double> spread_ticks(const Grid& g, double from, double to) {
  std::vector<double> at{0};
  const double nearest = 0.07;  // of the scale's half
  for (const double sign : {1.0, -1.0}) {
    double last = 0;
    for (double decade = std::pow(10, std::floor(std::log10(g.map.middle)) - 1);
         decade <= g.map.limit; decade *= 10)
      for (const double digit : {1.0, 2.0, 5.0}) {
        const double value = sign * digit * decade;
        const double place = g.place(value);
        if (value < from || value > to || std::abs(value) > g.map.limit ||
            std::abs(place - last) < nearest)
          continue;
        at.push_back(value);
        last = place;
      }
  }
  return at;
}

// from the least to the greatest colour that is in the map, at least from or to zero
void add_scale(Drawing& d, const Grid& g) {
  double low = 0, high = 0;
  for (Eigen::Index i = 0; i < g.map.values.size(); ++i)
    if (const double v = g.map.values.data()[i]; std::isfinite(v)) {
      low = std::min(low, v);
      high = std::max(high, v);
    }
  if (g.map.middle == 0 || high - low == 0) {
    low = -g.map.limit;
    high = g.map.limit;
  }
  low = std::max(low, -g.map.limit);
  high = std::min(high, g.map.limit);
  const double from = g.place(low);
  const double to = g.place(high);
  const double x = g.left + g.width + 30;
  const double cells = 40;
  const double tall = std::max(g.height, 90.0);
  const double step = tall / cells;
  const double foot = std::max(g.bottom(), g.top + tall);
  for (int k = 0; k < cells; ++k)
    d.marks.push_back(box(x, foot - step * (k + 1), 16, step,
                          g.of_place(from + (to - from) * (k + 0.5) / cells), 0.5));
  std::vector<double> at;
  if (g.map.middle == 0) {
    at = ticks(low, high, 4);
  } else {
    at = spread_ticks(g, low, high);
  }
  const std::vector<std::string> texts = tick_texts(at);
  for (std::size_t k = 0; k < at.size(); ++k)
    d.marks.push_back(label(x + 22, foot - tall * (g.place(at[k]) - from) / (to - from) + 4,
                            g.map.middle == 0 ? texts[k] : fmt::format("{:g}", at[k]), 12,
                            Label::Anchor::start));
  if (!g.map.value_label.empty())
    d.marks.push_back(label(x, g.top - 14, g.map.value_label, 13, Label::Anchor::start));
}

}  // namespace

Drawing heat_map(const HeatMap& map, const Look& look) {
  const Grid g(map, look);
  Drawing d;
  const double x_label = map.x_label.empty() ? 0 : 28;
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
    Label y = label(g.map.y_names.empty() ? std::max(16.0, g.left - 56) : 16, g.top + g.height / 2,
                    map.y_label, 14);
    y.turned = 90;
    d.marks.push_back(y);
  }
  if (!map.losses) add_scale(d, g);
  return d;
}

Drawing bars(const Bars& b, const Look& look) {
  // Okabe and Ito
  constexpr Colour colours[] = {{0, 0.447, 0.698},   {0.835, 0.369, 0}, {0, 0.62, 0.451},
                                {0.8, 0.475, 0.655}, {0.902, 0.624, 0}, {0.337, 0.706, 0.914},
                                {0.2, 0.2, 0.2}};
  Drawing d;
  d.width = look.width.value_or(720);
  // the legend in as many rows as it needs
  const double left = 76;
  const double right = 20;
  const double width = d.width - left - right;
  const bool titled = look.titles && !b.title.empty();
  const double first = titled ? 44 : 14;
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
  double most = 0;
  const MatX& tall = b.high.size() ? b.high : b.values;
  for (Eigen::Index i = 0; i < tall.rows(); ++i)
    for (Eigen::Index j = 0; j < tall.cols(); ++j)
      if (std::isfinite(tall(i, j))) most = std::max(most, tall(i, j));
  if (!(most > 0)) most = 1;
  const auto y_of = [&](double value) {
    return bottom - height * std::clamp(value / (1.05 * most), 0., 1.);
  };
  if (titled)
    d.marks.push_back(label(d.width / 2, 28, b.title,
                            std::min(16.0, 1.6 * d.width / static_cast<double>(b.title.size()))));
  d.marks.push_back(label(14, top - 12, b.y_label, 13, Label::Anchor::start));
  const std::vector<double> at = ticks(0, most);
  const std::vector<std::string> texts = tick_texts(at);
  for (std::size_t k = 0; k < at.size(); ++k) {
    d.marks.push_back(Stroke{{{left, y_of(at[k])}, {left + width, y_of(at[k])}}, pale, 1, 1});
    d.marks.push_back(label(left - 8, y_of(at[k]) + 4, texts[k], 13, Label::Anchor::end));
  }
  const auto n = b.values.rows();
  const double group = width / static_cast<double>(b.values.cols());
  const double bar = 0.8 * group / static_cast<double>(n);
  for (Eigen::Index j = 0; j < b.values.cols(); ++j) {
    for (Eigen::Index i = 0; i < n; ++i) {
      const double x = left + group * (static_cast<double>(j) + 0.1) + bar * static_cast<double>(i);
      const double value = b.values(i, j);
      if (!std::isfinite(value)) continue;
      d.marks.push_back(box(x, y_of(value), 0.9 * bar, bottom - y_of(value), colours[i % 7]));
      if (!b.low.size() || !std::isfinite(b.low(i, j)) || b.high(i, j) - b.low(i, j) < 1e-3 * most)
        continue;
      const double c = x + 0.45 * bar;
      const double lo = y_of(b.low(i, j));
      const double hi = y_of(b.high(i, j));
      d.marks.push_back(Stroke{{{c, lo}, {c, hi}}, ink, 1.2, 1});
      for (double y : {lo, hi})
        d.marks.push_back(Stroke{{{c - 0.2 * bar, y}, {c + 0.2 * bar, y}}, ink, 1.2, 1});
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
