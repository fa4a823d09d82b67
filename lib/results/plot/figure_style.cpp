#include "results/plot/figure_style.hpp"

namespace langer {

std::vector<Complaint> FigureStyle::complaints() const {
  std::vector<Complaint> all;
  const auto strange = [](char c) {
    return static_cast<unsigned char>(c) < ' ' ||
           std::string_view("'\",<>&;{}").find(c) != std::string_view::npos;
  };
  if (font.empty() || std::any_of(font.begin(), font.end(), strange))
    all.push_back({"font", "\"" + font + "\"", "the name of a font, such as Liberation Sans",
                   "the size has a key of its own, font_size"});
  if (formats.empty())
    all.push_back({"formats", "an empty list", "one or more of svg, png, pdf, eps", ""});
  for (std::size_t i = 0; i < formats.size(); ++i)
    if (std::find(formats.begin(), formats.begin() + static_cast<std::ptrdiff_t>(i), formats[i]) !=
        formats.begin() + static_cast<std::ptrdiff_t>(i))
      all.push_back(
          {"formats[" + std::to_string(i) + "]", "a format a second time", "each once", ""});
  return all;
}

Look FigureStyle::look() const {
  Look look{colours, signed_colours, {}, titles};
  if (on_paper()) look.width = width_mm() / 25.4 * 72 / drawing_unit();
  return look;
}

}  // namespace langer
