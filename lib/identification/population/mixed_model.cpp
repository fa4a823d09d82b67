#include "identification/population/mixed_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/in_order.hpp"
#include "core/base/random.hpp"
#include "core/tensor/dense.hpp"
#include "identification/posterior/nuts.hpp"

namespace langer {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// A specimen whose residuals were made linear: |u + J (phi - phi_i)|^2 = |R phi - c|^2 + rest.
struct Linear {
  MatX R;  // (min(m, q), q)
  VecX c;
  double rest = 0;
  double values = 0;  // m
};

// The model with mixed effects that is linear in phi. Its parameters are the entries of L, row by
// row, and ln sigma^2; beta follows from them.
class LinearMixed {
 public:
  LinearMixed(const std::vector<MixedSpecimen>& specimens, const std::vector<Eigen::Index>& random,
              bool full)
      : specimens_(specimens), random_(random) {
    const auto r = static_cast<Eigen::Index>(random.size());
    for (Eigen::Index i = 0; i < r; ++i) {
      for (Eigen::Index j = full ? 0 : i; j <= i; ++j) {
        entry_.push_back({i, j});
      }
    }
  }

  std::vector<Linear> data;
  VecX reference;  // beta where nothing is known of it

  Eigen::Index size() const { return static_cast<Eigen::Index>(entry_.size()) + 1; }
  Eigen::Index random_size() const { return static_cast<Eigen::Index>(random_.size()); }

  MatX factor(const VecX& x) const {
    MatX L = MatX::Zero(random_size(), random_size());
    for (std::size_t e = 0; e < entry_.size(); ++e) {
      L(entry_[e].row, entry_[e].column) = x[static_cast<Eigen::Index>(e)];
    }
    return L;
  }

  VecX parameters(const MatX& L, double sigma) const {
    VecX x(size());
    for (std::size_t e = 0; e < entry_.size(); ++e) {
      x[static_cast<Eigen::Index>(e)] = L(entry_[e].row, entry_[e].column);
    }
    x[size() - 1] = 2 * std::log(sigma);
    return x;
  }

  // d Omega / d of an entry of L
  MatX omega_slope(const MatX& L, std::size_t e) const {
    MatX slope = MatX::Zero(L.rows(), L.cols());
    const auto [row, column] = entry_[e];
    slope.row(row) += L.col(column).transpose();
    slope.col(row) += L.col(column);
    return slope;
  }

  struct Value {
    double minus_two_log_likelihood = std::numeric_limits<double>::infinity();
    VecX beta;
    MatX beta_information;
    VecX gradient;     // of -2 ln L
    MatX information;  // Fisher's, of ln L
    // of the determinant of beta's information: ln of it and its gradient, for restricted
    // likelihood
    double log_determinant = 0;
    VecX log_determinant_gradient;
  };

