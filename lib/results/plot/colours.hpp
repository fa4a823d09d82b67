// Colours of values. Every map grows in lightness from end to end, so that it can be read in print
// without colour and by colour-blind readers.
//   a scale       from 0 to 1
//   signed        from -1 over 0, almost white, to 1; the lightness falls on both sides
#pragma once

#include <array>
#include <string>

namespace langer {

struct Colour {
  double r = 0, g = 0, b = 0;  // sRGB, 0 to 1
};
std::string hex(const Colour& colour);     // "#rrggbb"
double lightness(const Colour& colour);    // CIE L*, 0 to 100
int colour_byte(double part);              // of a part from 0 to 1; 0 to 255
Colour shaded(const Colour& c, double s);  // darker by a factor

// violet_yellow is computed in CIE LCh. viridis and cividis are interpolated linearly between ten
// colours of the published maps.
enum class ColourMap { violet_yellow, viridis, cividis, grey };
constexpr auto names(ColourMap) {
  return std::array{"violet_yellow", "viridis", "cividis", "grey"};
}
enum class SignedColours { blue_red, green_purple };
constexpr auto names(SignedColours) { return std::array{"blue_red", "green_purple"}; }

Colour scale_colour(double position, ColourMap map = ColourMap::violet_yellow);
Colour signed_colour(double position, SignedColours colours = SignedColours::blue_red);

}  // namespace langer
