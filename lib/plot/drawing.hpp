// A drawing on a page: filled polygons, lines and texts in the order of painting. Written as SVG, and as a gnuplot script
// that makes the PNG, so that both show the same. Lengths in points, x to the right, y downwards from the top left corner.
#pragma once

#include <array>
#include <string>
#include <variant>
#include <vector>

namespace langer {

struct Colour {
  double r = 0, g = 0, b = 0;  // sRGB, 0 to 1
};
std::string hex(const Colour& colour);  // "#rrggbb"

using PagePoint = std::array<double, 2>;

struct Patch {
  std::vector<PagePoint> corners;
  Colour fill;
  double hem = 0;  // width of a border of the same colour: neighbours with it show no seam between them
};
struct Stroke {
  std::vector<PagePoint> points;  // two, or a closed line
  Colour colour;
  double width = 1, opacity = 1;
};
struct Label {
  PagePoint at;
  std::string text;
  double size = 14;
  enum class Anchor { start, middle, end } anchor = Anchor::start;
  bool enhanced = false;  // with gnuplot's marks, as σ_{xx}: shown as subscripts
  bool white = false;     // instead of black: on dark ground
};

struct Drawing {
  double width = 0, height = 0;
  std::vector<std::variant<Patch, Stroke, Label>> marks;
};

std::string svg(const Drawing& drawing);
// writes <name>.png when run by gnuplot
std::string gnuplot_script(const Drawing& drawing, const std::string& name);

// Colours of a scale from 0 (dark violet) to 1 (light yellow): lightness grows evenly, so that the scale reads in grey and for
// colour-blind readers. Computed in CIE LCh: lightness, chroma and hue are simple functions of the position.
Colour scale_colour(double position);
// From -1 (blue) over 0 (almost white) to 1 (red): lightness falls evenly on both sides.
Colour signed_colour(double position);
double lightness(const Colour& colour);  // CIE L*, 0 to 100

// Round numbers from low to high, about `wished` of them, and their texts with as many digits as the steps need.
std::vector<double> ticks(double low, double high, int wished = 5);
std::vector<std::string> tick_texts(const std::vector<double>& ticks);

}  // namespace langer
