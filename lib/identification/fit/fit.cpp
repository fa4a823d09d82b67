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
#include "identification/fit/periodic.hpp"

namespace langer {

namespace {

// in [0, 1), the same on every platform
double uniform(std::mt19937_64& rng) { return static_cast<double>(rng() >> 11) * 0x1p-53; }

std::vector<MaterialParameter> chosen(Material& material, const std::vector<FreeParameter>& free) {
  const std::vector<MaterialParameter> all = parameters(material);
  std::vector<MaterialParameter> list;
  for (const FreeParameter& p : free) {
    if (!p.of_law()) {
      list.push_back({p.key, p.name, p.unit, {}, nullptr});
      continue;
    }
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.key == p.key; });
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

  explicit Model(const FitProblem& problem)
      : material(problem.law),
        tests(problem.tests),
        dilatation(problem.dilatation),
        stress(measured_stress(problem.tests)),
        weight(weights(problem.tests)),
        tied(material, problem.ties) {
    for (const MaterialParameter& p : chosen(material, problem.free)) numbers.push_back(p.value);
  }
  Model(const Model&) = delete;

  bool residual(const VecX& p, VecX& r) {
    for (std::size_t i = 0; i < numbers.size(); ++i)
      if (numbers[i]) *numbers[i] = p[static_cast<Eigen::Index>(i)];
    tied.follow();
    r.resize(stress.size());
    Eigen::Index at = 0;
    for (const Test& test : tests) {
      if (!model_stress(material, test, dilatation, r.data() + at)) return false;
      at += static_cast<Eigen::Index>(test.values());
    }
    r = weight.cwiseProduct(r - stress);
    return true;
  }
};

// whether nothing of the state has to be found: then the stress is linear in every modulus
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

// One search, told within the box. An angle that turned as far as the wider box of the search
// allows goes on from there.
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

// where a search starts: exponents up to 100 act alike over most of such a box, so small ones are
// drawn more often
double drawn(const FreeParameter& p, double u) {
  const bool wide_exponent = p.key.ends_with(".c2") && p.upper - p.lower > 20;
  return p.lower + (wide_exponent ? u * u * u : u) * (p.upper - p.lower);
}

void know(const FitProblem& problem, const LeastSquares& q, FitResult& fit) {
  const LeastSquaresResult& best = fit.best;
  const double size = q.size / std::sqrt(static_cast<double>(best.r.size()));
  const std::vector<Eigen::Index> curves = curve_sizes(problem);
  const auto noise = [&] {
    std::vector<Eigen::Index> in;
    for (Eigen::Index i = 0; i < best.p.size(); ++i)
      if (!fit.left_out[static_cast<std::size_t>(i)]) in.push_back(i);
    const ResidualNoise shown = residual_noise(best.r, best.J(Eigen::all, in), curves, size);
    return problem.further ? with_least(shown, 1) : shown;
  };
  fit.left_out = best.at_bound;
  fit.noise = noise();
  std::vector<double> turn;
  Material law = problem.law;
  for (const MaterialParameter& p : chosen(law, problem.free))
    turn.push_back(p.unit == unit::deg ? 180 : 0);
  const SymmetricAngles found = symmetric_angles(q, best, fit.noise.total(), turn);
  fit.symmetric = found.at, fit.columns = found.columns;
  for (std::size_t i = 0; i < found.at.size(); ++i)
    if (found.at[i]) fit.left_out[i] = true;
  if (fit.left_out != best.at_bound) fit.noise = noise();
  fit.covariance =
      fit.noise.total() > 0 || std::isfinite(fit.noise.freedom)
          ? covariance(best.J, fit.left_out, fit.noise)
          : MatX::Constant(best.p.size(), best.p.size(), std::numeric_limits<double>::quiet_NaN());
}

FitQuality quality(const VecX& model, const VecX& stress, double largest) {
  FitQuality q;
  const VecX error = model - stress;
  const double spread = (stress.array() - stress.mean()).matrix().squaredNorm();
  q.r2 = spread > 0 ? 1 - error.squaredNorm() / spread : std::numeric_limits<double>::quiet_NaN();
  q.mean_error_percent = q.max_error_percent = std::numeric_limits<double>::quiet_NaN();
  if (largest > 0)
    q.mean_error_percent = 100 * error.cwiseAbs().mean() / largest,
    q.max_error_percent = 100 * error.cwiseAbs().maxCoeff() / largest;
  return q;
}

// errors of each test, and of all of them together
void judge_errors(const FitProblem& problem, const VecX& stress, FitResult& fit) {
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

// of values of several units: each curve about its own mean, weighted
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
  return spread > 0 ? 1 - fit.best.r.squaredNorm() / spread
                    : std::numeric_limits<double>::quiet_NaN();
}

void judge(const FitProblem& problem, FitResult& fit) {
  const VecX stress = measured_stress(problem.tests);
  const auto n = static_cast<double>(fit.best.r.size());
  if (problem.further)
    fit.quality.r2 = r2_of_all(problem, stress, fit);
  else
    fit.quality = quality(fit.model, stress, 1);
  fit.quality.mean_error_percent = fit.quality.max_error_percent = 0;
  judge_errors(problem, stress, fit);
  const bool correlated = fit.noise.rho > 0;
  const double spread =
      correlated
          ? minus_two_log_likelihood(fit.best.r, fit.noise)
          : n * std::log(std::max(2 * fit.best.cost, std::numeric_limits<double>::min()) / n);
  const double k = static_cast<double>(problem.free.size()) + (correlated ? 2 : 1),
               m = fit.noise.effective;
  fit.quality.aicc = m > k + 1 ? spread + 2 * k + 2 * k * (k + 1) / (m - k - 1)
                               : std::numeric_limits<double>::quiet_NaN();
  fit.quality.bic = spread + k * std::log(m);
}

// the residuals of further tests behind those of q, and the slope of all
LeastSquares with_further(LeastSquares q, const std::shared_ptr<FurtherTests>& further) {
  const auto tests = std::make_shared<const LeastSquares>(q);
  const VecX weight = further->weight(), target = weight.cwiseProduct(further->measured());
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
    const PointMemory memory =
        point ? point->begin(then ? points.time[i] - *then : 0) : PointMemory{};
    const PlaneState state = plane_state(material, a, test.kind, points.first[i],
                                         points.second.empty() ? 1 : points.second[i], test.shear,
                                         point ? &memory : nullptr);
    if (state.converged && point) point->accept(state.F), then = points.time[i];
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

VecX measured_stress(const std::vector<Test>& tests) {
  std::vector<double> all;
  for (const Test& test : tests)
    for (const auto* list : {&test.stress_x, &test.stress_z})
      all.insert(all.end(), list->begin(), list->end());
  return Eigen::Map<const VecX>(all.data(), static_cast<Eigen::Index>(all.size()));
}

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

Material with_parameters(const FitProblem& problem, const VecX& p) {
  Material material = problem.law;
  const auto list = chosen(material, problem.free);
  for (std::size_t i = 0; i < list.size(); ++i)
    if (list[i].value) *list[i].value = p[static_cast<Eigen::Index>(i)];
  TiedNumbers(material, problem.ties).follow();
  return material;
}

LeastSquares least_squares_problem(const FitProblem& problem) {
  const auto model = std::make_shared<Model>(problem);
  const auto n = static_cast<Eigen::Index>(problem.free.size());
  LeastSquares q;
  q.residual = [model](const VecX& p, VecX& r) {
    return model->residual(p, r);
  };
  q.size = model->weight.cwiseProduct(model->stress).norm();
  q.lower.resize(n), q.upper.resize(n), q.typical.resize(n), q.start.resize(n);
  const bool linear = problem.dilatation == Dilatation::incompressible &&
                      std::all_of(problem.tests.begin(), problem.tests.end(),
                                  [&](const Test& t) { return imposed(t, problem.law); });
  const auto list = chosen(model->material, problem.free);
  for (Eigen::Index i = 0; i < n; ++i) {
    const FreeParameter& p = problem.free[static_cast<std::size_t>(i)];
    q.start[i] = p.start, q.lower[i] = p.lower, q.upper[i] = p.upper;
    const double width = p.upper - p.lower;
    q.typical[i] = std::max(std::abs(p.start), std::isfinite(width) ? 0.01 * width : 0.1);
    // every energy is a sum of moduli times functions of the rest
    q.linear.push_back(linear && list[static_cast<std::size_t>(i)].unit == std::string(unit::MPa));
    q.period.push_back(period(problem, p, list[static_cast<std::size_t>(i)].unit));
    q.lower[i] -= q.period.back(), q.upper[i] += q.period.back();
  }
  return problem.further ? with_further(std::move(q), problem.further) : q;
}

LeastSquaresResult fit_from(const FitProblem& problem, const VecX& start,
                            const LeastSquaresOptions& options) {
  LeastSquares q = least_squares_problem(problem);
  q.start = start;
  return search(problem, q, options);
}

FitResult fit(const FitProblem& problem, const FitOptions& options) {
  std::size_t values =
      problem.further ? static_cast<std::size_t>(problem.further->measured().size()) : 0;
  double largest = problem.further ? problem.further->measured().cwiseAbs().maxCoeff() : 0;
  for (const Test& test : problem.tests)
    values += test.values(), largest = std::max(largest, largest_stress(test));
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
  double lowest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < options.starts; ++k) {
    for (Eigen::Index i = 0; i < n; ++i)
      q.start[i] =
          k == 0 ? given[i] : drawn(problem.free[static_cast<std::size_t>(i)], uniform(rng));
    LeastSquaresResult one = search(problem, q, options.least_squares);
    fit.starts.row(k) << one.p.transpose(), one.cost;
    // two starts at the same optimum differ by rounding: the first stays
    if (k == 0 || one.cost < lowest * (1 - 1e-9) - 1e-30 * q.size * q.size) {
      lowest = one.cost;
      fit.best = std::move(one);
    }
  }
  fit.material = with_parameters(problem, fit.best.p);
  if (std::isfinite(fit.best.cost)) {
    know(problem, q, fit);
    const VecX stress = measured_stress(problem.tests);
    fit.model = stress + fit.best.r.head(stress.size()).cwiseQuotient(weights(problem.tests));
    if (const auto& more = problem.further)
      fit.further =
          more->measured() + fit.best.r.tail(more->measured().size()).cwiseQuotient(more->weight());
    judge(problem, fit);
  }
  return fit;
}

}  // namespace langer
