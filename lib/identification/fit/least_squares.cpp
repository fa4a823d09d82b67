#include "identification/fit/least_squares.hpp"

#include <cmath>
#include <limits>

#include "identification/fit/bounded_linear.hpp"
#include "identification/fit/residual_noise.hpp"

namespace langer {

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

// Whether a change of the parameter by its typical size has no effect of first order.
bool without_first_effect(const LeastSquares& q, const MatX& J, Eigen::Index i) {
  return J.col(i).norm() * q.typical[i] < 1e-6 * q.size;
}

// The violation of the Kuhn-Tucker conditions as the header defines it: the largest relative step
// of the projected gradient.
double kkt_residual(const LeastSquares& q, const VecX& p, const VecX& r, const MatX& J) {
  const VecX g = J.transpose() * r;
  double worst = 0;
  for (Eigen::Index i = 0; i < p.size(); ++i) {
    const double norm = J.col(i).norm();
    if (norm == 0) continue;
    if (without_first_effect(q, J, i)) {
      const double t = q.typical[i];
      const double moved =
          std::min(std::max(p[i] - g[i] * t * t / (q.size * q.size), q.lower[i]), q.upper[i]) -
          p[i];
      worst = std::max(worst, std::abs(moved) / t);
      continue;
    }
    const double moved =
        std::min(std::max(p[i] - g[i] / (norm * norm), q.lower[i]), q.upper[i]) - p[i];
    worst = std::max(worst, norm * std::abs(moved) / q.size);
  }
  return worst;
}

// the damped linear problem in the box: min |J d + r|^2 + mu |D d|^2
// curvature: of the residual, beyond J^T J
VecX damped_step(const LeastSquares& q, const VecX& p, const VecX& r, const MatX& J, const VecX& D,
                 const VecX& curvature, double mu) {
  const Eigen::Index m = J.rows();
  const Eigen::Index n = J.cols();
  // in units of D, so that a stiff and a soft parameter count alike
  MatX A(m + n, n);
  A.topRows(m) = J * D.cwiseInverse().asDiagonal();
  A.bottomRows(n) = (mu + curvature.array() / D.array().square()).sqrt().matrix().asDiagonal();
  VecX b = VecX::Zero(m + n);
  b.head(m) = -r;
  return bounded_linear(A, b, D.cwiseProduct(q.lower - p), D.cwiseProduct(q.upper - p))
      .cwiseQuotient(D);
}

// r . d2r/dp_i^2 where it is positive: what Gauss and Newton leave out
VecX residual_curvature(const LeastSquares& q, const VecX& p, const VecX& r) {
  VecX curvature = VecX::Zero(p.size());
  VecX moved = p;
  VecX above;
  VecX below;
  for (Eigen::Index i = 0; i < p.size(); ++i) {
    if (!q.linear.empty() && q.linear[static_cast<std::size_t>(i)]) continue;
    const double h = std::min(
        {1e-3 * std::max(std::abs(p[i]), q.typical[i]), p[i] - q.lower[i], q.upper[i] - p[i]});
    if (!(h > 0)) continue;
    moved[i] = p[i] + h;
    const bool up = q.residual(moved, above) && above.allFinite();
    moved[i] = p[i] - h;
    const bool down = q.residual(moved, below) && below.allFinite();
    moved[i] = p[i];
    if (up && down) curvature[i] = std::max(0., r.dot(above - 2 * r + below) / (h * h));
  }
  return curvature;
}

// A place to go on from, along a parameter without first effect; p itself if there is none: beside
// p where the cost is lower, or anywhere in the box where it is the same and other parameters have
// become free to lower it.
VecX escape_point(const LeastSquares& q, const VecX& p, const VecX& r, const MatX& J) {
  const double rounding = 1e-13 * q.size * q.size;
  VecX best = p;
  VecX moved = p;
  VecX other;
  VecX level = p;
  MatX J_other;
  double most = rounding;
  for (Eigen::Index i = 0; i < p.size(); ++i) {
    if (!without_first_effect(q, J, i)) continue;
    const auto gain_at = [&](double x) {
      moved[i] = std::min(std::max(x, q.lower[i]), q.upper[i]);
      if (!q.residual(moved, other) || !other.allFinite()) return -q.size * q.size;
      return 0.5 * (r - other).dot(r + other);
    };
    for (double part : {1e-3, -1e-3, 1e-2, -1e-2, 1e-1, -1e-1})
      if (const double gained = gain_at(p[i] + part * q.typical[i]); gained > most) {
        most = gained;
        best = moved;
      }
    double width = 0;
    if (q.period_of(i) > 0) {
      width = q.period_of(i);
    } else {
      width = q.upper[i] - q.lower[i];
    }
    for (int k = 1; k < 8 && std::isfinite(width) && level == p; ++k)
      if (std::abs(gain_at(q.lower[i] + k * width / 8)) <= rounding &&
          jacobian(q, moved, J_other) && kkt_residual(q, moved, other, J_other) > 1e-6)
        level = moved;
    moved[i] = p[i];
  }
  return best == p ? level : best;
}

}  // namespace

