// What an accepted state says about its stability: signs of the constrained tangent, strong
// ellipticity, falling force.
#include "accuracy/checks/stability_watch.hpp"

#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <cmath>

#include "core/tensor/dense.hpp"
#include "mechanics/nonlinear/load_path.hpp"
#include "support/block.hpp"
#include "support/directions.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

struct Seen {
  double stretch;
  StabilityReport report;
};

// a bar of n hexahedra pulled along x between lubricated ends, sides free
std::vector<Seen> pull(const Material& material, int n, double to, int steps, double width = 1) {
  Mesh mesh = test::block(test::even(0, 1, n), {0, width}, {0, width});
  std::vector<Prescribed> held;
  for (const auto& [face, axis] : {std::pair{"x_min", 0}, {"y_min", 1}, {"z_min", 2}})
    for (int i : mesh.node_sets[face]) held.push_back({3 * i + axis, 0});
  for (int i : mesh.node_sets["x_max"]) held.push_back({3 * i, to - 1});
  Assembler body = test::equilibrium(mesh, {material}, Formulation::mean_dilatation,
                                     number_dofs(mesh.n_nodes(), held).dofs);
  Increment increment(body, {}, {});
  StabilityWatch watch({});
  LoadPathOptions options;
  options.steps = steps;
  std::vector<Seen> seen;
  const PathReport path = load_path(
      options, 0, {}, {},
      [&](double t) {
        increment.begin(t);
        return newton(increment.problem(), increment.trial(), {});
      },
      [&](double t, double, double, const SolveReport&) {
        increment.accept();
        seen.push_back({1 + t * (to - 1), watch.look(body, increment)});
        return true;
      });
  REQUIRE(path.complete);
  return seen;
}

// first and last stretch of each run of `what`
template <class What>
std::vector<std::array<double, 2>> spans(const std::vector<Seen>& seen, What what) {
  std::vector<std::array<double, 2>> out;
  bool open = false;
  for (const Seen& s : seen) {
    const bool here = what(s.report);
    if (here && !open) out.push_back({s.stretch, s.stretch});
    if (here) out.back()[1] = s.stretch;
    open = here;
  }
  return out;
}

// K on the free dofs as a dense matrix
MatX dense(const Assembler& body) {
  const Pattern& p = body.pattern();
  MatX K = MatX::Zero(p.n, p.n);
  for (int c = 0; c < p.n; ++c)
    for (int k = p.column_start[c]; k < p.column_start[c + 1]; ++k)
      K(p.row[k], c) = K(c, p.row[k]) = body.K()[k];
  return K;
}

}  // namespace

TEST_CASE(
    "Table 1 along the fibres: the force falls from 1.079 to 1.159 and from 1.621, ellipticity is lost at 1.638") {
  const auto seen = pull(test::table1(0, 1e-6), 1, 1.7, 350);  // steps of 0.002
  const auto falling = spans(seen, [](const StabilityReport& r) { return r.falling; });
  REQUIRE(falling.size() == 2);
  // a step falls as a whole: its end lies up to one step and a half behind the maximum
  CHECK(std::abs(falling[0][0] - 1.079) < 0.004);
  CHECK(std::abs(falling[0][1] - 1.159) < 0.004);
  CHECK(std::abs(falling[1][0] - 1.621) < 0.004);
  CHECK(falling[1][1] == near(1.7));
  const auto lost = spans(seen, [](const StabilityReport& r) { return r.material_unstable(); });
  REQUIRE(lost.size() == 1);
  CHECK(std::abs(lost[0][0] - 1.638) < 0.003);
  CHECK(lost[0][1] == near(1.7));
  // one element held by its ends cannot neck: nothing is wrong with its equilibrium before the
  // material gives way
  for (const Seen& s : seen)
    if (s.stretch < 1.63) CHECK(s.report.signature->negative == 0);
  CHECK(seen.back().report.lost == near(1));
}

// A thread gives way where its force falls; in a thick bar the neighbours hold a neck back.
TEST_CASE(
    "n elements in a thread: n - 1 negative eigenvalues where the force falls and none elsewhere") {
  for (int n : {2, 4}) {
    const auto seen = pull(test::table1(0, 1e-6), n, 1.6, 150, 0.01);
    CAPTURE(n);
    int unstable = 0;
    for (const Seen& s : seen) {
      CAPTURE(s.stretch);
      if (s.stretch > 1.084 && s.stretch < 1.155) {
        CHECK(s.report.signature->negative >=
              n - 1);  // and a taper of each element where it falls steepest
        ++unstable;
      } else if (s.stretch < 1.074 || s.stretch > 1.165) {
        CHECK(s.report.signature->negative == 0);
      }
    }
    CHECK(unstable > 10);
    for (const Seen& s : pull(test::table1(0, 1e-6), n, 1.3, 75))
      CHECK(s.report.signature->negative == 0);
  }
}