  Value at(const VecX& x, bool with_slopes) const {
    Value value;
    const MatX L = factor(x);
    const MatX omega = L * L.transpose();
    const double variance = std::exp(x[size() - 1]);
    const auto k = specimens_.front().design.cols();
    std::vector<Cholesky> factors;
    MatX normal = MatX::Zero(k, k);
    VecX right = VecX::Zero(k);
    double sum = 0;
    for (std::size_t i = 0; i < data.size(); ++i) {
      const Linear& one = data[i];
      const MatX Rr = one.R(Eigen::all, random_);
      MatX S = Rr * omega * Rr.transpose();
      S.diagonal().array() += variance;
      factors.emplace_back(S);
      if (!factors.back().positive_definite()) {
        return value;
      }
      const MatX X = one.R * specimens_[i].design;
      const MatX SX = factors.back().solve_columns(X);
      normal += X.transpose() * SX;
      right += SX.transpose() * one.c;
      const double left = one.values - static_cast<double>(one.c.size());
      sum += left * std::log(variance) + one.rest / variance +
             one.values * std::log(2 * std::numbers::pi);
      sum += factors.back().log_determinant();
    }
    // what the data say nothing of stays where it is
    value.beta = reference + LeastNorm(normal, 1e-10).solve(right - normal * reference);
    value.beta_information = normal;
    const auto r = random_size();
    MatX of_omega = MatX::Zero(r, r);
    double of_variance = 0;
    const std::size_t entries = entry_.size();
    std::vector<MatX> slopes;
    if (with_slopes) {
      value.information = MatX::Zero(size(), size());
      for (std::size_t e = 0; e < entries; ++e) {
        slopes.push_back(omega_slope(L, e));
      }
    }
    for (std::size_t i = 0; i < data.size(); ++i) {
      const Linear& one = data[i];
      const VecX d = one.c - one.R * (specimens_[i].design * value.beta);
      const VecX Sd = factors[i].solve(d);
      sum += d.dot(Sd);
      if (!with_slopes) {
        continue;
      }
      const auto n = one.c.size();
      const MatX inverse = factors[i].inverse();
      const MatX Rr = one.R(Eigen::all, random_);
      const MatX P = Rr.transpose() * inverse * Rr;
      const MatX Q = Rr.transpose() * inverse * inverse * Rr;
      const VecX g = Rr.transpose() * Sd;
      of_omega += P - g * g.transpose();
      const double left = one.values - static_cast<double>(n);
      of_variance += variance * (inverse.trace() - Sd.squaredNorm()) + left - one.rest / variance;
      add_information(P, Q, inverse, left, variance, slopes, value.information);
    }
    value.minus_two_log_likelihood = sum;
    if (with_slopes) {
      value.gradient.resize(size());
      for (std::size_t e = 0; e < entries; ++e) {
        value.gradient[static_cast<Eigen::Index>(e)] = (of_omega * slopes[e]).trace();
      }
      value.gradient[size() - 1] = of_variance;
    }
    return value;
  }

  // Adds ln |N| of the information N of beta, and with dS of a parameter
  //   d ln |N| = -tr(N^-1 X^T S^-1 dS S^-1 X)
  void add_log_determinant(const VecX& x, Value& value) const {
    const MatX L = factor(x);
    const MatX omega = L * L.transpose();
    const double variance = std::exp(x[size() - 1]);
    const Cholesky information(value.beta_information);
    value.log_determinant = information.log_determinant();
    value.log_determinant_gradient = VecX::Zero(size());
    MatX of_omega = MatX::Zero(random_size(), random_size());
    double of_variance = 0;
    for (std::size_t i = 0; i < data.size(); ++i) {
      const Linear& one = data[i];
      const MatX Rr = one.R(Eigen::all, random_);
      MatX S = Rr * omega * Rr.transpose();
      S.diagonal().array() += variance;
      const MatX M = Cholesky(S).solve_columns(one.R * specimens_[i].design);
      const MatX G = M * information.solve_columns(M.transpose());
      of_omega += Rr.transpose() * G * Rr;
      of_variance += variance * G.trace();
    }
    for (std::size_t e = 0; e < entry_.size(); ++e)
      value.log_determinant_gradient[static_cast<Eigen::Index>(e)] =
          -(of_omega * omega_slope(L, e)).trace();
    value.log_determinant_gradient[size() - 1] = -of_variance;
  }

  bool on_diagonal(std::size_t e) const { return entry_[e].row == entry_[e].column; }
  Eigen::Index row_of(std::size_t e) const { return entry_[e].row; }
  std::size_t entries() const { return entry_.size(); }
  // how many entries a row of L has up to its diagonal
  Eigen::Index row_entries(Eigen::Index row) const {
    return std::ranges::count_if(entry_, [row](const Entry& e) { return e.row == row; });
  }

