#include "identification/fit/identifiability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/in_order.hpp"
#include "core/base/no_number.hpp"
#include "core/base/quantile.hpp"
#include "core/base/random.hpp"
#include "core/tensor/dense.hpp"
#include "identification/fit/periodic.hpp"

namespace langer {

namespace {

// The problem with parameter `held` fixed at x: the others remain.
struct ReducedProblem {
  LeastSquares rest;
  ReducedProblem(const LeastSquares& all, Eigen::Index held, double x, const VecX& start) {
    const auto n = start.size();
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0; i < n; ++i)
      if (i != held) free.push_back(i);
    const auto part = [&](const VecX& v) {
      VecX w(n - 1);
      for (Eigen::Index i = 0; i < n - 1; ++i) w[i] = v[free[static_cast<std::size_t>(i)]];
      return w;
    };
    rest.start = part(start);
    rest.lower = part(all.lower);
    rest.upper = part(all.upper);
    rest.typical = part(all.typical);
    rest.size = all.size;
    if (!all.linear.empty())
      for (Eigen::Index i : free) rest.linear.push_back(all.linear[static_cast<std::size_t>(i)]);
    if (!all.period.empty())
      for (Eigen::Index i : free) rest.period.push_back(all.period[static_cast<std::size_t>(i)]);
    rest.residual = [&all, free, held, x, n](const VecX& q, VecX& r) {
      VecX p(n);
      p[held] = x;
      for (Eigen::Index i = 0; i < n - 1; ++i) p[free[static_cast<std::size_t>(i)]] = q[i];
      return all.residual(p, r);
    };
    if (!all.cheap_slope) return;
    rest.cheap_slope = true;
    rest.slope = [&all, free, held, x, n](const VecX& q, MatX& J) {
      VecX p(n);
      p[held] = x;
      for (Eigen::Index i = 0; i < n - 1; ++i) p[free[static_cast<std::size_t>(i)]] = q[i];
      MatX J_all;
      if (!all.slope(p, J_all)) return false;
      J = J_all(Eigen::all, free);
      return true;
    };
  }
};

struct Point {
  double x, rise;
  VecX p;
};

// chi-square above `chi_min` at x, others optimal, searched from the neighbour `from`
Point profile_point(const LeastSquares& q, Eigen::Index i, double x, const VecX& from,
                    double chi_min, double noise) {
  Point point{x, inf, from};
  point.p[i] = x;
  double chi = inf;
  if (from.size() == 1) {
    VecX r;
    if (q.residual(point.p, r) && r.allFinite()) chi = r.squaredNorm();
  } else {
    const ReducedProblem held(q, i, x, from);
    LeastSquaresOptions enough;
    enough.iterations = 60;
    enough.kkt = 1e-9;
    const LeastSquaresResult found = least_squares(held.rest, enough);
    chi = 2 * found.cost;
    for (Eigen::Index k = 0, j = 0; k < from.size(); ++k)
      if (k != i) point.p[k] = found.p[j++];
  }
  point.rise = (chi - chi_min) / (noise * noise);
  return point;
}

// Walks from the optimum to one side until the rise passes the limit; then the place where it does.
void walk(Profile& profile, const LeastSquares& q, Eigen::Index i, const VecX& best, double error,
          double chi_min, double noise, double limit, int side) {
  const double half = 0.5 * q.period_of(i);
  double bound = 0;
  if (half > 0) {
    bound = best[i] + side * half;
  } else if (side < 0) {
    bound = q.lower[i];
  } else {
    bound = q.upper[i];
  }
  const double room = std::abs(bound - best[i]);
  double& end = side < 0 ? profile.low : profile.high;
  bool& open = side < 0 ? profile.low_open : profile.high_open;
  double step = 0;
  if (std::isfinite(error) && error > 0) {
    step = 0.5 * error;
  } else {
    double width = q.upper[i] - q.lower[i];
    if (half > 0) width = half;
    step = 0.02 * width;
  }
  Point last{best[i], 0, best};
  const double root = std::sqrt(limit);
  for (int n = 0; n < 40; ++n) {
    const double left = std::abs(bound - last.x);
    if (left <= 1e-12 * (room + std::abs(bound))) break;
    double x = 0;
    if (step >= left) {
      x = bound;
    } else {
      x = last.x + side * step;
    }
    // the others start where the last two points lead
    Point next = profile_point(q, i, x, last.p, chi_min, noise);
    profile.value.push_back(next.x);
    profile.rise.push_back(next.rise);
    if (next.rise >= limit) {
      Point in = last;
      Point out = next;
      for (int k = 0; k < 25 && std::abs(out.x - in.x) > 1e-4 * std::abs(out.x - best[i]); ++k) {
        // the root of the rise is nearly linear
        const double a = std::sqrt(std::max(in.rise, 0.));
        double b = 0;
        if (std::isfinite(out.rise)) {
          b = std::sqrt(out.rise);
        } else {
          b = 2 * root;
        }
        double t = 0.5;
        if (b > a) t = (root - a) / (b - a);
        if (k % 3 == 2 || !std::isfinite(out.rise)) t = 0.5;
        const Point middle = profile_point(q, i, in.x + std::clamp(t, 0.05, 0.95) * (out.x - in.x),
                                           in.p, chi_min, noise);
        if (middle.rise < limit) {
          in = middle;
        } else {
          out = middle;
        }
        if (std::abs(middle.rise - limit) < 1e-4 * limit) {
          in = middle;
          break;
        }
      }
      profile.value.push_back(in.x);
      profile.rise.push_back(in.rise);
      end = in.x;
      open = false;
      return;
    }
    // slow rises take longer steps
    const double gained = std::sqrt(std::max(next.rise, 0.)) - std::sqrt(std::max(last.rise, 0.));
    if (gained < 0.15 * root) step *= 2;
    last = next;
  }
  end = last.x;
  open = true;
}

}  // namespace

