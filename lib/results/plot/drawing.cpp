#include "results/plot/drawing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include <fmt/format.h>

#include "core/base/text.hpp"
#include "core/base/xml.hpp"
#include "results/plot/figure_style.hpp"
#include "results/plot/gnuplot.hpp"

namespace langer {

namespace {

// Puts the argument of a mark, one character or a group in braces, into `script`. It begins at
// `from`; returns the position of its last character.
std::size_t append_script(std::string& script, const std::string& text, std::size_t from) {
  if (text[from] != '{') {
    script = text[from];
    return from;
  }
  const std::size_t end = std::min(text.find('}', from), text.size());
  script = text.substr(from + 1, end - from - 1);
  return end;
}

// A part of an enhanced text that is printed at one height.
struct Piece {
  std::string text;
  int below = 0;  // 1 a subscript, -1 a superscript, 0 on the line

  bool on_line() const { return below == 0; }
};

// Splits enhanced text into its pieces: "σ_{xx} (MPa)" becomes "σ", "xx" below the line, " (MPa)".
// A backslash takes the meaning from the character after it; other braces are not printed.
std::vector<Piece> pieces(const std::string& text) {
  std::vector<Piece> found(1);
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool has_next = i + 1 < text.size();
    if (text[i] == '\\' && has_next) {
      found.back().text += text[++i];
    } else if (text[i] == '_' && has_next) {
      found.push_back({"", 1});
      i = append_script(found.back().text, text, i + 1);
      found.push_back({});
    } else if (text[i] == '^' && has_next) {
      found.push_back({"", -1});
      i = append_script(found.back().text, text, i + 1);
      found.push_back({});
    } else if (text[i] != '{' && text[i] != '}') {
      found.back().text += text[i];
    }
  }
  return found;
}

// Subscripts and superscripts have 0.7 times the size of their line.
double relative_size(const Piece& piece) {
  if (piece.on_line()) return 1;
  return 0.7;
}

// The label as SVG text. Each dy is relative to the piece before.
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
                       relative_size(piece) * label.size, xml_text(piece.text));
    }
  }
  return s;
}

// The points of a polygon as SVG writes them: "x,y x,y".
std::string points_text(const std::vector<PagePoint>& points) {
  std::string s;
  for (const PagePoint& p : points) append(s, " ", fmt::format("{:.2f},{:.2f}", p[0], p[1]));
  return s;
}

// The label with the decimal sign of the style in its numbers, unless the user wrote them.
Label printed(Label label, DecimalSign sign) {
  if (!label.own) label.text = with_decimal(label.text, sign);
  return label;
}

// Appends each mark of a drawing to an SVG text.
struct SvgWriter {
  std::string& s;
  DecimalSign sign;
  void operator()(const Patch& p) const {
    s += fmt::format("<polygon points=\"{}\" fill=\"{}\"", points_text(p.corners), hex(p.fill));
    if (p.border_width > 0) {
      s += fmt::format(" stroke=\"{}\" stroke-width=\"{}\"/>\n", hex(p.fill), p.border_width);
    } else {
      s += "/>\n";
    }
  }
  void operator()(const Stroke& l) const {
    s += fmt::format(
        "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" "
        "stroke-opacity=\"{}\"/>\n",
        points_text(l.points), hex(l.colour), l.width, l.opacity);
  }
  void operator()(const Label& label) const {
    constexpr const char* anchors[] = {"start", "middle", "end"};
    const Label t = printed(label, sign);
    s += fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{}\" text-anchor=\"{}\"", t.at[0],
                     t.at[1], t.size, anchors[static_cast<int>(t.anchor)]);
    if (t.white) s += " fill=\"#ffffff\"";
    if (t.turned != 0)
      s += fmt::format(" transform=\"rotate({:g} {:.2f} {:.2f})\"", -t.turned, t.at[0], t.at[1]);
    if (t.enhanced) {
      s += fmt::format(">{}</text>\n", with_subscripts(t));
    } else {
      s += fmt::format(">{}</text>\n", xml_text(t.text));
    }
  }
};

