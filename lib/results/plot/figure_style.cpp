#include "results/plot/figure_style.hpp"

namespace langer {

namespace {

// Characters that would end or change the name of a font in gnuplot, SVG or CSS.
bool ends_font_name(char c) {
  return static_cast<unsigned char>(c) < ' ' ||
         std::string_view("'\",<>&;{}").find(c) != std::string_view::npos;
}

}  // namespace

// Faults that ranges of numbers cannot express: the name of the font and the list of formats.
std::vector<Complaint> FigureStyle::complaints() const {
  std::vector<Complaint> all;
  if (font.empty() || std::any_of(font.begin(), font.end(), ends_font_name))
    all.push_back({"font", "\"" + font + "\"", "the name of a font, such as Liberation Sans",
                   "the size has a key of its own, font_size"});
  if (formats.empty())
    all.push_back({"formats", "an empty list", "one or more of svg, png, pdf, eps", ""});
  for (std::size_t i = 0; i < formats.size(); ++i) {
    const auto here = formats.begin() + static_cast<std::ptrdiff_t>(i);
    const bool duplicate = std::find(formats.begin(), here, *here) != here;
    if (duplicate)
      all.push_back(
          {"formats[" + std::to_string(i) + "]", "a format a second time", "each once", ""});
  }
  return all;
}

Look FigureStyle::look() const {
  // The width is converted from mm to units of the page.
  Look look{colours, signed_colours, {}, titles};
  if (on_paper()) look.width = width_mm() / 25.4 * 72 / drawing_unit();
  return look;
}

}  // namespace langer
