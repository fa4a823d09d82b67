#include "layers/guided_wave.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/tensor/principal.hpp"

namespace langer {

namespace {

using Complex = std::complex<double>;

constexpr double order_of_lines = 4;

// Waves so much slower than body waves of a half-space are told from them. Those between reach
// hundreds of wavelengths deep.
constexpr double off_body_waves = 1e-6;

// Speeds of the shear waves of a layer along the surface and through the depth [mm/s].
struct ShearSpeeds {
  double slowest = 0, fastest = 0;
};

ShearSpeeds shear_speeds(const DirectedModuli<double>& m) {
  // polarised across the direction of travel: along the surface y and z', through the depth x', z'
  const double along[2] = {m.Q(1, 1), m.Q(2, 2)};
  const double deep[2] = {m.T(0, 0), m.T(2, 2)};
  double low = std::numeric_limits<double>::infinity();
  double high = 0;
  for (const double modulus : {along[0], along[1], deep[0], deep[1]}) {
    low = std::min(low, modulus);
    high = std::max(high, modulus);
  }
  return {std::sqrt(std::max(low, 0.0) / m.density), std::sqrt(std::max(high, 0.0) / m.density)};
}

// Whether motions along z' have nothing to do with those along x' and y: in directions of symmetry.
bool is_decoupled(const DirectedModuli<double>& m) {
  const double size = 1e-10 * (m.Q.cwiseAbs().maxCoeff() + m.T.cwiseAbs().maxCoeff());
  const double coupling = std::max({std::abs(m.Q(0, 2)), std::abs(m.Q(1, 2)), std::abs(m.T(0, 2)),
                                    std::abs(m.T(1, 2)), std::abs(m.S(2, 1)), std::abs(m.S(1, 2))});
  return coupling < size;
}

// One direction of a stack, for real moduli: modes of a wavenumber or of a frequency.
class Modes {
 public:
  Modes(const LayerStack& stack, const WaveQuery& query) : stack_(stack), query_(query) {
    for (const LayerState& layer : stack.layers) {
      if (query.frequency && !layer.branches.empty()) {
        moduli_.push_back(storage_moduli(layer, query.angle, *query.frequency));
      } else {
        moduli_.push_back(directed_moduli(layer, query.angle));
      }
      thickness_.push_back(layer.thickness);
      const ShearSpeeds speeds = shear_speeds(moduli_.back());
      fastest_ = std::max(fastest_, speeds.fastest);
      slowest_.push_back(speeds.slowest);
    }
    // no vertical tap excites motions along z' where they are alone: a stiffness holds them
    const bool decoupled = std::ranges::all_of(moduli_, is_decoupled);
    if (query.mode != WaveMode::vertical || !decoupled) return;
    held_ = true;
    constexpr double held = 1e6;
    for (DirectedModuli<double>& m : moduli_) {
      m.Q(2, 2) = held * m.Q.cwiseAbs().maxCoeff();
      m.T(2, 2) = held * m.T.cwiseAbs().maxCoeff();
    }
  }

  double fastest() const { return fastest_; }
  // A wave that is faster than the shear waves of a half-space below leaks into it.
  // A layer on a base carries waves of any speed near the frequency where they are cut off.
  double top_speed() const {
    if (!stack_.has_half_space()) return (query_.frequency ? 10 : 2) * fastest_;
    const DirectedModuli<double>& m = moduli_.back();
    double modulus = std::max(m.Q(1, 1), 0.0);
    if (!held_) modulus = std::max(std::min(modulus, m.Q(2, 2)), 0.0);
    return std::sqrt(modulus / m.density);
  }
  const std::vector<DirectedModuli<double>>& moduli() const { return moduli_; }

  // Lines for waves of the wavenumber k that are as fast as `speed`.
  LineMesh mesh(double k, double speed, int refine) const {
    std::vector<double> oscillation;
    for (std::size_t i = 0; i < slowest_.size(); ++i) {
      double there = 0;
      if (speed > slowest_[i]) {
        const double ratio = std::min(speed / std::max(slowest_[i], 1e-3 * speed), 20.0);
        there = k * std::sqrt(ratio * ratio - 1);
      }
      const bool half_space = std::isinf(thickness_[i]);
      oscillation.push_back(there > k && !half_space ? there : 0);
    }
    LineChoice choice;
    choice.refine = refine;
    return line_mesh(thickness_, k, oscillation, stack_.bottom == BottomFace::fixed, choice);
  }