  // The parameters of largest likelihood, from x on.
  VecX maximise(VecX x) const {
    double damping = 1e-3;
    Value now = at(x, true);
    if (!std::isfinite(now.minus_two_log_likelihood)) {
      return x;
    }
    for (int iteration = 0; iteration < 500; ++iteration) {
      MatX H = 2 * now.information;
      const double least = 1e-12 * H.diagonal().maxCoeff();
      H.diagonal() += damping * H.diagonal();
      H.diagonal().array() += least;
      const VecX step = -solve_symmetric(H, now.gradient);
      const double promised = -step.dot(now.gradient);
      Value next = at(x + step, true);
      if (next.minus_two_log_likelihood < now.minus_two_log_likelihood) {
        x += step;
        now = std::move(next);
        damping = std::max(1e-9, 0.3 * damping);
      } else {
        damping = std::max(1e-6, 10 * damping);
      }
      if (promised < 1e-11 || damping > 1e8) {
        break;
      }
    }
    return x;
  }

 private:
  struct Entry {
    Eigen::Index row, column;
  };

  // information of a pair of parameters: 1/2 tr(S^-1 dS_a S^-1 dS_b)
  void add_information(const MatX& P, const MatX& Q, const MatX& inverse, double left,
                       double variance, const std::vector<MatX>& slopes, MatX& sum) const {
    std::vector<MatX> turned;
    for (const MatX& slope : slopes) {
      turned.push_back(P * slope);
    }
    const auto last = size() - 1;
    for (Eigen::Index a = 0; a < last; ++a) {
      const MatX& first = turned[static_cast<std::size_t>(a)];
      for (Eigen::Index b = 0; b <= a; ++b) {
        const MatX& second = turned[static_cast<std::size_t>(b)];
        const double term = 0.5 * first.cwiseProduct(second.transpose()).sum();
        sum(a, b) += term;
        if (a != b) sum(b, a) += term;
      }
      const double cross =
          0.5 * variance * Q.cwiseProduct(slopes[static_cast<std::size_t>(a)]).sum();
      sum(a, last) += cross;
      sum(last, a) += cross;
    }
    sum(last, last) += 0.5 * (variance * variance * inverse.squaredNorm() + left);
  }

  const std::vector<MixedSpecimen>& specimens_;
  std::vector<Eigen::Index> random_;
  std::vector<Entry> entry_;
};

// The density of scatter and noise, beta integrated. The sampler sees the logarithms of the
// diagonal of L, its other entries over the deviation of the estimate, and ln sigma^2.
class ScatterDensity {
 public:
  ScatterDensity(const LinearMixed& model, const MatX& L)
      : model_(model), unit_(VecX::Ones(model.size())) {
    for (std::size_t e = 0; e < model.entries(); ++e)
      unit_[static_cast<Eigen::Index>(e)] = std::max(1e-9, L.row(model.row_of(e)).norm());
  }

  VecX parameters(const VecX& y) const {
    VecX x = y;
    for (std::size_t e = 0; e < model_.entries(); ++e) {
      const auto at = static_cast<Eigen::Index>(e);
      if (model_.on_diagonal(e)) x[at] = std::exp(y[at]);
      x[at] *= unit_[at];
    }
    return x;
  }

  VecX place(const VecX& x) const {
    VecX y = x;
    for (std::size_t e = 0; e < model_.entries(); ++e) {
      const auto at = static_cast<Eigen::Index>(e);
      y[at] = x[at] / unit_[at];
      if (model_.on_diagonal(e)) y[at] = std::log(std::max(1e-3, std::abs(y[at])));
    }
    return y;
  }

