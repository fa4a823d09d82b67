#include "plot/heat_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace langer {

namespace {

constexpr Colour ink{0.15, 0.15, 0.15}, grey{0.8, 0.8, 0.8}, pale{0.87, 0.87, 0.87};

Patch box(double x, double y, double w, double h, const Colour& colour, double hem = 0) {
  return {{{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}}, colour, hem};
}

Label label(double x, double y, const std::string& text, double size = 13, Label::Anchor anchor = Label::Anchor::middle) {
  return {{x, y}, text, size, anchor};
}

// Where the cells of a map are drawn.
struct Grid {
  const HeatMap& map;
  double left = 150, top = 60, width = 420;
  Eigen::Index rows = map.values.rows(), columns = map.values.cols();
  double height = map.y_names.empty() ? 420 : std::max(60., 42. * static_cast<double>(rows));
  double w = width / static_cast<double>(columns), h = height / static_cast<double>(rows);  // of a cell

  double bottom() const { return top + height; }
  double x_of(Eigen::Index column) const { return left + w * static_cast<double>(column); }
  double y_of(Eigen::Index row) const { return top + h * static_cast<double>(map.first_row_on_top ? row : rows - 1 - row); }
  Colour colour(double value) const {
    if (!std::isfinite(value)) return grey;
    if (map.losses) return signed_colour(1 - 0.9 * std::clamp(value / map.limit, 0., 1.));
    return signed_colour((map.swap_colours ? -1 : 1) * std::clamp(value / map.limit, -1., 1.));
  }
};

void add_cells(Drawing& d, const Grid& g) {
  for (Eigen::Index i = 0; i < g.rows; ++i)
    for (Eigen::Index j = 0; j < g.columns; ++j)
      d.marks.push_back(box(g.x_of(j), g.y_of(i), g.w, g.h, g.colour(g.map.values(i, j)), g.map.numbers ? 0 : 0.5));
}

void add_numbers(Drawing& d, const Grid& g) {
  for (Eigen::Index i = 0; i < g.rows; ++i)
    for (Eigen::Index j = 0; j < g.columns; ++j) {
      const double value = g.map.values(i, j);
      const std::string text = std::isfinite(value) ? fmt::format("{:.3g}", value) : std::isinf(value) ? "none" : "–";
      Label number = label(g.x_of(j) + g.w / 2, g.y_of(i) + g.h / 2 + 4, text, g.w > 55 ? 13 : 11);
      const Colour ground = g.colour(value);
      number.white = 0.21 * ground.r + 0.72 * ground.g + 0.07 * ground.b < 0.4;  // luminance
      d.marks.push_back(number);
    }
}

void add_zero_line(Drawing& d, const Grid& g) {
  const MatX& values = g.map.values;
  const auto differ = [](double a, double b) { return std::isfinite(a) && std::isfinite(b) && (a < 0) != (b < 0); };
  for (Eigen::Index i = 0; i < g.rows; ++i)
    for (Eigen::Index j = 0; j < g.columns; ++j) {
      const double x = g.x_of(j), y = g.y_of(i);
      if (j + 1 < g.columns && differ(values(i, j), values(i, j + 1)))
        d.marks.push_back(Stroke{{{x + g.w, y}, {x + g.w, y + g.h}}, ink, 1.5, 1});
      if (i + 1 < g.rows && differ(values(i, j), values(i + 1, j))) {
        const double edge = g.map.first_row_on_top ? y + g.h : y;
        d.marks.push_back(Stroke{{{x, edge}, {x + g.w, edge}}, ink, 1.5, 1});
      }
    }
}

// names of the columns, or numbers at the middles of cells
void add_x_axis(Drawing& d, const Grid& g) {
  for (std::size_t j = 0; j < g.map.x_names.size(); ++j)
    d.marks.push_back(label(g.x_of(static_cast<Eigen::Index>(j)) + g.w / 2, g.bottom() + 20, g.map.x_names[j]));
  if (!g.map.x_names.empty()) return;
  const std::vector<double> at = ticks(g.map.x_from, g.map.x_to);
  const std::vector<std::string> texts = tick_texts(at);
  for (std::size_t k = 0; k < at.size(); ++k) {
    const double x = g.left + g.w / 2 + (g.width - g.w) * (at[k] - g.map.x_from) / (g.map.x_to - g.map.x_from);
    d.marks.push_back(Stroke{{{x, g.bottom()}, {x, g.bottom() + 5}}, ink, 1, 1});
    d.marks.push_back(label(x, g.bottom() + 20, texts[k]));
  }
}

void add_y_axis(Drawing& d, const Grid& g) {
  for (std::size_t i = 0; i < g.map.y_names.size(); ++i)
    d.marks.push_back(
        label(g.left - 8, g.y_of(static_cast<Eigen::Index>(i)) + g.h / 2 + 4, g.map.y_names[i], 13, Label::Anchor::end));
  if (!g.map.y_names.empty()) return;
  const std::vector<double> at = ticks(g.map.y_from, g.map.y_to);
  const std::vector<std::string> texts = tick_texts(at);
  for (std::size_t k = 0; k < at.size(); ++k) {
    const double y = g.bottom() - g.h / 2 - (g.height - g.h) * (at[k] - g.map.y_from) / (g.map.y_to - g.map.y_from);
    d.marks.push_back(Stroke{{{g.left - 5, y}, {g.left, y}}, ink, 1, 1});
    d.marks.push_back(label(g.left - 9, y + 4, texts[k], 13, Label::Anchor::end));
  }
}

void add_scale(Drawing& d, const Grid& g) {
  const double x = g.left + g.width + 30, cells = 40, step = g.height / cells, limit = g.map.limit;
  for (int k = 0; k < cells; ++k)
    d.marks.push_back(box(x, g.bottom() - step * (k + 1), 16, step, g.colour(limit * (2 * (k + 0.5) / cells - 1)), 0.5));
  const std::vector<double> at = ticks(-limit, limit, 4);
  const std::vector<std::string> texts = tick_texts(at);
  for (std::size_t k = 0; k < at.size(); ++k)
    d.marks.push_back(label(x + 22, g.bottom() - g.height * (at[k] / limit + 1) / 2 + 4, texts[k], 12, Label::Anchor::start));
  if (!g.map.value_label.empty()) d.marks.push_back(label(x, g.top - 14, g.map.value_label, 13, Label::Anchor::start));
}

}  // namespace

