#include "mechanics/contact/local_problem.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/traps.hpp"
#include "core/tensor/dense.hpp"
#include "core/tensor/principal.hpp"
#include "mechanics/contact/alart_curnier.hpp"

namespace langer {

namespace {

// rho of each contact: 1.5 over the largest eigenvalue of its block W_ii. With it the Gauss-Seidel
// step on one contact contracts, so that nothing has to be tuned.
VecX step_lengths(const LocalProblem& problem) {
  VecX rho(problem.n_contacts());
  for (int i = 0; i < rho.size(); ++i) {
    const Mat3 W_ii = problem.W.block<3, 3>(3 * i, 3 * i);
    const double largest = principal_values(Mat3(0.5 * (W_ii + W_ii.transpose())))[2];
    rho[i] = 1;
    if (largest > 0) rho[i] = 1.5 / largest;
  }
  return rho;
}

// The projection of  r - rho (x_t + (x_n + mu |x_t|) n)  on the cone. The solution is the reaction
// that this map leaves unchanged. Without friction only the normal part counts.
ConeProjection trial(const Vec3& r, const Vec3& x, double rho, double mu) {
  if (mu == 0) return project_on_cone(Vec3(r[0] - rho * x[0], 0, 0), 0);
  const double x_t = std::hypot(x[1], x[2]);
  return project_on_cone(Vec3(r[0] - rho * (x[0] + mu * x_t), r[1] - rho * x[1], r[2] - rho * x[2]),
                         mu);
}

// An indefinite W lets the reactions grow without end.
bool diverged(const Eigen::Ref<const VecX>& r) { return !(r.lpNorm<Eigen::Infinity>() < 1e100); }

// The largest change that the map `trial` makes, relative to the largest reaction; without any
// reaction relative to rho |q|.
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
  if (largest > 0) scale = largest;
  return defect / std::max(scale, std::numeric_limits<double>::min());
}

void gauss_seidel_sweep(const LocalProblem& problem, const VecX& rho, VecX& r) {
  for (int i = 0; i < problem.n_contacts(); ++i) {
    const Vec3 x = problem.W.middleRows<3>(3 * i) * r + problem.q.segment<3>(3 * i);
    r.segment<3>(3 * i) = trial(r.segment<3>(3 * i), x, rho[i], problem.mu[i]).r;
    // one more contact could overflow
    if (diverged(r.segment<3>(3 * i))) return;
  }
}

// The function F of each contact whose root is the solution (alart_curnier.hpp).
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

// Newton's step for the reactions of the closed contacts while those of the open ones change by
// dr_open.
std::optional<VecX> closed_step(const LocalProblem& problem, const VecX& rho,
                                const std::vector<AlartCurnier>& laws,
                                const std::vector<int>& closed, const VecX& dr_open) {
  const int m = static_cast<int>(closed.size());
  VecX moved = VecX::Zero(dr_open.size());
  if (!dr_open.isZero(0)) moved = problem.W * dr_open;
  VecX b(3 * m);
  MatX J(3 * m, 3 * m);
  for (int p = 0; p < m; ++p) {
    const int i = closed[p];
    b.segment<3>(3 * p) =
        -laws[i].F - laws[i].change(Vec3(Vec3::Zero()), Vec3(rho[i] * moved.segment<3>(3 * i)));
    for (int q = 0; q < m; ++q) {
      Mat3 dr = Mat3::Zero();
      if (q == p) dr = Mat3::Identity();
      J.block<3, 3>(3 * p, 3 * q) =
          laws[i].change(dr, Mat3(rho[i] * problem.W.block<3, 3>(3 * i, 3 * closed[q])));
    }
  }
  VecX step;
  {
    const NoTraps a_pivot_may_be_zero;  // J of a rank-deficient W: the answer is checked
    step = Lu(J).solve(b);
    if (step.allFinite() && (J * step - b).norm() <= 1e-6 * b.norm()) return step;
  }
  step = LeastNorm(J).solve(b);  // the smallest step
  if (step.allFinite()) return std::optional(step);
  return std::nullopt;
}

// One damped semismooth Newton step. False if no step length reduces |F| enough.
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

// Projects each reaction on its cone, so that the law holds exactly.
void project_reactions(const LocalProblem& problem, VecX& r) {
  for (int i = 0; i < problem.n_contacts(); ++i) {
    Vec3 r_i = r.segment<3>(3 * i);
    if (problem.mu[i] == 0) r_i = Vec3(r[3 * i], 0, 0);
    r.segment<3>(3 * i) = project_on_cone(r_i, problem.mu[i]).r;
  }
}

// Rounds of Gauss-Seidel sweeps, which find the status of each contact, and of Newton steps, which
// then converge quadratically. Newton comes first where the solution next to r is wanted. Ends when
// the residual is small or the budget is spent; r gets the best iterate.
void gauss_seidel_newton(const LocalProblem& problem, const VecX& rho, VecX& r,
                         const LocalOptions& options, LocalReport& report) {
  VecX best = r;
  double least = residual_of(problem, rho, r, nullptr);
  const auto update_best = [&] {
    if (diverged(r)) r = best;
    const double residual = residual_of(problem, rho, r, nullptr);
    if (residual < least) {
      least = residual;
      best = r;
    }
    return residual;
  };
  int round = 12;  // sweeps before Newton is tried; doubled after each failure
  int sweeps = 0, newton_steps = 0;
  double last = least;
  const auto take_newton_steps = [&] {
    for (int s = 0; s < 12 && newton_steps < options.newton_steps; ++s) {
      ++newton_steps;
      if (!newton_step(problem, rho, r)) break;
      last = update_best();
      if (last <= options.tolerance) break;
    }
  };
  constexpr double rounding = 1e-12;
  bool solved = least <= options.tolerance;
  if (options.next_to_start && !solved) {
    const VecX start = r;
    const double at_start = least;
    take_newton_steps();
    solved = least <= std::max(options.tolerance, rounding);
    if (!solved) {
      r = best = start;
      least = at_start;
    }
  }
  while (!solved && sweeps < options.sweeps) {
    const VecX start = r;
    bool ran_away = false;
    for (const int until = std::min(sweeps + round, options.sweeps); sweeps < until && !ran_away;
         ++sweeps) {
      gauss_seidel_sweep(problem, rho, r);
      ran_away = diverged(r);
    }
    if (update_best() <= options.tolerance) break;
    last = least;
    VecX before_newton = r;
    take_newton_steps();
    if (least <= options.tolerance || least < rounding) break;
    if (!(last < 1e-3)) r = before_newton;
    if (ran_away && r == start) break;  // the next round would repeat this one
    round = std::min(2 * round, options.sweeps);
  }
  report.sweeps += sweeps;
  report.newton_steps += newton_steps;
  r = best;
}

// The proximal point method. If W is singular in the directions that stick, so is Newton's matrix.
// The problem with  W + e,  q - e r_last  is regular; its solution becomes the next r_last. When r
// no longer changes, it solves the problem with W and q.
void proximal_point(const LocalProblem& problem, const VecX& rho, VecX& r,
                    const LocalOptions& options, LocalReport& report) {
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
    gauss_seidel_newton(near, step_lengths(near), r, each, report);
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
  gauss_seidel_newton(problem, rho, r, options, report);
  if (residual_of(problem, rho, r, nullptr) > std::max(options.tolerance, enough))
    proximal_point(problem, rho, r, options, report);
  report.residual = residual_of(problem, rho, r, nullptr);
  // the projection is kept unless it makes the residual worse
  VecX projected = r;
  project_reactions(problem, projected);
  if (residual_of(problem, rho, projected, nullptr) <= std::max(report.residual, options.tolerance))
    r = projected;
  report.residual = residual_of(problem, rho, r, &report.status);
  report.converged = report.residual <= std::max(options.tolerance, enough);
  return report;
}

}  // namespace langer