  LineChain<double> chain(LineMesh mesh) const {
    return {moduli_, std::move(mesh), stack_.bottom, stack_.surface_tension};
  }

 private:
  const LayerStack& stack_;
  const WaveQuery& query_;
  std::vector<DirectedModuli<double>> moduli_;
  std::vector<double> thickness_, slowest_;
  double fastest_ = 0;
  bool held_ = false;  // motions along z'
};

// A mode that was found on one mesh.
struct Found {
  double k = 0, w = 0;
  double mass = 0, slope = 0;  // of the motion with the surface motion v, |v| = 1
  Vec3 v = Vec3::Zero();
  bool exists = false;
  bool trapped = false;  // below the surface, which does not move
};

// The eigenvalue of the surface stiffness that is closest to 0, with its vector.
std::pair<double, Vec3> smallest(const Mat3& surface) {
  const Principal eigen = principal(surface);
  Eigen::Index at = 0;
  eigen.values.cwiseAbs().minCoeff(&at);
  return {eigen.values[at], eigen.directions.col(at)};
}

// Either k or w is given; x is what is searched, such that the number of modes grows with x.
struct Search {
  LineChain<double>& chain;
  bool of_frequency;  // x = w^2 at the wavenumber `fixed`; else x = -k at the frequency `fixed`
  double fixed;

  double k(double x) const { return of_frequency ? fixed : -x; }
  double w2(double x) const { return of_frequency ? x : fixed * fixed; }
  int count(double x, bool keep = false) const {
    chain.eliminate(k(x), w2(x), keep);
    return chain.modes_below();
  }
  // Newton's step from the last elimination, which was kept
  double step(Found& found) const {
    const auto [s, v] = smallest(chain.surface());
    const auto forms = chain.forms(v);
    found.v = v;
    found.mass = forms.mass;
    found.slope = forms.slope;
    if (of_frequency) return s / forms.mass;
    return s / forms.slope;
  }
};

// Mode number m between x with fewer than m modes and x with m or more: bisection by the number of
// modes, then Newton's steps as long as they converge within the bracket.
Found find_mode(const Search& search, int m, double low, double high) {
  constexpr double rounding = 4e-15;
  Found found;
  int in_low = m - 1;
  int in_high = m;
  double x = 0.5 * (low + high);
  double last_step = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < 300; ++iteration) {
    const double size = std::max(std::abs(low), std::abs(high));
    const bool alone = in_low == m - 1 && in_high == m && high - low < 0.05 * size;
    const int n = search.count(x, alone);
    if (n >= m) {
      high = x;
      in_high = n;
    } else {
      low = x;
      in_low = n;
    }
    if (high - low <= rounding * size) break;
    double next = 0.5 * (low + high);
    if (alone) {
      const double step = search.step(found);
      const bool inside = x + step >= low && x + step <= high;
      if (std::abs(step) < rounding * size) break;
      if (inside && std::abs(step) < 0.3 * last_step) {
        next = x + step;
        last_step = std::abs(step);
      } else {
        last_step = std::numeric_limits<double>::infinity();
      }
    }
    x = next;
  }
  // A mode that does not move the surface is found by the number of modes alone.
  search.count(x, true);
  const double left = search.step(found);
  found.trapped = !(std::abs(left) < 1e-7 * std::abs(x));
  found.exists = true;
  found.k = search.k(x);
  found.w = std::sqrt(std::max(search.w2(x), 0.0));
  return found;
}

// The largest x up to `top` at which no body waves travel in the half-space, less what cannot be
// told from them. In anisotropic layers they may begin below the speed of those that travel along
// the surface.
double below_body_waves(const Search& search, double bottom, double top) {
  const auto travels = [&](double x) {
    search.count(x);
    return search.chain.modes_of_half_space() > 0;
  };
  if (travels(top)) {
    double none = bottom;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (none + top);
      (travels(middle) ? top : none) = middle;
    }
    top = none;
  }
  return top - 2 * off_body_waves * std::abs(top);
}

