// A x = b for a matrix that is known by its products, preconditioned from the right.                                [SS86]
#pragma once

#include <functional>
#include <optional>

#include "tensor/types.hpp"

namespace langer {

struct GmresOptions {
  double wanted = 1e-10;  // |b - A x| / |b|
  double enough = 1e-5;   // where `largest` steps do not reach what is wanted
  int largest = 40;       // steps, each keeps a vector
};

using Product = std::function<VecX(const VecX&)>;

// Nothing where not even `enough` is reached.
std::optional<VecX> gmres(const Product& A, const Product& preconditioner, const VecX& b, const GmresOptions& options);

}  // namespace langer
