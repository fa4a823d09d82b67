// Panels, bands, marks and the colour bar of maps.
#include "results/plot/map_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "results/plot/figure_units.hpp"

namespace langer {

namespace {

constexpr double gap = 16, left_room = 62, bottom_room = 44;
constexpr int wished_bands = 14, parts = 3;  // of a facet's side, where bands end in it
const Colour ink{0.13, 0.13, 0.13};

struct Corner {
  PlanePoint at;
  double value;
};
using Polygon = std::vector<Corner>;

// the part of a polygon where f, linear between its corners, is not negative
Polygon part_of(const Polygon& polygon, auto&& f) {
  Polygon part;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Corner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double f_a = f(a);
    const double f_b = f(b);
    if (f_a >= 0) part.push_back(a);
    if ((f_a >= 0) == (f_b >= 0)) continue;
    const double s = f_a / (f_a - f_b);
    part.push_back({{a.at[0] + s * (b.at[0] - a.at[0]), a.at[1] + s * (b.at[1] - a.at[1])},
                    a.value + s * (b.value - a.value)});
  }
  return part;
}

// Bands between ascending levels, and the two beyond them.
struct Scale {
  std::vector<double> levels;
  bool is_signed = false, below = false, beyond = false;  // values outside the levels
  ColourMap colours = ColourMap::violet_yellow;
  SignedColours signed_colours = SignedColours::blue_red;
  int band(double value) const {
    return static_cast<int>(std::upper_bound(levels.begin(), levels.end(), value) - levels.begin());
  }
  Colour colour(int band) const {
    const int last = static_cast<int>(levels.size());
    const double step = levels[1] - levels[0];
    double middle = 0;
    if (band == 0) {
      middle = levels.front() - 0.5 * step;
    } else if (band == last) {
      middle = levels.back() + 0.5 * step;
    } else {
      middle = 0.5 * (levels[band - 1] + levels[band]);
    }
    if (!is_signed)
      return scale_colour(
          (middle - levels.front() + step) / (levels.back() - levels.front() + 2 * step), colours);
    return signed_colour(
        middle / (std::max(std::abs(levels.front()), std::abs(levels.back())) + step),
        signed_colours);
  }
};

struct Window {
  double x_low, x_high, z_low, z_high;
  bool has(const PlanePoint& p) const {
    return p[0] >= x_low && p[0] <= x_high && p[1] >= z_low && p[1] <= z_high;
  }
  Polygon part(Polygon polygon) const {
    polygon = part_of(polygon, [&](const Corner& c) { return x_high - c.at[0]; });
    polygon = part_of(polygon, [&](const Corner& c) { return c.at[0] - x_low; });
    polygon = part_of(polygon, [&](const Corner& c) { return z_high - c.at[1]; });
    return part_of(polygon, [&](const Corner& c) { return c.at[1] - z_low; });
  }
};

Window window_of(const std::vector<MapPanel>& panels, const MapStyle& style) {
  if (style.reach) return {-*style.reach, *style.reach, -*style.reach, *style.reach};
  constexpr double far = std::numeric_limits<double>::max();
  Window w{far, -far, far, -far};
  for (const MapPanel& panel : panels)
    for (const auto& [x, z] : panel.map->places)
      w = {std::min(w.x_low, x), std::max(w.x_high, x), std::min(w.z_low, z),
           std::max(w.z_high, z)};
  return w;
}

Scale scale_of(const std::vector<MapPanel>& panels, const MapStyle& style, const Window& window) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  const auto seen = [&](const PlanePoint& at) {
    return window.has(at);
  };
  const bool none = std::none_of(
      panels.begin(), panels.end(), [&](const MapPanel& p) {  // a window within one cell
        return std::any_of(p.map->places.begin(), p.map->places.end(), seen);
      });
  for (const MapPanel& panel : panels)
    for (std::size_t i = 0; i < panel.map->places.size(); ++i)
      if (none || seen(panel.map->places[i])) {
        low = std::min(low, panel.map->values[i]);
        high = std::max(high, panel.map->values[i]);
      }
  const double least = low;
  const double most = high;
  if (style.range) {
    low = (*style.range)[0];
    high = (*style.range)[1];
  }
  if (!(high - low > 1e-12 * std::max(std::abs(low), std::abs(high)))) {
    // one value everywhere
    low -= 0.5;
    high += 0.5;
  }
  Scale scale;
  scale.levels = ticks(low, high, wished_bands);
  const double step = scale.levels[1] - scale.levels[0];
  if (!style.range) {  // whole bands around all values
    if (scale.levels.front() > low)
      scale.levels.insert(scale.levels.begin(), scale.levels.front() - step);
    if (scale.levels.back() < high) scale.levels.push_back(scale.levels.back() + step);
  }
  for (double& level : scale.levels)
    if (std::abs(level) < 1e-9 * step) level = 0;
  const double slack = 1e-9 * step;
  scale.is_signed = scale.levels.front() < 0 && scale.levels.back() > 0;
  scale.below =
      least<scale.levels.front() - slack, scale.beyond = most> scale.levels.back() + slack;
  return scale;
}