// The rise of chi-square if one parameter is held at a value and the others are fitted.
double profile_rise(const LeastSquares& problem, Eigen::Index parameter, double value,
                    const VecX& best, double noise) {
  VecX r;
  if (!problem.residual(best, r)) return inf;
  return profile_point(problem, parameter, value, best, r.squaredNorm(), noise).rise;
}

// Sizes of the parameters; for a parameter at zero its period or the width of its box.
VecX sizes_of(const LeastSquares& problem, const VecX& p) {
  VecX size = p.cwiseAbs();
  for (Eigen::Index i = 0; i < p.size(); ++i)
    if (size[i] == 0) {
      if (problem.period_of(i) > 0) {
        size[i] = problem.period_of(i);
      } else {
        size[i] = problem.upper[i] - problem.lower[i];
      }
    }
  return size;
}

// Covariance, correlations and the singular value decomposition of J diag(size)/noise.
Identifiability identifiability(const MatX& J, const VecX& p, const VecX& size,
                                const std::vector<bool>& left_out, const ResidualNoise& noise) {
  Identifiability s;
  const auto n = p.size();
  s.noise = noise.total();
  s.size = size;
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < n; ++i)
    if (!left_out[static_cast<std::size_t>(i)]) free.push_back(i);
  const auto k = static_cast<Eigen::Index>(free.size());
  MatX A(J.rows(), k);
  for (Eigen::Index j = 0; j < k; ++j)
    A.col(j) = J.col(free[static_cast<std::size_t>(j)]) * size[free[static_cast<std::size_t>(j)]] /
               s.noise;
  s.error = s.correlation_worst = VecX::Constant(n, nan);
  s.covariance = s.correlation = MatX::Constant(n, n, nan);
  s.combination = MatX::Zero(n, k);
  if (k == 0) return s;
  const Svd of = svd(A);
  s.singular = VecX::Zero(k);
  s.singular.head(of.values.size()) = of.values;
  MatX V = MatX::Zero(k, k);
  V.leftCols(of.V.cols()) = of.V;
  // A combination and its negative are the same: the largest part is made positive.
  for (Eigen::Index c = 0; c < k; ++c) {
    Eigen::Index at = 0;
    V.col(c).cwiseAbs().maxCoeff(&at);
    if (V(at, c) < 0) V.col(c) *= -1;
  }
  for (Eigen::Index j = 0; j < k; ++j)
    s.combination.row(free[static_cast<std::size_t>(j)]) = V.row(j);
  s.covariance = covariance(J, left_out, noise);
  for (Eigen::Index i : free) s.error[i] = std::sqrt(s.covariance(i, i));
  for (Eigen::Index i : free)
    for (Eigen::Index j : free) {
      if (i == j) {
        s.correlation(i, j) = 1;
      } else {
        s.correlation(i, j) = s.covariance(i, j) / (s.error[i] * s.error[j]);
      }
      if (i != j && !std::islessequal(std::abs(s.correlation(i, j)),
                                      s.correlation_worst[i]))  // of NaN too, without a trap
        s.correlation_worst[i] = std::abs(s.correlation(i, j));
    }
  return s;
}

