// Contact in the tangent where the body is solved iteratively: law and candidates act on
// displacements and pressures together.
#include <Eigen/Dense>
#include <algorithm>

#include "mechanics/solve/contact_in_tangent.hpp"

namespace langer {

// B Q
void ContactInTangent::turn_dyads(const std::vector<int>& cell_rows, std::vector<double>& b) const {
  for (std::size_t k = 0; k < cell_rows.size(); k += 3) {
    std::size_t first = k;
    while (first < k + 3 && cell_rows[first] < 0) ++first;
    if (first == k + 3 || begins_[cell_rows[first]] < 0) continue;
    const Candidate& c = candidates_[static_cast<std::size_t>(begins_[cell_rows[first]])];
    Vec3 own = Vec3::Zero();
    int n = 0;
    for (std::size_t i = first; i < k + 3; ++i)
      if (cell_rows[i] >= 0) own[n++] = b[i];
    own.head(n) = (c.Q.topLeftCorner(n, n).transpose() * own.head(n)).eval();
    n = 0;
    for (std::size_t i = first; i < k + 3; ++i)
      if (cell_rows[i] >= 0) b[i] = own[n++];
  }
}

bool ContactInTangent::precondition(MixedTangent& mixed) {
  std::vector<char> is_given;
  given(is_given);
  MatX rigid = mixed.rigid();
  for (Eigen::Index k = 0; k < rigid.cols(); ++k) rigid.col(k) = turned(rigid.col(k), false);
  std::string why;
  const Ranks* ranks = mixed.solver().ranks();
  return mixed.solver().precondition(matrix(true, !ranks || ranks->first()), mixed.b(), mixed.D(),
                                     is_given, rigid, why);
}

// A y + B^T q
VecX ContactInTangent::force_of(MixedTangent& mixed, const VecX& y, const VecX* q) const {
  VecX force = times(y);
  if (q) mixed.solver().spread_own(mixed.b(), *q, force);
  if (const Ranks* ranks = mixed.solver().ranks())
    ranks->sum(force.data(), static_cast<std::size_t>(force.size()));
  return force;
}

// K_ is A here, and Ky of what is returned A y + B^T q. from: y and q of a solution with other
// states of the candidates, and then of this one.
std::optional<ContactInTangent::Solved> ContactInTangent::solution(MixedTangent& mixed,
                                                                   double relative,
                                                                   MixedSolver::Answer& from,
                                                                   VecX& dp) const {
  const MixedSolver& solver = mixed.solver();
  const std::vector<double>& b = mixed.b();
  std::vector<char> is_given;
  Solved at{given(is_given), {}};
  at.Ky = force_of(mixed, at.y);
  const auto given_out = [&](VecX& d) {
    for (Eigen::Index row = 0; row < d.size(); ++row)
      if (is_given[static_cast<std::size_t>(row)]) d[row] = 0;
  };
  const VecX f = missing(at.y, at.Ky, 1, is_given);
  const VecX g = mixed.known_strain() - solver.gather(b, at.y);
  const VecX diagonal = solver.diagonal_of(K_);
  const auto product = [&](const VecX& d, const VecX& q, VecX& of_f, VecX& of_g) {
    VecX own = d;
    given_out(own);
    of_f = -missing(own, force_of(mixed, own, &q), 0, is_given);
    for (Eigen::Index row = 0; row < own.size(); ++row)
      if (is_given[static_cast<std::size_t>(row)]) of_f[row] = diagonal[row] * d[row];
    of_g = solver.gather(b, own) - q.cwiseQuotient(mixed.D());
  };
  if (from.d.size() > 0) given_out(from.d);
  const int before = from.products;
  from = solver.solve(product, b, f, g, relative, MixedTangent::most, from);
  from.products += before;
  if (!from.converged) return std::nullopt;
  given_out(from.d);
  at.y += from.d;
  from.d = at.y;
  at.Ky = force_of(mixed, at.y, &from.q);
  dp = mixed.pressures(solver.gather(b, at.y), from.q);
  return at;
}

// Multigrid is made anew where many candidates do something else than in it, or when the products
// that a new one would have saved have cost as much as it does. A solution is more accurate where
// the last correction has left more than a tenth of the residual.
std::optional<ContactInTangent::Answer> ContactInTangent::solve(const ContactState& state,
                                                                const Assembler& body,
                                                                const VecX& rhs,
                                                                MixedTangent& mixed, VecX& dp) {
  constexpr int price = 10;  // of a new multigrid, in products
  constexpr int many = 10;   // candidates, each of which costs about a product
  const bool slow = residual_ > 0 && rhs.norm() > 0.1 * residual_;
  const double relative = slow ? MixedTangent::accurate : MixedTangent::usual;
  residual_ = rhs.norm();
  linearise_at(state, true);
  K_ = mixed.rest_of(body);
  turn(K_);
  turn_dyads(mixed.cell_rows(), mixed.b());
  rhs_ = turned(rhs, false);
  mixed.solver().spread(mixed.b(), mixed.known_force(), rhs_);
  for (Candidate& c : candidates_) judge(c, c.present, c.q);
  std::optional<Answer> answer;
  MixedSolver::Answer last;
  for (int step = 0; step < 30; ++step) {
    const auto differ =
        std::count_if(candidates_.begin(), candidates_.end(),
                      [](const Candidate& c) { return c.law.status != c.factored; });
    const bool anew = !mixed.solver().preconditioned() || differ > many || lost_ > price;
    if (anew) {
      if (!precondition(mixed)) return std::nullopt;
      for (Candidate& c : candidates_) c.factored = c.law.status;
    }
    const int before = last.products;
    const auto solved = solution(mixed, relative, last, dp);
    if (!solved && anew) return std::nullopt;
    if (!solved) {
      lost_ = price + 1;
      last.d.resize(0);
      continue;
    }
    const int products = last.products - before;
    if (anew) {
      fresh_ = products;
      lost_ = 0;
    }
    lost_ += std::max(products - fresh_, 0);
    answer = answer_of(*solved, state);
    // Candidates may change to and fro where the last answer is accurate enough for either.
    const bool stays = step > 0 && products == 0;
    if (changes(*solved) == 0 || stays) break;
  }
  if (answer) answer->solutions = last.products;
  return answer;
}

}  // namespace langer
