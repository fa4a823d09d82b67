// A body whose cells are divided among ranks: what each makes of its own is together what one makes
// of all.
#include <doctest/doctest.h>

#include <mutex>

#include "core/base/random.hpp"
#include "mechanics/linear/mixed_tangent.hpp"
#include "support/block.hpp"
#include "support/directions.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"
#include "support/thread_ranks.hpp"

using namespace langer;

namespace {

struct Slab {
  Mesh mesh = test::block(test::graded(2, 6, 0.3), test::even(0, 1.5, 3), test::even(-2, 2, 5));
  Dofs dofs;
  VecX u, du;

  Slab() {
    std::vector<Prescribed> held;
    for (int i : mesh.node_sets.at("y_min"))
      for (int k = 0; k < 3; ++k)
        if (k != 0 || i % 2 == 0) held.push_back({3 * i + k, 0});
    for (int i : mesh.node_sets.at("y_max")) held.push_back({3 * i + 1, -0.1});
    dofs = number_dofs(mesh.n_nodes(), held).dofs;
    Random random(3);
    u.resize(dofs.n), du = VecX::Zero(dofs.n);
    for (double& x : u) x = 0.01 * (random.uniform() - 0.5);
    for (const Prescribed& p : dofs.prescribed) du[p.dof] = random.uniform();
  }

  Assembler assembler(std::optional<Division> division = {}) const {
    const std::vector<Material> laws{test::table1(30, 1e-6)};
    return Assembler(mesh, laws, test::directions(mesh, laws), Formulation::mean_dilatation, dofs,
                     1, Kernel::packets, {}, std::move(division));
  }
  // some cells here, some there
  Division division(const Ranks& ranks) const {
    Division out{&ranks, {}};
    for (int e = 0; e < mesh.n_cells(); ++e)
      out.rank_of.push_back(mesh.X[mesh.connectivity[static_cast<std::size_t>(e) * 8]][0] < -0.5 ? 0
                            : (e * 7) % 5 < 2 ? ranks.n() - 1
                                              : e % ranks.n());
    return out;
  }
};

void agree(const VecX& found, const VecX& wanted, double tolerance = 1e-12) {
  CHECK((found - wanted).norm() <= tolerance * wanted.norm());
}

}  // namespace

TEST_CASE("divided: forces, energy, bounds and the tangent's products of ranks are those of one") {
  const Slab scene;
  Assembler whole = scene.assembler();
  REQUIRE(whole.assemble(scene.u, true, &scene.du));
  VecX v(scene.dofs.n_free());
  Random random(5);
  for (double& x : v) x = random.uniform() - 0.5;
  for (int n : {2, 3}) {
    std::mutex alone;  // doctest's, among threads
    test::on_ranks(n, [&](const Ranks& ranks) {
      Assembler part = scene.assembler(scene.division(ranks));
      const bool assembled = part.assemble(scene.u, true, &scene.du);
      VecX product = part.K_times(v);
      ranks.sum(product.data(), static_cast<std::size_t>(product.size()));
      const double J_min = part.smallest_J(scene.u);
      const Assembler::VolumetricPart volume = part.volumetric_part(),
                                      all = whole.volumetric_part();
      VecX turned = scene.u;
      turned[3 * scene.mesh.n_nodes() / 2] +=
          100;  // a cell of one rank is turned inside out: all know
      const bool of_turned = part.assemble(turned, false);
      const std::lock_guard lock(alone);
      CHECK(assembled);
      CHECK(!of_turned);
      CHECK(part.own_cells().size() < static_cast<std::size_t>(scene.mesh.n_cells()));
      agree(product, whole.K_times(v));
      CHECK(J_min == whole.smallest_J(scene.u));
      agree(volume.missing, all.missing);
      CHECK(volume.b == all.b);
    });
    test::on_ranks(n, [&](const Ranks& ranks) {
      Assembler part = scene.assembler(scene.division(ranks));
      part.assemble(scene.u, true, &scene.du);
      const std::lock_guard lock(alone);
      agree(part.f_int(), whole.f_int());
      agree(part.K_du(), whole.K_du());
      CHECK(part.W() == near(whole.W(), 1e-13));
      CHECK(part.J_min() == whole.J_min());
      CHECK(part.rounding_floor() == near(whole.rounding_floor(), 1e-13));
    });
  }
}

TEST_CASE(
    "divided: the Schur complement of the pressures is factorized exactly, however the cells lie") {
  const Slab scene;
  std::vector<int> rows = scene.assembler().element_dofs();
  for (int& row : rows)
    if (scene.dofs.equation[static_cast<std::size_t>(row)] < 0) row = -1;
  Random random(7);
  std::vector<double> scaled(rows.size());
  for (double& x : scaled) x = random.uniform() - 0.5;
  const int cells = scene.mesh.n_cells();
  VecX inverse_D(cells), g(cells);
  for (int e = 0; e < cells; ++e)
    inverse_D[e] = 1e-3 * (1 + random.uniform()), g[e] = random.uniform() - 0.5;
  PressureSchur whole(rows, scene.dofs.n, nullptr, 1);
  REQUIRE(whole.factorize(scaled, inverse_D));
  const VecX wanted = whole.solve(g);
  std::mutex alone;
  const auto same = [&](int n, const std::function<int(int)>& rank_of) {
    test::on_ranks(n, [&](const Ranks& ranks) {
      Division division{&ranks, {}};
      for (int e = 0; e < cells; ++e) division.rank_of.push_back(rank_of(e));
      PressureSchur part(rows, scene.dofs.n, &division, 1);
      for (int twice = 0; twice < 2; ++twice) {
        const bool positive = part.factorize(scaled, inverse_D);
        const VecX found = part.solve(g);
        const std::lock_guard lock(alone);
        CHECK(positive);
        agree(found, wanted, 1e-10);
      }
    });
  };
  const auto x_of = [&](int e) {
    return scene.mesh.X[scene.mesh.connectivity[static_cast<std::size_t>(e) * 8]][0];
  };
  same(2, [&](int e) { return x_of(e) < 0 ? 0 : 1; });  // a layer between them
  same(3, [&](int e) { return x_of(e) < -0.5 ? 2 : x_of(e) < 0.5 ? 0 : 1; });
  same(2, [&](int e) { return e % 2; });                // nearly all between them: rank 0 has them
  same(4, [&](int e) { return x_of(e) < 0 ? 1 : 3; });  // two have none
  VecX negative = inverse_D;
  negative[3] = -100;
  test::on_ranks(2, [&](const Ranks& ranks) {
    Division division{&ranks, {}};
    for (int e = 0; e < cells; ++e) division.rank_of.push_back(x_of(e) < 0 ? 0 : 1);
    PressureSchur part(rows, scene.dofs.n, &division, 1);
    const bool positive = part.factorize(scaled, negative);
    const std::lock_guard lock(alone);
    CHECK(!positive);
  });
}