// The Jacobian by five-point differences inside the box, or exactly from one difference for linear
// parameters.
bool jacobian(const LeastSquares& q, const VecX& p, MatX& J) {
  if (q.slope) return q.slope(p, J) && J.allFinite();
  VecX p_moved = p;
  VecX r;
  const auto at = [&](Eigen::Index i, double x, VecX& out) {
    p_moved[i] = x;
    const bool good = q.residual(p_moved, out) && out.allFinite();
    p_moved[i] = p[i];
    return good;
  };
  const auto column = [&](Eigen::Index i, const VecX& dr_dp) {
    if (i == 0) J.resize(dr_dp.size(), p.size());
    J.col(i) = dr_dp;
  };
  VecX value, base;
  for (Eigen::Index i = 0; i < p.size(); ++i) {
    if (!q.linear.empty() && q.linear[static_cast<std::size_t>(i)]) {
      // any step is exact: a large one, into the box
      const double above = q.upper[i] - p[i];
      const double below = p[i] - q.lower[i];
      const double size = std::max(std::abs(p[i]), q.typical[i]);
      double h = 0;
      if (above >= below) {
        h = std::min(size, above);
      } else {
        h = -std::min(size, below);
      }
      if (base.size() == 0 && !at(i, p[i], base)) return false;
      if (h != 0 && !at(i, p[i] + h, value)) return false;
      if (h != 0) {
        column(i, (value - base) / h);
      } else {
        column(i, VecX::Zero(base.size()));
      }
      continue;
    }
    // h^4 against eps/h
    double h = std::pow(eps, 0.2) * std::max(std::abs(p[i]), q.typical[i]);
    const double below = p[i] - q.lower[i];
    const double above = q.upper[i] - p[i];
    if (below + above == 0) {
      if (!at(i, p[i], value)) return false;
      column(i, VecX::Zero(value.size()));
      continue;
    }
    h = std::min(h, (below + above) / 8);
    // five points in a row inside the box, `first` steps from p
    int first = -2;
    while (first < 0 && p[i] + first * h < q.lower[i]) ++first;
    while (p[i] + (first + 4) * h > q.upper[i]) --first;
    static constexpr double weights[5][5] = {{-25, 48, -36, 16, -3},
                                             {-3, -10, 18, -6, 1},
                                             {1, -8, 0, 8, -1},
                                             {-1, 6, -18, 10, 3},
                                             {3, -16, 36, -48, 25}};
    // The stencil acts on changes against the first point, so that a parameter without effect gives
    // exactly zero
    VecX first_value, slope;
    for (int k = 0; k < 5; ++k) {
      const double w = weights[-first][k];
      if (w == 0) continue;
      if (!at(i, p[i] + (first + k) * h, value)) return false;
      if (first_value.size() == 0) {
        first_value = value;
        slope = VecX::Zero(value.size());
      } else {
        slope += w * (value - first_value);
      }
    }
    column(i, slope / (12 * h));
  }
  return true;
}

