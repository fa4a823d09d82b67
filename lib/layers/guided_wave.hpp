// Waves that travel along the surface of stretched layers: phase speed, group speed, attenuation.
//
// A wave is a wavenumber k and a frequency w at which the lines of line_chain.hpp have a free
// motion. One of them is given:
//   wavelength  2 pi / k, measured on the deformed surface
//   frequency   w / 2 pi
// A half-space without branches is not dispersive: it needs neither.
// Modes are numbered from the slowest. Which of them an instrument sees depends on how it taps:
//   vertical  the mode that a vertical line force excites most, |u_y(0)|^2 / (u.K'(k) u)
//   slowest   number 1
// Attenuation [1/mm]: amplitudes fall by exp(-attenuation x).
// The lines are halved once; Richardson's extrapolation (order 4) gives the result and its error.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "layers/line_chain.hpp"

namespace langer {

// The stretched body, from the top.
struct LayerStack {
  std::vector<LayerState> layers;
  BottomFace bottom = BottomFace::fixed;
  double surface_tension = 0;  // of the top face [N/mm]

  bool exists() const;
  bool has_half_space() const;
  bool is_viscous() const;
  bool is_dispersive() const;  // whether the speed depends on the wavelength
};

enum class WaveMode { vertical, slowest };
constexpr auto names(WaveMode) { return std::array{"vertical", "slowest"}; }

struct WaveQuery {
  double angle = 0;                             // of the direction, from x towards z [rad]
  std::optional<double> wavenumber, frequency;  // [1/mm], [rad/s]; one of them
  WaveMode mode = WaveMode::vertical;
  int modes = 40;  // that are compared, at most
};

struct GuidedWave {
  bool exists = false;
  double wavenumber = 0, frequency = 0;  // [1/mm], [rad/s]
  double speed = 0, group_speed = 0;     // [mm/s]
  double attenuation = 0;                // [1/mm]
  double error = 0;                      // of the speed, relative: lines
  int mode = 0;                          // from 1
  std::string reason;                    // where there is none
};

GuidedWave guided_wave(const LayerStack& stack, const WaveQuery& query);

}  // namespace langer