// Names the combination of parameters that the data determine least.
std::string sloppy_words(const Identifiability& s, const std::vector<std::string>& names,
                         Eigen::Index which) {
  const VecX v = s.combination.col(which);
  const double largest = v.cwiseAbs().maxCoeff();
  const double sigma = s.singular[which];
  // one standard deviation in all, or the whole size where even that is not felt
  double scale = 1;
  if (sigma > 1e-6) scale = 1 / sigma;
  std::vector<std::string> parts;
  for (Eigen::Index i = 0; i < v.size(); ++i)
    if (std::abs(v[i]) > 0.05 * largest)
      parts.push_back(
          fmt::format("{} {:+.3g} %", names[static_cast<std::size_t>(i)], 100 * scale * v[i]));
  std::string how = "alone";
  if (parts.size() > 1) how = "together";
  std::string size = "1 standard deviation";
  if (!(sigma > 1e-6)) size = fmt::format("{:.2g} standard deviations", sigma);
  return fmt::format("{} {} move the data by {} of the noise in all", fmt::join(parts, ", "), how,
                     size);
}

// The profile of one parameter, to both sides.
Profile profile(const LeastSquares& problem, Eigen::Index parameter, const VecX& best, double error,
                double noise, double limit) {
  VecX r;
  Profile both;
  if (!problem.residual(best, r)) return both;
  for (int side : {-1, 1})
    walk(both, problem, parameter, best, error, r.squaredNorm(), noise, limit, side);
  return both;
}

// Profiles of all parameters; each side is one job of the threads.
std::vector<Profile> profiles(const ProblemMaker& maker, const VecX& best, const VecX& error,
                              double noise, const ProfileOptions& options) {
  const auto n = static_cast<int>(best.size());
  const auto jobs = 2 * n;
  const int threads = std::clamp(options.threads, 1, std::max(1, jobs));
  std::vector<LeastSquares> problem;
  for (int t = 0; t < threads; ++t) problem.push_back(maker());
  std::vector<Profile> sides(static_cast<std::size_t>(jobs));
  VecX r;
  problem[0].residual(best, r);
  const double chi_min = r.squaredNorm();
  in_order(
      threads, jobs,
      [&](int worker, int job) {
        double factor = 1;
        if (options.factor.size() > 0) factor = options.factor[job / 2];
        const int side = 2 * (job % 2) - 1;  // even jobs go down, odd jobs up
        walk(sides[static_cast<std::size_t>(job)], problem[static_cast<std::size_t>(worker)],
             job / 2, best, error[job / 2], chi_min, noise * factor, options.limit, side);
      },
      [&](int, int job) {
        if (options.progress) options.progress((job + 1.) / jobs);
      });
  std::vector<Profile> all;
  for (int i = 0; i < n; ++i) {
    const Profile &down = sides[static_cast<std::size_t>(2 * i)],
                  &up = sides[static_cast<std::size_t>(2 * i + 1)];
    Profile one;
    std::vector<std::pair<double, double>> points{{best[i], 0}};
    for (const Profile* side : {&down, &up})
      for (std::size_t k = 0; k < side->value.size(); ++k)
        points.push_back({side->value[k], side->rise[k]});
    std::sort(points.begin(), points.end());
    for (const auto& [x, rise] : points) {
      one.value.push_back(x);
      one.rise.push_back(rise);
    }
    one.low = down.low;
    one.low_open = down.low_open;
    one.high = up.high;
    one.high_open = up.high_open;
    all.push_back(std::move(one));
  }
  return all;
}

namespace {

// Draws residuals like those of the fit. z are the residuals before a correlation was taken out.
class Residuals {
 public:
  Residuals(const VecX& r, const ResidualNoise& noise, double growth)
      : noise_(noise), innovation_(innovations(correlated(r), noise.curves, noise.rho)) {
    innovation_.array() -= innovation_.mean();
    const double size = innovation_.norm() / std::sqrt(static_cast<double>(r.size()));
    double deviation = noise.deviation;
    if (noise.removed == 0) deviation *= std::sqrt(1 - noise.rho * noise.rho);
    if (size > 0) innovation_ *= growth * deviation / size;
    if (noise.rho > 0) {
      block_ = static_cast<Eigen::Index>(std::ceil(std::cbrt(static_cast<double>(r.size()))));
    } else {
      block_ = 1;
    }
  }

