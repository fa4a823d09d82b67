// A drawing on a page: filled polygons, lines and texts in the order of painting.
//
// The same drawing is written as SVG and as a gnuplot script. gnuplot makes PNG, PDF and EPS from
// the script, so that all formats show the same. Lengths are in units of the page: x to the right,
// y downwards from the top left corner. FigureStyle::drawing_unit() says how large a unit is on
// paper.
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

// A filled polygon.
struct Patch {
  std::vector<PagePoint> corners;
  Colour fill;
  // Width of a border of the same colour. It covers the seam that viewers show between neighbours.
  double border_width = 0;
};
// A line with a width; corners are round.
struct Stroke {
  std::vector<PagePoint> points;  // two, or a closed line
  Colour colour;
  double width = 1, opacity = 1;
};
// A text at a place: its base line begins, is centred or ends there.
struct Label {
  PagePoint at;
  std::string text;
  double size = 14;
  enum class Anchor { start, middle, end } anchor = Anchor::start;
  bool enhanced = false;  // gnuplot's marks, as in σ_{xx}, are shown as subscripts
  bool white = false;     // for dark ground; otherwise black
  double turned = 0;      // degrees, counter-clockwise about `at`
  bool own = false;       // a text of the config, whose numbers keep their decimal sign
};

// The page and its marks, which cover each other in their order.
struct Drawing {
  double width = 0, height = 0;
  std::vector<std::variant<Patch, Stroke, Label>> marks;
};

// The settings of FigureStyle that change how a drawing is laid out.
struct Look {
  static constexpr double number_size = 13;  // height of numbers and labels in units of the page
  ColourMap colours = ColourMap::violet_yellow;
  SignedColours signed_colours = SignedColours::blue_red;
  std::optional<double> width;  // of the page; none: the default of the drawing
  bool titles = true;
};

struct FigureStyle;
std::string svg(const Drawing& drawing, const FigureStyle& style);
// A script that writes <name>.png, .pdf and .eps, those of them that the style lists.
std::string gnuplot_script(const Drawing& drawing, const std::string& name,
                           const FigureStyle& style);

// The text with another decimal sign: 0.5 becomes 0,5. Only points between digits are replaced.
std::string with_decimal(const std::string& text, DecimalSign sign);
// Estimated width of enhanced or plain text: 0.6 of the size for each letter.
double text_width(const std::string& text, double size);
// Adds enhanced text whose last line ends at a place. It is broken into lines, stacked upwards, so
// that none is wider than `room` if its words allow.
void add_lines_above(Drawing& drawing, const PagePoint& end, const std::string& text, double size,
                     double room);

// Round numbers from low to high, about `wished` of them.
std::vector<double> ticks(double low, double high, int wished = 5);
// Their texts, with as many digits as the steps need.
std::vector<std::string> tick_texts(const std::vector<double>& ticks);

}  // namespace langer
