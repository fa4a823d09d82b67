#include "identification/fit/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <stdexcept>

#include "core/base/error.hpp"
#include "identification/fit/imposed_states.hpp"
#include "identification/fit/periodic.hpp"

namespace langer {

namespace {

// in [0, 1), the same on every platform
double uniform(std::mt19937_64& rng) { return static_cast<double>(rng() >> 11) * 0x1p-53; }

// The numbers of `material` behind the free parameters, in their order; without a pointer for those
// that are no numbers of the material.
std::vector<MaterialParameter> chosen(Material& material, const std::vector<FreeParameter>& free) {
  const std::vector<MaterialParameter> all = parameters(material);
  std::vector<MaterialParameter> list;
  for (const FreeParameter& p : free) {
    if (!p.is_material_number()) {
      list.push_back({p.key, p.name, p.unit, {}, nullptr});
      continue;
    }
    const auto found = std::ranges::find(all, p.key, &MaterialParameter::key);
    if (found == all.end()) throw std::logic_error("the law has no parameter " + p.key);
    list.push_back(*found);
  }
  return list;
}

// The law with pointers to the numbers that vary.
struct Model {
  Material material;
  std::vector<double*> numbers;
  std::vector<Test> tests;
  Dilatation dilatation;
  VecX stress, weight;
  TiedNumbers tied;
  std::vector<std::optional<ImposedStates>> imposed;  // of each test, for the last fibres

  explicit Model(const FitProblem& problem)
      : material(problem.law),
        tests(problem.tests),
        dilatation(problem.dilatation),
        stress(measured_stress(problem.tests)),
        weight(weights(problem.tests)),
        tied(material, problem.ties) {
    for (const MaterialParameter& p : chosen(material, problem.free)) numbers.push_back(p.value);
    imposed.resize(tests.size());
  }
  Model(const Model&) = delete;

  bool stress_of(std::size_t test, double* result) {
    std::optional<ImposedStates>& states = imposed[test];
    const bool known = states && states->hold_for(material);
    if (!known && dilatation == Dilatation::incompressible)
      states = ImposedStates::of(material, tests[test]);
    if (states) return states->stress(material, result);
    return model_stress(material, tests[test], dilatation, result);
  }

