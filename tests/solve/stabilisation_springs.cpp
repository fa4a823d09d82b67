// Matrices that are not positive definite, without a second factorization of another kind.
#include <doctest/doctest.h>

#include <Eigen/Dense>

#include "core/tensor/dense.hpp"
#include "mechanics/assembly/assembler.hpp"
#include "mechanics/linear/linear.hpp"
#include "support/block.hpp"
#include "support/directions.hpp"
#include "support/laws.hpp"

using namespace langer;

TEST_CASE("springs: an indefinite matrix solved by Cholesky and a few springs taken out again") {
  const Mesh mesh = test::block(test::even(0, 1, 3), test::even(0, 1.3, 3),
                                test::even(0, 0.8, 3));  // no two alike
  std::vector<Prescribed> held;
  for (int i : mesh.node_sets.at("y_min"))
    for (int k = 0; k < 3; ++k) held.push_back({3 * i + k, 0});
  Assembler body =
      test::equilibrium(mesh, {test::neo_hooke(0.5, 0.1)}, Formulation::mean_dilatation,
                        number_dofs(mesh.n_nodes(), held).dofs);
  REQUIRE(body.assemble(VecX::Zero(body.dofs().n), true));
  const Pattern& p = body.pattern();
  const auto dense = [&](const std::vector<double>& values) {
    MatX K = MatX::Zero(p.n, p.n);
    for (int c = 0; c < p.n; ++c)
      for (int k = p.column_start[c]; k < p.column_start[c + 1]; ++k)
        K(p.row[k], c) = K(c, p.row[k]) = values[k];
    return K;
  };
  const VecX e = symmetric_eigenvalues(dense(body.K()));
  std::vector<int> last;
  for (int i : mesh.node_sets.at("y_max"))
    for (int k = 0; k < 3; ++k) last.push_back(body.dofs().equation[3 * i + k]);
  LinearSolver linear(p, last);
  const VecX b = VecX::LinSpaced(p.n, -1, 2);
  for (int negative : {0, 1, 3, 7}) {
    CAPTURE(negative);
    std::vector<double> values = body.K();
    const double shift = negative == 0 ? 0 : 0.5 * (e[negative - 1] + e[negative]);
    for (int c = 0; c < p.n; ++c) values[p.column_start[c]] -= shift;
    CHECK(linear.factorize(values) == (negative == 0));
    // Springs go where pivots fail, so how many it takes depends on the order of the rows, and that
    // on the version of METIS: 7 modes took 18 with one of them, and with another more than are
    // allowed. Then UMFPACK solves it, as well.
    if (!linear.factorize_with_springs(values)) {
      CHECK(negative == 7);
      REQUIRE(linear.factorize_indefinite(values));
    }
    const MatX K = dense(values);
    CHECK((K * linear.solve(b) - b).norm() < 1e-9 * b.norm());
    const MatX B = MatX::Identity(static_cast<Eigen::Index>(last.size()), 5);
    MatX wide = MatX::Zero(p.n, 5);
    for (int c = 0; c < 5; ++c) wide(last[static_cast<std::size_t>(c)], c) = 1;
    const MatX W = wide.transpose() * Lu(K).solve_columns(wide);
    CHECK((linear.compliance(B) - W).norm() < 1e-8 * W.norm());
  }
  std::vector<double> values = body.K();
  for (double& v : values) v = -v;
  CHECK_FALSE(linear.factorize_with_springs(values, 5));
}