// One panel: where it lies on the page and what it shows.
class Painter {
 public:
  Painter(Drawing& drawing, const Window& window, const Scale& scale, double left, double top,
          double pt_per_mm)
      : drawing_(drawing),
        window_(window),
        scale_(scale),
        left_(left),
        top_(top),
        k_(pt_per_mm),
        bands_(scale.levels.size() + 1) {}

  PagePoint page(const PlanePoint& p) const {
    return {left_ + k_ * (p[0] - window_.x_low), top_ + k_ * (p[1] - window_.z_low)};
  }

  void field(const SurfaceMap& map) {
    for (const auto& facet : map.facets) {
      Polygon quad;
      for (int node : facet) quad.push_back({map.places[node], map.values[node]});
      const auto [low, high] =
          std::minmax({quad[0].value, quad[1].value, quad[2].value, quad[3].value});
      if (scale_.band(low) == scale_.band(high))
        paint(quad);
      else
        for (int i = 0; i < parts; ++i)
          for (int j = 0; j < parts; ++j) {
            const auto at = [&](int a, int b) {
              return bilinear(quad, double(a) / parts, double(b) / parts);
            };
            paint({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
          }
    }
    // lower bands first: no seam of a lower colour shows in a higher one
    for (std::vector<Patch>& band : bands_)
      std::move(band.begin(), band.end(), std::back_inserter(drawing_.marks));
  }
  void edges(const SurfaceMap& map) {
    for (const auto& facet : map.facets)
      for (int k = 0; k < 4; ++k)
        line(map.places[facet[k]], map.places[facet[(k + 1) % 4]], 0.35, 0.4);
  }
  // short lines on a raster, each in the direction of the facet that lies nearest
  void fibres(const SurfaceMap& map) {
    constexpr int raster = 9;
    const double dx = (window_.x_high - window_.x_low) / raster;
    const double dz = (window_.z_high - window_.z_low) / raster;
    for (int i = 0; i < raster; ++i)
      for (int j = 0; j < raster && !map.fibres.empty(); ++j) {
        const PlanePoint at{window_.x_low + (i + 0.5) * dx, window_.z_low + (j + 0.5) * dz};
        double nearest = std::numeric_limits<double>::infinity();
        PlanePoint a{0, 0};
        for (std::size_t f = 0; f < map.facets.size(); ++f) {
          PlanePoint centre{0, 0};
          for (int node : map.facets[f])
            for (int c = 0; c < 2; ++c) centre[c] += map.places[node][c] / 4;
          const double d = std::hypot(centre[0] - at[0], centre[1] - at[1]);
          if (d < nearest) {
            nearest = d;
            a = map.fibres[f];
          }
        }
        const double half = 0.3 * std::min(dx, dz);
        line({at[0] - half * a[0], at[1] - half * a[1]}, {at[0] + half * a[0], at[1] + half * a[1]},
             1.0, 0.6);
      }
  }
  void points(const SurfaceMap& map) {
    constexpr int corners = 16;
    for (const auto& [name, at] : map.points) {
      if (!window_.has(at)) continue;
      const PagePoint c = page(at);
      for (const auto& [radius, colour] : {std::pair{4.2, Colour{1, 1, 1}}, {2.8, ink}}) {
        Patch dot{{}, colour, 0};
        for (int i = 0; i < corners; ++i)
          dot.corners.push_back({c[0] + radius * std::cos(2 * std::numbers::pi * i / corners),
                                 c[1] + radius * std::sin(2 * std::numbers::pi * i / corners)});
        drawing_.marks.push_back(dot);
      }
      drawing_.marks.push_back(Label{{c[0] + 7, c[1] - 5}, name, 14});
    }
  }
  void frame(bool x_axis, bool z_axis) {
    const PagePoint a = page({window_.x_low, window_.z_low});
    const PagePoint b = page({window_.x_high, window_.z_high});
    drawing_.marks.push_back(Stroke{{a, {b[0], a[1]}, b, {a[0], b[1]}, a}, ink, 0.8});
    for (int axis = 0; axis < 2; ++axis) {
      std::vector<double> at;
      if (axis == 0) {
        at = ticks(window_.x_low, window_.x_high, 4);
      } else {
        at = ticks(window_.z_low, window_.z_high, 4);
      }
      const std::vector<std::string> texts = tick_texts(at);
      for (std::size_t i = 0; i < at.size(); ++i) {
        const PagePoint p =
            axis == 0 ? PagePoint{page({at[i], 0})[0], b[1]} : PagePoint{a[0], page({0, at[i]})[1]};
        drawing_.marks.push_back(Stroke{{p, {p[0] - 4 * axis, p[1] + 4 * (1 - axis)}}, ink, 0.8});
        if (axis == 0 && x_axis)
          drawing_.marks.push_back(Label{{p[0], p[1] + 17}, texts[i], 12, Label::Anchor::middle});
        if (axis == 1 && z_axis)
          drawing_.marks.push_back(Label{{p[0] - 8, p[1] + 4.2}, texts[i], 12, Label::Anchor::end});
      }
    }
    if (x_axis)
      drawing_.marks.push_back(
          Label{{0.5 * (a[0] + b[0]), b[1] + 36}, "x (mm)", 13, Label::Anchor::middle});
    if (z_axis) {  // clear of the numbers: between the upper two
      const std::vector<double> at = ticks(window_.z_low, window_.z_high, 4);
      double z = 0;
      if (at.size() < 2) {
        z = window_.z_low;
      } else {
        z = 0.5 * (at[0] + at[1]);
      }
      drawing_.marks.push_back(
          Label{{a[0] - 8, page({0, z})[1] + 4}, "z (mm)", 13, Label::Anchor::end});
    }
  }

 private:
  Drawing& drawing_;
  const Window& window_;
  const Scale& scale_;
  double left_, top_, k_;
  std::vector<std::vector<Patch>> bands_;

  static Corner bilinear(const Polygon& quad, double p, double q) {
    const double N[] = {(1 - p) * (1 - q), p * (1 - q), p * q, (1 - p) * q};
    Corner c{{0, 0}, 0};
    for (int k = 0; k < 4; ++k) {
      for (int i = 0; i < 2; ++i) c.at[i] += N[k] * quad[k].at[i];
      c.value += N[k] * quad[k].value;
    }
    return c;
  }
  // the whole in the colour of its lowest band, over it what lies above each level
  void paint(const Polygon& whole) {
    const Polygon polygon = window_.part(whole);
    if (polygon.size() < 3) return;
    double low = polygon[0].value;
    double high = low;
    for (const Corner& c : polygon) {
      low = std::min(low, c.value);
      high = std::max(high, c.value);
    }
    patch(polygon, scale_.band(low));
    for (int band = scale_.band(low) + 1; band <= scale_.band(high); ++band) {
      const Polygon part =
          part_of(polygon, [&](const Corner& c) { return c.value - scale_.levels[band - 1]; });
      if (part.size() >= 3) patch(part, band);
    }
  }
  void patch(const Polygon& polygon, int band) {
    Patch p{{}, scale_.colour(band), 0.4};
    for (const Corner& c : polygon) p.corners.push_back(page(c.at));
    bands_[band].push_back(std::move(p));
  }
  // as far as it lies in the window
  void line(const PlanePoint& a, const PlanePoint& b, double width, double opacity) {
    const Polygon ends = window_.part({{a, 0}, {b, 0}});
    if (ends.size() < 2) return;
    drawing_.marks.push_back(Stroke{{page(ends[0].at), page(ends[1].at)}, ink, width, opacity});
  }
};

void add_colour_bar(Drawing& drawing, const Scale& scale, const std::string& label, double x,
                    double top, double height, double room) {
  const double width = 20, tip = 16;
  const std::size_t n = scale.levels.size() - 1;
  const auto y = [&](double level) {
    return top +
           height * (scale.levels.back() - level) / (scale.levels.back() - scale.levels.front());
  };
  for (std::size_t i = 0; i < n; ++i) {
    const double y0 = y(scale.levels[i + 1]);
    const double y1 = y(scale.levels[i]);
    drawing.marks.push_back(Patch{{{x, y0}, {x + width, y0}, {x + width, y1}, {x, y1}},
                                  scale.colour(static_cast<int>(i) + 1),
                                  0.4});
  }
  std::vector<PagePoint> outline{{x, top}};
  if (scale.beyond) {
    const std::vector<PagePoint> corners{{x, top}, {x + width / 2, top - tip}, {x + width, top}};
    drawing.marks.push_back(Patch{corners, scale.colour(static_cast<int>(n) + 1), 0.4});
    outline.push_back(corners[1]);
  }
  outline.push_back({x + width, top});
  outline.push_back({x + width, top + height});
  if (scale.below) {
    const std::vector<PagePoint> corners{
        {x, top + height}, {x + width / 2, top + height + tip}, {x + width, top + height}};
    drawing.marks.push_back(Patch{corners, scale.colour(0), 0.4});
    outline.push_back(corners[1]);
  }
  outline.push_back({x, top + height});
  outline.push_back({x, top});
  drawing.marks.push_back(Stroke{outline, ink, 0.8});
  const std::vector<std::string> texts = tick_texts(scale.levels);
  const std::size_t every = n > 14 ? 2 : 1;
  for (std::size_t i = 0; i <= n; ++i) {
    const double at = y(scale.levels[i]);
    drawing.marks.push_back(Stroke{{{x + width, at}, {x + width + 4, at}}, ink, 0.8});
    if (std::abs(std::remainder(std::round(scale.levels[i] / (scale.levels[1] - scale.levels[0])),
                                double(every))) < 0.5)
      drawing.marks.push_back(Label{{x + width + 8, at + 4.4}, texts[i], 12});
  }
  add_lines_above(drawing, {drawing.width - 10, top - tip - 14}, label, 13, room);
}

}  // namespace

std::vector<Complaint> MapStyle::complaints() const {
  if (!range || (*range)[0] < (*range)[1]) return {};
  return {{"range", "its ends are not ascending", "[low, high]", ""}};
}

Drawing map_drawing(const std::vector<MapPanel>& panels, const MapStyle& style, int columns,
                    const Look& look) {
  const Window window = window_of(panels, style);
  Scale scale = scale_of(panels, style, window);
  scale.colours = look.colours;
  scale.signed_colours = look.signed_colours;
  const int n = static_cast<int>(panels.size());
  columns = std::clamp(columns, 1, n);
  const int rows = (n + columns - 1) / columns;
  const bool titled =
      std::any_of(panels.begin(), panels.end(), [](const MapPanel& p) { return !p.title.empty(); });
  double bar_room = 178;
  if (look.width && *look.width < 500) bar_room = 110;
  // width of a panel
  double liked = 0;
  if (columns == 1) {
    liked = 460;
  } else if (columns == 2) {
    liked = 340;
  } else {
    liked = 260;
  }
  double width = liked;
  if (look.width) {
    width = std::max(60.0, (*look.width - left_room - bar_room - (columns - 1) * gap) / columns);
  }
  const double k = width / (window.x_high - window.x_low);
  const double height = k * (window.z_high - window.z_low);
  const double panel_title = titled ? 24 : 8;
  double title_room = 38;
  if (style.title.empty() || !look.titles) title_room = 8;

  Drawing drawing;
  drawing.width = std::round(left_room + columns * width + (columns - 1) * gap + bar_room);
  drawing.height = std::round(title_room + std::max(190.0, rows * (height + panel_title)) +
                              bottom_room);  // the colour bar needs that
  for (int i = 0; i < n; ++i) {
    const int row = i / columns;
    const int column = i % columns;
    const double left = left_room + column * (width + gap);
    const double top = title_room + row * (height + panel_title) + panel_title;
    Painter painter(drawing, window, scale, left, top, k);
    const SurfaceMap& map = *panels[i].map;
    painter.field(map);
    if (style.cells) painter.edges(map);
    if (style.fibres) painter.fibres(map);
    painter.points(map);
    painter.frame(i + columns >= n, column == 0);
    if (!panels[i].title.empty())
      drawing.marks.push_back(
          Label{{left + width / 2, top - 7}, panels[i].title, 14, Label::Anchor::middle});
  }
  const double words = look.width ? 36 : 0;  // its label takes more than one line on a narrow page
  const double bar = std::min(360.0, drawing.height - title_room - bottom_room - 60 - words);
  const double free = drawing.height - title_room - bottom_room - bar;
  const SurfaceMap& first = *panels.front().map;
  add_colour_bar(drawing, scale, with_unit(first.label, first.unit), drawing.width - bar_room + 20,
                 title_room + (free + words) / 2 + 14, bar,
                 look.width ? bar_room - 10 : drawing.width);
  if (title_room > 8)
    drawing.marks.push_back(Label{{(drawing.width - bar_room) / 2, 24},
                                  style.title,
                                  16,
                                  Label::Anchor::middle,
                                  false,
                                  false,
                                  0,
                                  true});
  return drawing;
}

}  // namespace langer