  bool residual(const VecX& p, VecX& r) {
    for (std::size_t i = 0; i < numbers.size(); ++i)
      if (numbers[i]) *numbers[i] = p[static_cast<Eigen::Index>(i)];
    tied.follow();
    r.resize(stress.size());
    Eigen::Index at = 0;
    for (std::size_t k = 0; k < tests.size(); ++k) {
      if (!stress_of(k, r.data() + at)) return false;
      at += static_cast<Eigen::Index>(tests[k].values());
    }
    r = weight.cwiseProduct(r - stress);
    return true;
  }
};

// Whether the whole deformation is imposed. The stress is then linear in every modulus.
bool imposed(const Test& test, const Material& law) {
  if (law.fibres.empty()) return true;
  return test.kind == TestKind::simple_shear ||
         (test.kind != TestKind::uniaxial && test.shear == OffAxisShear::held);
}

// 180 for an angle whose box holds all of them, and whatever follows it as well; 0 for other
// numbers
double period(const FitProblem& problem, const FreeParameter& p, const std::string& unit) {
  if (unit != unit::deg || !(p.upper - p.lower >= 180 * (1 - 1e-12))) return 0;
  for (const Tie& tie : problem.ties)
    if (tie.of == p.key && tie.factor != std::round(tie.factor)) return 0;
  return 180;
}

// One search. Angles are returned within their box; an angle that reached the end of the wider box
// of the search continues from there.
LeastSquaresResult search(const FitProblem& problem, LeastSquares& q,
                          const LeastSquaresOptions& options) {
  LeastSquaresResult one;
  for (int turn = 0; turn < 4; ++turn) {
    one = least_squares(q, options);
    bool stopped = false;
    for (Eigen::Index i = 0; i < one.p.size(); ++i)
      if (const double period = q.period_of(i); period > 0) {
        const FreeParameter& p = problem.free[static_cast<std::size_t>(i)];
        one.p[i] = into_box(one.p[i], period, p.lower, p.upper);
        stopped = stopped || one.at_bound[static_cast<std::size_t>(i)];
      }
    if (!stopped) break;
    q.start = one.p;
  }
  return one;
}

// The random place where a search starts; u is uniform in [0, 1]. In a wide box of exponents small
// values are drawn more often (SearchBounds).
double drawn_start(const FreeParameter& p, const MaterialParameter& parameter, double u) {
  const double width = p.upper - p.lower;
  double share = u;
  if (parameter.search && parameter.search->small_values_first && width > 20) share = u * u * u;
  return p.lower + share * width;
}

// Size and correlation of the noise that residuals show, with what the parameters took from them;
// in: the parameters that were free.
ResidualNoise shown_noise(const FitProblem& problem, const LeastSquares& q, const FitResult& fit,
                          const std::vector<Eigen::Index>& in) {
  const LeastSquaresResult& best = fit.best;
  const std::vector<Eigen::Index> curves = curve_sizes(problem);
  if (fit.noise_model.rho > 0) {
    MatX J;
    const LeastSquares plain = least_squares_problem(problem);
    if (!jacobian(plain, best.p, J)) throw std::logic_error("no derivative at an optimum");
    const Standardizer by = standardizer(problem, fit.noise_model);
    const MatX free = by.scaled_slope(fit.residual, J)(Eigen::all, in);
    return innovation_noise(by.scaled(fit.residual), free, curves, fit.noise_model.rho,
                            by.correlation_scale());
  }
  const double size = q.size / std::sqrt(static_cast<double>(best.r.size()));
  const ResidualNoise shown = residual_noise(best.r, best.J(Eigen::all, in), curves, size);
  if (problem.further) return with_least(shown, 1);
  return shown;
}

// Noise, angles of symmetry and covariance. q: the problem whose least squares the fit found.
void set_covariance(const FitProblem& problem, const LeastSquares& q, FitResult& fit) {
  const LeastSquaresResult& best = fit.best;
  const auto noise = [&] {
    std::vector<Eigen::Index> in;
    for (Eigen::Index i = 0; i < best.p.size(); ++i)
      if (!fit.left_out[static_cast<std::size_t>(i)]) in.push_back(i);
    return shown_noise(problem, q, fit, in);
  };
  fit.left_out = best.at_bound;
  fit.noise = noise();
  std::vector<double> turn;
  Material law = problem.law;
  for (const MaterialParameter& p : chosen(law, problem.free)) {
    double half_turn = 0;
    if (p.unit == unit::deg) half_turn = 180;
    turn.push_back(half_turn);
  }
  const SymmetricAngles found = symmetric_angles(q, best, fit.noise.total(), turn);
  fit.symmetric = found.at;
  fit.columns = found.columns;
  for (std::size_t i = 0; i < found.at.size(); ++i)
    if (found.at[i]) fit.left_out[i] = true;
  if (fit.left_out != best.at_bound) fit.noise = noise();
  if (fit.noise.total() > 0 || std::isfinite(fit.noise.freedom)) {
    fit.covariance = covariance(best.J, fit.left_out, fit.noise);
  } else {
    fit.covariance =
        MatX::Constant(best.p.size(), best.p.size(), std::numeric_limits<double>::quiet_NaN());
  }
}

// R2 and errors of one curve, in percent of the largest value.
FitQuality quality(const VecX& model, const VecX& stress, double largest) {
  FitQuality q;
  const VecX error = model - stress;
  const double spread = (stress.array() - stress.mean()).matrix().squaredNorm();
  if (spread > 0) {
    q.r2 = 1 - error.squaredNorm() / spread;
  } else {
    q.r2 = std::numeric_limits<double>::quiet_NaN();
  }
  q.mean_error_percent = q.max_error_percent = std::numeric_limits<double>::quiet_NaN();
  if (largest > 0) {
    q.mean_error_percent = 100 * error.cwiseAbs().mean() / largest;
    q.max_error_percent = 100 * error.cwiseAbs().maxCoeff() / largest;
  }
  return q;
}

// errors of each test, and of all of them together
void set_errors(const FitProblem& problem, const VecX& stress, FitResult& fit) {
  Eigen::Index stressed = 0;
  const auto add = [&](const VecX& model, const VecX& measured, double largest) {
    const FitQuality q = quality(model, measured, largest);
    fit.of_test.push_back(q);
    if (!(largest > 0)) return;
    fit.quality.mean_error_percent += q.mean_error_percent * static_cast<double>(measured.size());
    fit.quality.max_error_percent = std::max(fit.quality.max_error_percent, q.max_error_percent);
    stressed += measured.size();
  };
  Eigen::Index at = 0;
  for (const Test& test : problem.tests) {
    const auto m = static_cast<Eigen::Index>(test.values());
    add(fit.model.segment(at, m), stress.segment(at, m), largest_stress(test));
    at += m;
  }
  at = 0;
  for (const Eigen::Index m :
       problem.further ? problem.further->curves() : std::vector<Eigen::Index>()) {
    const VecX measured = problem.further->measured().segment(at, m);
    add(fit.further.segment(at, m), measured, measured.cwiseAbs().maxCoeff());
    at += m;
  }
  fit.quality.mean_error_percent /= static_cast<double>(stressed);
}

// R2 of values with several units: each curve is compared with its own mean, weighted.
double r2_of_all(const FitProblem& problem, const VecX& stress, const FitResult& fit) {
  const VecX weight = weights(problem.tests);
  double spread = 0;
  Eigen::Index at = 0, further = 0;
  for (const Eigen::Index m : curve_sizes(problem)) {
    const bool of_tests = at < stress.size();
    const VecX y =
        of_tests ? stress.segment(at, m) : problem.further->measured().segment(further, m);
    const VecX w = of_tests ? weight.segment(at, m) : problem.further->weight().segment(further, m);
    (of_tests ? at : further) += m;
    spread += w.cwiseProduct((y.array() - y.mean()).matrix()).squaredNorm();
  }
  if (spread > 0) return 1 - fit.best.r.squaredNorm() / spread;
  return std::numeric_limits<double>::quiet_NaN();
}

// Akaike's criterion with the correction for few values; NaN if there are too few for it.
double aicc(double minus_two_log_likelihood, const FitProblem& problem, const NoiseModel& noise) {
  double n = 0;
  if (problem.further) n = static_cast<double>(problem.further->measured().size());
  for (const Test& test : problem.tests) n += static_cast<double>(test.values());
  const double k = static_cast<double>(problem.free.size()) + 1 + noise.parameters();
  if (!(n > k + 1)) return std::numeric_limits<double>::quiet_NaN();
  return minus_two_log_likelihood + 2 * k + 2 * k * (k + 1) / (n - k - 1);
}

// Sets R2, errors, AICc and BIC of a fit.
void set_quality(const FitProblem& problem, FitResult& fit) {
  const VecX stress = measured_stress(problem.tests);
  const auto n = static_cast<double>(fit.best.r.size());
  if (problem.further)
    fit.quality.r2 = r2_of_all(problem, stress, fit);
  else
    fit.quality = quality(fit.model, stress, 1);
  fit.quality.mean_error_percent = fit.quality.max_error_percent = 0;
  set_errors(problem, stress, fit);
  const double spread = minus_two_log_likelihood(fit.best.r);
  fit.quality.aicc = aicc(spread, problem, fit.noise_model);
  const double k = static_cast<double>(problem.free.size()) + 1 + fit.noise_model.parameters();
  fit.quality.bic = spread + k * std::log(n);
}

// the residuals of further tests behind those of q, and the slope of all
LeastSquares with_further(LeastSquares q, const std::shared_ptr<FurtherTests>& further) {
  const auto tests = std::make_shared<const LeastSquares>(q);
  const VecX weight = further->weight();
  const VecX target = weight.cwiseProduct(further->measured());
  q.size = std::hypot(tests->size, target.norm());
  q.residual = [=](const VecX& p, VecX& r) {
    VecX first, values;
    if (!tests->residual(p, first) || !further->model(p, values)) return false;
    r.resize(first.size() + values.size());
    r << first, weight.cwiseProduct(values) - target;
    return true;
  };
  q.slope = [=](const VecX& p, MatX& J) {
    VecX first;
    MatX above, below;
    if (!tests->residual(p, first) || (first.size() > 0 && !jacobian(*tests, p, above)) ||
        !further->slope(p, below))
      return false;
    J.resize(first.size() + below.rows(), p.size());
    if (first.size() > 0) J.topRows(first.size()) = above;
    J.bottomRows(below.rows()) = weight.asDiagonal() * below;
    return true;
  };
  q.linear.clear();
  return q;
}

}  // namespace

// The stresses of a test in its imposed states. Viscous materials go through the history first.
bool model_stress(const Material& material, const Test& test, Dilatation dilatation,
                  double* stress) {
  if (dilatation == Dilatation::compressible) {
    std::vector<double> strain(test.first);
    for (double& e : strain) e -= 1;
    const auto sigma = uniaxial_curve(material, strain, test.measure, dilatation);
    if (sigma) std::copy(sigma->begin(), sigma->end(), stress);
    return sigma.has_value();
  }
  const std::vector<Vec3> a = specimen_fibres(material, test.fibre_angle_deg);
  std::optional<ViscousPoint> point;
  if (is_viscous(material) && !test.time.empty()) point.emplace(material, a);
  std::optional<double> then;  // at rest until the first point
  const auto state_at = [&](const auto& points, std::size_t i) {
    PointMemory memory;
    const PointMemory* known_memory = nullptr;
    if (point) {
      double passed = 0;
      if (then) passed = points.time[i] - *then;
      memory = point->begin(passed);
      known_memory = &memory;
    }
    double second = 1;
    if (!points.second.empty()) second = points.second[i];
    const PlaneState state =
        plane_state(material, a, test.kind, points.first[i], second, test.shear, known_memory);
    if (state.converged && point) {
      point->accept(state.F);
      then = points.time[i];
    }
    return state;
  };
  for (std::size_t i = 0; point && i < test.before.first.size(); ++i)
    if (!state_at(test.before, i).converged) return false;
  for (std::size_t i = 0; i < test.points(); ++i) {
    const PlaneState state = state_at(test, i);
    if (!state.converged) return false;
    const auto both = measured_stress(state, test.kind, test.measure);
    stress[i] = both[0];
    if (!test.stress_z.empty()) stress[test.points() + i] = both[1];
  }
  return true;
}

// All measured stresses, in the order of the header.
VecX measured_stress(const std::vector<Test>& tests) {
  std::vector<double> all;
  for (const Test& test : tests)
    for (const auto* list : {&test.stress_x, &test.stress_z})
      all.insert(all.end(), list->begin(), list->end());
  return Eigen::Map<const VecX>(all.data(), static_cast<Eigen::Index>(all.size()));
}

// The number of values of each measured curve: correlated noise ends where a curve ends.
std::vector<Eigen::Index> curve_sizes(const FitProblem& problem) {
  std::vector<Eigen::Index> sizes;
  for (const Test& test : problem.tests)
    for (const auto* list : {&test.stress_x, &test.stress_z})
      if (!list->empty()) sizes.push_back(static_cast<Eigen::Index>(list->size()));
  if (problem.further)
    sizes.insert(sizes.end(), problem.further->curves().begin(), problem.further->curves().end());
  return sizes;
}

VecX weights(const std::vector<Test>& tests) {
  std::vector<double> all;
  for (const Test& test : tests) all.insert(all.end(), test.values(), test.weight);
  return Eigen::Map<const VecX>(all.data(), static_cast<Eigen::Index>(all.size()));
}

namespace {

// zero stress in the state of rest, which the zero of the device makes and no noise
std::vector<bool> values_at_rest(const std::vector<Test>& tests) {
  std::vector<bool> all;
  for (const Test& test : tests) {
    double rest = 1;
    if (test.kind == TestKind::simple_shear) rest = 0;
    for (const auto* list : {&test.stress_x, &test.stress_z})
      for (std::size_t i = 0; i < list->size(); ++i) {
        const bool second = test.second.empty() || test.second[i] == 1;
        all.push_back((*list)[i] == 0 && test.first[i] == rest && second);
      }
  }
  return all;
}

VecX weighted_stress(const FitProblem& problem) {
  return weights(problem.tests).cwiseProduct(measured_stress(problem.tests));
}

}  // namespace

Standardizer standardizer(const FitProblem& problem, const NoiseModel& noise) {
  return {weighted_stress(problem), curve_sizes(problem), values_at_rest(problem.tests), noise};
}

// The material at p, tied numbers included.
Material with_parameters(const FitProblem& problem, const VecX& p) {
  Material material = problem.law;
  const auto list = chosen(material, problem.free);
  for (std::size_t i = 0; i < list.size(); ++i)
    if (list[i].value) *list[i].value = p[static_cast<Eigen::Index>(i)];
  TiedNumbers(material, problem.ties).follow();
  return material;
}

// Bounds, typical sizes and periods of the parameters. Moduli are linear if the stress state is
// imposed: the energy is a sum of moduli times functions of the deformation.
LeastSquares least_squares_problem(const FitProblem& problem) {
  const auto model = std::make_shared<Model>(problem);
  const auto n = static_cast<Eigen::Index>(problem.free.size());
  LeastSquares q;
  q.residual = [model](const VecX& p, VecX& r) {
    return model->residual(p, r);
  };
  q.size = model->weight.cwiseProduct(model->stress).norm();
  q.lower.resize(n);
  q.upper.resize(n);
  q.typical.resize(n);
  q.start.resize(n);
  const bool linear = problem.dilatation == Dilatation::incompressible &&
                      std::all_of(problem.tests.begin(), problem.tests.end(),
                                  [&](const Test& t) { return imposed(t, problem.law); });
  const auto list = chosen(model->material, problem.free);
  for (Eigen::Index i = 0; i < n; ++i) {
    const FreeParameter& p = problem.free[static_cast<std::size_t>(i)];
    q.start[i] = p.start;
    q.lower[i] = p.lower;
    q.upper[i] = p.upper;
    const double width = p.upper - p.lower;
    double least_size = 0.1;
    if (std::isfinite(width)) least_size = 0.01 * width;
    q.typical[i] = std::max(std::abs(p.start), least_size);
    // every energy is a sum of moduli times functions of the rest
    q.linear.push_back(linear && list[static_cast<std::size_t>(i)].unit == std::string(unit::MPa));
    q.period.push_back(period(problem, p, list[static_cast<std::size_t>(i)].unit));
    q.lower[i] -= q.period.back();
    q.upper[i] += q.period.back();
  }
  if (problem.further) return with_further(std::move(q), problem.further);
  return q;
}

namespace {

// q: the problem under white noise; e: its residuals at the point that sets the size
LeastSquares under_noise(const LeastSquares& q, const FitProblem& problem, const NoiseModel& noise,
                         const VecX& e) {
  const Standardizer by = standardizer(problem, noise);
  LeastSquares whitened = standardized(q, by);
  whitened.size = by.size(e);
  return whitened;
}

// Parameters and noise of largest likelihood, of one kind of noise.
struct Likeliest {
  NoiseModel noise;
  LeastSquaresResult best;
  double minus_two_log_likelihood = std::numeric_limits<double>::infinity();
};

// Alternates between the parameters for known noise and the noise for known parameters. Both lower
// -2 ln L, and the two hardly depend on each other: a few rounds suffice.
Likeliest alternate(const FitProblem& problem, const LeastSquares& q, const VecX& from,
                    NoiseModel noise, const LeastSquaresOptions& options) {
  constexpr int rounds = 40;
  Likeliest found;
  VecX p = from;
  VecX e;
  if (!q.residual(p, e)) return found;
  const VecX measured = weighted_stress(problem);
  const std::vector<Eigen::Index> curves = curve_sizes(problem);
  const std::vector<bool> rest = values_at_rest(problem.tests);
  for (int round = 0; round < rounds; ++round) {
    LeastSquares u = under_noise(q, problem, noise, e);
    u.start = p;
    found.best = search(problem, u, options);
    if (!std::isfinite(found.best.cost) || !q.residual(found.best.p, e)) return {};
    p = found.best.p;
    found.noise = noise;
    const double before = found.minus_two_log_likelihood;
    found.minus_two_log_likelihood = minus_two_log_likelihood(found.best.r);
    noise = most_likely_noise(e, measured, curves, rest, noise.kind);
    const bool same = std::abs(noise.rho - found.noise.rho) < 1e-9 &&
                      std::abs(noise.share - found.noise.share) < 1e-9 * (1 - noise.share);
    if (same || std::abs(before - found.minus_two_log_likelihood) < 1e-10) break;
  }
  return found;
}

// of several starts the one of largest likelihood; one without an optimum only where there is no
// other
void keep_likelier(Likeliest& best, Likeliest other) {
  // two optima that differ by rounding, as at angles of either sign: the first stays
  constexpr double rounding = 1e-6;
  const bool likelier = other.minus_two_log_likelihood < best.minus_two_log_likelihood - rounding;
  const bool better = other.best.converged && (likelier || !best.best.converged);
  const bool none_converged = !other.best.converged && !best.best.converged && likelier;
  if (better || none_converged) best = std::move(other);
}

// The most general noise model that a kind allows.
NoiseModel largest_noise(const FitProblem& problem, NoiseKind kind) {
  NoiseModel noise;
  noise.kind = kind;
  if (noise.correlated()) noise.rho = largest_correlation(curve_sizes(problem));
  return noise;
}

// from one set of parameters: with the noise that its residuals show, and with the largest
// correlation, where a law that misses the curves may have an optimum of its own
Likeliest likeliest_from(const FitProblem& problem, const LeastSquares& q, const VecX& p,
                         NoiseKind kind, const LeastSquaresOptions& options) {
  VecX e;
  if (!q.residual(p, e)) return {};
  const NoiseModel shown = most_likely_noise(e, weighted_stress(problem), curve_sizes(problem),
                                             values_at_rest(problem.tests), kind);
  Likeliest best = alternate(problem, q, p, shown, options);
  const NoiseModel largest = largest_noise(problem, kind);
  if (largest.rho > 0) keep_likelier(best, alternate(problem, q, p, largest, options));
  return best;
}

// other optima of least squares that the starts found, the lowest first
std::vector<VecX> other_optima(const FitResult& fit, const LeastSquares& q) {
  constexpr std::size_t most = 3;
  const Eigen::Index n = fit.best.p.size();
  std::vector<Eigen::Index> order;
  for (Eigen::Index k = 0; k < fit.starts.rows(); ++k)
    if (std::isfinite(fit.starts(k, n))) order.push_back(k);
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return fit.starts(a, n) < fit.starts(b, n);
  });
  std::vector<VecX> others;
  const auto apart = [&](const VecX& a, const VecX& b) {
    double largest = 0;
    for (Eigen::Index i = 0; i < n; ++i)
      largest = std::max(largest, std::abs(difference(q, i, a[i], b[i])) / q.typical[i]);
    return largest > 1e-3;
  };
  for (const Eigen::Index k : order) {
    const VecX p = fit.starts.row(k).head(n).transpose();
    bool known = !apart(p, fit.best.p);
    for (const VecX& other : others) known = known || !apart(p, other);
    if (!known) others.push_back(p);
    if (others.size() == most) break;
  }
  return others;
}