namespace {

// One search: its state is the result so far, the scaling D and the damping mu.
class LevenbergMarquardt {
 public:
  explicit LevenbergMarquardt(const LeastSquares& q) : q_(q) {
    s_.p = q.start.cwiseMax(q.lower).cwiseMin(q.upper);
    s_.cost = s_.kkt = std::numeric_limits<double>::infinity();
    s_.at_bound.assign(static_cast<std::size_t>(s_.p.size()), false);
    D_ = curvature_ = VecX::Zero(s_.p.size());
  }

  LeastSquaresResult search(const LeastSquaresOptions& options) {
    if (!q_.residual(s_.p, s_.r) || !s_.r.allFinite() || !jacobian(q_, s_.p, s_.J)) {
      s_.why = "the model does not exist at the start";
      return s_;
    }
    s_.cost = 0.5 * s_.r.squaredNorm();
    good_enough_ = options.good_enough;
    iterate(options);
    for (Eigen::Index i = 0; i < s_.p.size(); ++i)
      s_.at_bound[static_cast<std::size_t>(i)] = s_.p[i] == q_.lower[i] || s_.p[i] == q_.upper[i];
    return s_;
  }

 private:
  static constexpr int slow_ = 25;  // iterations after which a search is
  // Where a least step is told a search ends, too, where a step promises less than this part of the
  // cost: far less than a standard error, and less than runs of scenes are exact to. Data without
  // noise never come to that, their cost falls to 0.
  static constexpr double least_gain_ = 1e-7;
  // And where no step gains ten times that, though the undamped one promises as much: the model has
  // kinks, as that of a scene where fibres are taken up or let go at some Gauss point. Then the
  // optimum is known to this part of the standard errors.
  static constexpr double stalled_gain_ = 1e-6, known_to_ = 0.03;
  static constexpr int stalled_steps_ = 2;

  void iterate(const LeastSquaresOptions& options) {
    for (s_.iterations = 0; s_.iterations < options.iterations; ++s_.iterations) {
      s_.kkt = kkt_residual(q_, s_.p, s_.r, s_.J);
      if (s_.kkt <= options.kkt) {
        if (escaped_saddle()) continue;
        s_.converged = true;
        s_.why = "optimal";
        return;
      }
      D_ = D_.cwiseMax(s_.J.colwise().norm().transpose());
      for (Eigen::Index i = 0; i < D_.size(); ++i)
        if (D_[i] == 0) D_[i] = 1 / std::max(q_.typical[i], eps);
      if (s_.iterations >= slow_ && (!q_.slope || q_.cheap_slope))
        curvature_ = residual_curvature(q_, s_.p, s_.r);
      bool accepted = false;
      while (!accepted && mu_ < 1e12 && !small_) accepted = step(options.step);
      if (small_) {
        if (escaped_saddle()) continue;
        s_.converged = true;
        s_.why = "optimal within the step asked for";
        return;
      }
      if (options.step > 0 && (!accepted || stalled_ >= stalled_steps_) &&
          is_known_within_errors()) {
        s_.converged = true;
        s_.why = "optimal to a thirtieth of the standard errors; the model has kinks";
        return;
      }
      if (!accepted && !escaped_saddle())
        return end("optimal within rounding", "no step lowers the cost");
    }
    s_.kkt = kkt_residual(q_, s_.p, s_.r, s_.J);
    end("optimal", "iteration limit reached");
  }

  void end(const char* good, const char* bad) {
    s_.converged = s_.kkt <= good_enough_;
    s_.why = s_.converged ? good : bad;
  }

