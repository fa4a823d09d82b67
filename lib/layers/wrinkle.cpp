#include "layers/wrinkle.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "core/tensor/principal.hpp"

namespace langer {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

struct Surface {
  double smallest = 0;  // stiffness
  int modes = 0;        // that grow, by the count of pivots
};

Surface surface_of(const LayerStack& stack, double wave_angle, double k, int refine) {
  std::vector<DirectedModuli<double>> moduli;
  std::vector<double> thickness;
  for (const LayerState& layer : stack.layers) {
    moduli.push_back(directed_moduli(layer, wave_angle));
    thickness.push_back(layer.thickness);
  }
  LineChoice choice;
  choice.refine = refine;
  const std::vector<double> decays(thickness.size(), 0.0);
  const bool cuttable = stack.bottom == BottomFace::fixed;
  LineChain<double> chain(moduli, line_mesh(thickness, k, decays, cuttable, choice), stack.bottom,
                          stack.surface_tension);
  chain.eliminate(k, 0);
  return {principal_values(chain.surface())[0], chain.modes_below()};
}

// How far waves of the wavenumber k along a direction are from growing: negative where they grow.
// The smallest stiffness of the surface, which is 0 at a wrinkle; the number of modes gives the
// sign. Lines that are too long for layers under strong stretch or with stiff fibres keep the
// volume too loosely, and show modes that are none. Their number changes on finer lines, and then
// the surface stiffness there decides.
double stability(const LayerStack& stack, double wave_angle, double k, int refine) {
  const Surface found = surface_of(stack, wave_angle, k, refine);
  const double size = std::abs(found.smallest);
  if (found.modes <= 0) return size;
  const Surface finer = surface_of(stack, wave_angle, k, 3 * refine);
  if (finer.modes != found.modes && finer.smallest > 0) return size;
  return -size - std::numeric_limits<double>::min();
}

bool unstable(const LayerStack& stack, double wave_angle, double k, int refine) {
  return stability(stack, wave_angle, k, refine) < 0;
}

// The path of one direction: s as a distance t >= 0 from the prestretch.
class Path {
 public:
  Path(const WrinkleProblem& problem, double angle) : problem_(problem), angle_(angle) {
    end_ = problem.load == WrinkleLoad::shear ? 1 / problem.limit : -std::log(problem.limit);
  }

  double end() const { return end_; }
  double s(double t) const { return problem_.load == WrinkleLoad::shear ? t : std::exp(-t); }
  LayerStack stack(double t) const { return problem_.stack(angle_, s(t)); }

  double stability_at(double t, double wave_angle, double k, int refine) const {
    const LayerStack there = stack(t);
    if (!there.exists()) return -1;
    return stability(there, wave_angle, k, refine);
  }

  // The smallest t in [low, high] at which a wave is unstable; nothing if it is stable at `high`.
  // Illinois' secants, with a bisection every third time.
  std::optional<double> critical(double low, double high, double wave_angle, double k, int refine,
                                 double tolerance) const {
    double at_high = stability_at(high, wave_angle, k, refine);
    if (at_high >= 0) return std::nullopt;
    double at_low = stability_at(low, wave_angle, k, refine);
    if (at_low < 0) return low;
    double last = low;
    for (int i = 0; i < 100 && high - low > tolerance; ++i) {
      double t = 0.5 * (low + high);
      if (i % 3 != 2) t = low + (high - low) * at_low / (at_low - at_high);
      const bool settled = i % 3 != 2 && std::abs(t - last) < tolerance;
      if (settled) return t;
      if (i % 3 != 2) last = t;
      const double here = stability_at(t, wave_angle, k, refine);
      if (here < 0) {
        high = t;
        at_high = here;
        if (i % 3 == 1) at_low /= 2;
      } else {
        low = t;
        at_low = here;
        if (i % 3 == 1) at_high /= 2;
      }
    }
    return 0.5 * (low + high);
  }