// All modes up to `most` that lie below x = top, slowest first.
std::vector<Found> find_modes(const Search& search, double bottom, double top, int most) {
  std::vector<Found> modes;
  const int last = std::min(most, search.count(top));
  double low = bottom;
  for (int m = 1; m <= last; ++m) {
    const Found found = find_mode(search, m, low, top);
    if (!found.exists) break;
    modes.push_back(found);
    // a double root is found twice from the same bracket
    const double x = search.of_frequency ? found.w * found.w : -found.k;
    low = x - 1e-9 * std::abs(x);
    if (search.count(low) > m) low = bottom;
  }
  return modes;
}

// How much a vertical line force at the surface excites a mode, up to a common factor.
double vertical_excitation(const Found& mode) {
  if (mode.trapped) return 0;
  const double slope = std::abs(mode.slope);
  return mode.v[1] * mode.v[1] / std::max(slope, std::numeric_limits<double>::min());
}

// Complex wavenumber at a real frequency, from that of the storage moduli: Newton's method on the
// eigenvalue of the surface stiffness.
std::optional<Complex> damped(const LayerStack& stack, double angle, double frequency, Found start,
                              const LineMesh& mesh) {
  std::vector<DirectedModuli<Complex>> moduli;
  for (const LayerState& layer : stack.layers) {
    moduli.push_back(complex_moduli(layer, angle, frequency));
  }
  LineChain<Complex> chain(moduli, mesh, stack.bottom, stack.surface_tension);
  Complex k = start.k;
  Eigen::Vector3cd v = start.v.cast<Complex>();
  for (int iteration = 0; iteration < 60; ++iteration) {
    chain.eliminate(k, frequency * frequency, true);
    const Eigen::Matrix3cd S = chain.surface();
    const Eigen::PartialPivLU<Eigen::Matrix3cd> lu(S);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3cd w = lu.solve(v);
      if (!w.allFinite()) break;
      v = w / w.norm();
    }
    const Complex vv = (v.transpose() * v)(0);
    const Complex s = (v.transpose() * S * v)(0);
    if (std::abs(vv) < 1e-8) return std::nullopt;
    Complex step = s / chain.forms(v).slope;
    const double most = 0.2 * std::abs(k);
    if (std::abs(step) > most) step *= most / std::abs(step);
    k -= step;
    if (!std::isfinite(std::abs(k))) return std::nullopt;
    if (std::abs(step) < 1e-13 * std::abs(k)) return k;
  }
  return std::nullopt;
}

constexpr const char* it_leaks =
    "the wave is faster than shear waves of the half-space and leaks into it";

GuidedWave none(std::string reason) {
  GuidedWave wave;
  wave.reason = std::move(reason);
  return wave;
}

}  // namespace

bool LayerStack::exists() const {
  return std::ranges::all_of(layers, [](const LayerState& layer) { return layer.exists; });
}

bool LayerStack::has_half_space() const { return std::isinf(layers.back().thickness); }

bool LayerStack::is_viscous() const {
  return std::ranges::any_of(layers,
                             [](const LayerState& layer) { return !layer.branches.empty(); });
}

bool LayerStack::is_dispersive() const {
  return layers.size() > 1 || !has_half_space() || surface_tension != 0 || is_viscous();
}

