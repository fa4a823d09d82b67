// Panels, bands, marks and the colour bar of maps.
//
// A facet is a bilinear quadrilateral. It is cut into parts whose values are linear enough, and
// each part is cut at the levels of the colour scale (Sutherland and Hodgman's clipping of
// polygons).
#include "results/plot/map_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "results/plot/figure_units.hpp"

namespace langer {

namespace {

constexpr double gap = 16, left_room = 62, bottom_room = 44;
constexpr int wished_bands = 14;
constexpr int parts = 3;  // into which the side of a facet is divided if several bands meet in it
const Colour ink{0.13, 0.13, 0.13};

// A corner of a polygon on the surface, with the value of the field.
struct Corner {
  PlanePoint at;
  double value;
};
using Polygon = std::vector<Corner>;

// The part of a polygon where f is not negative; f is linear between the corners.
Polygon clipped(const Polygon& polygon, auto&& f) {
  Polygon part;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Corner& a = polygon[i];
    const Corner& b = polygon[(i + 1) % polygon.size()];
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

// The colour scale: bands between ascending levels, one band below the first and one above the
// last.
struct Scale {
  std::vector<double> levels;
  bool is_signed = false;
  bool below = false, beyond = false;  // there are values outside the levels
  ColourMap colours = ColourMap::violet_yellow;
  SignedColours signed_colours = SignedColours::blue_red;

  // The number of the band of a value: 0 below the first level.
  int band(double value) const {
    return static_cast<int>(std::upper_bound(levels.begin(), levels.end(), value) - levels.begin());
  }

  // The colour of the value in the middle of a band.
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
    // A scale without sign covers all bands, also the two outside the levels. A signed scale is
    // symmetric about 0, so that its white is 0.
    if (!is_signed)
      return scale_colour(
          (middle - levels.front() + step) / (levels.back() - levels.front() + 2 * step), colours);
    return signed_colour(
        middle / (std::max(std::abs(levels.front()), std::abs(levels.back())) + step),
        signed_colours);
  }
};

// Functions of a corner that are not negative on one side of a bound.
auto up_to(int axis, double bound) {
  return [axis, bound](const Corner& c) {
    return bound - c.at[axis];
  };
}
auto from(int axis, double bound) {
  return [axis, bound](const Corner& c) {
    return c.at[axis] - bound;
  };
}

// The part of the plane that is shown.
struct Window {
  double x_low, x_high, z_low, z_high;
  bool has(const PlanePoint& p) const {
    return p[0] >= x_low && p[0] <= x_high && p[1] >= z_low && p[1] <= z_high;
  }

  Polygon part(Polygon polygon) const {
    polygon = clipped(polygon, up_to(0, x_high));
    polygon = clipped(polygon, from(0, x_low));
    polygon = clipped(polygon, up_to(1, z_high));
    return clipped(polygon, from(1, z_low));
  }
};

// A square around the origin if the style has `reach`, otherwise the rectangle of all nodes.
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

// Whether at least one node of a panel is in the window.
bool has_nodes(const Window& window, const std::vector<MapPanel>& panels) {
  return std::ranges::any_of(panels, [&](const MapPanel& panel) {
    return std::ranges::any_of(panel.map->places,
                               [&](const PlanePoint& at) { return window.has(at); });
  });
}

// The scale of all panels: round levels over the values that are seen, or over the user's range.
Scale scale_of(const std::vector<MapPanel>& panels, const MapStyle& style, const Window& window) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  // A window within one element has no nodes. Then all values count.
  const bool all_values = !has_nodes(window, panels);
  for (const MapPanel& panel : panels)
    for (std::size_t i = 0; i < panel.map->places.size(); ++i)
      if (all_values || window.has(panel.map->places[i])) {
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
    // The values are equal. A scale needs a width.
    low -= 0.5;
    high += 0.5;
  }
  Scale scale;
  // The levels are round numbers within the range.
  scale.levels = ticks(low, high, wished_bands);
  const double step = scale.levels[1] - scale.levels[0];
  if (!style.range) {
    // Whole bands cover all values.
    if (scale.levels.front() > low)
      scale.levels.insert(scale.levels.begin(), scale.levels.front() - step);
    if (scale.levels.back() < high) scale.levels.push_back(scale.levels.back() + step);
  }
  for (double& level : scale.levels)
    if (std::abs(level) < 1e-9 * step) level = 0;
  const double slack = 1e-9 * step;
  scale.is_signed = scale.levels.front() < 0 && scale.levels.back() > 0;
  scale.below = least < scale.levels.front() - slack;
  scale.beyond = most > scale.levels.back() + slack;
  return scale;
}

// Paints one panel: its field, the edges of elements, fibres, named points and the frame.
class Painter {
 public:
  // The panel begins at `left` and `top` on the page.
  Painter(Drawing& drawing, const Window& window, const Scale& scale, double left, double top,
          double pt_per_mm)
      : drawing_(drawing),
        window_(window),
        scale_(scale),
        left_(left),
        top_(top),
        k_(pt_per_mm),
        bands_(scale.levels.size() + 1) {}

