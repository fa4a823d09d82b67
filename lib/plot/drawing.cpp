#include "plot/drawing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "plot/gnuplot.hpp"

namespace langer {

namespace {

int byte(double x) { return static_cast<int>(std::lround(255 * std::clamp(x, 0.0, 1.0))); }

std::string escaped(const std::string& text) {
  std::string s;
  for (char c : text) {
    if (c == '&')
      s += "&amp;";
    else if (c == '<')
      s += "&lt;";
    else if (c == '>')
      s += "&gt;";
    else
      s += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return s;
}

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
      const std::size_t from = i + 1, end = text[from] == '{' ? std::min(text.find('}', from), text.size()) : from;
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
    s += dy == 0 ? escaped(piece.text)
                 : fmt::format("<tspan dy=\"{:.2f}\" font-size=\"{:.2f}\">{}</tspan>", dy, (piece.below ? 0.7 : 1) * label.size,
                               escaped(piece.text));
  }
  return s;
}

std::string points_text(const std::vector<PagePoint>& points) {
  std::string s;
  for (const PagePoint& p : points) s += fmt::format("{}{:.2f},{:.2f}", s.empty() ? "" : " ", p[0], p[1]);
  return s;
}

struct SvgWriter {
  std::string& s;
  void operator()(const Patch& p) const {
    s += fmt::format("<polygon points=\"{}\" fill=\"{}\"", points_text(p.corners), hex(p.fill));
    s += p.hem > 0 ? fmt::format(" stroke=\"{}\" stroke-width=\"{}\"/>\n", hex(p.fill), p.hem) : "/>\n";
  }
  void operator()(const Stroke& l) const {
    s += fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-opacity=\"{}\"/>\n",
                     points_text(l.points), hex(l.colour), l.width, l.opacity);
  }
  void operator()(const Label& t) const {
    constexpr const char* anchors[] = {"start", "middle", "end"};
    s += fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{}\" text-anchor=\"{}\"{}>{}</text>\n", t.at[0], t.at[1], t.size,
                     anchors[static_cast<int>(t.anchor)], t.white ? " fill=\"#ffffff\"" : "",
                     t.enhanced ? with_subscripts(t) : escaped(t.text));
  }
};

// All patches and strokes are polygons of one data block, in the order of painting: thousands of gnuplot's own objects take minutes.
// A row is x, y and the colour with its transparency; an empty line ends a polygon.
struct GnuplotWriter {
  const Drawing& drawing;
  std::string polygons, labels;
  void polygon(const std::vector<PagePoint>& corners, const Colour& c, double opacity) {
    const unsigned colour = byte(1 - opacity) << 24 | byte(c.r) << 16 | byte(c.g) << 8 | byte(c.b);
    for (const PagePoint& p : corners) polygons += fmt::format("{:.2f} {:.2f} {}\n", p[0], drawing.height - p[1], colour);
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
      const double dx = b[0] - a[0], dy = b[1] - a[1], length = std::hypot(dx, dy);
      if (length == 0) continue;
      const double x = 0.5 * l.width * dx / length, y = 0.5 * l.width * dy / length;  // along; across is (-y, x)
      polygon({{a[0] - 0.5 * x - y, a[1] - 0.5 * y + x},
               {b[0] + 0.5 * x - y, b[1] + 0.5 * y + x},
               {b[0] + 0.5 * x + y, b[1] + 0.5 * y - x},
               {a[0] - 0.5 * x + y, a[1] - 0.5 * y - x}},
              l.colour, l.opacity);
    }
  }
  void operator()(const Label& t) {
    constexpr const char* anchors[] = {"left", "center", "right"};
    // SVG places the base line, gnuplot the middle of the letters
    labels += fmt::format("set label {} at {:.2f},{:.2f} {} front {}enhanced font ',{}'{}\n", gnuplot_string(t.text), t.at[0],
                          drawing.height - t.at[1] + 0.35 * t.size, anchors[static_cast<int>(t.anchor)], t.enhanced ? "" : "no",
                          0.75 * t.size, t.white ? " textcolor rgb '#ffffff'" : "");
  }
};

}  // namespace

std::string hex(const Colour& c) { return fmt::format("#{:02x}{:02x}{:02x}", byte(c.r), byte(c.g), byte(c.b)); }

std::string svg(const Drawing& drawing) {
  std::string s = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "font-family=\"DejaVu Sans, Arial, sans-serif\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
      drawing.width, drawing.height);
  for (const auto& mark : drawing.marks) std::visit(SvgWriter{s}, mark);
  return s + "</svg>\n";
}

