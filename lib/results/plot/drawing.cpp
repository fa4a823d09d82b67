#include "results/plot/drawing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include <fmt/format.h>

#include "core/base/xml.hpp"
#include "results/plot/figure_style.hpp"
#include "results/plot/gnuplot.hpp"

namespace langer {

namespace {

// σ_{xx} (MPa) -> σ, xx below the line, (MPa)
struct Piece {
  std::string text;
  int below = 0;  // 1 a subscript, -1 a superscript
};
std::vector<Piece> pieces(const std::string& text) {
  std::vector<Piece> found(1);
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\\' && i + 1 < text.size())
      found.back().text += text[++i];
    else if ((text[i] == '_' || text[i] == '^') && i + 1 < text.size()) {
      found.push_back({"", text[i] == '_' ? 1 : -1});
      const std::size_t from = i + 1;
      std::size_t end = from;
      if (text[from] == '{') end = std::min(text.find('}', from), text.size());
      if (text[from] == '{')
        found.back().text = text.substr(from + 1, end - from - 1);
      else
        found.back().text = text[from];
      i = end;
      found.push_back({});
    } else if (text[i] != '{' && text[i] != '}')
      found.back().text += text[i];
  }
  return found;
}
std::string with_subscripts(const Label& label) {
  std::string s;
  int line = 0;
  for (const Piece& piece : pieces(label.text)) {
    if (piece.text.empty()) continue;
    const double dy = 0.25 * label.size * (piece.below - line);
    line = piece.below;
    if (dy == 0) {
      s += xml_text(piece.text);
    } else {
      s += fmt::format("<tspan dy=\"{:.2f}\" font-size=\"{:.2f}\">{}</tspan>", dy,
                       (piece.below ? 0.7 : 1) * label.size, xml_text(piece.text));
    }
  }
  return s;
}

std::string points_text(const std::vector<PagePoint>& points) {
  std::string s;
  for (const PagePoint& p : points)
    s += fmt::format("{}{:.2f},{:.2f}", s.empty() ? "" : " ", p[0], p[1]);
  return s;
}

Label printed(Label label, DecimalSign sign) {
  if (!label.own) label.text = with_decimal(label.text, sign);
  return label;
}

struct SvgWriter {
  std::string& s;
  DecimalSign sign;
  void operator()(const Patch& p) const {
    s += fmt::format("<polygon points=\"{}\" fill=\"{}\"", points_text(p.corners), hex(p.fill));
    if (p.hem > 0) {
      s += fmt::format(" stroke=\"{}\" stroke-width=\"{}\"/>\n", hex(p.fill), p.hem);
    } else {
      s += "/>\n";
    }
  }
  void operator()(const Stroke& l) const {
    s += fmt::format(
        "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-opacity=\"{}\"/>\n",
        points_text(l.points), hex(l.colour), l.width, l.opacity);
  }
  void operator()(const Label& label) const {
    constexpr const char* anchors[] = {"start", "middle", "end"};
    const Label t = printed(label, sign);
    std::string turn;
    if (t.turned == 0) {
      turn = "";
    } else {
      turn = fmt::format(" transform=\"rotate({:g} {:.2f} {:.2f})\"", -t.turned, t.at[0], t.at[1]);
    }
    s += fmt::format(
        "<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{}\" text-anchor=\"{}\"{}{}>{}</text>\n",
        t.at[0], t.at[1], t.size, anchors[static_cast<int>(t.anchor)],
        t.white ? " fill=\"#ffffff\"" : "", turn,
        t.enhanced ? with_subscripts(t) : xml_text(t.text));
  }
};

// All patches and strokes are polygons of one data block, in the order of painting: thousands of
// gnuplot's own objects take minutes. A row is x, y and the colour with its transparency; an empty
// line ends a polygon.
struct GnuplotWriter {
  const Drawing& drawing;
  DecimalSign sign;
  std::string polygons = {}, labels = {};
  void polygon(const std::vector<PagePoint>& corners, const Colour& c, double opacity) {
    const unsigned colour = colour_byte(1 - opacity) << 24 | colour_byte(c.r) << 16 |
                            colour_byte(c.g) << 8 | colour_byte(c.b);
    for (const PagePoint& p : corners)
      polygons += fmt::format("{:.2f} {:.2f} {}\n", p[0], drawing.height - p[1], colour);
    polygons += "\n";
  }
  void operator()(const Patch& p) {
    PagePoint middle{0, 0};
    for (const PagePoint& c : p.corners)
      for (int k = 0; k < 2; ++k) middle[k] += c[k] / static_cast<double>(p.corners.size());
    std::vector<PagePoint> corners = p.corners;
    for (PagePoint& c : corners)  // as wide as with its hem
      if (const double far = std::hypot(c[0] - middle[0], c[1] - middle[1]); far > 0)
        for (int k = 0; k < 2; ++k) c[k] += 0.7 * p.hem * (c[k] - middle[k]) / far;
    polygon(corners, p.fill, 1);
  }
  void operator()(const Stroke& l) {
    for (std::size_t i = 1; i < l.points.size(); ++i) {
      const PagePoint &a = l.points[i - 1], &b = l.points[i];
      const double dx = b[0] - a[0];
      const double dy = b[1] - a[1];
      const double length = std::hypot(dx, dy);
      if (length == 0) continue;
      // along; across is (-y, x)
      const double x = 0.5 * l.width * dx / length;
      const double y = 0.5 * l.width * dy / length;
      polygon({{a[0] - 0.5 * x - y, a[1] - 0.5 * y + x},
               {b[0] + 0.5 * x - y, b[1] + 0.5 * y + x},
               {b[0] + 0.5 * x + y, b[1] + 0.5 * y - x},
               {a[0] - 0.5 * x + y, a[1] - 0.5 * y - x}},
              l.colour, l.opacity);
    }
  }
  void operator()(const Label& label) {
    constexpr const char* anchors[] = {"left", "center", "right"};
    const Label t = printed(label, sign);
    // SVG places the base line, gnuplot the middle of the letters
    const double up = 0.35 * t.size;
    const double turned = t.turned * std::numbers::pi / 180;
    labels += fmt::format(
        "set label {} at {:.2f},{:.2f} {} {}front {}enhanced font ',{}'{}\n",
        gnuplot_string(t.text), t.at[0] - up * std::sin(turned),
        drawing.height - t.at[1] + up * std::cos(turned), anchors[static_cast<int>(t.anchor)],
        t.turned == 0 ? "" : fmt::format("rotate by {:g} ", t.turned), t.enhanced ? "" : "no",
        0.75 * t.size, t.white ? " textcolor rgb '#ffffff'" : "");
  }
};

}  // namespace

