#include "identification/fit/residual_noise.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/no_number.hpp"
#include "core/base/student.hpp"
#include "core/tensor/dense.hpp"

namespace langer {

namespace {

using Curves = std::vector<Eigen::Index>;

// The transpose of the linear map innovations().
MatX transposed_innovations(const MatX& A, const Curves& curves, double rho) {
  MatX B = A;
  Eigen::Index at = 0;
  for (Eigen::Index n : curves) {
    if (n > 0) B.row(at) *= std::sqrt(1 - rho * rho);
    for (Eigen::Index i = 1; i < n; ++i) B.row(at + i - 1) -= rho * A.row(at + i);
    at += n;
  }
  return B;
}

// v^T R v for the correlation matrix R_ij = rho^|i-j| within a curve, in one pass: the sum over j <
// i is kept in `before`.
double correlated_square(const VecX& v, const Curves& curves, double rho) {
  double sum = 0;
  Eigen::Index at = 0;
  for (Eigen::Index n : curves) {
    double before = 0;  // sum of rho^(i-j) v_j over j < i
    for (Eigen::Index i = 0; i < n; ++i) {
      sum += v[at + i] * (v[at + i] + 2 * before);
      before = rho * (before + v[at + i]);
    }
    at += n;
  }
  return sum;
}

// R A without forming R: one recursion forwards and one backwards along each curve.
MatX correlated(const MatX& A, const Curves& curves, double rho) {
  MatX forward = A;
  MatX backward = A;
  Eigen::Index at = 0;
  for (Eigen::Index n : curves) {
    for (Eigen::Index i = 1; i < n; ++i) forward.row(at + i) += rho * forward.row(at + i - 1);
    for (Eigen::Index i = n - 2; i >= 0; --i)
      backward.row(at + i) += rho * backward.row(at + i + 1);
    at += n;
  }
  return forward + backward - A;
}

// v^T V v for a deviation of 1. Residuals that are innovations already (removed > 0) are taken back
// to the values first.
double correlated_square(const VecX& v, const ResidualNoise& noise, double rho) {
  if (noise.removed == 0) return correlated_square(v, noise.curves, rho);
  const VecX back = transposed_innovations(v, noise.curves, noise.removed);
  return correlated_square(back, noise.curves, rho) / (1 - rho * rho);
}

// V A for a deviation of 1, see above.
MatX correlated(const MatX& A, const ResidualNoise& noise) {
  if (noise.removed == 0) return correlated(A, noise.curves, noise.rho);
  const MatX back = transposed_innovations(A, noise.curves, noise.removed);
  return innovations(correlated(back, noise.curves, noise.rho), noise.curves, noise.removed) /
         (1 - noise.rho * noise.rho);
}

// An orthonormal basis of the column space of J. Columns are scaled first, so that the rank does
// not depend on units.
MatX column_space(const MatX& J) {
  if (J.cols() == 0) return J;
  MatX scaled = J;
  for (Eigen::Index j = 0; j < J.cols(); ++j)
    if (const double n = J.col(j).norm(); n > 0) scaled.col(j) /= n;
  const Svd of = svd(scaled);
  Eigen::Index rank = 0;
  while (rank < of.values.size() && of.values[rank] > 1e-10 * of.values[0]) ++rank;
  return of.U.leftCols(rank);
}

// The restricted likelihood (REML) at one correlation, and the deviation that maximises it there.
struct Restricted {
  double rho, log_likelihood, deviation;
};

// log L = -1/2 ((m - k) log s^2 + log det(W^T W) - log det R), with W the innovations of U and s^2
// the variance of what the parameters cannot explain. U (m, k): orthonormal basis of the columns of
// J.
Restricted restricted(const VecX& r, const MatX& U, const Curves& curves, double rho) {
  const auto free = static_cast<double>(r.size() - U.cols());
  const MatX W = innovations(U, curves, rho);
  const VecX y = innovations(r, curves, rho);
  double rest = y.squaredNorm();
  double log_volume = 0;
  if (U.cols() > 0) {
    const Qr qr(W);
    const VecX z = qr.Q_transposed_times(y);
    rest = z.tail(r.size() - U.cols()).squaredNorm();
    log_volume = 2 * qr.R().diagonal().cwiseAbs().array().log().sum();
  }
  const double variance = rest / free;  // of the innovations
  const double curves_log = static_cast<double>(curves.size()) * std::log1p(-rho * rho);
  return {rho, -0.5 * (free * std::log(variance) + log_volume - curves_log),
          std::sqrt(variance / (1 - rho * rho))};
}

// The place of the largest value of f on [0, high]: a grid that is finer towards high, where
// correlations of smooth residuals are, then a golden section search.
template <class F>
double highest(F f, double high) {
  constexpr int steps = 40;
  const auto at = [&](int k) {
    return 1 - std::pow(1 - high, static_cast<double>(k) / steps);
  };
  int best = 0;
  double value = f(0.);
  for (int k = 1; k <= steps; ++k)
    if (const double x = f(at(k)); x > value) {
      value = x;
      best = k;
    }
  double a = at(std::max(0, best - 1));
  double b = at(std::min(steps, best + 1));
  constexpr double golden = 0.6180339887498949;
  for (int k = 0; k < 40 && b - a > 1e-9; ++k) {
    const double c = b - golden * (b - a);
    const double d = a + golden * (b - a);
    if (f(c) >= f(d)) {
      b = d;
    } else {
      a = c;
    }
  }
  const double inside = 0.5 * (a + b);
  if (f(inside) > value) return inside;
  return at(best);
}

// The number of independent values with the same information about a mean: n / (1 + 2 sum (1 - k/n)
// rho^k) for each curve.
double effective_values(const Curves& curves, double rho) {
  double sum = 0;
  for (Eigen::Index n : curves) {
    double factor = 1, power = 1;
    for (Eigen::Index k = 1; k < n && power > 1e-17; ++k) {
      power *= rho;
      factor += 2 * (1 - static_cast<double>(k) / static_cast<double>(n)) * power;
    }
    sum += static_cast<double>(n) / factor;
  }
  return sum;
}

// The part of a column that is orthogonal to the columns of U. Two passes keep it orthogonal in
// spite of rounding.
VecX beyond(const MatX& U, const VecX& column) {
  VecX v = column;
  for (int pass = 0; pass < 2 && U.cols() > 0; ++pass) v -= U * (U.transpose() * v);
  return v;
}

// The columns of J that are not left out, without column `but`.
MatX chosen_columns(const MatX& J, const std::vector<bool>& left_out, Eigen::Index but = -1) {
  std::vector<Eigen::Index> in;
  for (Eigen::Index i = 0; i < J.cols(); ++i)
    if (!left_out[static_cast<std::size_t>(i)] && i != but) in.push_back(i);
  return J(Eigen::all, in);
}

// Sets the correlation, its deviation and the variance of the estimated correlation, which is the
// inverse curvature of the restricted likelihood. Neighbouring correlations serve as differences in
// along(). U (m, k): orthonormal basis of the columns of J.
void set_correlation(const VecX& r, const MatX& U, double rho, ResidualNoise& noise) {
  const Restricted best = restricted(r, U, noise.curves, rho);
  noise.rho = rho;
  noise.deviation = best.deviation;
  noise.effective = effective_values(noise.curves, rho);
  const double h = std::min(0.02, 0.3 * (1 - rho));
  const Restricted below = restricted(r, U, noise.curves, std::max(0., rho - h));
  const Restricted above = restricted(r, U, noise.curves, rho + h);
  const double curvature =
      -(above.log_likelihood - 2 * best.log_likelihood + below.log_likelihood) / (h * h);
  const double most = 1 - rho * rho;
  noise.rho_variance = most;
  if (curvature > 0) noise.rho_variance = std::min(1 / curvature, most);
  noise.below = {below.rho, below.deviation};
  noise.above = {above.rho, above.deviation};
}

}  // namespace

MatX innovations(const MatX& A, const std::vector<Eigen::Index>& curves, double rho) {
  MatX B = A;
  Eigen::Index at = 0;
  for (Eigen::Index n : curves) {
    if (n > 0) B.row(at) *= std::sqrt(1 - rho * rho);
    for (Eigen::Index i = 1; i < n; ++i) B.row(at + i) -= rho * A.row(at + i - 1);
    at += n;
  }
  return B;
}

VecX from_innovations(const VecX& u, const std::vector<Eigen::Index>& curves, double rho) {
  VecX z = u;
  Eigen::Index at = 0;
  for (Eigen::Index n : curves) {
    if (n > 0) z[at] /= std::sqrt(1 - rho * rho);
    for (Eigen::Index i = 1; i < n; ++i) z[at + i] += rho * z[at + i - 1];
    at += n;
  }
  return z;
}

double largest_correlation(const std::vector<Eigen::Index>& curves) {
  Eigen::Index longest = 2;
  for (Eigen::Index n : curves) longest = std::max(longest, n);
  return 1 - 1 / static_cast<double>(longest);
}

double most_likely_correlation(const VecX& z, const std::vector<Eigen::Index>& curves) {
  // the sum of squares of the innovations is a parabola in rho
  double first = 0;    // z_i^2 at the beginnings of curves
  double later = 0;    // z_i^2 of the others
  double before = 0;   // z_(i-1)^2 of those
  double product = 0;  // z_i z_(i-1)
  Eigen::Index at = 0;
  for (Eigen::Index n : curves) {
    if (n > 0) first += z[at] * z[at];
    for (Eigen::Index i = at + 1; i < at + n; ++i) {
      later += z[i] * z[i];
      before += z[i - 1] * z[i - 1];
      product += z[i] * z[i - 1];
    }
    at += n;
  }
  const auto count = static_cast<double>(z.size());
  const auto likelihood = [&](double rho) {
    const double square = (1 - rho * rho) * first + later - 2 * rho * product + rho * rho * before;
    const double least = std::numeric_limits<double>::min();
    return static_cast<double>(curves.size()) * std::log1p(-rho * rho) -
           count * std::log(std::max(square, least));
  };
  const double limit = largest_correlation(curves);
  const double rho = highest(likelihood, limit);
  // the search ends within 1e-9 of a limit that it cannot reach
  if (likelihood(limit) >= likelihood(rho)) return limit;
  return rho;
}

ResidualNoise white_noise(double deviation, Eigen::Index values) {
  ResidualNoise noise;
  noise.curves = {values};
  noise.white = deviation;
  noise.effective = static_cast<double>(values);
  return noise;
}

ResidualNoise residual_noise(const VecX& r, const MatX& J, const std::vector<Eigen::Index>& curves,
                             double size) {
  ResidualNoise noise;
  noise.curves = curves;
  noise.effective = static_cast<double>(r.size());
  const MatX U = column_space(J);
  const Eigen::Index free = r.size() - U.cols();
  if (free <= 0) return noise;
  noise.freedom = static_cast<double>(free);
  noise.deviation = r.norm() / std::sqrt(noise.freedom);
  if (free < 3 || noise.deviation <= 1e-4 * size) return noise;
  const auto likelihood = [&](double rho) {
    return restricted(r, U, curves, rho).log_likelihood;
  };
  const double rho = highest(likelihood, largest_correlation(curves));
  if (2 * (likelihood(rho) - likelihood(0)) < 2.706) return noise;
  set_correlation(r, U, rho, noise);
  return noise;
}

ResidualNoise innovation_noise(const VecX& z, const MatX& J,
                               const std::vector<Eigen::Index>& curves, double removed,
                               double scale) {
  ResidualNoise noise;
  noise.curves = curves;
  noise.removed = removed;
  noise.effective = static_cast<double>(z.size());
  const MatX U = column_space(J);
  const Eigen::Index free = z.size() - U.cols();
  if (free <= 0) return noise;
  noise.freedom = static_cast<double>(free);
  const auto likelihood = [&](double rho) {
    return restricted(z, U, curves, rho).log_likelihood;
  };
  set_correlation(z, U, highest(likelihood, largest_correlation(curves)), noise);
  // the deviation of the innovations, in units of u
  const auto of_innovations = [&](double rho, double deviation) {
    return scale * deviation * std::sqrt(1 - rho * rho);
  };
  noise.deviation = of_innovations(noise.rho, noise.deviation);
  noise.below.deviation = of_innovations(noise.below.rho, noise.below.deviation);
  noise.above.deviation = of_innovations(noise.above.rho, noise.above.deviation);
  return noise;
}

ResidualNoise with_least(ResidualNoise noise, double least) {
  if (least > noise.deviation)
    noise.white = std::sqrt((least - noise.deviation) * (least + noise.deviation));
  return noise;
}

NoiseAlong along(const ResidualNoise& noise, const VecX& direction) {
  const auto shown = [&](double rho, double deviation) {
    return deviation * deviation * correlated_square(direction, noise, rho);
  };
  const double square = shown(noise.rho, noise.deviation);
  const double variance = square + noise.white * noise.white * direction.squaredNorm();
  if (!(square > 0) || std::isinf(noise.freedom)) return {variance, inf};
  double relative = 2 / noise.freedom;
  if (noise.above.rho > noise.below.rho) {
    const double slope = std::log(shown(noise.above.rho, noise.above.deviation) /
                                  shown(noise.below.rho, noise.below.deviation)) /
                         (noise.above.rho - noise.below.rho);
    relative += slope * slope * noise.rho_variance;
  }
  const double part = square / variance;
  return {variance, 2 / (relative * part * part)};
}

MatX covariance(const MatX& J, const std::vector<bool>& left_out, const ResidualNoise& noise) {
  const Eigen::Index n = J.cols();
  MatX cov = MatX::Constant(n, n, nan);
  std::vector<Eigen::Index> in;
  for (Eigen::Index i = 0; i < n; ++i)
    if (!left_out[static_cast<std::size_t>(i)] && J.col(i).norm() > 0) in.push_back(i);
  const auto k = static_cast<Eigen::Index>(in.size());
  if (k == 0 || J.rows() == 0) return cov;
  MatX A = J(Eigen::all, in);
  const VecX norms = A.colwise().norm().transpose();
  A = A * norms.cwiseInverse().asDiagonal();
  const Svd of = svd(A);
  const VecX& sv = of.values;
  // columns are known to about 1e-11 (differences of fourth order): a smaller singular value is not
  // distinguishable from 0
  const double smallest = 1e-10 * sv[0];
  VecX inverse = VecX::Zero(sv.size());
  VecX undetermined = VecX::Ones(k);
  for (Eigen::Index c = 0; c < sv.size(); ++c)
    if (sv[c] > smallest) {
      inverse[c] = 1 / sv[c];
      undetermined -= of.V.col(c).cwiseAbs2();
    }
  const MatX P = of.U * inverse.asDiagonal() * of.V.transpose();  // (m, k): parameters are P^T e
  const MatX VP =
      noise.deviation * noise.deviation * correlated(P, noise) + noise.white * noise.white * P;
  const MatX all = P.transpose() * VP;
  for (Eigen::Index a = 0; a < k; ++a)
    for (Eigen::Index b = 0; b < k; ++b)
      if (undetermined[a] < 1e-6 && undetermined[b] < 1e-6)
        cov(in[static_cast<std::size_t>(a)], in[static_cast<std::size_t>(b)]) =
            0.5 * (all(a, b) + all(b, a)) / (norms[a] * norms[b]);
  return cov;
}

VecX interval_factors(const MatX& columns, const std::vector<bool>& left_out,
                      const ResidualNoise& noise) {
  VecX factors = VecX::Ones(columns.cols());
  const double total = noise.total();
  if (!(total > 0)) return factors;
  for (Eigen::Index i = 0; i < columns.cols(); ++i) {
    // The direction in the residuals that only this parameter can explain decides which noise it
    // feels.
    const VecX own = beyond(column_space(chosen_columns(columns, left_out, i)), columns.col(i));
    const double size = own.norm();
    if (!(size > 1e-12 * columns.col(i).norm())) continue;
    const NoiseAlong felt = along(noise, own / size);
    factors[i] = student_95(felt.freedom) / student_95(inf) * std::sqrt(felt.variance) / total;
  }
  return factors;
}

double minus_two_log_likelihood(const VecX& r, const std::vector<Eigen::Index>& curves,
                                double rho) {
  const auto n = static_cast<double>(r.size());
  const double rest =
      std::max(innovations(r, curves, rho).squaredNorm(), std::numeric_limits<double>::min());
  return n * std::log(rest / n) - static_cast<double>(curves.size()) * std::log1p(-rho * rho);
}

}  // namespace langer
