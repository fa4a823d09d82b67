#include "mechanics/contact/local_problem.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/tensor/dense.hpp"
#include "mechanics/contact/alart_curnier.hpp"

namespace langer {

namespace {

// 1.5 / largest eigenvalue of W_ii: the Gauss-Seidel step on one contact then contracts without
// tuning
VecX step_lengths(const LocalProblem& problem) {
  VecX rho(problem.n_contacts());
  for (int i = 0; i < rho.size(); ++i) {
    const Mat3 W_ii = problem.W.block<3, 3>(3 * i, 3 * i);
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(0.5 * (W_ii + W_ii.transpose()),
                                                    Eigen::EigenvaluesOnly);
    const double largest = eigen.eigenvalues()[2];
    if (largest > 0) {
      rho[i] = 1.5 / largest;
    } else {
      rho[i] = 1;
    }
  }
  return rho;
}

// projection of tau = r - rho (x_t + (x_n + mu |x_t|) n); without friction only the normal part
// counts
ConeProjection trial(const Vec3& r, const Vec3& x, double rho, double mu) {
  if (mu == 0) return project_on_cone(Vec3(r[0] - rho * x[0], 0, 0), 0);
  const double x_t = std::hypot(x[1], x[2]);
  return project_on_cone(Vec3(r[0] - rho * (x[0] + mu * x_t), r[1] - rho * x[1], r[2] - rho * x[2]),
                         mu);
}

// an indefinite W lets the sweeps run away
bool diverged(const Eigen::Ref<const VecX>& r) { return !(r.lpNorm<Eigen::Infinity>() < 1e100); }

double residual_of(const LocalProblem& problem, const VecX& rho, const VecX& r,
                   std::vector<ContactStatus>* status) {
  if (diverged(r)) return std::numeric_limits<double>::infinity();
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
    if (diverged(r.segment<3>(3 * i)))
      return;  // contact after contact would take it beyond what a double holds
  }
}

std::vector<AlartCurnier> laws_at(const LocalProblem& problem, const VecX& rho, const VecX& r) {
  const VecX x = problem.W * r + problem.q;
  std::vector<AlartCurnier> laws;
  laws.reserve(static_cast<std::size_t>(problem.n_contacts()));
  for (int i = 0; i < problem.n_contacts(); ++i)
    laws.emplace_back(r.segment<3>(3 * i), x.segment<3>(3 * i), rho[i], problem.mu[i]);
  return laws;
}

double size_of(const std::vector<AlartCurnier>& laws) {
  double sum = 0;
  for (const AlartCurnier& law : laws) sum += law.F.squaredNorm();
  return std::sqrt(sum);
}

// Change of the reactions of the closed contacts that Newton's method asks for where the others
// change by dr_open.
std::optional<VecX> closed_step(const LocalProblem& problem, const VecX& rho,
                                const std::vector<AlartCurnier>& laws,
                                const std::vector<int>& closed, const VecX& dr_open) {
  const int m = static_cast<int>(closed.size());
  const VecX moved =
      dr_open.isZero(0) ? VecX(VecX::Zero(dr_open.size())) : VecX(problem.W * dr_open);
  VecX b(3 * m);
  MatX J(3 * m, 3 * m);
  for (int p = 0; p < m; ++p) {
    const int i = closed[p];
    b.segment<3>(3 * p) =
        -laws[i].F - laws[i].change(Vec3(Vec3::Zero()), Vec3(rho[i] * moved.segment<3>(3 * i)));
    for (int q = 0; q < m; ++q) {
      const Mat3 dr = q == p ? Mat3(Mat3::Identity()) : Mat3(Mat3::Zero());
      J.block<3, 3>(3 * p, 3 * q) =
          laws[i].change(dr, Mat3(rho[i] * problem.W.block<3, 3>(3 * i, 3 * closed[q])));
    }
  }
  VecX step = Lu(J).solve(b);
  if (!step.allFinite() || (J * step - b).norm() > 1e-6 * b.norm())
    step = LeastNorm(J).solve(b);  // rank-deficient W: the smallest step
  if (step.allFinite()) return std::optional(step);
  return std::nullopt;
}

// One damped Newton step; false where no step length lowers |F|.
bool newton_step(const LocalProblem& problem, const VecX& rho, VecX& r) {
  const std::vector<AlartCurnier> laws = laws_at(problem, rho, r);
  const double before = size_of(laws);
  if (before == 0) return false;
  VecX dr = VecX::Zero(r.size());
  std::vector<int> closed;
  for (int i = 0; i < problem.n_contacts(); ++i)
    if (laws[i].status == ContactStatus::open)
      dr.segment<3>(3 * i) = -r.segment<3>(3 * i);  // to r = 0 at once
    else
      closed.push_back(i);
  if (!closed.empty()) {
    const auto step = closed_step(problem, rho, laws, closed, dr);
    if (!step) return false;
    for (std::size_t p = 0; p < closed.size(); ++p)
      dr.segment<3>(3 * closed[p]) = step->segment<3>(3 * static_cast<Eigen::Index>(p));
  }
  for (double t = 1; t > 1e-3; t *= 0.5) {
    const VecX next = r + t * dr;
    if (size_of(laws_at(problem, rho, next)) <= (1 - 0.1 * t) * before) {
      r = next;
      return true;
    }
  }
  return false;
}

// put each reaction on its cone exactly
void snap(const LocalProblem& problem, VecX& r) {
  for (int i = 0; i < problem.n_contacts(); ++i)
    r.segment<3>(3 * i) =
        project_on_cone(problem.mu[i] == 0 ? Vec3(r[3 * i], 0, 0) : Vec3(r.segment<3>(3 * i)),
                        problem.mu[i])
            .r;
}

// Sweeps and Newton steps in turn, until the natural map is small or the budget is spent; r gets
// the best seen.
void alternate(const LocalProblem& problem, const VecX& rho, VecX& r, const LocalOptions& options,
               LocalReport& report) {
  VecX best = r;
  double least = residual_of(problem, rho, r, nullptr);
  const auto judge = [&] {
    if (diverged(r)) r = best;
    const double residual = residual_of(problem, rho, r, nullptr);
    if (residual < least) {
      least = residual;
      best = r;
    }
    return residual;
  };
  int round = 12;  // sweeps between attempts of Newton; grows, so that hard problems get the
                   // patience they need
  int sweeps = 0, newton_steps = 0;
  while (least > options.tolerance && sweeps < options.sweeps) {
    const VecX start = r;
    bool fled = false;
    for (const int until = std::min(sweeps + round, options.sweeps); sweeps < until && !fled;
         ++sweeps) {
      sweep(problem, rho, r);
      fled = diverged(r);
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
  report.sweeps += sweeps;
  report.newton_steps += newton_steps;
  r = best;
}

// Where W is singular in the directions that stick, Newton's matrix is too, and wanders. Proximal
// points cure that: the answer of  W + e, q - e r  from the last r, again and again, is one of W
// and q when r no longer moves.
void approach(const LocalProblem& problem, const VecX& rho, VecX& r, const LocalOptions& options,
              LocalReport& report) {
  const double largest = problem.W.diagonal().maxCoeff();
  LocalOptions each = options;
  each.sweeps = 400;
  each.newton_steps = 40;
  VecX best = r;
  double least = residual_of(problem, rho, r, nullptr);
  for (double e = 1e-3 * largest; e > 1e-9 * largest && least > options.tolerance; e *= 0.5) {
    LocalProblem near = problem;
    near.W.diagonal().array() += e;
    near.q -= e * r;
    alternate(near, step_lengths(near), r, each, report);
    const double residual = residual_of(problem, rho, r, nullptr);
    if (residual < least) {
      least = residual;
      best = r;
    }
  }
  r = best;
}

}  // namespace

LocalReport solve_local(const LocalProblem& problem, VecX& r, const LocalOptions& options) {
  LocalReport report;
  const VecX rho = step_lengths(problem);
  if (r.size() != problem.q.size() || diverged(r)) r = VecX::Zero(problem.q.size());
  constexpr double enough = 1e-11;
  alternate(problem, rho, r, options, report);
  if (residual_of(problem, rho, r, nullptr) > std::max(options.tolerance, enough))
    approach(problem, rho, r, options, report);
  report.residual = residual_of(problem, rho, r, nullptr);
  VecX snapped = r;
  snap(problem, snapped);
  if (residual_of(problem, rho, snapped, nullptr) <= std::max(report.residual, options.tolerance))
    r = snapped;
  report.residual = residual_of(problem, rho, r, &report.status);
  report.converged = report.residual <= std::max(options.tolerance, enough);
  return report;
}

}  // namespace langer
