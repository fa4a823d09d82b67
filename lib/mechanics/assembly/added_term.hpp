// A force that belongs to a body beside those of its elements, such as its inertia, with its
// tangent. The assembly adds it last. Without one, nothing of it runs.
#pragma once

#include <vector>

#include "core/tensor/types.hpp"

namespace langer {

class AddedTerm {
 public:
  virtual ~AddedTerm() = default;

  // The force at u, (3 n) [N], on the side of the internal forces.
  virtual VecX force(const VecX& u) = 0;
  // Its derivative on the free rows, symmetric, in the tangent's pattern: (nnz) [N/mm].
  virtual const std::vector<double>& tangent() const = 0;
  // The derivative times du, (3 n) each.
  virtual VecX tangent_times(const VecX& du) const = 0;
};

}  // namespace langer