std::string with_decimal(const std::string& text, DecimalSign sign) {
  if (sign == DecimalSign::point) return text;
  std::string s = text;
  const auto digit = [&](std::size_t i) {
    return i < s.size() && s[i] >= '0' && s[i] <= '9';
  };
  for (std::size_t i = 1; i + 1 < s.size(); ++i)
    if (s[i] == '.' && digit(i - 1) && digit(i + 1)) s[i] = ',';
  return s;
}

double text_width(const std::string& text, double size) {
  double letters = 0;
  for (const Piece& piece : pieces(text))
    for (char c : piece.text)  // one for each character of UTF-8
      if ((static_cast<unsigned char>(c) & 0xC0) != 0x80) letters += piece.below ? 0.7 : 1;
  return 0.6 * size * letters;
}

void add_lines_above(Drawing& drawing, const PagePoint& end, const std::string& text, double size,
                     double room) {
  std::vector<std::string> lines(1);
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!lines.back().empty() && text_width(lines.back() + " " + word, size) > room)
      lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : " ") + word;
  }
  for (std::size_t i = 0; i < lines.size(); ++i)
    drawing.marks.push_back(
        Label{{end[0], end[1] - 1.25 * size * static_cast<double>(lines.size() - 1 - i)},
              lines[i],
              size,
              Label::Anchor::end,
              true});
}

