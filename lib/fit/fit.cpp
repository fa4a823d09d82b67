#include "fit/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <stdexcept>

#include "base/error.hpp"

namespace langer {

namespace {

// in [0, 1), the same on every platform
double uniform(std::mt19937_64& rng) { return static_cast<double>(rng() >> 11) * 0x1p-53; }

std::vector<MaterialParameter> chosen(Material& material, const std::vector<FreeParameter>& free) {
  const std::vector<MaterialParameter> all = parameters(material);
  std::vector<MaterialParameter> list;
  for (const FreeParameter& p : free) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.key == p.key; });
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

  explicit Model(const FitProblem& problem)
      : material(problem.law),
        tests(problem.tests),
        dilatation(problem.dilatation),
        stress(measured_stress(problem.tests)),
        weight(weights(problem.tests)) {
    for (const MaterialParameter& p : chosen(material, problem.free)) numbers.push_back(p.value);
  }
  Model(const Model&) = delete;

  bool residual(const VecX& p, VecX& r) {
    for (std::size_t i = 0; i < numbers.size(); ++i) *numbers[i] = p[static_cast<Eigen::Index>(i)];
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
  return test.kind == TestKind::simple_shear || (test.kind != TestKind::uniaxial && test.shear == OffAxisShear::held);
}

FitQuality quality(const VecX& model, const VecX& stress, double largest) {
  FitQuality q;
  const VecX error = model - stress;
  const double spread = (stress.array() - stress.mean()).matrix().squaredNorm();
  q.r2 = spread > 0 ? 1 - error.squaredNorm() / spread : std::numeric_limits<double>::quiet_NaN();
  q.mean_error_percent = q.max_error_percent = std::numeric_limits<double>::quiet_NaN();
  if (largest > 0)
    q.mean_error_percent = 100 * error.cwiseAbs().mean() / largest, q.max_error_percent = 100 * error.cwiseAbs().maxCoeff() / largest;
  return q;
}

void judge(const FitProblem& problem, FitResult& fit) {
  const VecX stress = measured_stress(problem.tests);
  const auto n = static_cast<double>(stress.size()), k = static_cast<double>(problem.free.size()) + 1;
  fit.quality = quality(fit.model, stress, 1);
  fit.quality.mean_error_percent = fit.quality.max_error_percent = 0;
  Eigen::Index at = 0, stressed = 0;
  for (const Test& test : problem.tests) {
    const auto m = static_cast<Eigen::Index>(test.values());
    const double largest = largest_stress(test);
    const FitQuality q = quality(fit.model.segment(at, m), stress.segment(at, m), largest);
    fit.of_test.push_back(q);
    at += m;
    if (!(largest > 0)) continue;
    fit.quality.mean_error_percent += q.mean_error_percent * static_cast<double>(m);
    fit.quality.max_error_percent = std::max(fit.quality.max_error_percent, q.max_error_percent);
    stressed += m;
  }
  fit.quality.mean_error_percent /= static_cast<double>(stressed);
  const double spread = n * std::log(std::max(2 * fit.best.cost, std::numeric_limits<double>::min()) / n);
  fit.quality.aicc = n > k + 1 ? spread + 2 * k + 2 * k * (k + 1) / (n - k - 1) : std::numeric_limits<double>::quiet_NaN();
  fit.quality.bic = spread + k * std::log(n);
}

}  // namespace