 private:
  const WrinkleProblem& problem_;
  double angle_, end_;
};

// Wavenumbers that are tried: from long waves of the whole stack to short ones of its thinnest
// layer.
std::vector<double> wavenumbers(const LayerStack& stack) {
  double thinnest = std::numeric_limits<double>::infinity();
  double whole = 0;
  for (const LayerState& layer : stack.layers) {
    if (std::isinf(layer.thickness)) continue;
    thinnest = std::min(thinnest, layer.thickness);
    whole += layer.thickness;
  }
  if (whole == 0) {  // a half-space has no length of its own, but for its surface tension
    if (stack.surface_tension == 0) return {1.0};
    const double length = stack.surface_tension / stack.layers[0].A.cwiseAbs().maxCoeff();
    whole = thinnest = length;
  }
  constexpr double ratio = 1.35;
  // A surface tension makes short waves stiff; how short the first wrinkle is depends on it.
  const double shortest = (stack.surface_tension > 0 ? 40 : 12) / thinnest;
  std::vector<double> all;
  for (double k = 0.01 / whole; k < shortest * ratio; k *= ratio) all.push_back(k);
  return all;
}

struct Wave {
  double angle, k;
};

// In the deformed plane, from x towards z [rad].
double direction_of_smallest_stretch(const PlaneDeformation& F) {
  const PlaneDeformation B = F * F.transpose();
  return 0.5 * std::atan2(-2 * B(0, 1), B(1, 1) - B(0, 0));
}

// Brackets of t: no wave of the list is unstable at `low`, those that remain are at `high`.
struct Bracket {
  double low = 0, high = 0;
  std::vector<Wave> unstable;
};

std::vector<Wave> unstable_of(const Path& path, double t, const std::vector<Wave>& waves) {
  const LayerStack stack = path.stack(t);
  std::vector<Wave> found;
  if (!stack.exists()) return found;
  for (const Wave& wave : waves) {
    if (unstable(stack, wave.angle, wave.k, 1)) found.push_back(wave);
  }
  return found;
}

// The smallest of a function with a single minimum, golden section: where, and how much.
template <class Value>
std::pair<double, double> golden(double low, double high, double tolerance, const Value& value) {
  const double g = (std::sqrt(5.0) - 1) / 2;
  double a = high - g * (high - low);
  double b = low + g * (high - low);
  double at_a = value(a);
  double at_b = value(b);
  while (high - low > tolerance) {
    if (at_a < at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = high - g * (high - low);
      at_a = value(a);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = low + g * (high - low);
      at_b = value(b);
    }
  }
  if (at_a < at_b) return {a, at_a};
  return {b, at_b};
}

// The direction within 12 degrees of another in which the surface is softest for waves of length k.
double softest_direction(const LayerStack& stack, double middle, double k) {
  constexpr double step = 3 * pi / 180;
  double best = middle;
  double least = std::numeric_limits<double>::infinity();
  for (int i = -4; i <= 4; ++i) {
    const double here = stability(stack, middle + i * step, k, 1);
    if (here >= least) continue;
    least = here;
    best = middle + i * step;
  }
  return golden(best - step, best + step, 1e-3,
                [&](double wave_angle) { return stability(stack, wave_angle, k, 1); })
      .first;
}

// First t of waves along one direction over all wavenumbers near `start`, at the lines of `refine`.
struct Optimum {
  double k = 0, t = 0;
};

Optimum smallest_over_k(const Path& path, double wave_angle, double start, double from, double to,
                        int refine, bool any_wavelength, double reach = 0.35) {
  if (any_wavelength) {
    return {start, path.critical(from, to, wave_angle, start, refine, 1e-12).value_or(to)};
  }
  const double middle = std::log(start);
  const auto t_of = [&](double log_k) {
    const auto t = path.critical(from, to, wave_angle, std::exp(log_k), refine, 1e-11);
    return t.value_or(to + 1e-9 * std::abs(log_k - middle));
  };
  const auto [log_k, t] = golden(middle - reach, middle + reach, 1e-4, t_of);
  return {std::exp(log_k), t};
}

// Force along m per width, over all layers; of a half-space alone that of its material [MPa mm].
double force_along(const LayerStack& stack, const Vec3& m) {
  double sum = 0;
  for (const LayerState& layer : stack.layers) {
    const double stress = m.dot(layer.sigma * m);
    if (std::isinf(layer.thickness)) return stress;
    sum += stress * layer.thickness;
  }
  return sum;
}

}  // namespace