// Turns the marks of a drawing into gnuplot commands. All patches and strokes become polygons of
// one data block, in the order of painting, because thousands of gnuplot's own objects take
// minutes. A row of the block is x, y and the colour with its transparency; an empty line ends a
// polygon.
struct GnuplotWriter {
  const Drawing& drawing;
  DecimalSign sign;
  std::string polygons = {};
  std::string labels = {};

  // Adds a polygon. gnuplot's y axis points upwards, and its colours are one number with
  // transparency, red, green and blue.
  void polygon(const std::vector<PagePoint>& corners, const Colour& c, double opacity) {
    const unsigned colour = colour_byte(1 - opacity) << 24 | colour_byte(c.r) << 16 |
                            colour_byte(c.g) << 8 | colour_byte(c.b);
    for (const PagePoint& p : corners)
      polygons += fmt::format("{:.2f} {:.2f} {}\n", p[0], drawing.height - p[1], colour);
    polygons += "\n";
  }

  // gnuplot fills polygons without a border, so the corners move outwards instead.
  void operator()(const Patch& p) {
    PagePoint middle{0, 0};
    for (const PagePoint& c : p.corners)
      for (int k = 0; k < 2; ++k) middle[k] += c[k] / static_cast<double>(p.corners.size());
    std::vector<PagePoint> corners = p.corners;
    for (PagePoint& c : corners) {
      const double radius = std::hypot(c[0] - middle[0], c[1] - middle[1]);
      if (radius == 0) continue;
      for (int k = 0; k < 2; ++k) c[k] += 0.7 * p.border_width * (c[k] - middle[k]) / radius;
    }
    polygon(corners, p.fill, 1);
  }

  // Each segment of a line is a rectangle. It is lengthened by half of its width at both ends, so
  // that the segments meet without gaps.
  void operator()(const Stroke& l) {
    for (std::size_t i = 1; i < l.points.size(); ++i) {
      const PagePoint& a = l.points[i - 1];
      const PagePoint& b = l.points[i];
      const double dx = b[0] - a[0];
      const double dy = b[1] - a[1];
      const double length = std::hypot(dx, dy);
      if (length == 0) continue;
      // (x, y) has half of the width and points along the segment, (-y, x) across.
      const double x = 0.5 * l.width * dx / length;
      const double y = 0.5 * l.width * dy / length;
      polygon({{a[0] - 0.5 * x - y, a[1] - 0.5 * y + x},
               {b[0] + 0.5 * x - y, b[1] + 0.5 * y + x},
               {b[0] + 0.5 * x + y, b[1] + 0.5 * y - x},
               {a[0] - 0.5 * x + y, a[1] - 0.5 * y - x}},
              l.colour, l.opacity);
    }
  }

  // A label is placed by its base line in SVG and by the middle of its letters in gnuplot.
  void operator()(const Label& label) {
    constexpr const char* anchors[] = {"left", "center", "right"};
    const Label t = printed(label, sign);
    // The middle of the letters is about 0.35 of their size above the base line.
    const double up = 0.35 * t.size;
    const double turned = t.turned * std::numbers::pi / 180;
    labels += fmt::format("set label {} at {:.2f},{:.2f} {} ", gnuplot_string(t.text),
                          t.at[0] - up * std::sin(turned),
                          drawing.height - t.at[1] + up * std::cos(turned),
                          anchors[static_cast<int>(t.anchor)]);
    if (t.turned != 0) labels += fmt::format("rotate by {:g} ", t.turned);
    if (t.enhanced) {
      labels += "front enhanced";
    } else {
      labels += "front noenhanced";
    }
    labels += fmt::format(" font ',{}'", 0.75 * t.size);
    if (t.white) labels += " textcolor rgb '#ffffff'";
    labels += "\n";
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
  for (const Piece& piece : pieces(text)) {
    for (char c : piece.text) {
      // Bytes 10xxxxxx continue a character of UTF-8.
      const bool begins_character = (static_cast<unsigned char>(c) & 0xC0) != 0x80;
      if (begins_character) letters += relative_size(piece);
    }
  }
  return 0.6 * size * letters;
}

void add_lines_above(Drawing& drawing, const PagePoint& end, const std::string& text, double size,
                     double room) {
  std::vector<std::string> lines(1);
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!lines.back().empty() && text_width(lines.back() + " " + word, size) > room)
      lines.emplace_back();
    append(lines.back(), " ", word);
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const double above = 1.25 * size * static_cast<double>(lines.size() - 1 - i);
    const PagePoint at{end[0], end[1] - above};
    drawing.marks.push_back(Label{at, lines[i], size, Label::Anchor::end, true});
  }
}

