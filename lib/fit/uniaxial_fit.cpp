#include "fit/uniaxial_fit.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <random>

#include "base/error.hpp"

namespace langer {

namespace {

// in [0, 1), the same on every platform
double uniform(std::mt19937_64& rng) { return static_cast<double>(rng() >> 11) * 0x1p-53; }

double largest(const std::vector<double>& stress) {
  double s = 0;
  for (double x : stress) s = std::max(s, std::abs(x));
  return s;
}

// The law with pointers to the numbers that vary.
struct Model {
  Material material;
  std::vector<double*> numbers;

  Model(const Material& law, const std::vector<FreeParameter>& free) : material(law) {
    const std::vector<MaterialParameter> all = parameters(material);
    for (const FreeParameter& p : free) {
      const auto found = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.key == p.key; });
      if (found == all.end()) throw std::logic_error("the law has no parameter " + p.key);
      numbers.push_back(found->value);
    }
  }
  Model(const Model&) = delete;

  void set(const VecX& p) {
    for (std::size_t i = 0; i < numbers.size(); ++i) *numbers[i] = p[static_cast<Eigen::Index>(i)];
  }
};

}  // namespace

CurveError curve_error(const std::vector<double>& model, const std::vector<double>& stress) {
  CurveError e;
  for (std::size_t i = 0; i < stress.size(); ++i) {
    const double percent = 100 * std::abs(model[i] - stress[i]) / largest(stress);
    e.mean_percent += percent / static_cast<double>(stress.size());
    e.max_percent = std::max(e.max_percent, percent);
  }
  return e;
}

UniaxialFit fit_uniaxial(const Curve& curve, const Material& law, const std::vector<FreeParameter>& free,
                         const UniaxialFitOptions& options) {
  const auto n = static_cast<Eigen::Index>(free.size()), m = static_cast<Eigen::Index>(curve.size());
  if (m < n)
    throw Failure(Exit::input, {{},
                                "curve",
                                fmt::format("{} points in the fitted range", m),
                                fmt::format("as many as there are parameters ({}) at least", n),
                                ""});
  const double size = largest(curve.stress);
  if (!(size > 0)) throw Failure(Exit::input, {{}, "curve", "no stress but zero", "a curve of a stressed specimen", ""});

  Model model(law, free);
  const Eigen::Map<const VecX> stress(curve.stress.data(), m);
  LeastSquares problem;
  problem.residual = [&](const VecX& p, VecX& r) {
    model.set(p);
    const auto sigma = uniaxial_curve(model.material, curve.strain, curve.measure, options.dilatation);
    if (!sigma) return false;
    r = Eigen::Map<const VecX>(sigma->data(), m) - stress;
    return true;
  };
  problem.size = stress.norm();
  problem.lower.resize(n), problem.upper.resize(n), problem.typical.resize(n), problem.start.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const FreeParameter& p = free[static_cast<std::size_t>(i)];
    problem.start[i] = p.start, problem.lower[i] = p.lower, problem.upper[i] = p.upper;
    problem.typical[i] = std::max(std::abs(p.start), 0.01 * (p.upper - p.lower));
  }

  UniaxialFit fit;
  fit.starts.resize(options.starts, n + 1);
  std::mt19937_64 rng(options.seed);
  const VecX given = problem.start;
  double lowest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < options.starts; ++k) {
    for (Eigen::Index i = 0; i < n; ++i)
      problem.start[i] = k == 0 ? given[i] : problem.lower[i] + uniform(rng) * (problem.upper[i] - problem.lower[i]);
    LeastSquaresResult one = least_squares(problem, options.least_squares);
    fit.starts.row(k) << one.p.transpose(), one.cost;
    // two starts at the same optimum differ by rounding: the first stays
    if (k == 0 || one.cost < lowest * (1 - 1e-9) - 1e-30 * problem.size * problem.size) {
      lowest = one.cost;
      fit.best = std::move(one);
    }
  }
  model.set(fit.best.p);
  fit.material = model.material;
  if (std::isfinite(fit.best.cost)) {
    fit.covariance = covariance(fit.best);
    for (Eigen::Index i = 0; i < m; ++i) fit.model.push_back(stress[i] + fit.best.r[i]);
    const CurveError e = curve_error(fit.model, curve.stress);
    fit.mean_error_percent = e.mean_percent, fit.max_error_percent = e.max_percent;
  }
  return fit;
}

}  // namespace langer