GuidedWave guided_wave(const LayerStack& stack, const WaveQuery& query) {
  if (!stack.exists()) return none("a layer has no such state of stretch");
  WaveQuery asked = query;
  if (!asked.wavenumber && !asked.frequency) asked.wavenumber = 1;
  const Modes modes(stack, asked);
  const double fastest = modes.fastest();
  if (!(fastest > 0)) return none("a layer without stiffness against shear");
  const bool of_frequency = asked.wavenumber.has_value();

  // the search on lines that every mode of interest is resolved on
  double k = 0;
  if (of_frequency) {
    k = *asked.wavenumber;
  } else {
    k = *asked.frequency / fastest;
  }
  LineMesh mesh = modes.mesh(k, fastest, 1);
  LineChain<double> chain = modes.chain(mesh);
  const Search search{chain, of_frequency, of_frequency ? k : *asked.frequency};
  double bottom = 0;
  double top = 0;
  const bool leaks = stack.has_half_space();
  if (of_frequency) {
    if (search.count(0) > 0) return none("the stretched layers are unstable: they wrinkle");
    top = std::pow(modes.top_speed() * k, 2);
    for (int i = 0; i < 40 && !leaks && search.count(top) == 0; ++i) top *= 2;
  } else {
    // at short wavelengths there are no modes below the frequency
    bottom = -k;
    for (int i = 0; i < 60 && search.count(bottom) > 0; ++i) bottom *= 1.5;
    if (search.count(bottom) > 0) return none("the stretched layers are unstable: they wrinkle");
    top = -k * fastest / modes.top_speed();
    for (int i = 0; i < 10 && !leaks && search.count(top) == 0; ++i) top /= 2;
    if (!leaks && search.count(top) == 0)
      return none("no wave of this frequency travels: it is cut off");
  }
  if (leaks) top = below_body_waves(search, bottom, top);
  int most = asked.modes;
  if (asked.mode == WaveMode::slowest || (leaks && stack.layers.size() == 1)) most = 1;
  const std::vector<Found> all = find_modes(search, bottom, top, most);
  if (all.empty() && leaks) {
    return none(it_leaks);
  }
  if (all.empty()) return none("no mode was found");
  std::size_t chosen = 0;
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (vertical_excitation(all[i]) > vertical_excitation(all[chosen])) chosen = i;
  }

  // the same mode on lines for its own wavelength, and on lines half as long
  GuidedWave wave;
  wave.mode = static_cast<int>(chosen) + 1;
  Found on[2];
  for (int level = 0; level < 2; ++level) {
    const Found& near = all[chosen];
    const LineMesh own = modes.mesh(near.k, near.w / near.k, level + 1);
    LineChain<double> refined = modes.chain(own);
    Search again{refined, of_frequency, search.fixed};
    const double x = of_frequency ? near.w * near.w : -near.k;
    double low = x - 0.02 * std::abs(x);
    double high = x + 0.02 * std::abs(x);
    for (int i = 0; i < 8 && again.count(low) >= wave.mode; ++i) low -= 0.1 * std::abs(x);
    for (int i = 0; i < 8 && again.count(high) < wave.mode; ++i) high += 0.1 * std::abs(x);
    if (leaks) high = std::min(high, below_body_waves(again, bottom, high));
    if (leaks && again.count(high) < wave.mode) return none(it_leaks);
    on[level] = find_mode(again, wave.mode, low, high);
    if (!on[level].exists) return none("the mode is lost on shorter lines");
    mesh = own;
  }
  const double ratio = std::pow(2.0, order_of_lines) - 1;
  const auto limit = [ratio](double coarse, double fine) {
    return fine + (fine - coarse) / ratio;
  };
  const auto speed = [](const Found& f) {
    return f.w / f.k;
  };
  const auto group = [](const Found& f) {
    return f.slope / (2 * f.w * f.mass);
  };
  wave.exists = true;
  wave.speed = limit(speed(on[0]), speed(on[1]));
  wave.group_speed = limit(group(on[0]), group(on[1]));
  wave.error = std::abs(wave.speed - speed(on[1])) / wave.speed;
  if (of_frequency) {
    wave.wavenumber = k;
    wave.frequency = wave.speed * k;
  } else {
    wave.frequency = *asked.frequency;
    wave.wavenumber = wave.frequency / wave.speed;
  }
  if (!stack.is_viscous()) return wave;

  // branches: complex wavenumbers at this frequency and beside it, for the group speed
  const double w = wave.frequency;
  constexpr double beside = 1e-4;
  std::optional<Complex> at[3];
  for (int i = 0; i < 3; ++i) {
    at[i] = damped(stack, asked.angle, w * (1 + beside * (i - 1)), on[1], mesh);
    if (!at[i]) return none("no damped wave was found");
  }
  wave.wavenumber = at[1]->real();
  wave.attenuation = at[1]->imag();
  wave.speed = w / wave.wavenumber;
  wave.group_speed = 2 * beside * w / (at[2]->real() - at[0]->real());
  return wave;
}

}  // namespace langer