// On paper the size of the picture is in mm, so that programs of text processing place it in its
// true size. The coordinates inside are in units of the page.
std::string svg(const Drawing& drawing, const FigureStyle& style) {
  // On a screen the size is in pixels, one for each unit of the page.
  std::string unit;
  double k = 1;
  if (style.on_paper()) {
    unit = "mm";
    k = style.drawing_unit() / 72 * 25.4;
  }
  std::string s = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{3:.6g}{2}\" "
      "height=\"{4:.6g}{2}\" "
      "font-family=\"{5}, DejaVu Sans, Arial, sans-serif\" stroke-linejoin=\"round\" "
      "stroke-linecap=\"round\">\n"
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
  s += "set lmargin at screen 0\nset rmargin at screen 1\nset tmargin at screen 1\nset bmargin at "
       "screen 0\n";
  s += fmt::format("unset border\nunset tics\nunset key\nset xrange [0:{}]\nset yrange [0:{}]\n",
                   drawing.width, drawing.height);
  GnuplotWriter writer{drawing, style.decimal};
  for (const auto& mark : drawing.marks) std::visit(writer, mark);
  s += writer.labels;
  if (!writer.polygons.empty()) s += "$marks << end\n" + writer.polygons + "end\n";
  // The size of a unit. Labels are given in points of a screen, of which a unit has 0.75.
  const double inch = style.drawing_unit() / 72;
  const double font_scale = style.drawing_unit() / 0.75;
  const std::string font = gnuplot_string(style.font);
  for (PictureFormat format : style.formats) {
    if (format == PictureFormat::svg) continue;
    if (format == PictureFormat::png) {
      s += fmt::format(
          "set terminal pngcairo size {:.0f},{:.0f} font {} fontscale {:.4g} background rgb "
          "'white'\n",
          style.dpi * inch * drawing.width, style.dpi * inch * drawing.height, font,
          style.dpi / 96.0 * style.drawing_unit() / 0.75);
    } else {
      s += fmt::format("set terminal {}cairo size {:.4f}in,{:.4f}in font {} fontscale {:.4g}\n",
                       word_of(format), inch * drawing.width, inch * drawing.height, font,
                       font_scale);
    }
    s += gnuplot_output(name + "." + word_of(format));
    if (writer.polygons.empty()) {
      s += "plot NaN\n";
    } else {
      s += "plot $marks using 1:2:3 with filledcurves closed linecolor rgb variable fillstyle "
           "solid noborder\n";
    }
  }
  return s + "unset output\n";
}

namespace {

// The smallest of 1, 2, 5 and 10 times a power of ten that is not below the width.
double round_step(double width) {
  const double decade = std::pow(10, std::floor(std::log10(width)));
  const double digit = width / decade;
  if (digit > 5) return decade * 10;
  if (digit > 2) return decade * 5;
  if (digit > 1) return decade * 2;
  return decade;
}

}  // namespace

std::vector<double> ticks(double low, double high, int wished) {
  const double step = round_step((high - low) / wished);
  std::vector<double> values;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k)
    values.push_back(k * step);
  return values;
}

std::vector<std::string> tick_texts(const std::vector<double>& at) {
  // The number of decimals follows from the step; small steps are written with an exponent.
  double step = 1;
  if (at.size() > 1) step = at[1] - at[0];
  const int digits = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  std::vector<std::string> texts;
  for (double value : at) {
    if (digits > 5) {
      texts.push_back(fmt::format("{:.2e}", value));
    } else {
      texts.push_back(fmt::format("{:.{}f}", value + 0.0, digits));  // + 0.0: no "-0"
    }
  }
  return texts;
}

}  // namespace langer