PlaneDeformation WrinkleProblem::deformation(double angle, double s) const {
  const Vec2 n(std::cos(angle), std::sin(angle));
  const Vec2 m(-std::sin(angle), std::cos(angle));
  const PlaneDeformation one = PlaneDeformation::Identity();
  if (load == WrinkleLoad::shear) return (one + s * n * m.transpose()) * prestretch;
  if (width == WidthUnderCompression::equal) return s * prestretch;
  const PlaneDeformation compressed = one + (s - 1) * n * n.transpose();
  if (width == WidthUnderCompression::held) return compressed * prestretch;
  // width free: bisection of the force along m
  const Vec3 across(m[0], 0, m[1]);
  const auto at = [&](double w) -> PlaneDeformation {
    return (compressed + (w - 1) * m * m.transpose()) * prestretch;
  };
  const auto force = [&](double w) {
    LayerStack stack;
    for (const Layer& layer : layers) stack.layers.push_back(layer_state(layer, at(w), dilatation));
    return stack.exists() ? force_along(stack, across) : not_known;
  };
  double low = 0.2;
  double high = 5;
  for (int i = 0; i < 100 && high - low > 1e-15 * high; ++i) {
    const double middle = std::sqrt(low * high);
    const double f = force(middle);
    if (f > 0 || (std::isnan(f) && middle > 1)) {
      high = middle;
    } else {
      low = middle;
    }
  }
  return at(std::sqrt(low * high));
}

LayerStack WrinkleProblem::stack(double angle, double s) const {
  LayerStack stack;
  const PlaneDeformation F = deformation(angle, s);
  for (const Layer& layer : layers) stack.layers.push_back(layer_state(layer, F, dilatation));
  stack.bottom = bottom;
  stack.surface_tension = surface_tension;
  return stack;
}