// The kinds of noise that may be chosen, those that contain others last.
std::vector<NoiseKind> kinds_of(NoiseKind asked) {
  if (asked != NoiseKind::automatic) return {asked};
  return {NoiseKind::proportional, NoiseKind::autoregressive, NoiseKind::both};
}

// Replaces the least squares of `fit` by the largest likelihood of the noise that was asked for;
// of several kinds by the one of lowest AICc.
void choose_noise(const FitProblem& problem, const LeastSquares& q, const FitOptions& options,
                  FitResult& fit) {
  std::vector<Likeliest> found;
  Likeliest white;
  white.best = fit.best;
  white.minus_two_log_likelihood = minus_two_log_likelihood(fit.best.r);
  for (const NoiseKind kind : kinds_of(problem.noise)) {
    Likeliest best = likeliest_from(problem, q, fit.best.p, kind, options.least_squares);
    // a kind that contains others is no less likely than they are
    for (const Likeliest& inner : found) {
      if (kind != NoiseKind::both || !inner.best.converged) continue;
      NoiseModel begin = inner.noise;
      begin.kind = kind;
      keep_likelier(best, alternate(problem, q, inner.best.p, begin, options.least_squares));
    }
    found.push_back(std::move(best));
  }
  const bool choose = problem.noise == NoiseKind::automatic;
  std::size_t chosen = 0;
  if (choose) found.insert(found.begin(), white);
  for (std::size_t k = 0; k < found.size(); ++k) {
    const double value = aicc(found[k].minus_two_log_likelihood, problem, found[k].noise);
    fit.noise_candidates.push_back({found[k].noise, found[k].minus_two_log_likelihood, value});
    if (k > 0 && found[k].best.converged && value < fit.noise_candidates[chosen].aicc) chosen = k;
  }
  Likeliest best = std::move(found[chosen]);
  if (best.noise.is_white()) return;
  for (const VecX& p : other_optima(fit, q))
    keep_likelier(best, likeliest_from(problem, q, p, best.noise.kind, options.least_squares));
  fit.noise_candidates[chosen] = {best.noise, best.minus_two_log_likelihood,
                                  aicc(best.minus_two_log_likelihood, problem, best.noise)};
  if (best.best.r.size() == 0) {
    fit.best.converged = false;
    fit.best.why = "the likelihood of the noise asked for has no maximum that was found";
    return;
  }
  fit.noise_model = best.noise;
  fit.best = std::move(best.best);
}

