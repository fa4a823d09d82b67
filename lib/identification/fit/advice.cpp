#include "identification/fit/advice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/tensor/dense.hpp"

namespace langer {

namespace {

// What an information matrix says about the parameters.
struct Known {
  // (p) standard errors relative to the size of each parameter; infinity: not determined
  VecX relative;
  double ln_det;
};

// Standard errors and log determinant of an information matrix, by its eigenvalues. The matrix is
// scaled to a unit diagonal first, so that the errors of well determined parameters keep their
// digits if the matrix is nearly singular.
Known known(const MatX& M) {
  const auto n = M.rows();
  VecX d = M.diagonal().cwiseSqrt();
  Known k{VecX::Constant(n, std::numeric_limits<double>::infinity()), 0};
  for (Eigen::Index i = 0; i < n; ++i)
    if (!(d[i] > 0)) d[i] = 1;
  const MatX scaled = d.cwiseInverse().asDiagonal() * M * d.cwiseInverse().asDiagonal();
  // The variance of parameter i is the sum of v_i^2 / l over the eigenpairs (l, v). A parameter
  // with a part in the null space has no finite variance.
  const SymmetricEigen eigen = symmetric_eigen(scaled);
  constexpr double floor = 1e-14;
  for (Eigen::Index i = 0; i < n; ++i) {
    double sum = 0;
    for (Eigen::Index c = 0; c < n; ++c) {
      const double v = eigen.vectors(i, c);
      const double l = eigen.values[c];
      if (l > floor)
        sum += v * v / l;
      else if (std::abs(v) > 1e-6)
        sum = std::numeric_limits<double>::infinity();
    }
    k.relative[i] = std::sqrt(sum) / d[i];
    k.ln_det += std::log(std::max(eigen.values[i], floor)) + 2 * std::log(d[i]);
  }
  return k;
}

}  // namespace

MatX information(const MatX& J, const VecX& size, double noise) {
  const MatX A = J * size.asDiagonal() / noise;
  return A.transpose() * A;
}

std::vector<Advice> advise(const MatX& so_far, const VecX& size,
                           const std::vector<Candidate>& candidates) {
  // Rank the candidates by the largest relative error that is left after the new test.
  const Known before = known(so_far);
  std::vector<Advice> all;
  for (const Candidate& c : candidates) {
    const Known after = known(so_far + information(c.J, size, c.noise));
    Advice one{c.name,
               after.relative.maxCoeff(),
               {after.relative.data(), after.relative.data() + after.relative.size()},
               0};
    one.gain = (after.ln_det - before.ln_det) / static_cast<double>(size.size());
    all.push_back(one);
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Advice& a, const Advice& b) { return a.worst < b.worst; });
  return all;
}

}  // namespace langer
