#include "mechanics/material/stability.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/in_order.hpp"
#include "core/base/no_number.hpp"
#include "core/base/random.hpp"
#include "core/tensor/principal.hpp"
#include "mechanics/material/ellipticity.hpp"

namespace langer {

namespace {

// The slope by a central difference (one-sided at 0); zero if it is negative by no more than the
// rounding of the difference.
double slope_at(const Material& material, Path path, double x) {
  constexpr double h = 1e-5, rounding = 1e-10;
  double below = x;
  double width = h;
  if (x > 0) {
    below = x - h;
    width = 2 * h;
  }
  const PathState after = on_path(material, path, x + h);
  const PathState before = on_path(material, path, below);
  if (!after.exists || !before.exists) return nan;
  const double slope = (after.work - before.work) / width;
  const double noise = rounding * (std::abs(after.work) + std::abs(before.work)) / width;
  if (std::isless(slope, 0) && std::isgreater(slope, -noise)) return 0;
  return slope;
}

double ellipticity_at(const Material& material, Path path, double x) {
  const PathState s = on_path(material, path, x);
  if (s.exists) {
    return smallest_shear_stiffness(material, s.F, fibre_directions(material)).value;
  }
  return nan;
}

double ellipticity_sign_at(const Material& material, Path path, double x) {
  const PathState s = on_path(material, path, x);
  if (s.exists) return sign_of_shear_stiffness(material, s.F, fibre_directions(material));
  return nan;
}

// The first x at which `is` holds for f: bisection in the first interval at whose end it holds. NaN
// is compared by functions that do not trap.
template <class F, class Is>
double first_place(const std::vector<double>& x, const std::vector<double>& values, F f, Is is) {
  const auto found = std::find_if(values.begin(), values.end(), is);
  if (found == values.end()) return inf;
  const auto i = static_cast<std::size_t>(found - values.begin());
  if (i == 0) return x[0];
  double without = x[i - 1];
  double with = x[i];
  while (with - without > 1e-4) {
    const double middle = 0.5 * (without + with);
    if (is(f(middle)))
      with = middle;
    else
      without = middle;
  }
  return with;
}

bool is_lost(double value) { return std::isless(value, 0); }
bool is_no_number(double value) { return !std::isfinite(value); }

// the state ln U = r h
Mat3 state_at(const Principal& h, double r) {
  const Vec3 stretch = (r * h.values).array().exp();
  return h.directions * stretch.asDiagonal() * h.directions.transpose();
}

}  // namespace

PathStability path_stability(const Material& material, Path path,
                             const std::vector<double>& amount) {
  PathStability s;
  s.path = path;
  s.angle = 0;
  if (!material.fibres.empty()) s.angle = material.fibres[0].alpha_deg;
  for (double x : amount) {
    const PathState state = on_path(material, path, x);
    s.nominal.push_back(state.exists ? state.nominal : nan);
    s.slope.push_back(slope_at(material, path, x));
    s.ellipticity.push_back(ellipticity_at(material, path, x));
  }
  const auto slope = [&](double x) {
    return slope_at(material, path, x);
  };
  const auto ellipticity = [&](double x) {
    return ellipticity_sign_at(material, path, x);
  };
  s.slope_loss = first_place(amount, s.slope, slope, is_lost);
  s.ellipticity_loss = first_place(amount, s.ellipticity, ellipticity, is_lost);
  s.end = first_place(amount, s.ellipticity, ellipticity, is_no_number);
  return s;
}

// Directions of ln U are drawn at random, on the sphere of symmetric tensors without trace. Along
// each the norm grows in steps until ellipticity is lost or the energy has no value; bisection then
// finds that place.
HenckyReach hencky_reach(const Material& material, double most) {
  constexpr int directions = 300;
  constexpr double step = 0.1;
  const std::vector<Vec3> a = fibre_directions(material);
  const auto stiffness = [&](const auto& h, double r) {
    return sign_of_shear_stiffness(material, state_at(h, r), a);
  };
  HenckyReach reach{inf, inf};
  for (int i = 0; i < directions; ++i) {
    Random random(1, static_cast<std::uint64_t>(i));
    Mat3 h = Mat3::Zero();
    // the first six are tension and compression along the axes, the worst cases for fibres there
    if (i < 6)
      h(i / 2, i / 2) = i % 2 ? -1 : 1;
    else
      for (int p = 0; p < 3; ++p)
        for (int q = 0; q <= p; ++q)
          h(p, q) = h(q, p) = random.normal() * (p == q ? 1 : std::sqrt(0.5));
    h.diagonal().array() -= h.trace() / 3;
    const Principal direction = principal(Mat3(h / h.norm()));
    for (double r = step; r - step < std::min(reach.safe, most); r += step) {
      const double here = std::min({r, reach.safe, most});
      const double value = stiffness(direction, here);
      if (std::isgreaterequal(value, 0)) continue;
      const bool lost = is_lost(value);
      double good = r - step;
      double bad = here;
      while (bad - good > 1e-3) {
        const double middle = 0.5 * (good + bad);
        const double at = stiffness(direction, middle);
        if (std::isgreaterequal(at, 0) || (lost && is_no_number(at)))
          good = middle;
        else
          bad = middle;
      }
      if (lost)
        reach.safe = good;
      else
        reach.end = std::min(reach.end, good);
      break;
    }
  }
  return reach;
}

double safe_hencky(const Material& material, double most) {
  return hencky_reach(material, most).safe;
}

StabilityMap stability_map(const Material& material, const StabilityOptions& options) {
  StabilityMap map;
  for (int i = 0; i < options.points; ++i)
    map.amount.push_back(options.to * i / (options.points - 1));
  map.angle = options.angles;
  for (int i = 0; i < options.stretches; ++i)
    map.stretch.push_back(options.stretch_from + i * (options.stretch_to - options.stretch_from) /
                                                     (options.stretches - 1));
  map.plane.resize(options.stretches, options.stretches);
  const auto angles = static_cast<int>(options.angles.size());
  const auto n_paths = static_cast<int>(all_paths.size()) * angles;
  map.paths.resize(static_cast<std::size_t>(n_paths));
  double own = 0;
  if (!material.fibres.empty()) own = material.fibres[0].alpha_deg;
  const std::vector<Vec3> a = fibre_directions(material);
  const auto compute = [&](int, int job) {
    if (job < n_paths) {
      const Material sample =
          turned(material, options.angles[static_cast<std::size_t>(job % angles)] - own);
      auto& path = map.paths[static_cast<std::size_t>(job)];
      path = path_stability(sample, all_paths[static_cast<std::size_t>(job / angles)], map.amount);
      path.angle = options.angles[static_cast<std::size_t>(job % angles)];
    } else if (job < n_paths + options.stretches) {
      const int row = job - n_paths;
      for (int column = 0; column < options.stretches; ++column) {
        const double l1 = map.stretch[static_cast<std::size_t>(column)];
        const double l2 = map.stretch[static_cast<std::size_t>(row)];
        map.plane(row, column) =
            smallest_shear_stiffness(material, Vec3(l1, 1 / (l1 * l2), l2).asDiagonal(), a).value;
      }
    } else {
      const HenckyReach reach = hencky_reach(material, 1.2);
      map.safe_hencky = reach.safe;
      map.hencky_end = reach.end;
    }
  };
  const int jobs = n_paths + options.stretches + 1;
  in_order(std::max(1, options.threads), jobs, compute, [&](int, int job) {
    if (options.progress) options.progress((job + 1.) / jobs);
  });
  return map;
}

}  // namespace langer
