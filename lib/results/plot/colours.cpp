#include "results/plot/colours.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include <fmt/format.h>

namespace langer {

int colour_byte(double part) {
  return static_cast<int>(std::lround(255 * std::clamp(part, 0.0, 1.0)));
}
std::string hex(const Colour& c) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour_byte(c.r), colour_byte(c.g), colour_byte(c.b));
}
Colour shaded(const Colour& c, double s) { return {c.r * s, c.g * s, c.b * s}; }

namespace {

// CIE 15 and IEC 61966-2-1: L* a* b* with white point D65, and sRGB
constexpr double white[3] = {0.95047, 1, 1.08883};
double from_f(double t) {
  if (t > 6.0 / 29) return t * t * t;
  return 3 * (6.0 / 29) * (6.0 / 29) * (t - 4.0 / 29);
}
double encoded(double x) {
  if (x <= 0.0031308) return 12.92 * x;
  return 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}
double decoded(double x) {
  if (x <= 0.04045) return x / 12.92;
  return std::pow((x + 0.055) / 1.055, 2.4);
}

Colour of_lch(double L, double C, double h) {
  const double fy = (L + 16) / 116;
  const double a = C * std::cos(h);
  const double b = C * std::sin(h);
  const double X = white[0] * from_f(fy + a / 500);
  const double Y = white[1] * from_f(fy);
  const double Z = white[2] * from_f(fy - b / 200);
  return {encoded(3.2404542 * X - 1.5371385 * Y - 0.4985314 * Z),
          encoded(-0.9692660 * X + 1.8760108 * Y + 0.0415560 * Z),
          encoded(0.0556434 * X - 0.2040259 * Y + 1.0572252 * Z)};
}

struct Bytes {
  double r, g, b;
};
constexpr Bytes viridis[] = {{68, 1, 84},    {72, 40, 120},  {62, 74, 137},  {49, 104, 142},
                             {38, 130, 142}, {31, 158, 137}, {53, 183, 121}, {109, 205, 89},
                             {180, 222, 44}, {253, 231, 37}};
constexpr Bytes cividis[] = {{0, 32, 77},     {0, 48, 111},    {58, 71, 108},   {87, 93, 109},
                             {112, 113, 115}, {138, 134, 120}, {167, 156, 117}, {197, 180, 107},
                             {227, 205, 91},  {255, 234, 70}};

Colour between(std::span<const Bytes> knots, double s) {
  const double x = s * static_cast<double>(knots.size() - 1);
  const std::size_t i = std::min(knots.size() - 2, static_cast<std::size_t>(x));
  const Bytes &a = knots[i], &b = knots[i + 1];
  const double t = x - static_cast<double>(i);
  return {(a.r + (b.r - a.r) * t) / 255, (a.g + (b.g - a.g) * t) / 255,
          (a.b + (b.b - a.b) * t) / 255};
}

}  // namespace

Colour scale_colour(double position, ColourMap map) {
  const double s = std::clamp(position, 0.0, 1.0);
  if (map == ColourMap::viridis) return between(viridis, s);
  if (map == ColourMap::cividis) return between(cividis, s);
  const double L = 22 + 70 * s;
  if (map == ColourMap::grey) return of_lch(L, 0, 0);
  const double h = (310 - 210 * s) * std::numbers::pi / 180;  // violet, blue, green, yellow
  const double C =
      29 + 120 * (s - 0.35) *
               (s - 0.35);  // stays within what a screen can show, least around blue-green
  return of_lch(L, C, h);
}

Colour signed_colour(double position, SignedColours colours) {
  const double s = std::clamp(std::abs(position), 0.0, 1.0);
  // hue and most chroma of either end within what a screen can show
  const bool below = position < 0, classic = colours == SignedColours::blue_red;
  const double h = (classic ? below ? 277 : 32 : below ? 145 : 315) * std::numbers::pi / 180;
  const double C = (classic ? below ? 41 : 60 : below ? 45 : 55) * s;
  return of_lch(96 - 62 * s, C, h);
}

double lightness(const Colour& c) {
  const double Y = 0.2126729 * decoded(c.r) + 0.7151522 * decoded(c.g) + 0.0721750 * decoded(c.b);
  if (Y > 216.0 / 24389) return 116 * std::cbrt(Y) - 16;
  return Y * 24389 / 27;
}

}  // namespace langer
