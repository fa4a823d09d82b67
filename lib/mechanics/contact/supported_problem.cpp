#include "mechanics/contact/supported_problem.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/base/traps.hpp"
#include "core/tensor/dense.hpp"
#include "mechanics/contact/alart_curnier.hpp"

namespace langer {

namespace {

struct Function {
  VecX F;
  std::vector<ContactStatus> status;
};

Function evaluate(const SupportedProblem& p, const VecX& rho, const VecX& s, MatX* Jacobian) {
  const VecX x = p.q + p.W * s;
  const VecX r = p.b + p.A * s;
  Function out{VecX(s.size()), {}};
  if (Jacobian) Jacobian->resize(s.size(), s.size());
  for (int i = 0; i < p.n_contacts(); ++i) {
    const AlartCurnier law(r.segment<3>(3 * i), x.segment<3>(3 * i), rho[i], p.mu[i]);
    out.F.segment<3>(3 * i) = law.F, out.status.push_back(law.status);
    if (Jacobian)
      Jacobian->middleRows<3>(3 * i) =
          law.change<Eigen::Dynamic>(p.A.middleRows<3>(3 * i), rho[i] * p.W.middleRows<3>(3 * i));
  }
  return out;
}

}  // namespace

LocalReport solve_supported(const SupportedProblem& p, VecX& s, const LocalOptions& options) {
  LocalReport report;
  VecX compliance(p.n_contacts());
  for (int i = 0; i < compliance.size(); ++i) compliance[i] = p.W.block<3, 3>(3 * i, 3 * i).norm();
  // A candidate that is held has no compliance: it shares the limit of the others, and says nothing
  // of the size of the forces.
  const double least = std::max(1e-6 * compliance.maxCoeff(), 1e-300);
  const VecX rho = compliance.cwiseMax(least).cwiseInverse();
  MatX Jacobian;
  const auto scale = [&](const VecX& at) {
    return std::max({(p.b + p.A * at).lpNorm<Eigen::Infinity>(),
                     rho.cwiseProduct(VecX::NullaryExpr(rho.size(),
                                                        [&](Eigen::Index i) {
                                                          if (compliance[i] < least) return 0.0;
                                                          return std::abs(p.q[3 * i]);
                                                        }))
                             .maxCoeff() *
                         1e-3,
                     1e-300});
  };
  Function now = evaluate(p, rho, s, &Jacobian);
  for (; report.newton_steps < options.newton_steps; ++report.newton_steps) {
    report.residual = now.F.lpNorm<Eigen::Infinity>() / scale(s);
    if (report.residual <= 1e-12 || !std::isfinite(report.residual)) break;
    // directions that nothing decides (all contacts open, a body free to spin under a smooth
    // sphere): the least step
    constexpr double decided = 1e-8;
    const Lu lu(Jacobian);
    VecX step;
    {
      const NoTraps a_pivot_may_be_zero;
      step = lu.solve(-now.F);
    }
    if (lu.rcond() < decided || !step.allFinite() ||
        (Jacobian * step + now.F).norm() > 1e-8 * now.F.norm())
      step = LeastNorm(Jacobian, decided).solve(-now.F);
    if (!step.allFinite()) break;
    double t = 1;
    Function next;
    for (; t > 1e-4; t *= 0.5) {
      next = evaluate(p, rho, s + t * step, nullptr);
      if (next.F.norm() <= (1 - 1e-4 * t) * now.F.norm()) break;
    }
    if (report.residual <= 1e-10 && !(next.F.norm() < 0.5 * now.F.norm()))
      break;               // that is rounding
    if (t <= 1e-4) t = 1;  // between pieces of the function |F| may have to rise once
    s += t * step;
    now = evaluate(p, rho, s, &Jacobian);
  }
  report.residual = now.F.lpNorm<Eigen::Infinity>() / scale(s);
  report.status = now.status;
  report.converged = report.residual <= 1e-10;
  return report;
}

}  // namespace langer
