// Wrinkles: the smallest compression (or shear) of stretched layers at which a small motion
// u(y) exp(i k x') needs no force.
//
// The body is first stretched by the prestretch F0, then compressed along the direction n by the
// factor s (or sheared along n by s):
//   width held   F = (1 + (s - 1) n n) F0                  plane strain, where F0 = 1
//   width equal  F = s F0                                  equibiaxial
//   width free   F = (1 + (s - 1) n n + (w - 1) m m) F0    m normal to n; no force along m
//   shear        F = (1 + s n m) F0
// The number of modes below w^2 = 0 (line_chain.hpp) tells for each wavenumber whether the state is
// unstable. The critical s is the one closest to the prestretch over all wavenumbers, and over all
// directions of k. Where short waves are the first to lose stability, all of them do at once:
// Biot's surface instability (Biot 1963). Creases appear earlier (Hong, Zhao, Suo 2009: at 35 % in
// plane strain of neo-Hooke) and are out of reach of a linearisation. References: Biot (1963),
// Appl. Sci. Res. A 12; Cao and Hutchinson (2012), J. Appl. Mech. 79; Ciarletta, Destrade, Gower
// (2013), arXiv 1306.0198.
#pragma once

#include "layers/guided_wave.hpp"

namespace langer {

enum class WrinkleLoad { compression, shear };
constexpr auto names(WrinkleLoad) { return std::array{"compression", "shear"}; }

enum class WidthUnderCompression { held, free, equal };
constexpr auto names(WidthUnderCompression) { return std::array{"held", "free", "equal"}; }

// The body at rest and what is done to it.
struct WrinkleProblem {
  std::vector<Layer> layers;  // from the top
  BottomFace bottom = BottomFace::fixed;
  double surface_tension = 0;  // of the top face [N/mm]
  Dilatation dilatation = Dilatation::incompressible;
  PlaneDeformation prestretch = PlaneDeformation::Identity();
  WrinkleLoad load = WrinkleLoad::compression;
  WidthUnderCompression width = WidthUnderCompression::held;
  double limit = 0.1;  // the smallest s that is tried; of shear the largest is 1 / limit
  // Which directions of k are tried beside n: all, or none.
  bool every_wave_direction = true;

  PlaneDeformation deformation(double angle, double s) const;
  LayerStack stack(double angle, double s) const;
};

struct Wrinkle {
  enum class Kind {
    none,      // stable up to the limit
    at_once,   // unstable at the prestretch already
    surface,   // short waves first: every wavelength of a half-space
    wavy,      // a wavelength
    buckling,  // long waves first: a sheet that nothing holds
    no_state   // a law ends before
  };
  Kind kind = Kind::none;
  double s = 0;                  // critical stretch from the prestretch on, or amount of shear
  double wavelength = 0;         // on the deformed surface [mm]; NaN unless wavy
  double wavelength_before = 0;  // of the same material points in the prestretched state [mm]
  double wave_angle = 0;         // of k, from x towards z [rad]
  double error = 0;              // of s, relative: lines
};
constexpr auto names(Wrinkle::Kind) {
  return std::array{"none", "at_prestretch", "surface", "wrinkles", "buckling", "no_state"};
}

// angle: of n, from x towards z in the prestretched plane [rad]
Wrinkle first_wrinkle(const WrinkleProblem& problem, double angle);

}  // namespace langer