  double operator()(const VecX& y, VecX& gradient) const {
    const VecX x = parameters(y);
    gradient = VecX::Zero(y.size());
    const double never = -std::numeric_limits<double>::infinity();
    if (!x.allFinite()) return never;
    LinearMixed::Value value = model_.at(x, true);
    if (!std::isfinite(value.minus_two_log_likelihood)) return never;
    model_.add_log_determinant(x, value);
    double density = -0.5 * (value.minus_two_log_likelihood + value.log_determinant);
    gradient = -0.5 * (value.gradient + value.log_determinant_gradient);
    if (!std::isfinite(density) || !gradient.allFinite()) return never;
    const MatX L = model_.factor(x);
    for (std::size_t e = 0; e < model_.entries(); ++e) {
      // a row of n entries that has a uniform direction and a flat length has the density
      // |row|^(1-n)
      const auto at = static_cast<Eigen::Index>(e);
      const Eigen::Index row = model_.row_of(e);
      const double n = static_cast<double>(model_.row_entries(row));
      const double square = L.row(row).squaredNorm();
      gradient[at] += (1 - n) * x[at] / square;
      if (model_.on_diagonal(e)) {
        density += 0.5 * (1 - n) * std::log(square);
        gradient[at] *= x[at];
        density += y[at];
        gradient[at] += 1;
      } else {
        gradient[at] *= unit_[at];
      }
    }
    return density;
  }

  // covariance by Fisher's information, for the first steps of the sampler
  MatX scale(const VecX& y) const {
    const VecX x = parameters(y);
    MatX H = model_.at(x, true).information;
    VecX slope = unit_;
    for (std::size_t e = 0; e < model_.entries(); ++e)
      if (model_.on_diagonal(e))
        slope[static_cast<Eigen::Index>(e)] = x[static_cast<Eigen::Index>(e)];
    H = (slope.asDiagonal() * H * slope.asDiagonal()).eval();
    H.diagonal().array() += 0.25;
    return Cholesky(H).inverse();
  }

 private:
  const LinearMixed& model_;
  VecX unit_;
};

// The mode of one specimen: min over z of |u(centre + L z)|^2 / sigma^2 + |z|^2. False where the
// model has no state at the beginning.
bool find_mode(const MixedSpecimen& specimen, const VecX& centre, const MatX& spread, double sigma,
               VecX& z, double& cost) {
  VecX u;
  MatX J;
  if (!specimen.residual(centre + spread * z, u, &J)) {
    z.setZero();
    if (!specimen.residual(centre, u, &J)) {
      return false;
    }
  }
  const double weight = 1 / (sigma * sigma);
  cost = weight * u.squaredNorm() + z.squaredNorm();
  double damping = 1e-4;
  for (int iteration = 0; iteration < 100; ++iteration) {
    const MatX K = J * spread;
    const VecX gradient = weight * (K.transpose() * u) + z;
    MatX H = weight * (K.transpose() * K);
    H.diagonal().array() += 1;
    H.diagonal() += damping * H.diagonal();
    const VecX step = -solve_symmetric(H, gradient);
    VecX u_next;
    MatX J_next;
    const VecX z_next = z + step;
    const bool exists = specimen.residual(centre + spread * z_next, u_next, &J_next);
    double next = std::numeric_limits<double>::infinity();
    if (exists) {
      next = weight * u_next.squaredNorm() + z_next.squaredNorm();
    }
    const double promised = -step.dot(gradient);
    if (next <= cost) {
      z = z_next;
      u = u_next;
      J = J_next;
      cost = next;
      damping = std::max(1e-10, 0.1 * damping);
    } else {
      damping = std::max(1e-8, 10 * damping);
    }
    if (promised < 1e-13 * (1 + cost) || damping > 1e10) {
      break;
    }
  }
  return true;
}

// residuals that are linear at phi, as R and c
bool make_linear(const MixedSpecimen& specimen, const VecX& phi, Linear& one) {
  VecX u;
  MatX J;
  if (!specimen.residual(phi, u, &J) || !u.allFinite() || !J.allFinite()) {
    return false;
  }
  const VecX target = J * phi - u;
  const Qr qr(J);
  one.R = qr.R();
  one.c = qr.Q_transposed_times(target).head(one.R.rows());
  one.rest = std::max(0., target.squaredNorm() - one.c.squaredNorm());
  one.values = static_cast<double>(u.size());
  return true;
}

// What an information matrix tells of its parameters. Directions without information have no part
// in the covariance.
class Known {
 public:
  explicit Known(const MatX& information)
      : scale_(information.diagonal().cwiseAbs().cwiseMax(1e-300).cwiseSqrt().cwiseInverse()) {
    const SymmetricEigen eigen =
        symmetric_eigen(scale_.asDiagonal() * information * scale_.asDiagonal());
    vectors_ = eigen.vectors;
    inverse_ = (eigen.values.array() > 1e-10).select(eigen.values.cwiseInverse(), 0);
  }