std::string svg(const Drawing& drawing, const FigureStyle& style) {
  const double mm = style.drawing_unit() / 72 * 25.4;
  const std::string unit = style.on_paper() ? "mm" : "";
  const double k = style.on_paper() ? mm : 1;
  std::string s = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{3:.6g}{2}\" height=\"{4:.6g}{2}\" "
      "font-family=\"{5}, DejaVu Sans, Arial, sans-serif\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
      drawing.width, drawing.height, unit, k * drawing.width, k * drawing.height,
      xml_text(style.font));
  for (const auto& mark : drawing.marks) std::visit(SvgWriter{s, style.decimal}, mark);
  return s + "</svg>\n";
}

std::string gnuplot_script(const Drawing& drawing, const std::string& name,
                           const FigureStyle& style) {
  std::string s =
      fmt::format("# made by langer; run again with: gnuplot {}.gp\nset encoding utf8\n", name);
  s +=
      "set lmargin at screen 0\nset rmargin at screen 1\nset tmargin at screen 1\nset bmargin at screen 0\n";
  s += fmt::format("unset border\nunset tics\nunset key\nset xrange [0:{}]\nset yrange [0:{}]\n",
                   drawing.width, drawing.height);
  GnuplotWriter writer{drawing, style.decimal};
  for (const auto& mark : drawing.marks) std::visit(writer, mark);
  s += writer.labels;
  if (!writer.polygons.empty()) s += "$marks << end\n" + writer.polygons + "end\n";
  const double inch =
      style.drawing_unit() / 72;  // of a unit; labels are said in points of a screen
  for (PictureFormat format : style.formats) {
    const std::string font = gnuplot_string(style.font);
    if (format == PictureFormat::svg) continue;
    if (format == PictureFormat::png)
      s += fmt::format(
          "set terminal pngcairo size {:.0f},{:.0f} font {} fontscale {:.4g} background rgb 'white'\n",
          style.dpi * inch * drawing.width, style.dpi * inch * drawing.height, font,
          style.dpi / 96.0 * style.drawing_unit() / 0.75);
    else
      s += fmt::format("set terminal {}cairo size {:.4f}in,{:.4f}in font {} fontscale {:.4g}\n",
                       names(PictureFormat{})[static_cast<std::size_t>(format)],
                       inch * drawing.width, inch * drawing.height, font,
                       style.drawing_unit() / 0.75);
    s += gnuplot_output(name + "." + names(PictureFormat{})[static_cast<std::size_t>(format)]);
    if (writer.polygons.empty()) {
      s += "plot NaN\n";
    } else {
      s +=
          "plot $marks using 1:2:3 with filledcurves closed linecolor rgb variable fillstyle solid noborder\n";
    }
  }
  return s + "unset output\n";
}

std::vector<double> ticks(double low, double high, int wished) {
  const double wide = (high - low) / wished;
  const double decade = std::pow(10, std::floor(std::log10(wide)));
  const double step = decade * (wide / decade > 5   ? 10
                                : wide / decade > 2 ? 5
                                : wide / decade > 1 ? 2
                                                    : 1);
  std::vector<double> values;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k)
    values.push_back(k * step);
  return values;
}

std::vector<std::string> tick_texts(const std::vector<double>& at) {
  double step = 1;
  if (at.size() > 1) step = at[1] - at[0];
  const int digits = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  std::vector<std::string> texts;
  for (double value : at)
    texts.push_back(digits > 5 ? fmt::format("{:.2e}", value)
                               : fmt::format("{:.{}f}", value + 0.0, digits));
  return texts;
}

}  // namespace langer
