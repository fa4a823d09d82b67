// A drawing on a page: filled polygons, lines and texts in the order of painting. Written as SVG,
// and as a gnuplot script that makes the PNG, so that both show the same. Lengths in points, x to
// the right, y downwards from the top left corner.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/csv_table.hpp"
#include "results/plot/colours.hpp"

namespace langer {

using PagePoint = std::array<double, 2>;

struct Patch {
  std::vector<PagePoint> corners;
  Colour fill;
  double hem =
      0;  // width of a border of the same colour: neighbours with it show no seam between them
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
  double turned = 0;      // degrees, counter-clockwise about `at`
  bool own = false;       // words of the config: their numbers keep their decimal sign
};

struct Drawing {
  double width = 0, height = 0;
  std::vector<std::variant<Patch, Stroke, Label>> marks;
};

// What a drawing takes from the style of the figures.
struct Look {
  static constexpr double number_size = 13;  // units of a page that numbers and labels are high
  ColourMap colours = ColourMap::violet_yellow;
  SignedColours signed_colours = SignedColours::blue_red;
  std::optional<double> width;  // of the page; none: what the drawing likes
  bool titles = true;
};

struct FigureStyle;
std::string svg(const Drawing& drawing, const FigureStyle& style);
// writes <name>.png, .pdf and .eps, as far as the style wants them, when run by gnuplot
std::string gnuplot_script(const Drawing& drawing, const std::string& name,
                           const FigureStyle& style);

// 0.5 as 0,5: points between digits only
std::string with_decimal(const std::string& text, DecimalSign sign);
double text_width(const std::string& text, double size);  // about, of enhanced or plain text
// Enhanced text that ends at a place, in as many lines upwards as its words need to be no wider
// than `room`.
void add_lines_above(Drawing& drawing, const PagePoint& end, const std::string& text, double size,
                     double room);

// Round numbers from low to high, about `wished` of them, and their texts with as many digits as
// the steps need.
std::vector<double> ticks(double low, double high, int wished = 5);
std::vector<std::string> tick_texts(const std::vector<double>& ticks);

}  // namespace langer
