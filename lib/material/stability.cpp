#include "material/stability.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/in_order.hpp"
#include "base/random.hpp"
#include "material/ellipticity.hpp"

namespace langer {

namespace {

constexpr double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();

double slope_at(const Material& material, Path path, double x) {
  constexpr double h = 1e-5;
  const PathState after = on_path(material, path, x + h), before = on_path(material, path, x > 0 ? x - h : x);
  return after.exists && before.exists ? (after.work - before.work) / (x > 0 ? 2 * h : h) : nan;
}

double ellipticity_at(const Material& material, Path path, double x) {
  const PathState s = on_path(material, path, x);
  return s.exists ? smallest_shear_stiffness(material, s.F, fibre_directions(material)).value : nan;
}

// first x at which f turns negative or ends (NaN, compared without a trap): the first interval with such an end, halved
template <class F>
double first_loss(const std::vector<double>& x, const std::vector<double>& values, F f) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::isgreaterequal(values[i], 0)) continue;
    if (i == 0) return x[0];
    double good = x[i - 1], lost = x[i];
    while (lost - good > 1e-4) {
      const double middle = 0.5 * (good + lost);
      (std::isgreaterequal(f(middle), 0) ? good : lost) = middle;
    }
    return lost;
  }
  return inf;
}

// the state ln U = r h
Mat3 state_at(const Eigen::SelfAdjointEigenSolver<Mat3>& h, double r) {
  const Vec3 stretch = (r * h.eigenvalues()).array().exp();
  return h.eigenvectors() * stretch.asDiagonal() * h.eigenvectors().transpose();
}

}  // namespace

PathStability path_stability(const Material& material, Path path, const std::vector<double>& amount) {
  PathStability s;
  s.path = path;
  s.angle = material.fibres.empty() ? 0 : material.fibres[0].alpha_deg;
  for (double x : amount) {
    const PathState state = on_path(material, path, x);
    s.nominal.push_back(state.exists ? state.nominal : nan);
    s.slope.push_back(slope_at(material, path, x));
    s.ellipticity.push_back(ellipticity_at(material, path, x));
  }
  s.slope_loss = first_loss(amount, s.slope, [&](double x) { return slope_at(material, path, x); });
  s.ellipticity_loss = first_loss(amount, s.ellipticity, [&](double x) { return ellipticity_at(material, path, x); });
  return s;
}

double safe_hencky(const Material& material, double most) {
  constexpr int directions = 300;
  constexpr double step = 0.1;
  const std::vector<Vec3> a = fibre_directions(material);
  const auto stable = [&](const auto& h, double r) {
    return std::isgreaterequal(smallest_shear_stiffness(material, state_at(h, r), a).value, 0);
  };
  double safe = inf;
  for (int i = 0; i < directions; ++i) {
    Random random(1, static_cast<std::uint64_t>(i));
    Mat3 h = Mat3::Zero();
    // the first ones are pulls and pushes along the axes, the worst for fibres along them
    if (i < 6)
      h(i / 2, i / 2) = i % 2 ? -1 : 1;
    else
      for (int p = 0; p < 3; ++p)
        for (int q = 0; q <= p; ++q) h(p, q) = h(q, p) = random.normal() * (p == q ? 1 : std::sqrt(0.5));
    h.diagonal().array() -= h.trace() / 3;
    const Eigen::SelfAdjointEigenSolver<Mat3> direction(Mat3(h / h.norm()));
    for (double r = step; r - step < std::min(safe, most); r += step) {
      const double reach = std::min({r, safe, most});
      if (stable(direction, reach)) continue;
      double good = r - step, lost = reach;
      while (lost - good > 1e-3) {
        const double middle = 0.5 * (good + lost);
        (stable(direction, middle) ? good : lost) = middle;
      }
      safe = good;
      break;
    }
  }
  return safe;
}

StabilityMap stability_map(const Material& material, const StabilityOptions& options) {
  StabilityMap map;
  for (int i = 0; i < options.points; ++i) map.amount.push_back(options.to * i / (options.points - 1));
  map.angle = options.angles;
  for (int i = 0; i < options.stretches; ++i)
    map.stretch.push_back(options.stretch_from + i * (options.stretch_to - options.stretch_from) / (options.stretches - 1));
  map.plane.resize(options.stretches, options.stretches);
  const auto angles = static_cast<int>(options.angles.size()), n_paths = static_cast<int>(all_paths.size()) * angles;
  map.paths.resize(static_cast<std::size_t>(n_paths));
  const double own = material.fibres.empty() ? 0 : material.fibres[0].alpha_deg;
  const std::vector<Vec3> a = fibre_directions(material);
  const auto compute = [&](int, int job) {
    if (job < n_paths) {
      const Material sample = turned(material, options.angles[static_cast<std::size_t>(job % angles)] - own);
      auto& path = map.paths[static_cast<std::size_t>(job)];
      path = path_stability(sample, all_paths[static_cast<std::size_t>(job / angles)], map.amount);
      path.angle = options.angles[static_cast<std::size_t>(job % angles)];
    } else if (job < n_paths + options.stretches) {
      const int row = job - n_paths;
      for (int column = 0; column < options.stretches; ++column) {
        const double l1 = map.stretch[static_cast<std::size_t>(column)], l2 = map.stretch[static_cast<std::size_t>(row)];
        map.plane(row, column) = smallest_shear_stiffness(material, Vec3(l1, 1 / (l1 * l2), l2).asDiagonal(), a).value;
      }
    } else {
      map.safe_hencky = safe_hencky(material, 1.2);
    }
  };
  const int jobs = n_paths + options.stretches + 1;
  in_order(std::max(1, options.threads), jobs, compute, [&](int, int job) {
    if (options.progress) options.progress((job + 1.) / jobs);
  });
  return map;
}

}  // namespace langer
