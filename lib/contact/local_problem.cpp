#include "contact/local_problem.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace langer {

namespace {

// 1.5 / largest eigenvalue of W_ii: the Gauss-Seidel step on one contact then contracts without tuning
VecX step_lengths(const LocalProblem& problem) {
  VecX rho(problem.n_contacts());
  for (int i = 0; i < rho.size(); ++i) {
    const Mat3 W_ii = problem.W.block<3, 3>(3 * i, 3 * i);
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(0.5 * (W_ii + W_ii.transpose()), Eigen::EigenvaluesOnly);
    const double largest = eigen.eigenvalues()[2];
    rho[i] = largest > 0 ? 1.5 / largest : 1;
  }
  return rho;
}

// projection of tau = r - rho (x_t + (x_n + mu |x_t|) n); without friction only the normal part counts
ConeProjection trial(const Vec3& r, const Vec3& x, double rho, double mu) {
  if (mu == 0) return project_on_cone(Vec3(r[0] - rho * x[0], 0, 0), 0);
  const double x_t = std::hypot(x[1], x[2]);
  return project_on_cone(Vec3(r[0] - rho * (x[0] + mu * x_t), r[1] - rho * x[1], r[2] - rho * x[2]), mu);
}

// an indefinite W lets the sweeps run away
bool ran_away(const Eigen::Ref<const VecX>& r) { return !(r.lpNorm<Eigen::Infinity>() < 1e100); }

double residual_of(const LocalProblem& problem, const VecX& rho, const VecX& r, std::vector<ContactStatus>* status) {
  if (ran_away(r)) return std::numeric_limits<double>::infinity();
  const VecX x = problem.W * r + problem.q;
  double defect = 0, largest = 0, scale = 0;
  if (status) status->resize(problem.n_contacts());
  for (int i = 0; i < problem.n_contacts(); ++i) {
    const Vec3 r_i = r.segment<3>(3 * i);
    const ConeProjection p = trial(r_i, x.segment<3>(3 * i), rho[i], problem.mu[i]);
    if (status) (*status)[i] = p.status;
    defect = std::max(defect, (p.r - r_i).norm());
    largest = std::max(largest, r_i.norm());
    scale = std::max(scale, rho[i] * std::abs(problem.q[3 * i]));
  }
  if (!std::isfinite(defect)) return std::numeric_limits<double>::infinity();
  return defect / std::max(largest > 0 ? largest : scale, std::numeric_limits<double>::min());
}

void sweep(const LocalProblem& problem, const VecX& rho, VecX& r) {
  for (int i = 0; i < problem.n_contacts(); ++i) {
    const Vec3 x = problem.W.middleRows<3>(3 * i) * r + problem.q.segment<3>(3 * i);
    r.segment<3>(3 * i) = trial(r.segment<3>(3 * i), x, rho[i], problem.mu[i]).r;
    if (ran_away(r.segment<3>(3 * i))) return;  // contact after contact would take it beyond what a double holds
  }
}

// Alart-Curnier function and its generalised Jacobian, on the contacts that are not open.
//   F_n = r_n - max(0, A),  A = r_n - rho x_n;   F_t = r_t - projection of s = r_t - rho x_t on the disc of radius mu A
struct AlartCurnier {
  VecX F;
  std::vector<int> closed;
  MatX Jacobian;  // rows and columns of the closed contacts
};

double alart_curnier(const LocalProblem& problem, const VecX& rho, const VecX& r, AlartCurnier* out) {
  const VecX x = problem.W * r + problem.q;
  VecX F = VecX::Zero(r.size());
  std::vector<int> closed;
  for (int i = 0; i < problem.n_contacts(); ++i) {
    const Vec3 r_i = r.segment<3>(3 * i), x_i = x.segment<3>(3 * i);
    const double A = r_i[0] - rho[i] * x_i[0];
    if (A <= 0) {
      F.segment<3>(3 * i) = r_i;
      continue;
    }
    closed.push_back(i);
    const Eigen::Vector2d s = r_i.tail<2>() - rho[i] * x_i.tail<2>();
    const double radius = problem.mu[i] * A, size = s.norm();
    F[3 * i] = rho[i] * x_i[0];
    F.segment<2>(3 * i + 1) = r_i.tail<2>() - (size > radius ? Eigen::Vector2d(radius / size * s) : s);
  }
  if (out) {
    const int m = static_cast<int>(closed.size());
    MatX J = MatX::Zero(3 * m, 3 * m);
    for (int p = 0; p < m; ++p) {
      const int i = closed[p];
      const Vec3 r_i = r.segment<3>(3 * i), x_i = x.segment<3>(3 * i);
      const double A = r_i[0] - rho[i] * x_i[0];
      const Eigen::Vector2d s = r_i.tail<2>() - rho[i] * x_i.tail<2>();
      const double radius = problem.mu[i] * A, size = s.norm();
      for (int q = 0; q < m; ++q) {
        const Mat3 W = rho[i] * problem.W.block<3, 3>(3 * i, 3 * closed[q]);
        Mat3 row = W;
        if (size > radius) {
          const Mat3 identity = q == p ? Mat3(Mat3::Identity()) : Mat3(Mat3::Zero());
          const Mat3 d = identity - W;  // derivative of (A, s)
          const Eigen::Vector2d t = s / size;
          const Eigen::Matrix2d turn = (radius / size) * (Eigen::Matrix2d::Identity() - t * t.transpose());
          row.bottomRows<2>() = identity.bottomRows<2>() - problem.mu[i] * t * d.topRows<1>() - turn * d.bottomRows<2>();
        }
        J.block<3, 3>(3 * p, 3 * q) = row;
      }
    }
    out->closed = closed, out->Jacobian = std::move(J), out->F = F;
  }
  return F.norm();
}

// One damped Newton step; false where no step length lowers |F|.
bool newton_step(const LocalProblem& problem, const VecX& rho, VecX& r) {
  AlartCurnier at;
  const double before = alart_curnier(problem, rho, r, &at);
  if (before == 0) return false;
  const int m = static_cast<int>(at.closed.size());
  // open contacts go to r = 0 at once: dr = -r there, moved to the right-hand side through W
  VecX dr = VecX::Zero(r.size());
  std::vector<char> is_closed(problem.n_contacts(), 0);
  for (int i : at.closed) is_closed[i] = 1;
  for (int i = 0; i < problem.n_contacts(); ++i)
    if (!is_closed[i]) dr.segment<3>(3 * i) = -r.segment<3>(3 * i);
  if (m > 0) {
    VecX b(3 * m);
    const bool any_open = !dr.isZero(0);
    const VecX W_dr = any_open ? VecX(problem.W * dr) : VecX(VecX::Zero(r.size()));
    const VecX x = problem.W * r + problem.q;
    for (int p = 0; p < m; ++p) {
      const int i = at.closed[p];
      Vec3 moved = rho[i] * W_dr.segment<3>(3 * i);  // derivative of F through x
      const double A = r[3 * i] - rho[i] * x[3 * i];
      const Eigen::Vector2d s = r.segment<2>(3 * i + 1) - rho[i] * x.segment<2>(3 * i + 1);
      const double radius = problem.mu[i] * A, size = s.norm();
      if (size > radius) {
        const Eigen::Vector2d t = s / size;
        const Eigen::Vector2d along = problem.mu[i] * t * moved[0];
        const Eigen::Vector2d across = (radius / size) * (moved.tail<2>() - t * t.dot(moved.tail<2>()));
        moved.tail<2>() = along + across;
      }
      b.segment<3>(3 * p) = -at.F.segment<3>(3 * i) - moved;
    }
    VecX step = at.Jacobian.partialPivLu().solve(b);
    if (!step.allFinite() || (at.Jacobian * step - b).norm() > 1e-6 * b.norm())
      step = at.Jacobian.completeOrthogonalDecomposition().solve(b);  // rank-deficient W: the smallest step
    if (!step.allFinite()) return false;
    for (int p = 0; p < m; ++p) dr.segment<3>(3 * at.closed[p]) = step.segment<3>(3 * p);
  }
  for (double t = 1; t > 1e-3; t *= 0.5) {
    const VecX next = r + t * dr;
    if (alart_curnier(problem, rho, next, nullptr) <= (1 - 0.1 * t) * before) {
      r = next;
      return true;
    }
  }
  return false;
}

// put each reaction on its cone exactly
void snap(const LocalProblem& problem, VecX& r) {
  for (int i = 0; i < problem.n_contacts(); ++i)
    r.segment<3>(3 * i) = project_on_cone(problem.mu[i] == 0 ? Vec3(r[3 * i], 0, 0) : Vec3(r.segment<3>(3 * i)), problem.mu[i]).r;
}

// Sweeps and Newton steps in turn, until the natural map is small or the budget is spent; r gets the best seen.
void alternate(const LocalProblem& problem, const VecX& rho, VecX& r, const LocalOptions& options, LocalReport& report) {
  VecX best = r;
  double least = residual_of(problem, rho, r, nullptr);
  const auto judge = [&] {
    if (ran_away(r)) r = best;
    const double residual = residual_of(problem, rho, r, nullptr);
    if (residual < least) least = residual, best = r;
    return residual;
  };
  int round = 12;  // sweeps between attempts of Newton; grows, so that hard problems get the patience they need
  int sweeps = 0, newton_steps = 0;
  while (least > options.tolerance && sweeps < options.sweeps) {
    const VecX start = r;
    bool fled = false;
    for (const int until = std::min(sweeps + round, options.sweeps); sweeps < until && !fled; ++sweeps) {
      sweep(problem, rho, r);
      fled = ran_away(r);
    }
    if (judge() <= options.tolerance) break;
    double last = least;
    VecX before_newton = r;
    for (int s = 0; s < 12 && newton_steps < options.newton_steps; ++s) {
      ++newton_steps;
      if (!newton_step(problem, rho, r)) break;
      last = judge();
      if (last <= options.tolerance) break;
    }
    if (least <= options.tolerance || least < 1e-12) break;  // the rest is rounding
    if (!(last < 1e-3)) r = before_newton;
    if (fled && r == start) break;  // all of this would come again
    round = std::min(2 * round, options.sweeps);
  }
  report.sweeps += sweeps, report.newton_steps += newton_steps;
  r = best;
}

// Where W is singular in the directions that stick, Newton's matrix is too, and wanders. Proximal points cure that: the
// answer of  W + e, q - e r  from the last r, again and again, is one of W and q when r no longer moves.
void approach(const LocalProblem& problem, const VecX& rho, VecX& r, const LocalOptions& options, LocalReport& report) {
  const double largest = problem.W.diagonal().maxCoeff();
  LocalOptions each = options;
  each.sweeps = 400, each.newton_steps = 40;
  VecX best = r;
  double least = residual_of(problem, rho, r, nullptr);
  for (double e = 1e-3 * largest; e > 1e-9 * largest && least > options.tolerance; e *= 0.5) {
    LocalProblem near = problem;
    near.W.diagonal().array() += e;
    near.q -= e * r;
    alternate(near, step_lengths(near), r, each, report);
    const double residual = residual_of(problem, rho, r, nullptr);
    if (residual < least) least = residual, best = r;
  }
  r = best;
}

}  // namespace

double natural_map(const LocalProblem& problem, const VecX& r, std::vector<ContactStatus>* status) {
  return residual_of(problem, step_lengths(problem), r, status);
}

LocalReport solve_local(const LocalProblem& problem, VecX& r, const LocalOptions& options) {
  LocalReport report;
  const VecX rho = step_lengths(problem);
  if (r.size() != problem.q.size() || ran_away(r)) r = VecX::Zero(problem.q.size());
  constexpr double enough = 1e-11;
  alternate(problem, rho, r, options, report);
  if (residual_of(problem, rho, r, nullptr) > std::max(options.tolerance, enough)) approach(problem, rho, r, options, report);
  report.residual = residual_of(problem, rho, r, nullptr);
  VecX snapped = r;
  snap(problem, snapped);
  if (residual_of(problem, rho, snapped, nullptr) <= std::max(report.residual, options.tolerance)) r = snapped;
  report.residual = residual_of(problem, rho, r, &report.status);
  report.converged = report.residual <= std::max(options.tolerance, enough);
  return report;
}

}  // namespace langer
