#include "mechanics/solve/staged_solution.hpp"

namespace langer {

StagedSolution::StagedSolution(const TangentFactor& factor, const VecX& rhs)
    : factor_(factor), rhs_(rhs) {
  if (factor.kind() == TangentFactor::Kind::whole) {
    half_ = factor.linear().start(rhs);
    last_ = half_.last;
    return;
  }
  const VecX all = factor.linear().solve(rhs);
  last_.resize(static_cast<Eigen::Index>(factor.last().size()));
  for (Eigen::Index i = 0; i < last_.size(); ++i)
    last_[i] = all[factor.last()[static_cast<std::size_t>(i)]];
}

VecX StagedSolution::with(const VecX& force) const {
  if (factor_.kind() == TangentFactor::Kind::whole) return factor_.linear().finish(half_, force);
  VecX all = rhs_;
  for (std::size_t i = 0; i < factor_.last().size(); ++i)
    all[factor_.last()[i]] += force[static_cast<Eigen::Index>(i)];
  return factor_.linear().solve(all);
}

}  // namespace langer