  MatX covariance() const {
    const MatX inner = vectors_ * inverse_.asDiagonal() * vectors_.transpose();
    return scale_.asDiagonal() * inner * scale_.asDiagonal();
  }

  // Variance of a function with this gradient; infinite where a direction without information
  // changes it.
  double variance(const VecX& gradient) const {
    const VecX along = vectors_.transpose() * scale_.cwiseProduct(gradient);
    const double size = along.norm();
    double sum = 0;
    for (Eigen::Index i = 0; i < along.size(); ++i) {
      if (inverse_[i] > 0) {
        sum += along[i] * along[i] * inverse_[i];
      } else if (std::abs(along[i]) > 1e-6 * size) {
        return std::numeric_limits<double>::infinity();
      }
    }
    return sum;
  }

 private:
  VecX scale_, inverse_;
  MatX vectors_;
};

// The covariance of parameters with this information, with infinite variances where it is missing.
MatX covariance_of(const MatX& information) {
  const Known known(information);
  MatX C = known.covariance();
  for (Eigen::Index i = 0; i < C.rows(); ++i) C(i, i) = known.variance(VecX::Unit(C.rows(), i));
  return C;
}

// Errors of standard deviations and correlations, by the delta method from those of L.
void set_errors(const LinearMixed& model, const LinearMixed::Value& value, const MatX& L,
                const std::vector<Eigen::Index>& random, MixedResult& result) {
  const auto q = result.omega.rows();
  const auto last = model.size() - 1;
  const Known known(value.information);
  result.log_deviation_error = VecX::Constant(q, unknown);
  result.correlation_error = MatX::Constant(q, q, unknown);
  const MatX omega = L * L.transpose();
  std::vector<MatX> slopes;
  for (Eigen::Index e = 0; e < last; ++e) {
    slopes.push_back(model.omega_slope(L, static_cast<std::size_t>(e)));
  }
  const auto error_of = [&](const std::function<double(const MatX&)>& change) {
    VecX gradient = VecX::Zero(model.size());
    for (Eigen::Index e = 0; e < last; ++e) {
      gradient[e] = change(slopes[static_cast<std::size_t>(e)]);
    }
    return std::sqrt(known.variance(gradient));
  };
  const auto r = static_cast<Eigen::Index>(random.size());
  for (Eigen::Index i = 0; i < r; ++i) {
    const double variance = omega(i, i);
    if (!(variance > 0)) {
      continue;
    }
    const auto at_i = random[static_cast<std::size_t>(i)];
    result.log_deviation_error[at_i] =
        error_of([&](const MatX& change) { return 0.5 * change(i, i) / variance; });
    for (Eigen::Index j = 0; j < i; ++j) {
      const double other = omega(j, j);
      if (!(other > 0)) {
        continue;
      }
      const double root = std::sqrt(variance * other);
      const double rho = omega(i, j) / root;
      const double error = error_of([&](const MatX& change) {
        const double of_rho =
            change(i, j) / root - 0.5 * rho * (change(i, i) / variance + change(j, j) / other);
        return of_rho / std::max(1e-12, 1 - rho * rho);
      });
      const auto at_j = random[static_cast<std::size_t>(j)];
      result.correlation_error(at_i, at_j) = error;
      result.correlation_error(at_j, at_i) = error;
    }
  }
}

// Keeps deviations between specimens from growing by more than a factor of three at once, and
// below the largest that is believed in. Linear models are trusted no further.
VecX limited(const LinearMixed& model, const VecX& next, const MatX& L_before,
             const VecX& largest) {
  MatX L = model.factor(next);
  for (Eigen::Index j = 0; j < L.rows(); ++j) {
    const double deviation = L.row(j).norm();
    double most = 3 * L_before.row(j).norm() + 0.05;
    if (largest.size() > 0) most = std::min(most, largest[j]);
    if (deviation > most) L.row(j) *= most / deviation;
  }
  VecX x = model.parameters(L, 1);
  x[model.size() - 1] = next[model.size() - 1];
  return x;
}

struct Modes {
  std::vector<VecX> phi;
  double cost = 0;  // sum of |u|^2/sigma^2 + |z|^2
};

// The modes of all specimens for given population and scatter, from those of the round before.
// Returns which specimen has none; empty: each has one.
std::string find_modes(const std::vector<MixedSpecimen>& specimens, const LinearMixed& model,
                       const VecX& x, const std::vector<Eigen::Index>& random,
                       const MixedOptions& options, MixedResult& result, Modes& modes) {
  const auto n = specimens.size();
  const auto q = specimens.front().design.rows();
  const MatX L = model.factor(x);
  MatX spread = MatX::Zero(q, L.cols());
  spread(random, Eigen::all) = L;
  const double sigma = std::exp(0.5 * x[model.size() - 1]);
  const LeastNorm inverse(L);
  std::vector<char> exists(n, 1);
  result.b.resize(n);
  modes.phi.resize(n);
  std::vector<VecX> b(n);
  std::vector<double> cost(n, 0);
  in_order(
      options.threads, static_cast<int>(n),
      [&](int, int job) {
        const auto i = static_cast<std::size_t>(job);
        VecX z = VecX::Zero(L.cols());
        if (result.b[i].size() == q) z = inverse.solve(result.b[i](random));
        const VecX centre = specimens[i].design * result.beta;
        exists[i] = find_mode(specimens[i], centre, spread, sigma, z, cost[i]);
        b[i] = spread * z;
        modes.phi[i] = centre + b[i];
      },
      [](int, int) {});
  modes.cost = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!exists[i]) return "the model has no stress for specimen " + std::to_string(i + 1);
    modes.cost += cost[i];
  }
  result.b = b;
  return "";
}