std::string gnuplot_script(const Drawing& drawing, const std::string& name) {
  std::string s = fmt::format("# made by langer; run again with: gnuplot {}.gp\nset encoding utf8\n", name);
  s += fmt::format("set terminal pngcairo size {},{} font 'DejaVu Sans' fontscale 2 linewidth 2 background rgb 'white'\n",
                   2 * drawing.width, 2 * drawing.height);
  s += fmt::format(
      "set output {}\nset lmargin at screen 0\nset rmargin at screen 1\nset tmargin at screen 1\nset bmargin at screen 0\n",
      gnuplot_file(name + ".png"));
  s += fmt::format("unset border\nunset tics\nunset key\nset xrange [0:{}]\nset yrange [0:{}]\n", drawing.width, drawing.height);
  GnuplotWriter writer{drawing, {}, {}};
  for (const auto& mark : drawing.marks) std::visit(writer, mark);
  const bool empty = writer.polygons.empty();
  return s + writer.labels + (empty ? "" : "$marks << end\n" + writer.polygons + "end\n") +
         (empty ? "plot NaN\n"
                : "plot $marks using 1:2:3 with filledcurves closed linecolor rgb variable fillstyle solid noborder\n") +
         "unset output\n";
}

namespace {

// CIE 15 and IEC 61966-2-1: L* a* b* with white point D65, and sRGB
constexpr double white[3] = {0.95047, 1, 1.08883};
double from_f(double t) { return t > 6.0 / 29 ? t * t * t : 3 * (6.0 / 29) * (6.0 / 29) * (t - 4.0 / 29); }
double encoded(double x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055; }
double decoded(double x) { return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4); }

std::array<double, 3> linear_rgb(double L, double C, double h) {
  const double fy = (L + 16) / 116, a = C * std::cos(h), b = C * std::sin(h);
  const double X = white[0] * from_f(fy + a / 500), Y = white[1] * from_f(fy), Z = white[2] * from_f(fy - b / 200);
  return {3.2404542 * X - 1.5371385 * Y - 0.4985314 * Z, -0.9692660 * X + 1.8760108 * Y + 0.0415560 * Z,
          0.0556434 * X - 0.2040259 * Y + 1.0572252 * Z};
}

}  // namespace

Colour scale_colour(double position) {
  const double s = std::clamp(position, 0.0, 1.0);
  const double L = 22 + 70 * s;
  const double h = (310 - 210 * s) * std::numbers::pi / 180;  // violet, blue, green, yellow
  const double C = 29 + 120 * (s - 0.35) * (s - 0.35);        // stays within what a screen can show, least around blue-green
  const auto rgb = linear_rgb(L, C, h);
  return {encoded(rgb[0]), encoded(rgb[1]), encoded(rgb[2])};
}

Colour signed_colour(double position) {
  const double s = std::clamp(std::abs(position), 0.0, 1.0);
  // hue and most chroma of either end within what a screen can show
  const double h = (position < 0 ? 277 : 32) * std::numbers::pi / 180, C = (position < 0 ? 41 : 60) * s;
  const auto rgb = linear_rgb(96 - 62 * s, C, h);
  return {encoded(rgb[0]), encoded(rgb[1]), encoded(rgb[2])};
}

double lightness(const Colour& c) {
  const double Y = 0.2126729 * decoded(c.r) + 0.7151522 * decoded(c.g) + 0.0721750 * decoded(c.b);
  return Y > 216.0 / 24389 ? 116 * std::cbrt(Y) - 16 : Y * 24389 / 27;
}

std::vector<double> ticks(double low, double high, int wished) {
  const double wide = (high - low) / wished;
  const double decade = std::pow(10, std::floor(std::log10(wide)));
  const double step = decade * (wide / decade > 5 ? 10 : wide / decade > 2 ? 5 : wide / decade > 1 ? 2 : 1);
  std::vector<double> values;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) values.push_back(k * step);
  return values;
}

std::vector<std::string> tick_texts(const std::vector<double>& at) {
  const double step = at.size() > 1 ? at[1] - at[0] : 1;
  const int digits = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  std::vector<std::string> texts;
  for (double value : at) texts.push_back(digits > 5 ? fmt::format("{:.2e}", value) : fmt::format("{:.{}f}", value + 0.0, digits));
  return texts;
}

}  // namespace langer
