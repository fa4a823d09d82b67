// Random contact problems, a fifth of them with a rank-deficient W, a third ill-conditioned, a
// quarter without friction.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "mechanics/contact/local_problem.hpp"

namespace langer::test {

inline LocalProblem random_problem(int seed, int k) {
  std::mt19937 random(1000 + seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0, 1);
  const int rank = seed % 5 == 0 ? std::max(1, 3 * k - 2) : 3 * k;
  MatX A(3 * k, rank);
  for (auto& a : A.reshaped()) a = normal(random);
  if (seed % 3 == 0)
    for (int c = 0; c < rank; ++c) A.col(c) *= std::pow(10, -2.0 * c / rank);
  LocalProblem p{A * A.transpose(), VecX(3 * k), VecX(k)};
  for (auto& q : p.q) q = normal(random);
  for (auto& mu : p.mu) mu = seed % 4 == 0 ? 0 : uniform(random);
  if (rank < 3 * k)
    p.q = A * VecX::NullaryExpr(rank,
                                [&] { return normal(random); });  // in the range: a solution exists
  return p;
}

// how far r is from the law, without the solver's own measure: gap, cone, dissipation
inline double law_defect(const LocalProblem& p, const VecX& r) {
  const VecX x = p.W * r + p.q;
  double defect = 0;
  for (int i = 0; i < p.n_contacts(); ++i) {
    const double r_n = r[3 * i], r_t = std::hypot(r[3 * i + 1], r[3 * i + 2]), x_n = x[3 * i];
    const double slip = std::hypot(x[3 * i + 1], x[3 * i + 2]), mu = p.mu[i];
    const double power = r_n * x_n + mu * r_n * slip +
                         (mu > 0 ? r[3 * i + 1] * x[3 * i + 1] + r[3 * i + 2] * x[3 * i + 2] : 0);
    defect = std::max({defect, -r_n, -x_n, r_t - mu * r_n, std::abs(power)});
  }
  return defect;
}

}  // namespace langer::test