// Data that the law follows to 1e-4 have no noise that a load cell resolves.
bool has_noise(const LeastSquaresResult& best, double size) {
  const auto freedom = static_cast<double>(best.r.size() - best.p.size());
  const double mean_square = size * size / static_cast<double>(best.r.size());
  return freedom > 0 && 2 * best.cost > 1e-8 * mean_square * freedom;
}

}  // namespace

LeastSquares likelihood_problem(const FitProblem& problem, const FitResult& fit) {
  LeastSquares q = least_squares_problem(problem);
  if (fit.noise_model.is_white()) return q;
  return under_noise(q, problem, fit.noise_model, fit.residual);
}

LeastSquaresResult fit_from(const FitProblem& problem, const VecX& start,
                            const LeastSquaresOptions& options) {
  LeastSquares q = least_squares_problem(problem);
  q.start = start;
  return search(problem, q, options);
}

// Searches from the given start and from random places, then alternates between noise and
// parameters.
FitResult fit(const FitProblem& problem, const FitOptions& options) {
  std::size_t values = 0;
  if (problem.further) {
    values = static_cast<std::size_t>(problem.further->measured().size());
  }
  double largest = 0;
  if (problem.further) largest = problem.further->measured().cwiseAbs().maxCoeff();
  for (const Test& test : problem.tests) {
    values += test.values();
    largest = std::max(largest, largest_stress(test));
  }
  if (values < problem.free.size())
    throw Failure(Exit::input, {{},
                                "curve",
                                fmt::format("{} points in the fitted range", values),
                                fmt::format("as many as there are parameters ({}) at least",
                                            problem.free.size()),
                                ""});
  if (!(largest > 0))
    throw Failure(Exit::input,
                  {{}, "curve", "no stress but zero", "a curve of a stressed specimen", ""});

  LeastSquares q = least_squares_problem(problem);
  const Eigen::Index n = q.start.size();
  FitResult fit;
  fit.starts.resize(options.starts, n + 1);
  std::mt19937_64 rng(options.seed);
  const VecX given = q.start;
  Material law = problem.law;
  const std::vector<MaterialParameter> numbers = chosen(law, problem.free);
  double lowest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < options.starts; ++k) {
    for (Eigen::Index i = 0; i < n; ++i) {
      if (k == 0) {
        q.start[i] = given[i];
      } else {
        const auto at = static_cast<std::size_t>(i);
        q.start[i] = drawn_start(problem.free[at], numbers[at], uniform(rng));
      }
    }
    LeastSquaresResult one = search(problem, q, options.least_squares);
    fit.starts.row(k) << one.p.transpose(), one.cost;
    // two starts at the same optimum differ by rounding: the first stays
    if (k == 0 || one.cost < lowest * (1 - 1e-9) - 1e-30 * q.size * q.size) {
      lowest = one.cost;
      fit.best = std::move(one);
    }
  }
  q.start = given;
  const bool noisy = fit.best.converged && has_noise(fit.best, q.size);
  if (problem.noise != NoiseKind::white && !problem.further && noisy)
    choose_noise(problem, q, options, fit);
  fit.material = with_parameters(problem, fit.best.p);
  if (std::isfinite(fit.best.cost)) {
    fit.residual = fit.best.r;
    if (!fit.noise_model.is_white() && !q.residual(fit.best.p, fit.residual))
      throw std::logic_error("no model at an optimum");
    set_covariance(problem, likelihood_problem(problem, fit), fit);
    const VecX stress = measured_stress(problem.tests);
    fit.model = stress + fit.residual.head(stress.size()).cwiseQuotient(weights(problem.tests));
    if (const auto& more = problem.further)
      fit.further = more->measured() +
                    fit.residual.tail(more->measured().size()).cwiseQuotient(more->weight());
    set_quality(problem, fit);
  }
  return fit;
}

}  // namespace langer