// Moves beta along a step, halved until the cost of modes and scatter does not rise. `share`: of
// the step that was taken. Returns which specimen has no mode; empty: each has one.
std::string take_step(const std::vector<MixedSpecimen>& specimens, const LinearMixed& model,
                      const VecX& x, const std::vector<Eigen::Index>& random,
                      const MixedOptions& options, const VecX& step, MixedResult& result,
                      Modes& modes, double& share) {
  const std::string missing = find_modes(specimens, model, x, random, options, result, modes);
  if (!missing.empty()) return missing;
  const VecX beta = result.beta;
  const std::vector<VecX> b = result.b;
  share = 1;
  for (int halving = 0; halving < 12; ++halving, share *= 0.5) {
    Modes moved;
    result.beta = beta + share * step;
    const bool exist = find_modes(specimens, model, x, random, options, result, moved).empty();
    if (exist && moved.cost <= modes.cost * (1 + 1e-9)) {
      modes = moved;
      return "";
    }
    result.b = b;
  }
  result.beta = beta;
  share = 0;
  return "";
}

}  // namespace

MixedResult fit_mixed_model(const std::vector<MixedSpecimen>& specimens, const MixedState& start,
                            const MixedOptions& options) {
  const auto n = specimens.size();
  const auto q = specimens.front().design.rows();
  std::vector<Eigen::Index> random;
  for (Eigen::Index j = 0; j < q; ++j) {
    if (options.varies.empty() || options.varies[static_cast<std::size_t>(j)]) {
      random.push_back(j);
    }
  }
  const auto r = static_cast<Eigen::Index>(random.size());
  LinearMixed model(specimens, random, options.full);
  model.data.resize(n);

  MixedResult result;
  static_cast<MixedState&>(result) = start;
  const MatX omega_start = start.omega(random, random);
  MatX L = Cholesky(omega_start).L();
  if (!options.full) {
    L = omega_start.diagonal().cwiseSqrt().asDiagonal();
  }
  VecX x = model.parameters(L, start.sigma);
  LinearMixed::Value value;
  VecX largest;
  if (options.largest_deviation.size() > 0) largest = options.largest_deviation(random);
  Modes modes;
  result.why = find_modes(specimens, model, x, random, options, result, modes);
  if (!result.why.empty()) {
    return result;
  }

  for (result.rounds = 1; result.rounds <= options.rounds; ++result.rounds) {
    // The model that is linear at the modes.
    if (options.reweigh) {
      options.reweigh(modes.phi);
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (!make_linear(specimens[i], modes.phi[i], model.data[i])) {
        result.why = "the model has no derivative for specimen " + std::to_string(i + 1);
        return result;
      }
    }

    // Population, effects and variances of largest likelihood.
    model.reference = result.beta;
    VecX next = limited(model, model.maximise(x), L, largest);
    // a late oscillation between two sets of modes is damped
    if (result.rounds > 40) {
      next = 0.5 * (x + next);
    }
    value = model.at(next, true);
    if (!std::isfinite(value.minus_two_log_likelihood)) {
      result.why = "the likelihood of the linearised model is not finite";
      return result;
    }
    const MatX omega_before = L * L.transpose();
    const double variance_change = std::abs(next[model.size() - 1] - x[model.size() - 1]);
    x = next;
    L = model.factor(x);
    result.beta_covariance = covariance_of(value.beta_information);

    // The population goes to the minimum of the nonlinear model, as far as its cost falls.
    const VecX step = value.beta - result.beta;
    double share = 0;
    result.why = take_step(specimens, model, x, random, options, step, result, modes, share);
    if (!result.why.empty()) {
      return result;
    }
    const MatX omega = L * L.transpose();
    double change = std::max(variance_change, 1 - share);
    for (Eigen::Index j = 0; j < result.beta.size(); ++j) {
      const double error = std::sqrt(result.beta_covariance(j, j));
      change = std::max(change, std::abs(step[j]) / (error + 1e-300));
    }
    for (Eigen::Index i = 0; i < r; ++i) {
      for (Eigen::Index j = 0; j <= i; ++j) {
        // a variance that goes to zero changes by any share of itself: there that of the start
        // counts
        const double first = 1e-6 * std::sqrt(omega_start(i, i) * omega_start(j, j));
        const double size = std::sqrt(omega(i, i) * omega(j, j)) + first;
        change = std::max(change, std::abs(omega(i, j) - omega_before(i, j)) / size);
      }
    }
    if (change < options.tolerance) {
      result.converged = true;
      break;
    }
  }
  for (Eigen::Index j = 0; j < largest.size(); ++j) {
    if (L.row(j).norm() > 0.99 * largest[j]) {
      result.converged = false;
      result.unlimited.push_back(random[static_cast<std::size_t>(j)]);
    }
  }
  result.rounds = std::min(result.rounds, options.rounds);
  if (!result.converged && result.unlimited.empty()) {
    result.why =
        "modes and population still change after " + std::to_string(options.rounds) + " rounds";
  }
  result.sigma = std::exp(0.5 * x[model.size() - 1]);
  result.omega = MatX::Zero(q, q);
  result.omega(random, random) = L * L.transpose();
  result.minus_two_log_likelihood = value.minus_two_log_likelihood;
  set_errors(model, value, L, random, result);
  const MatX omega_random = L * L.transpose();
  for (std::size_t i = 0; i < n; ++i) {
    const Linear& one = model.data[i];
    const MatX Rr = one.R(Eigen::all, random);
    MatX S = Rr * omega_random * Rr.transpose();
    S.diagonal().array() += result.sigma * result.sigma;
    const MatX half = Rr * omega_random;
    MatX explained = MatX::Zero(q, q);
    explained(random, random) = half.transpose() * Cholesky(S).solve_columns(half);
    result.explained.push_back(explained);
    result.values += static_cast<int>(one.values);
  }
  result.likelihood_parameters =
      static_cast<int>(result.beta.size()) + static_cast<int>(model.size());
  return result;
}