  // Where a place of the plane is on the page; z points downwards.
  PagePoint page(const PlanePoint& p) const {
    return {left_ + k_ * (p[0] - window_.x_low), top_ + k_ * (p[1] - window_.z_low)};
  }

  // The field as coloured bands. Lower bands are painted first, so that no seam of a lower colour
  // shows in a higher one.
  void field(const SurfaceMap& map) {
    for (const auto& facet : map.facets) {
      Polygon quad;
      for (int node : facet) quad.push_back({map.places[node], map.values[node]});
      const auto [low, high] =
          std::minmax({quad[0].value, quad[1].value, quad[2].value, quad[3].value});
      if (scale_.band(low) == scale_.band(high)) {
        paint(quad);
      } else {
        paint_in_parts(quad);
      }
    }
    for (std::vector<Patch>& band : bands_)
      std::move(band.begin(), band.end(), std::back_inserter(drawing_.marks));
  }

  // The edges of the elements.
  void edges(const SurfaceMap& map) {
    for (const auto& facet : map.facets)
      for (int k = 0; k < 4; ++k)
        line(map.places[facet[k]], map.places[facet[(k + 1) % 4]], 0.35, 0.4);
  }

  // Short lines on a raster, each in the direction of the first fibre family in the closest facet.
  void fibres(const SurfaceMap& map) {
    if (map.fibres.empty()) return;
    constexpr int raster = 9;
    const double dx = (window_.x_high - window_.x_low) / raster;
    const double dz = (window_.z_high - window_.z_low) / raster;
    for (int i = 0; i < raster; ++i)
      for (int j = 0; j < raster; ++j) {
        const PlanePoint at{window_.x_low + (i + 0.5) * dx, window_.z_low + (j + 0.5) * dz};
        const PlanePoint a = fibre_near(map, at);
        const double half = 0.3 * std::min(dx, dz);
        line({at[0] - half * a[0], at[1] - half * a[1]}, {at[0] + half * a[0], at[1] + half * a[1]},
             1.0, 0.6);
      }
  }

  // Named places as dots with a white rim.
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