bool model_stress(const Material& material, const Test& test, Dilatation dilatation, double* stress) {
  if (dilatation == Dilatation::compressible) {
    std::vector<double> strain(test.first);
    for (double& e : strain) e -= 1;
    const auto sigma = uniaxial_curve(material, strain, test.measure, dilatation);
    if (sigma) std::copy(sigma->begin(), sigma->end(), stress);
    return sigma.has_value();
  }
  const std::vector<Vec3> a = specimen_fibres(material, test.fibre_angle_deg);
  for (std::size_t i = 0; i < test.points(); ++i) {
    const PlaneState state =
        plane_state(material, a, test.kind, test.first[i], test.second.empty() ? 1 : test.second[i], test.shear);
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
    for (const auto* list : {&test.stress_x, &test.stress_z}) all.insert(all.end(), list->begin(), list->end());
  return Eigen::Map<const VecX>(all.data(), static_cast<Eigen::Index>(all.size()));
}

VecX weights(const std::vector<Test>& tests) {
  std::vector<double> all;
  for (const Test& test : tests) all.insert(all.end(), test.values(), test.weight);
  return Eigen::Map<const VecX>(all.data(), static_cast<Eigen::Index>(all.size()));
}

Material with_parameters(const FitProblem& problem, const VecX& p) {
  Material material = problem.law;
  const auto list = chosen(material, problem.free);
  for (std::size_t i = 0; i < list.size(); ++i) *list[i].value = p[static_cast<Eigen::Index>(i)];
  return material;
}

LeastSquares least_squares_problem(const FitProblem& problem) {
  const auto model = std::make_shared<Model>(problem);
  const auto n = static_cast<Eigen::Index>(problem.free.size());
  LeastSquares q;
  q.residual = [model](const VecX& p, VecX& r) { return model->residual(p, r); };
  q.size = model->weight.cwiseProduct(model->stress).norm();
  q.lower.resize(n), q.upper.resize(n), q.typical.resize(n), q.start.resize(n);
  const bool linear =
      problem.dilatation == Dilatation::incompressible &&
      std::all_of(problem.tests.begin(), problem.tests.end(), [&](const Test& t) { return imposed(t, problem.law); });
  const auto list = chosen(model->material, problem.free);
  for (Eigen::Index i = 0; i < n; ++i) {
    const FreeParameter& p = problem.free[static_cast<std::size_t>(i)];
    q.start[i] = p.start, q.lower[i] = p.lower, q.upper[i] = p.upper;
    const double width = p.upper - p.lower;
    q.typical[i] = std::max(std::abs(p.start), std::isfinite(width) ? 0.01 * width : 0.1);
    // every energy is a sum of moduli times functions of the rest
    q.linear.push_back(linear && list[static_cast<std::size_t>(i)].unit == std::string(unit::MPa));
  }
  return q;
}

LeastSquaresResult fit_from(const FitProblem& problem, const VecX& start, const LeastSquaresOptions& options) {
  LeastSquares q = least_squares_problem(problem);
  q.start = start;
  return least_squares(q, options);
}

FitResult fit(const FitProblem& problem, const FitOptions& options) {
  std::size_t values = 0;
  double largest = 0;
  for (const Test& test : problem.tests) values += test.values(), largest = std::max(largest, largest_stress(test));
  if (values < problem.free.size())
    throw Failure(Exit::input, {{},
                                "curve",
                                fmt::format("{} points in the fitted range", values),
                                fmt::format("as many as there are parameters ({}) at least", problem.free.size()),
                                ""});
  if (!(largest > 0)) throw Failure(Exit::input, {{}, "curve", "no stress but zero", "a curve of a stressed specimen", ""});

  LeastSquares q = least_squares_problem(problem);
  const Eigen::Index n = q.start.size();
  FitResult fit;
  fit.starts.resize(options.starts, n + 1);
  std::mt19937_64 rng(options.seed);
  const VecX given = q.start;
  double lowest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < options.starts; ++k) {
    for (Eigen::Index i = 0; i < n; ++i) q.start[i] = k == 0 ? given[i] : q.lower[i] + uniform(rng) * (q.upper[i] - q.lower[i]);
    LeastSquaresResult one = least_squares(q, options.least_squares);
    fit.starts.row(k) << one.p.transpose(), one.cost;
    // two starts at the same optimum differ by rounding: the first stays
    if (k == 0 || one.cost < lowest * (1 - 1e-9) - 1e-30 * q.size * q.size) {
      lowest = one.cost;
      fit.best = std::move(one);
    }
  }
  fit.material = with_parameters(problem, fit.best.p);
  if (std::isfinite(fit.best.cost)) {
    fit.covariance = covariance(fit.best);
    fit.model = measured_stress(problem.tests) + fit.best.r.cwiseQuotient(weights(problem.tests));
    judge(problem, fit);
  }
  return fit;
}

}  // namespace langer