TEST_CASE("a stable law is called stable all the way to twice its length") {
  for (const Seen& s : pull(test::stable(30, 1e-4), 3, 2, 20)) {
    CHECK(in_words(s.report) == "");
    CHECK_FALSE(s.report.falling);
    CHECK(s.report.fibre_max >= s.report.fibre_min);
  }
}

TEST_CASE(
    "signs with contact: the same from the factor's Schur complement, from L D L^T and from a dense matrix") {
  // a sphere pressed into a block whose base may glide, with and without friction: K alone is
  // singular or worse
  for (const double mu : {0.0, 0.5})
    for (const bool loose : {false, true}) {
      CAPTURE(mu);
      CAPTURE(loose);
      Mesh mesh = test::block(test::even(-2, 2, 5), test::even(0, 2, 2), test::even(-2, 2, 5));
      std::vector<Prescribed> held;
      for (int i : mesh.node_sets["y_min"])
        for (int k = 0; k < 3; ++k)
          if (k > 0 || !loose) held.push_back({3 * i + k, 0});
      const RigidContact contact{"sphere",
                                 Sphere{3, {0.1, 5, 0.05}},
                                 mu,
                                 mesh.node_sets["y_max"],
                                 {{1, Vec3(0, -0.5, 0)}}};
      const Material material = test::stable(40, 1e-3);
      Assembler body = test::equilibrium(mesh, {material}, Formulation::mean_dilatation,
                                         number_dofs(mesh.n_nodes(), held).dofs);
      Increment increment(body, {contact}, {});
      for (double t : {0.1, 0.2, 0.3, 0.4}) {
        increment.begin(t);
        const SolveReport report = newton(increment.problem(), increment.trial(), {});
        if (!report.converged()) break;  // a block that nothing holds may glide away
        increment.accept();
        const Signature found = increment.signature();
        // the definition, dense
        const Dofs& dofs = body.dofs();
        MatX K = dense(body), Z = MatX::Zero(dofs.n_free(), dofs.n_free());
        const ContactDefect defect = increment.defects()[0];
        Eigen::Index columns = 0;
        std::vector<int> candidate(static_cast<std::size_t>(mesh.n_nodes()), -1);
        for (std::size_t i = 0; i < contact.nodes.size(); ++i)
          candidate[contact.nodes[i]] = static_cast<int>(i);
        for (int node = 0; node < mesh.n_nodes(); ++node) {
          Mat3 basis = Mat3::Identity();
          int kept = 3;
          if (const int i = candidate[node]; i >= 0 && defect.status[i] != ContactStatus::open) {
            const Vec3 c = indenter_displacement(contact, t);
            const ShapePoint shape = shape_at(
                contact.shape, mesh.X[node] + increment.accepted().u.segment<3>(3 * node) - c);
            const Mat3 frame = contact_frame(shape.normal);
            basis << frame.col(1), frame.col(2), frame.col(0);
            kept = defect.status[i] == ContactStatus::slip ? 2 : 0;
            if (kept == 2)
              for (int j = 0; j < 3; ++j)
                for (int k = 0; k < 3; ++k)
                  K(dofs.equation[3 * node + j], dofs.equation[3 * node + k]) -=
                      increment.accepted().r[0][i].dot(shape.normal) * shape.curvature(j, k);
          }
          for (int c = 0; c < kept; ++c) {
            VecX z = VecX::Zero(dofs.n_free());
            for (int j = 0; j < 3; ++j)
              if (const int row = dofs.equation[3 * node + j]; row >= 0) z[row] = basis(j, c);
            if (z.norm() > 0) Z.col(columns++) = z;
          }
        }
        const auto used = Z.leftCols(columns);
        const VecX e = symmetric_eigenvalues(used.transpose() * K * used);
        const int negative = static_cast<int>((e.array() < -1e-9 * e.maxCoeff()).count());
        CAPTURE(t);
        CHECK(found.negative == negative);
        // without contact: pivots against eigenvalues, and a shifted K that is surely indefinite
        LinearSolver linear(body.pattern());
        for (double shift : {0.0, 0.3, 0.9}) {
          std::vector<double> values = body.K();
          const MatX plain = dense(body);
          const VecX own = symmetric_eigenvalues(plain);
          const double middle = shift == 0
                                    ? 0
                                    : 0.5 * (own[static_cast<int>(shift * (own.size() - 2))] +
                                             own[static_cast<int>(shift * (own.size() - 2)) + 1]);
          if (shift == 0 && loose) continue;  // singular
          for (int c = 0; c < body.pattern().n; ++c)
            values[body.pattern().column_start[c]] -= middle;
          CHECK(linear.negative_pivots(values) == (own.array() < middle).count());
        }
      }
    }
}