MixedDraws mixed_posterior(const std::vector<MixedSpecimen>& specimens, const MixedResult& estimate,
                           const MixedOptions& options, const PosteriorConfig& config,
                           int threads) {
  const auto q = specimens.front().design.rows();
  std::vector<Eigen::Index> random;
  for (Eigen::Index j = 0; j < q; ++j)
    if (options.varies.empty() || options.varies[static_cast<std::size_t>(j)]) random.push_back(j);
  LinearMixed model(specimens, random, options.full);
  model.reference = estimate.beta;
  model.data.resize(specimens.size());
  for (std::size_t i = 0; i < specimens.size(); ++i)
    make_linear(specimens[i], specimens[i].design * estimate.beta + estimate.b[i], model.data[i]);
  // a deviation that the estimate puts at 0 begins at a small one
  MatX omega = estimate.omega(random, random);
  omega.diagonal().array() += 1e-4 * std::max(1e-12, omega.diagonal().maxCoeff());
  const MatX L = Cholesky(omega).L();
  const ScatterDensity density(model, L);
  const VecX start = density.place(model.parameters(L, estimate.sigma));
  const MatX scale = density.scale(start);
  const MatX root = Cholesky(scale).L();

  const int each = (config.samples + config.chains - 1) / config.chains;
  std::vector<NutsChain> chains(static_cast<std::size_t>(config.chains));
  in_order(
      std::min(threads, config.chains), config.chains,
      [&](int, int chain) {
        Random begin(static_cast<std::uint64_t>(config.seed) + 77,
                     static_cast<std::uint64_t>(chain));
        VecX z(start.size());
        for (double& one : z) one = begin.normal();
        NutsOptions nuts;
        nuts.samples = each;
        nuts.warmup = config.warmup;
        nuts.seed = static_cast<std::uint64_t>(config.seed);
        nuts.chain = static_cast<std::uint64_t>(chain);
        nuts.acceptance = config.acceptance;
        const LogDensity of_scatter = [&](const VecX& y, VecX& gradient) {
          return density(y, gradient);
        };
        chains[static_cast<std::size_t>(chain)] =
            sample_chain(of_scatter, start + root * z, scale, nuts);
      },
      [](int, int) {});

  const Eigen::Index samples = static_cast<Eigen::Index>(each) * config.chains;
  const auto k = estimate.beta.size();
  MixedDraws draws{MatX(samples, k), MatX::Zero(samples, q), VecX(samples), VecX(samples),
                   config.chains};
  Random random_beta(static_cast<std::uint64_t>(config.seed), 9001);
  Eigen::Index row = 0;
  for (const NutsChain& chain : chains) {
    draws.divergences += chain.divergences;
    draws.acceptance += chain.acceptance / config.chains;
    for (Eigen::Index i = 0; i < chain.draws.rows(); ++i, ++row) {
      const VecX x = density.parameters(chain.draws.row(i).transpose());
      const LinearMixed::Value value = model.at(x, false);
      VecX z(k);
      for (double& one : z) one = random_beta.normal();
      const MatX covariance = Known(value.beta_information).covariance();
      draws.beta.row(row) = (value.beta + covariance_root(covariance) * z).transpose();
      const MatX rows = model.factor(x);
      for (std::size_t j = 0; j < random.size(); ++j)
        draws.deviations(row, random[j]) = rows.row(static_cast<Eigen::Index>(j)).norm();
      draws.sigma[row] = std::exp(0.5 * x[model.size() - 1]);
      draws.log_density[row] = chain.log_density[i];
    }
  }
  return draws;
}

}  // namespace langer
