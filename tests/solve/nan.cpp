// Numbers that are none never make a success.
#include <doctest/doctest.h>

#include <cmath>

#include "support/directions.hpp"
#include "support/indentation.hpp"
#include "support/laws.hpp"

using namespace langer;

TEST_CASE(
    "NaN in the residual of a real scene, whenever and with whichever solver: never a success, never a hang") {
  const Material skin = test::stable(30, 1e-4);
  Mesh mesh = test::block(test::even(-2, 2, 4), test::even(0, 2, 2), test::even(-2, 2, 4));
  std::vector<Prescribed> held;
  for (int i : mesh.node_sets["y_min"])
    for (int k = 0; k < 3; ++k) held.push_back({3 * i + k, 0});
  const RigidContact contact{
      "sphere", Sphere{3, {0, 5, 0}}, 0.3, mesh.node_sets["y_max"], {{1, Vec3(0, -0.3, 0)}}};
  const Dofs dofs = number_dofs(mesh.n_nodes(), held).dofs;
  std::vector<std::variant<NewtonOptions, KinsolOptions>> solvers{NewtonOptions{}};
  for (KinsolStrategy s : {KinsolStrategy::newton, KinsolStrategy::linesearch,
                           KinsolStrategy::picard, KinsolStrategy::fixed_point})
    solvers.push_back(KinsolOptions{.strategy = s, .iterations = 30, .rounds = 6});
  for (const auto& solver : solvers)
    for (int from : {0, 1, 2, 3, 5}) {
      CAPTURE(solver.index());
      CAPTURE(from);
      Assembler body = test::equilibrium(mesh, {skin}, Formulation::mean_dilatation, dofs);
      Increment increment(body, {contact}, {});
      int calls = 0;
      const Problem clean = increment.problem();
      Problem spoilt = clean;
      spoilt.assess = [&](const VecX& x, bool with_tangent) {
        Assessment a = clean.assess(x, with_tangent);
        if (calls++ >= from) a.residual = std::nan("");
        return a;
      };
      const FreeBalance fixed = increment.free_balance();
      FreeBalance spoilt_fixed = fixed;
      spoilt_fixed.residual = [&](const VecX& x, VecX& f) {
        const bool ok = fixed.residual(x, f);
        if (ok && calls++ >= from) f[0] = std::nan("");
        return ok;
      };
      LoadPathOptions options;
      options.first = options.largest = 0.5, options.smallest = 0.1;
      const PathReport path = load_path(
          options, 0, {}, {},
          [&](double t) {
            increment.begin(t);
            if (const auto* o = std::get_if<KinsolOptions>(&solver))
              return kinsol(spoilt, spoilt_fixed, increment.trial(), *o);
            return newton(spoilt, increment.trial(), std::get<NewtonOptions>(solver));
          },
          [&](double, double, double, const SolveReport&) {
            increment.accept();
            return true;
          });
      CHECK_FALSE(path.complete);
      CHECK_FALSE(path.why.empty());
      CHECK(calls < 3000);
      CHECK(increment.accepted().u.allFinite());
    }
}