  VecX draw(Random& random) const {
    const Eigen::Index m = innovation_.size();
    VecX e(m);
    Eigen::Index at = 0, from = 0, left = 0;
    for (Eigen::Index n : noise_.curves) {
      for (Eigen::Index i = 0; i < n; ++i, ++at, ++from, --left) {
        if (left == 0) {
          left = block_;
          from = static_cast<Eigen::Index>(random.below(static_cast<std::uint64_t>(m)));
        }
        const double u = innovation_[from % m];
        if (i == 0) {
          e[at] = u / std::sqrt(1 - noise_.rho * noise_.rho);
        } else {
          e[at] = noise_.rho * e[at - 1] + u;
        }
      }
    }
    if (noise_.removed > 0) e = innovations(e, noise_.curves, noise_.removed);
    if (noise_.white > 0)
      for (double& x : e) x += noise_.white * random.normal();
    return e;
  }

 private:
  VecX correlated(const VecX& r) const {
    if (noise_.removed > 0) return from_innovations(r, noise_.curves, noise_.removed);
    return r;
  }

  const ResidualNoise& noise_;  // before innovation_, whose beginning needs it
  VecX innovation_;
  Eigen::Index block_ = 1;
};

}  // namespace

// The factor by which the uncertainty of the noise itself widens each interval: Student's t at the
// degrees of freedom, against the normal distribution.
VecX growth_of_intervals(const MatX& columns, const std::vector<bool>& left_out,
                         const ResidualNoise& noise) {
  ResidualNoise known = noise;
  known.freedom = inf;
  return interval_factors(columns, left_out, noise)
      .cwiseQuotient(interval_factors(columns, left_out, known));
}

// Residual bootstrap: fits to model values with resampled residuals. Quantiles are spread about the
// estimate by the factor of the interval.
Bootstrap bootstrap(const ProblemMaker& maker, const VecX& best, const ResidualNoise& noise,
                    const BootstrapOptions& options) {
  Bootstrap result;
  const int threads = std::clamp(options.threads, 1, std::max(1, options.samples));
  std::vector<LeastSquares> problem;
  for (int t = 0; t < threads; ++t) problem.push_back(maker());
  VecX r_best;
  problem[0].residual(best, r_best);
  const auto n = best.size();
  const Residuals residuals(r_best, noise, options.growth);
  std::vector<LeastSquaresResult> found(static_cast<std::size_t>(threads));
  std::vector<VecX> good;
  in_order(
      threads, options.samples,
      [&](int worker, int sample) {
        const auto w = static_cast<std::size_t>(worker);
        Random random(options.seed, static_cast<std::uint64_t>(sample));
        const VecX e = residuals.draw(random);
        LeastSquares q = problem[w];
        q.start = best;
        q.residual = [&, e](const VecX& p, VecX& r) {
          if (!problem[w].residual(p, r)) return false;
          r -= r_best + e;
          return true;
        };
        LeastSquaresOptions enough;
        enough.iterations = 100;
        enough.kkt = 1e-9;
        found[w] = least_squares(q, enough);
      },
      [&](int worker, int sample) {
        const LeastSquaresResult& one = found[static_cast<std::size_t>(worker)];
        // a sample that still creeps along a valley counts where it got to: its cost is right to
        // many digits
        if (std::isfinite(one.cost) && one.kkt <= 1e-4) {
          good.push_back(one.p);
          for (Eigen::Index j = 0; j < n; ++j)
            if (problem[0].period_of(j) > 0)
              good.back()[j] = best[j] + difference(problem[0], j, best[j], one.p[j]);
        } else {
          ++result.failed;
        }
        if (options.progress) options.progress((sample + 1.) / options.samples);
      });
  result.samples.resize(static_cast<Eigen::Index>(good.size()), n);
  for (std::size_t i = 0; i < good.size(); ++i)
    result.samples.row(static_cast<Eigen::Index>(i)) = good[i];
  result.low = result.high = VecX::Constant(n, nan);
  for (Eigen::Index j = 0; j < n && good.size() > 1; ++j) {
    std::vector<double> x(good.size());
    for (std::size_t i = 0; i < good.size(); ++i) x[i] = good[i][j];
    std::sort(x.begin(), x.end());
    double spread = 1;
    if (options.spread.size()) spread = options.spread[j];
    const auto spread_out = [&](double x) {
      const double far = best[j] + spread * (x - best[j]);
      return problem[0].period_of(j) > 0
                 ? far
                 : std::clamp(far, problem[0].lower[j], problem[0].upper[j]);
    };
    // samples that end at a bound or an axis of symmetry leave out an estimate that stopped a
    // rounding before it
    result.low[j] = std::min(spread_out(quantile(x, 0.025)), best[j]);
    result.high[j] = std::max(spread_out(quantile(x, 0.975)), best[j]);
  }
  return result;
}

}  // namespace langer