  // takes a step that lowers the cost, or damps the next one more
  bool step(double least) {
    const VecX d = damped_step(q_, s_.p, s_.r, s_.J, D_, curvature_, mu_);
    const VecX p = (s_.p + d).cwiseMax(q_.lower).cwiseMin(q_.upper);
    // a heavily damped step is short far from the optimum, too
    small_ = least > 0 && mu_ < 1 &&
             ((p - s_.p).array().abs() <= least * s_.p.array().abs().max(1e-3 * q_.typical.array()))
                 .all();
    //   |r|^2/2 - |r + J d|^2/2 = -d.J^T r - |J d|^2/2
    const VecX Jd = s_.J * d;
    const double predicted =
        -s_.r.dot(Jd) - 0.5 * Jd.squaredNorm() - 0.5 * curvature_.dot(d.cwiseAbs2());
    small_ = small_ || (least > 0 && mu_ < 1 && predicted < least_gain_ * s_.cost);
    if (small_) return false;
    VecX r;
    const bool exists = q_.residual(p, r) && r.allFinite();
    //   |r_old|^2 - |r_new|^2 = (r_old - r_new).(r_old + r_new), which keeps its digits near the optimum
    double gained = -1;
    if (exists) gained = 0.5 * (s_.r - r).dot(s_.r + r);
    if (exists && predicted > 0 && gained > 0)
      if (MatX J = s_.J; jacobian(q_, p, J)) {
        mu_ = std::max(
            1e-30, mu_ * std::max(0.1, 1 - std::pow(2 * std::min(gained / predicted, 1.) - 1, 3)));
        growth_ = 2;
        if (gained < stalled_gain_ * s_.cost) {
          ++stalled_;
        } else {
          stalled_ = 0;
        }
        accept(p, r, J);
        return true;
      }
    mu_ = std::max(mu_, 1e-15) * growth_;
    growth_ *= 2;
    return false;
  }

  //   |dp_i| <= standard error_i |J dp|/s,  s^2 = |r|^2/(m - n)
  bool is_known_within_errors() const {
    const Eigen::Index freedom = s_.r.size() - s_.p.size();
    if (freedom <= 0) return false;
    const VecX d = damped_step(q_, s_.p, s_.r, s_.J, D_, VecX::Zero(s_.p.size()), 0);
    return (s_.J * d).squaredNorm() <=
           known_to_ * known_to_ * 2 * s_.cost / static_cast<double>(freedom);
  }

  bool escaped_saddle() {
    if (++escapes_ > 10) return false;
    const VecX p = escape_point(q_, s_.p, s_.r, s_.J);
    VecX r;
    MatX J;
    if (p == s_.p || !q_.residual(p, r) || !jacobian(q_, p, J)) return false;
    accept(p, r, J);
    D_.setZero();
    mu_ = 1e-3;
    growth_ = 2;
    small_ = false;
    return true;
  }

  void accept(const VecX& p, const VecX& r, const MatX& J) {
    s_.p = p;
    s_.r = r;
    s_.J = J;
    s_.cost = 0.5 * r.squaredNorm();
  }

  const LeastSquares& q_;
  LeastSquaresResult s_;
  VecX D_, curvature_;
  double mu_ = 1e-3, growth_ = 2;
  int escapes_ = 0, stalled_ = 0;
  bool small_ = false;
  double good_enough_ = 0;
};

}  // namespace

LeastSquaresResult least_squares(const LeastSquares& q, const LeastSquaresOptions& options) {
  return LevenbergMarquardt(q).search(options);
}

// The covariance for white noise with the deviation that the residuals show.
MatX covariance(const LeastSquaresResult& s) {
  Eigen::Index n_free = 0;
  for (Eigen::Index i = 0; i < s.p.size(); ++i)
    n_free += !s.at_bound[static_cast<std::size_t>(i)] && s.J.col(i).norm() > 0;
  const Eigen::Index m = s.r.size();
  if (m <= n_free)
    return MatX::Constant(s.p.size(), s.p.size(), std::numeric_limits<double>::quiet_NaN());
  return covariance(s.J, s.at_bound,
                    white_noise(std::sqrt(2 * s.cost / static_cast<double>(m - n_free)), m));
}

}  // namespace langer