Wrinkle first_wrinkle(const WrinkleProblem& problem, double angle) {
  Wrinkle wrinkle;
  wrinkle.wavelength = wrinkle.wavelength_before = wrinkle.s = not_known;
  wrinkle.wave_angle = angle;
  const Path path(problem, angle);
  const LayerStack at_rest = path.stack(0);
  if (!at_rest.exists()) {
    wrinkle.kind = Wrinkle::Kind::no_state;
    return wrinkle;
  }
  const std::vector<double> ks = wavenumbers(at_rest);
  const auto waves_along = [&](std::initializer_list<double> degrees) {
    std::vector<Wave> waves;
    for (const double beside : degrees)
      for (const double k : ks) waves.push_back({angle + beside * pi / 180, k});
    return waves;
  };
  const bool shear = problem.load == WrinkleLoad::shear;
  std::vector<Wave> waves = waves_along({0});
  const std::vector<Wave> others = waves_along({15, -15, 30, -30, 45, -45, 60, -60, 75, -75, 90});
  if (shear) waves.insert(waves.end(), others.begin(), others.end());
  // Waves that grow under shear are close to the direction of the smallest stretch, which turns,
  // and next to stiff fibres they fill less than a degree.
  const auto waves_at = [&](double t) {
    std::vector<Wave> all = waves;
    if (!shear) return all;
    const LayerStack stack = path.stack(t);
    const double middle = direction_of_smallest_stretch(problem.deformation(angle, path.s(t)));
    for (const double k : ks) all.push_back({softest_direction(stack, middle, k), k});
    return all;
  };
  if (!unstable_of(path, 0, waves).empty()) {
    wrinkle.kind = Wrinkle::Kind::at_once;
    return wrinkle;
  }

  // forward until a wave grows
  Bracket bracket;
  double step = 0.02;
  while (bracket.unstable.empty() && bracket.high < path.end()) {
    bracket.low = bracket.high;
    bracket.high = std::min(bracket.high + step, path.end());
    step *= 1.6;
    if (!path.stack(bracket.high).exists()) {
      wrinkle.kind = Wrinkle::Kind::no_state;
      return wrinkle;
    }
    bracket.unstable = unstable_of(path, bracket.high, waves_at(bracket.high));
  }
  if (bracket.unstable.empty()) return wrinkle;

  // the first of them, among those that still grow
  const auto narrow = [&](Bracket& b) {
    for (int i = 0; i < 60 && b.high - b.low > 1e-4 * b.high; ++i) {
      if (b.unstable.size() == 1 && b.high - b.low < 1e-2 * b.high) break;
      const double middle = 0.5 * (b.low + b.high);
      std::vector<Wave> still = unstable_of(path, middle, shear ? waves_at(middle) : b.unstable);
      if (still.empty()) {
        b.low = middle;
      } else {
        b.high = middle;
        b.unstable = std::move(still);
      }
    }
  };
  narrow(bracket);

  // waves in other directions that grow even before
  if (!shear && problem.every_wave_direction) {
    std::vector<Wave> tried = others;
    const LayerStack stack = path.stack(bracket.low);
    const double k = bracket.unstable[bracket.unstable.size() / 2].k;
    for (const double factor : {0.75, 1.0, 1.35})
      tried.push_back({softest_direction(stack, angle, factor * k), factor * k});
    std::vector<Wave> earlier = unstable_of(path, bracket.low, tried);
    if (!earlier.empty()) {
      bracket.high = bracket.low;
      bracket.low = 0;
      bracket.unstable = std::move(earlier);
      narrow(bracket);
    }
  }
  const Wave sampled = bracket.unstable[bracket.unstable.size() / 2];
  Wave first = sampled;
  if (!shear && problem.every_wave_direction && first.angle == angle) {
    constexpr double off = 3e-3;  // directions by symmetry are found to less than that
    const LayerStack stack = path.stack(bracket.high);
    const double softest = softest_direction(stack, angle, first.k);
    if (std::abs(softest - angle) > off && unstable(stack, softest, first.k, 1))
      first.angle = softest;
  }
  const double shortest = ks.back();
  const bool one_length = ks.size() == 1;
  const bool short_first = !one_length && bracket.unstable.back().k >= shortest * (1 - 1e-12) &&
                           bracket.unstable.back().angle == sampled.angle;
  const bool long_first = !one_length && bracket.unstable.front().k <= ks.front() * (1 + 1e-12);
  wrinkle.wave_angle = first.angle;
  wrinkle.kind = Wrinkle::Kind::wavy;
  if (long_first) wrinkle.kind = Wrinkle::Kind::buckling;
  if (one_length || short_first) wrinkle.kind = Wrinkle::Kind::surface;
  const bool any_wavelength = wrinkle.kind != Wrinkle::Kind::wavy;
  const double from = 0.5 * bracket.low;  // between the waves that were tried lie earlier ones
  const double to = bracket.high * 1.02;
  double k0 = first.k;
  if (short_first) k0 = shortest;
  if (long_first) k0 = ks.front();

  // the direction of k, where it is not that of the compression by symmetry: in turn the best
  // wavenumber and the best direction
  if (first.angle != angle || shear) {
    wrinkle.wave_angle = first.angle;
    for (const double reach : {0.3, 0.05, 0.01}) {
      const int lines = reach < 0.02 ? 2 : 1;
      k0 = smallest_over_k(path, wrinkle.wave_angle, k0, from, to, lines, any_wavelength, reach).k;
      const double middle = wrinkle.wave_angle;
      wrinkle.wave_angle = golden(middle - reach, middle + reach, 1e-4, [&](double wave_angle) {
                             const auto t = path.critical(from, to, wave_angle, k0, lines, 1e-11);
                             return t.value_or(to + 1e-9 * std::abs(wave_angle - middle));
                           }).first;
    }
  }
  const Optimum coarse = smallest_over_k(path, wrinkle.wave_angle, k0, from, to, 1, any_wavelength);
  const Optimum fine =
      smallest_over_k(path, wrinkle.wave_angle, coarse.k, from, to, 2, any_wavelength, 0.02);
  const double t = fine.t + (fine.t - coarse.t) / 15;
  wrinkle.s = path.s(t);
  wrinkle.error = std::abs(wrinkle.s - path.s(fine.t)) / wrinkle.s;
  if (any_wavelength) return wrinkle;
  // layers of one law, as of a half-space: short waves are unstable in the same state
  constexpr double alike = 1e-5;
  if (path.stability_at(t * (1 + alike), wrinkle.wave_angle, shortest, 2) < 0) {
    wrinkle.kind = Wrinkle::Kind::surface;
    return wrinkle;
  }
  const double k = fine.k + (fine.k - coarse.k) / 15;
  wrinkle.wavelength = 2 * pi / k;
  // k as a covector of the prestretched plane: F^T k
  const PlaneDeformation relative =
      problem.deformation(angle, wrinkle.s) * problem.prestretch.inverse();
  const Vec2 k_now = k * Vec2(std::cos(wrinkle.wave_angle), std::sin(wrinkle.wave_angle));
  wrinkle.wavelength_before = 2 * pi / (relative.transpose() * k_now).norm();
  return wrinkle;
}

}  // namespace langer
