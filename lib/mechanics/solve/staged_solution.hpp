// A solution with the factor of a tangent in two steps: contact forces follow from the movement of
// the contact nodes without them.
#pragma once

#include "mechanics/solve/tangent_factor.hpp"

namespace langer {

class StagedSolution {
 public:
  // rhs: forces on the free rows, without those that follow. Refers to both.
  StagedSolution(const TangentFactor& factor, const VecX& rhs);

  const VecX& last() const { return last_; }  // movement of the rows of factor.last() so far
  // Movement of the free rows with forces on the rows of factor.last().
  VecX with(const VecX& force) const;

 private:
  const TangentFactor& factor_;
  const VecX& rhs_;
  LinearSolver::Half half_;  // of a factor that keeps these rows apart
  VecX last_;
};

}  // namespace langer