Drawing heat_map(const HeatMap& map) {
  const Grid g{map};
  Drawing d;
  d.width = 720, d.height = g.bottom() + 70;
  d.marks.push_back(label(g.left + g.width / 2, 30, map.title, 16));
  add_cells(d, g);
  if (map.numbers) add_numbers(d, g);
  if (map.zero_line) add_zero_line(d, g);
  add_x_axis(d, g);
  add_y_axis(d, g);
  d.marks.push_back(label(g.left + g.width / 2, g.bottom() + 48, map.x_label, 14));
  if (!map.y_label.empty()) d.marks.push_back(label(20, g.top - 14, map.y_label, 14, Label::Anchor::start));
  if (!map.losses) add_scale(d, g);
  return d;
}

Drawing bars(const Bars& b) {
  // Okabe and Ito
  constexpr Colour colours[] = {{0, 0.447, 0.698}, {0.835, 0.369, 0},     {0, 0.62, 0.451}, {0.8, 0.475, 0.655},
                                {0.902, 0.624, 0}, {0.337, 0.706, 0.914}, {0.2, 0.2, 0.2}};
  Drawing d;
  d.width = 720, d.height = 480;
  const double left = 90, top = 80, width = 600, height = 330, bottom = top + height;
  double most = 0;
  const MatX& tall = b.high.size() ? b.high : b.values;
  for (Eigen::Index i = 0; i < tall.rows(); ++i)
    for (Eigen::Index j = 0; j < tall.cols(); ++j)
      if (std::isfinite(tall(i, j))) most = std::max(most, tall(i, j));
  if (!(most > 0)) most = 1;
  const auto y_of = [&](double value) { return bottom - height * std::clamp(value / (1.05 * most), 0., 1.); };
  d.marks.push_back(label(left + width / 2, 28, b.title, 16));
  d.marks.push_back(label(14, top - 16, b.y_label, 13, Label::Anchor::start));
  const std::vector<double> at = ticks(0, most);
  const std::vector<std::string> texts = tick_texts(at);
  for (std::size_t k = 0; k < at.size(); ++k) {
    d.marks.push_back(Stroke{{{left, y_of(at[k])}, {left + width, y_of(at[k])}}, pale, 1, 1});
    d.marks.push_back(label(left - 8, y_of(at[k]) + 4, texts[k], 13, Label::Anchor::end));
  }
  const auto n = b.values.rows();
  const double group = width / static_cast<double>(b.values.cols()), bar = 0.8 * group / static_cast<double>(n);
  for (Eigen::Index j = 0; j < b.values.cols(); ++j) {
    for (Eigen::Index i = 0; i < n; ++i) {
      const double x = left + group * (static_cast<double>(j) + 0.1) + bar * static_cast<double>(i), value = b.values(i, j);
      if (!std::isfinite(value)) continue;
      d.marks.push_back(box(x, y_of(value), 0.9 * bar, bottom - y_of(value), colours[i % 7]));
      if (!b.low.size() || !std::isfinite(b.low(i, j)) || b.high(i, j) - b.low(i, j) < 1e-3 * most) continue;
      const double c = x + 0.45 * bar, lo = y_of(b.low(i, j)), hi = y_of(b.high(i, j));
      d.marks.push_back(Stroke{{{c, lo}, {c, hi}}, ink, 1.2, 1});
      for (double y : {lo, hi}) d.marks.push_back(Stroke{{{c - 0.2 * bar, y}, {c + 0.2 * bar, y}}, ink, 1.2, 1});
    }
    d.marks.push_back(label(left + group * (static_cast<double>(j) + 0.5), bottom + 22, b.groups[static_cast<std::size_t>(j)], 14));
  }
  d.marks.push_back(Stroke{{{left, bottom}, {left + width, bottom}}, ink, 1.2, 1});
  double x = left;
  for (std::size_t i = 0; i < b.series.size(); ++i) {
    d.marks.push_back(box(x, 44, 14, 12, colours[i % 7]));
    d.marks.push_back(label(x + 20, 55, b.series[i], 13, Label::Anchor::start));
    x += 40 + 9 * static_cast<double>(b.series[i].size());
  }
  return d;
}

}  // namespace langer