  // The frame with its ticks. The numbers and names of the axes are shown on request: panels side
  // by side share them.
  void frame(bool x_axis, bool z_axis) {
    const PagePoint a = page({window_.x_low, window_.z_low});
    const PagePoint b = page({window_.x_high, window_.z_high});
    drawing_.marks.push_back(Stroke{{a, {b[0], a[1]}, b, {a[0], b[1]}, a}, ink, 0.8});
    for (int axis = 0; axis < 2; ++axis) {
      double low = window_.x_low;
      double high = window_.x_high;
      if (axis == 1) {
        low = window_.z_low;
        high = window_.z_high;
      }
      const std::vector<double> at = ticks(low, high, 4);
      const std::vector<std::string> texts = tick_texts(at);
      for (std::size_t i = 0; i < at.size(); ++i) {
        PagePoint p{page({at[i], 0})[0], b[1]};
        if (axis == 1) p = {a[0], page({0, at[i]})[1]};
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
    if (z_axis) {
      // The name is between the upper two numbers.
      const std::vector<double> at = ticks(window_.z_low, window_.z_high, 4);
      double z = window_.z_low;
      if (at.size() >= 2) z = 0.5 * (at[0] + at[1]);
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

  // The point of a quadrilateral with the bilinear coordinates p and q in [0, 1], and its value.
  static Corner bilinear(const Polygon& quad, double p, double q) {
    const double N[] = {(1 - p) * (1 - q), p * (1 - q), p * q, (1 - p) * q};
    Corner c{{0, 0}, 0};
    for (int k = 0; k < 4; ++k) {
      for (int i = 0; i < 2; ++i) c.at[i] += N[k] * quad[k].at[i];
      c.value += N[k] * quad[k].value;
    }
    return c;
  }

  // The direction of the fibres in the facet whose centre is closest to a place.
  static PlanePoint fibre_near(const SurfaceMap& map, const PlanePoint& at) {
    double least = std::numeric_limits<double>::infinity();
    PlanePoint a{0, 0};
    for (std::size_t f = 0; f < map.facets.size(); ++f) {
      PlanePoint centre{0, 0};
      for (int node : map.facets[f])
        for (int c = 0; c < 2; ++c) centre[c] += map.places[node][c] / 4;
      const double distance = std::hypot(centre[0] - at[0], centre[1] - at[1]);
      if (distance < least) {
        least = distance;
        a = map.fibres[f];
      }
    }
    return a;
  }

  // Paints a bilinear quadrilateral in parts, within which its values are about linear.
  void paint_in_parts(const Polygon& quad) {
    const auto at = [&](int a, int b) {
      return bilinear(quad, double(a) / parts, double(b) / parts);
    };
    for (int i = 0; i < parts; ++i)
      for (int j = 0; j < parts; ++j)
        paint({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
  }

  // Paints a whole polygon in the colour of its lowest band, and over it the part above each level.
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
          clipped(polygon, [&](const Corner& c) { return c.value - scale_.levels[band - 1]; });
      if (part.size() >= 3) patch(part, band);
    }
  }

  // Adds a polygon in the colour of a band. Patches are collected by band until the field is
  // complete.
  void patch(const Polygon& polygon, int band) {
    Patch p{{}, scale_.colour(band), 0.4};
    for (const Corner& c : polygon) p.corners.push_back(page(c.at));
    bands_[band].push_back(std::move(p));
  }

  // Draws the part of a line that is in the window.
  void line(const PlanePoint& a, const PlanePoint& b, double width, double opacity) {
    const Polygon ends = window_.part({{a, 0}, {b, 0}});
    if (ends.size() < 2) return;
    drawing_.marks.push_back(Stroke{{page(ends[0].at), page(ends[1].at)}, ink, width, opacity});
  }
};

// A bar with all bands and the numbers of the levels. If there are values outside the levels, the
// bar ends in a tip of their colour.
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
  // The outline of the bar, with the tips at its ends.
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
  // Of many levels only those at even multiples of the step have numbers.
  const double every = n > 14 ? 2 : 1;
  const double step = scale.levels[1] - scale.levels[0];
  for (std::size_t i = 0; i <= n; ++i) {
    const double at = y(scale.levels[i]);
    drawing.marks.push_back(Stroke{{{x + width, at}, {x + width + 4, at}}, ink, 0.8});
    const double multiple = std::round(scale.levels[i] / step);
    if (std::abs(std::remainder(multiple, every)) < 0.5)
      drawing.marks.push_back(Label{{x + width + 8, at + 4.4}, texts[i], 12});
  }
  add_lines_above(drawing, {drawing.width - 10, top - tip - 14}, label, 13, room);
}

}  // namespace

namespace {

// The width of a panel if the style does not give the width of the page.
double default_width(int columns) {
  if (columns == 1) return 460;
  if (columns == 2) return 340;
  return 260;
}

}  // namespace

std::vector<Complaint> MapStyle::complaints() const {
  if (!range || (*range)[0] < (*range)[1]) return {};
  return {{"range", "its ends are not ascending", "[low, high]", ""}};
}

// Lays out panels, titles and colour bar on the page, then paints the panels from left to right
// and from top to bottom.
Drawing map_drawing(const std::vector<MapPanel>& panels, const MapStyle& style, int columns,
                    const Look& look) {
  const Window window = window_of(panels, style);
  Scale scale = scale_of(panels, style, window);
  scale.colours = look.colours;
  scale.signed_colours = look.signed_colours;
  // Panels are placed in rows of at most `columns`.
  const int n = static_cast<int>(panels.size());
  columns = std::clamp(columns, 1, n);
  const int rows = (n + columns - 1) / columns;
  const bool titled =
      std::ranges::any_of(panels, [](const MapPanel& panel) { return !panel.title.empty(); });
  double bar_room = 178;
  if (look.width && *look.width < 500) bar_room = 110;
  double width = default_width(columns);  // of a panel
  if (look.width) {
    width = std::max(60.0, (*look.width - left_room - bar_room - (columns - 1) * gap) / columns);
  }
  // Both axes have the same scale [units of the page per mm].
  const double k = width / (window.x_high - window.x_low);
  const double height = k * (window.z_high - window.z_low);
  double panel_title = 8;
  if (titled) panel_title = 24;
  double title_room = 38;
  if (style.title.empty() || !look.titles) title_room = 8;

  Drawing drawing;
  drawing.width = std::round(left_room + columns * width + (columns - 1) * gap + bar_room);
  // The colour bar needs a height of at least 190.
  drawing.height =
      std::round(title_room + std::max(190.0, rows * (height + panel_title)) + bottom_room);
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
  // On a narrow page the label of the colour bar has more than one line.
  double label_room = drawing.width;
  double words = 0;
  if (look.width) {
    label_room = bar_room - 10;
    words = 36;
  }
  const double bar = std::min(360.0, drawing.height - title_room - bottom_room - 60 - words);
  const double free = drawing.height - title_room - bottom_room - bar;
  const SurfaceMap& first = *panels.front().map;
  add_colour_bar(drawing, scale, with_unit(first.label, first.unit), drawing.width - bar_room + 20,
                 title_room + (free + words) / 2 + 14, bar, label_room);
  if (title_room > 8) {
    Label title{{(drawing.width - bar_room) / 2, 24}, style.title, 16, Label::Anchor::middle};
    title.own = true;
    drawing.marks.push_back(title);
  }
  return drawing;
}

}  // namespace langer
