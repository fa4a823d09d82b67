// Where a material stops being stable, along the tests of material/path.hpp and in every fibre
// direction.
//   slope         d work/d amount [MPa]. Negative: the nominal stress decreases, and the test is
//                 unstable under load control
//   ellipticity   smallest shear stiffness [MPa] (material/ellipticity.hpp). Negative: solutions
//                 depend on the mesh
//   first losses  the amount at which each first becomes negative, to 1e-4; infinity if it does not
//   end           the amount from which no state is found, or a value overflows. This is no loss of
//                 stability, but nothing is known beyond.
// A value that is negative by no more than rounding is not a loss (material/ellipticity.hpp).
#pragma once

#include <functional>
#include <vector>

#include "mechanics/material/path.hpp"

namespace langer {

struct PathStability {
  Path path = Path::uniaxial;
  double angle = 0;                                 // degrees between the first fibre family and x
  std::vector<double> nominal, slope, ellipticity;  // at each amount
  double slope_loss = 0, ellipticity_loss = 0, end = 0;
};

struct StabilityMap {
  std::vector<double> amount, angle;  // amounts from 0 evenly
  std::vector<PathStability> paths;   // path by path, angle by angle
  // ellipticity over the plane of stretches (fibre at its own angle, F = diag(l1, 1/(l1 l2), l2)):
  // rows l2, columns l1
  std::vector<double> stretch;
  MatX plane;
  // every incompressible state up to this Hencky norm |ln U| is strongly elliptic, as far as
  // sampled; infinity: none found
  double safe_hencky = 0;
  double hencky_end =
      0;  // least Hencky norm of the samples at which the law has no number; infinity: none found
};

struct StabilityOptions {
  double to = 1;     // amount
  int points = 101;  // amounts
  std::vector<double> angles{0, 15, 30, 45, 60, 75, 90};
  double stretch_from = 0.5, stretch_to = 2;
  int stretches = 61;
  int threads = 1;
  std::function<void(double)> progress;
};

StabilityMap stability_map(const Material& material, const StabilityOptions& options);

// one path, one direction of the material as it is
PathStability path_stability(const Material& material, Path path,
                             const std::vector<double>& amount);

// The largest Hencky norm, at most `most`, below which no sampled state has lost strong
// ellipticity. Each direction is followed as long as the energy is finite.
struct HenckyReach {
  double safe = 0, end = 0;  // of StabilityMap
};
HenckyReach hencky_reach(const Material& material, double most);
double safe_hencky(const Material& material, double most);

}  // namespace langer
