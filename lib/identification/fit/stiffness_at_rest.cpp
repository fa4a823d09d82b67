#include "identification/fit/stiffness_at_rest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/no_number.hpp"
#include "identification/fit/identifiability.hpp"

namespace langer {

namespace {

constexpr double limit = 3.841458820694124;  // of chi-square, 95 %

// d mu / d p_i of a number of the matrix, which mu is linear in; 0 for others
double effect(const FitProblem& problem, const VecX& p, Eigen::Index i) {
  VecX more = p;
  more[i] += 1;
  return shear_modulus(with_parameters(problem, more)) - shear_modulus(with_parameters(problem, p));
}

// Whether a free parameter is a modulus of the matrix with a preset bound, which may be raised.
bool is_modulus_of_the_matrix(const FitProblem& problem, std::size_t i) {
  const FreeParameter& free = problem.free[i];
  if (!free.preset || !free.key.starts_with("matrix")) return false;
  Material law = problem.law;
  for (const MaterialParameter& p : parameters(law))
    if (p.key == free.key) return p.unit == std::string(unit::MPa);
  return false;
}

// the box that keeps mu at `least` by number i alone; false where it does not reach so far
bool raise(FitProblem& problem, const VecX& p, Eigen::Index i, double least) {
  const double per = effect(problem, p, i);
  FreeParameter& free = problem.free[static_cast<std::size_t>(i)];
  if (!(std::abs(per) > 1e-9) || !std::isfinite(per)) return false;
  double& bound = per > 0 ? free.lower : free.upper;
  bound = least / per;
  if (per > 0) {
    free.start = std::max(free.start, bound);
  } else {
    free.start = std::min(free.start, bound);
  }
  return free.lower < free.upper;
}

// the largest modulus at rest that the tests allow, by number i, others following
double allowed_by(const FitProblem& problem, const FitResult& fit, Eigen::Index i, double least,
                  double noise) {
  const LeastSquares q = likelihood_problem(problem, fit);
  const VecX& p = fit.best.p;
  // in units of the residuals of q, which noise that is not white leaves with another size
  const double size = fit.residual.norm();
  if (size > 0) noise *= fit.best.r.norm() / size;
  const double per = effect(problem, p, i);
  const double mu = shear_modulus(fit.material);
  if (!(std::abs(per) > 1e-9)) return inf;
  const auto value = [&](double more) {
    return p[i] + more / per;
  };
  const auto inside = [&](double more) {
    return value(more) >= q.lower[i] && value(more) <= q.upper[i];
  };
  double in = 0;
  double out = least;
  while (inside(out) && profile_rise(q, i, value(out), p, noise) < limit) {
    in = out;
    out *= 2;
  }
  if (!inside(out)) return inf;
  for (int k = 0; k < 12; ++k) {
    const double middle = 0.5 * (in + out);
    if (profile_rise(q, i, value(middle), p, noise) < limit) {
      in = middle;
    } else {
      out = middle;
    }
  }
  return mu + in;
}

}  // namespace

// The warning about a shear modulus that was raised, with what it costs.
std::string in_words(const StiffnessAtRest& s) {
  std::string reach = "allow any";
  if (std::isfinite(s.allowed)) {
    reach = fmt::format("allow up to {:.3g} MPa (95 %)", s.allowed);
  }
  std::string cost;
  if (s.taken > s.allowed * (1 + 1e-9)) {
    cost = fmt::format(
        "more than they allow, the mean error goes from {:.3g} to {:.3g} %: this law does not follow "
        "the tests near rest",
        s.error_before, s.error_after);
  } else {
    cost =
        fmt::format("the mean error goes from {:.3g} to {:.3g} %", s.error_before, s.error_after);
  }
  return fmt::format(
      "the tests do not determine the shear modulus at rest: they give {:.3g} MPa and {}; {:.3g} MPa is used, the least that tests with a "
      "noise of {:.3g} MPa can distinguish from 0, since a body without stiffness at rest cannot be solved ({}). Forces at small strains depend on it",
      s.fitted, reach, s.taken, s.noise, cost);
}

double residual_noise(const FitProblem& problem, const FitResult& fit, double part) {
  double largest = 0;
  for (const Test& t : problem.tests) largest = std::max(largest, t.weight * largest_stress(t));
  const auto m = fit.best.r.size();
  const auto n = fit.best.p.size();
  double shown = 0;
  if (m > n) shown = fit.residual.norm() / std::sqrt(static_cast<double>(m - n));
  return std::max(part * largest, shown);
}

// The shear modulus whose stresses in all tests have the size of the noise: a smaller one cannot be
// distinguished from zero.
double least_shear_modulus(const FitProblem& problem, double noise) {
  const Material unit_matrix{{NeoHooke{0.5}}, {}, problem.law.volume};
  double sum = 0;
  for (const Test& test : problem.tests) {
    VecX stress(static_cast<Eigen::Index>(test.values()));
    if (model_stress(unit_matrix, test, problem.dilatation, stress.data()) && stress.allFinite())
      sum += test.weight * test.weight * stress.squaredNorm();
  }
  if (sum > 0) return noise / std::sqrt(sum);
  return inf;
}

// Repeats the fit with a raised lower bound of each modulus of the matrix and keeps the best one.
std::optional<StiffnessAtRest> stiffen_at_rest(FitProblem& problem, FitResult& fit,
                                               const FitOptions& options, double part) {
  StiffnessAtRest s;
  s.noise = residual_noise(problem, fit, part);
  s.least = least_shear_modulus(problem, s.noise);
  s.fitted = shear_modulus(fit.material);
  if (!std::isfinite(s.least) || s.fitted >= s.least) return std::nullopt;
  std::optional<FitResult> best;
  FitProblem raised;
  Eigen::Index by = 0;
  for (std::size_t i = 0; i < problem.free.size(); ++i) {
    if (!is_modulus_of_the_matrix(problem, i)) continue;
    FitProblem one = problem;
    one.noise = fit.noise_model.kind;  // likelihoods of one kind of noise compare
    for (std::size_t k = 0; k < one.free.size(); ++k)
      one.free[k].start = fit.best.p[static_cast<Eigen::Index>(k)];
    VecX p = fit.best.p;
    std::optional<FitResult> found;
    for (int again = 0; again < 5;
         ++again) {  // exponents, which the effect of a modulus depends on, follow
      if (!raise(one, p, static_cast<Eigen::Index>(i), s.least)) break;
      FitResult next = langer::fit(one, options);
      if (!next.best.converged) break;
      p = next.best.p;
      found = std::move(next);
      if (shear_modulus(found->material) >= s.least * (1 - 1e-9)) break;
    }
    if (!found || shear_modulus(found->material) < s.least * (1 - 1e-9)) continue;
    if (!best || found->best.cost < best->best.cost) {
      best = std::move(found);
      raised = one;
      by = static_cast<Eigen::Index>(i);
    }
  }
  if (!best) return std::nullopt;
  s.allowed = allowed_by(problem, fit, by, s.least, s.noise);
  s.key = problem.free[static_cast<std::size_t>(by)].key;
  s.taken = shear_modulus(best->material);
  s.error_before = fit.quality.mean_error_percent;
  s.error_after = best->quality.mean_error_percent;
  // the kinds of noise that were compared before; of the one chosen, what it makes of this fit
  std::vector<NoiseCandidate> candidates = fit.noise_candidates;
  for (NoiseCandidate& one : candidates) {
    const bool chosen = one.noise.kind == best->noise_model.kind;
    if (chosen && !best->noise_candidates.empty()) one = best->noise_candidates.front();
  }
  problem = std::move(raised);
  fit = std::move(*best);
  fit.noise_candidates = std::move(candidates);
  return s;
}

}  // namespace langer
