#include "post/drawing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "post/gnuplot.hpp"

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
    s += fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{}\" text-anchor=\"{}\">{}</text>\n", t.at[0], t.at[1],
                     t.size, anchors[static_cast<int>(t.anchor)], escaped(t.text));
  }
};

struct GnuplotWriter {
  const Drawing& drawing;
  std::string& s;
  int n = 0;
  static std::string colour(const Colour& c, double opacity) {
    return fmt::format("'#{:02x}{}'", byte(1 - opacity), hex(c).substr(1));  // alpha counts transparency
  }
  std::string point(const PagePoint& p) const { return fmt::format("{:.2f},{:.2f}", p[0], drawing.height - p[1]); }
  std::string path(const std::vector<PagePoint>& points) const {
    std::string text;
    for (const PagePoint& p : points) text += (text.empty() ? "from " : " to ") + point(p);
    return text;
  }
  void operator()(const Patch& p) {
    const std::string rgb = colour(p.fill, 1);
    s += fmt::format("set object {} polygon {} to {} front fillcolor rgb {} fillstyle solid {}\n", ++n, path(p.corners),
                     point(p.corners.front()), rgb, p.hem > 0 ? fmt::format("border lc rgb {} lw {}", rgb, p.hem) : "noborder");
  }
  void operator()(const Stroke& l) {
    s += fmt::format("set object {} polygon {} front fillstyle empty border lc rgb {} lw {}\n", ++n, path(l.points),
                     colour(l.colour, l.opacity), l.width);
  }
  void operator()(const Label& t) {
    constexpr const char* anchors[] = {"left", "center", "right"};
    // SVG places the base line, gnuplot the middle of the letters
    s += fmt::format("set label {} at {} {} front noenhanced font ',{}'\n", gnuplot_string(t.text),
                     point({t.at[0], t.at[1] - 0.35 * t.size}), anchors[static_cast<int>(t.anchor)], 0.75 * t.size);
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
      gnuplot_string(name + ".png"));
  s +=
      fmt::format("unset border\nunset tics\nunset key\nset xrange [0:{}]\nset yrange [0:{}]\n", drawing.width, drawing.height);
  GnuplotWriter writer{drawing, s};
  for (const auto& mark : drawing.marks) std::visit(writer, mark);
  return s + "plot NaN\nunset output\n";
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
  for (double value : at)
    texts.push_back(digits > 5 ? fmt::format("{:.2e}", value) : fmt::format("{:.{}f}", value + 0.0, digits));
  return texts;
}

}  // namespace langer
