// How all figures of a stage are made: one listing, `figure_style` in the configs of post, fit,
// gather, sensitivity and tune.
//   figure_style: {width: 85, font: Liberation Sans, font_size: 8, dpi: 600, decimal: comma,
//                  formats: [pdf, eps]}
// Without width and font_size a figure is made for a screen of 96 points to the inch. With them the
// figure is laid out for that width, so that its texts have that size on paper. Nothing is scaled
// afterwards, because that would also scale the texts.
#pragma once

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/base/fields.hpp"
#include "results/plot/drawing.hpp"

namespace langer {

enum class PictureFormat { svg, png, pdf, eps };
constexpr auto names(PictureFormat) { return std::array{"svg", "png", "pdf", "eps"}; }
// The word of a format, which is also the ending of its files.
constexpr const char* word_of(PictureFormat format) {
  return names(format)[static_cast<std::size_t>(format)];
}

// The listing `figure_style` with its defaults for a screen.
struct FigureStyle {
  std::optional<double> width, height, font_size;
  std::string font = "DejaVu Sans";
  int dpi = 192;
  ColourMap colours = ColourMap::violet_yellow;
  SignedColours signed_colours = SignedColours::blue_red;
  DecimalSign decimal = DecimalSign::point;
  bool titles = true;
  std::vector<PictureFormat> formats{PictureFormat::svg, PictureFormat::png};
  static void fields(auto& v) {
    v(&FigureStyle::width, "width", unit::mm,
      "of each figure on paper, such as 85 for a column; none: a size for the screen",
      between(30, 1000));
    v(&FigureStyle::height, "height", unit::mm, "of x-y figures; none: two thirds of the width",
      between(20, 1000));
    v(&FigureStyle::font, "font", unit::none, "name of an installed font");
    v(&FigureStyle::font_size, "font_size", unit::none,
      "of numbers and labels, in points of 1/72 inch; none: 8 where a width is given",
      between(4, 40));
    v(&FigureStyle::dpi, "dpi", unit::none, "pixels to the inch, of PNG", between(50, 2400));
    v(&FigureStyle::colours, "colours", unit::none, "of maps and of pictures of the body");
    v(&FigureStyle::signed_colours, "signed_colours", unit::none,
      "of maps whose values have both signs: white is 0");
    v(&FigureStyle::decimal, "decimal", unit::none,
      "sign between units and tenths in all numbers; texts of the config stay as they are");
    v(&FigureStyle::titles, "titles", unit::none,
      "false: without the titles above figures, which journals put into captions");
    v(&FigureStyle::formats, "formats", unit::none,
      "files of each figure; the script in the same folder makes all of these but the SVG");
  }
  std::vector<Complaint> complaints() const;

  bool on_paper() const { return width || font_size; }
  // Width of x-y figures; on a screen 190.5 mm are 720 pixels.
  double width_mm() const { return width.value_or(190.5); }
  // Size of the numbers in points of 1/72 inch.
  double points() const {
    if (on_paper()) return font_size.value_or(8);
    return 10.5;
  }
  bool wants(PictureFormat format) const {
    return std::find(formats.begin(), formats.end(), format) != formats.end();
  }
  // The size of a unit of a drawing's page in 1/72 inch.
  double drawing_unit() const {
    if (on_paper()) return points() / Look::number_size;
    return 0.75;
  }
  Look look() const;
};

}  // namespace langer
