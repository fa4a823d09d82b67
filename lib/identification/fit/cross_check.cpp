#include "identification/fit/cross_check.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlopt.hpp>

#include "identification/fit/periodic.hpp"

namespace langer {

namespace {

// The sum of squares as NLopt sees it. It keeps the best point of all evaluations, because the
// searches may end elsewhere.
struct Objective {
  LeastSquares q;
  double scale;  // cost of the data: NLopt sees numbers of order one
  VecX best;
  double lowest = std::numeric_limits<double>::infinity();

  double operator()(const std::vector<double>& x, std::vector<double>& gradient) {
    const VecX p = Eigen::Map<const VecX>(x.data(), static_cast<Eigen::Index>(x.size()));
    VecX r;
    MatX J;
    const bool exists =
        q.residual(p, r) && r.allFinite() && (gradient.empty() || jacobian(q, p, J));
    // A point without a model has a large cost and no gradient: the searches turn away from it.
    double f = 1e6;
    if (exists) f = 0.5 * r.squaredNorm() / scale;
    for (std::size_t i = 0; i < gradient.size(); ++i) {
      if (exists) {
        gradient[i] = J.col(static_cast<Eigen::Index>(i)).dot(r) / scale;
      } else {
        gradient[i] = 0;
      }
    }
    if (exists && f < lowest) {
      lowest = f;
      best = p;
    }
    return f;
  }
};

// NLopt takes a function pointer and an untyped argument.
double objective(const std::vector<double>& x, std::vector<double>& gradient, void* self) {
  return (*static_cast<Objective*>(self))(x, gradient);
}

}  // namespace

Comparison cross_check(const FitProblem& problem, const LeastSquaresResult& first, unsigned seed,
                       int evaluations) {
  return cross_check(least_squares_problem(problem), first, seed, evaluations);
}

Comparison cross_check(const LeastSquares& problem, const LeastSquaresResult& first, unsigned seed,
                       int evaluations) {
  Objective f;
  f.q = problem;
  f.scale = 0.5 * f.q.size * f.q.size;
  const auto n = static_cast<unsigned>(f.q.start.size());
  const auto list = [](const VecX& v) {
    return std::vector<double>(v.begin(), v.end());
  };
  const auto configured = [&](nlopt::algorithm algorithm, int most) {
    nlopt::opt o(algorithm, n);
    o.set_lower_bounds(list(f.q.lower));
    o.set_upper_bounds(list(f.q.upper));
    o.set_min_objective(objective, &f);
    o.set_ftol_rel(1e-13);
    o.set_xtol_rel(1e-12);
    o.set_maxeval(most);
    return o;
  };
  const auto search = [&](nlopt::opt o, const VecX& from) {
    std::vector<double> x = list(from);
    double value = 0;
    try {
      o.optimize(x, value);
    } catch (const std::exception&) {
      // rounding stops SLSQP with an exception; the best point seen is kept all the same
    }
  };
  // First a global search by multistart, then two rounds of a simplex search and a gradient search
  // from the best point so far.
  nlopt::srand(seed + 1);
  nlopt::opt multistart = configured(nlopt::GN_MLSL_LDS, evaluations / 4);
  multistart.set_local_optimizer(configured(nlopt::LD_SLSQP, 300));
  multistart.set_population(4);
  search(multistart, f.q.start);
  if (f.best.size() == 0) f.best = f.q.start;
  for (int round = 0; round < 2; ++round) {
    search(configured(nlopt::LN_SBPLX, evaluations / 4), f.best);
    search(configured(nlopt::LD_SLSQP, 300), f.best);
  }

  // Costs agree within 1e-4 of themselves, or within the rounding of an exact fit.
  Comparison c;
  c.p = f.best;
  c.cost = f.lowest * f.scale;
  const double allowed = 1e-4 * std::min(c.cost, first.cost) + 1e-10 * f.scale;
  const double higher = c.cost - first.cost;
  c.agrees = std::abs(higher) <= allowed;
  // The largest relative difference of a parameter between the two optima.
  double apart = 0;
  for (Eigen::Index i = 0; i < c.p.size(); ++i)
    apart = std::max(apart, std::abs(difference(f.q, i, first.p[i], c.p[i])) /
                                std::max(std::abs(first.p[i]), f.q.typical[i]));
  std::string same;
  if (apart < 1e-2) {
    same = fmt::format("parameters equal within {:.0e}", apart);
  } else {
    same = "with other parameters: these tests cannot decide between the two";
  }
  if (c.agrees) {
    c.text = fmt::format("NLopt agrees: cost {:.9g} and {:.9g}, {}", c.cost, first.cost, same);
  } else if (higher < 0) {
    c.text =
        fmt::format("NLopt finds a lower cost, {:.9g} instead of {:.9g}: more starts are needed",
                    c.cost, first.cost);
  } else {
    c.text = fmt::format(
        "NLopt ends at a higher cost, {:.9g} instead of {:.9g}: it does not confirm the fit",
        c.cost, first.cost);
  }
  return c;
}

}  // namespace langer
