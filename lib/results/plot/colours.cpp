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

// Transformations between L* a* b* with white point D65 (CIE 15) and sRGB (IEC 61966-2-1).
constexpr double white[3] = {0.95047, 1, 1.08883};

// The inverse of the cube root function of CIE 15, which is linear near black.
double inverse_cube_root(double t) {
  if (t > 6.0 / 29) return t * t * t;
  return 3 * (6.0 / 29) * (6.0 / 29) * (t - 4.0 / 29);
}

// From linear light to the value that sRGB stores.
double encoded(double x) {
  if (x <= 0.0031308) return 12.92 * x;
  return 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

// From the value that sRGB stores to linear light.
double decoded(double x) {
  if (x <= 0.04045) return x / 12.92;
  return std::pow((x + 0.055) / 1.055, 2.4);
}

// The colour of lightness L (0 to 100), chroma C and hue h [rad]: LCh to Lab to XYZ to sRGB.
Colour lch_colour(double L, double C, double h) {
  const double fy = (L + 16) / 116;
  const double a = C * std::cos(h);
  const double b = C * std::sin(h);
  const double X = white[0] * inverse_cube_root(fy + a / 500);
  const double Y = white[1] * inverse_cube_root(fy);
  const double Z = white[2] * inverse_cube_root(fy - b / 200);
  return {encoded(3.2404542 * X - 1.5371385 * Y - 0.4985314 * Z),
          encoded(-0.9692660 * X + 1.8760108 * Y + 0.0415560 * Z),
          encoded(0.0556434 * X - 0.2040259 * Y + 1.0572252 * Z)};
}

struct Bytes {
  double r, g, b;
};
// Ten colours at equal distances of the maps viridis and cividis.
constexpr Bytes viridis[] = {{68, 1, 84},    {72, 40, 120},  {62, 74, 137},  {49, 104, 142},
                             {38, 130, 142}, {31, 158, 137}, {53, 183, 121}, {109, 205, 89},
                             {180, 222, 44}, {253, 231, 37}};
constexpr Bytes cividis[] = {{0, 32, 77},     {0, 48, 111},    {58, 71, 108},   {87, 93, 109},
                             {112, 113, 115}, {138, 134, 120}, {167, 156, 117}, {197, 180, 107},
                             {227, 205, 91},  {255, 234, 70}};

// Linear interpolation between the colours of a table; s from 0 to 1.
Colour interpolated(std::span<const Bytes> knots, double s) {
  const double x = s * static_cast<double>(knots.size() - 1);
  const std::size_t i = std::min(knots.size() - 2, static_cast<std::size_t>(x));
  const Bytes& a = knots[i];
  const Bytes& b = knots[i + 1];
  const double t = x - static_cast<double>(i);
  return {(a.r + (b.r - a.r) * t) / 255, (a.g + (b.g - a.g) * t) / 255,
          (a.b + (b.b - a.b) * t) / 255};
}

// Hue [deg] and greatest chroma of one end of a two-sided map. The chroma is as large as the
// colours of a screen allow at the lightness of the end.
struct MapEnd {
  double hue, chroma;
};
MapEnd map_end(SignedColours colours, bool below_zero) {
  if (colours == SignedColours::blue_red) {
    if (below_zero) return {277, 41};
    return {32, 60};
  }
  if (below_zero) return {145, 45};
  return {315, 55};
}

}  // namespace

// All maps have the lightness L = 22 + 70 s or come close to it, so that they also work without
// colour.
Colour scale_colour(double position, ColourMap map) {
  const double s = std::clamp(position, 0.0, 1.0);
  if (map == ColourMap::viridis) return interpolated(viridis, s);
  if (map == ColourMap::cividis) return interpolated(cividis, s);
  const double L = 22 + 70 * s;
  if (map == ColourMap::grey) return lch_colour(L, 0, 0);
  // The hue passes violet, blue, green and yellow. A screen shows the least chroma in the range of
  // blue-green, which is at s = 0.35.
  const double h = (310 - 210 * s) * std::numbers::pi / 180;
  const double C = 29 + 120 * (s - 0.35) * (s - 0.35);
  return lch_colour(L, C, h);
}

// The lightness falls from 96 at zero to 34 at both ends.
Colour signed_colour(double position, SignedColours colours) {
  const double s = std::clamp(std::abs(position), 0.0, 1.0);
  const MapEnd end = map_end(colours, position < 0);
  const double h = end.hue * std::numbers::pi / 180;
  return lch_colour(96 - 62 * s, end.chroma * s, h);
}

// CIE L* of the relative luminance Y.
double lightness(const Colour& c) {
  const double Y = 0.2126729 * decoded(c.r) + 0.7151522 * decoded(c.g) + 0.0721750 * decoded(c.b);
  if (Y > 216.0 / 24389) return 116 * std::cbrt(Y) - 16;
  return Y * 24389 / 27;
}

}  // namespace langer
