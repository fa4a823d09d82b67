// Bodies under tractions and pressures, against closed forms and against imposed displacements.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "mechanics/mesh/select.hpp"
#include "mechanics/nonlinear/load_path.hpp"
#include "mechanics/nonlinear/newton.hpp"
#include "mechanics/solve/increment.hpp"
#include "support/block.hpp"
#include "support/directions.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

struct Ended {
  VecX u;
  int iterations = 0;
};

Ended solved(const Mesh& mesh, const Material& law, std::vector<Prescribed> held,
             std::vector<SurfaceLoad> loads, int steps,
             const NewtonOptions& newton_options = {.relative = 1e-10}) {
  Assembler body = test::equilibrium(mesh, {law}, usual_formulation(mesh.type),
                                     number_dofs(mesh.n_nodes(), std::move(held)).dofs);
  if (!loads.empty()) body.set_loads({mesh, std::move(loads)});
  Increment increment(body, {}, {});
  LoadPathOptions path;
  path.steps = steps;
  const PathReport report = load_path(
      path, 0, {}, {},
      [&](double t) {
        increment.begin(t);
        return newton(increment.problem(), increment.trial(), newton_options);
      },
      [&](double, double, double, const SolveReport&) {
        increment.accept();
        return true;
      });
  CAPTURE(report.why);
  REQUIRE(report.complete);
  return {increment.accepted().u, report.iterations + report.again};
}

std::vector<Prescribed> on_planes(const Mesh& mesh) {  // symmetry planes x = y = z = 0
  std::vector<Prescribed> held;
  for (const auto& [face, k] : {std::pair{"x_min", 0}, {"y_min", 1}, {"z_min", 2}})
    for (int n : mesh.node_sets.at(face)) held.push_back({3 * n + k, 0});
  return held;
}

Mesh sided(Mesh mesh, CellType cells) {
  if (cells != CellType::hex8) mesh = test::raised_block(mesh, cells);
  name_sides(mesh);
  return mesh;
}

}  // namespace

TEST_CASE(
    "a block under a dead traction is stretched as by a displacement that needs this force, whatever the cells and the law") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> draw(0.5, 1.5);
  for (CellType cells : {CellType::hex8, CellType::hex27, CellType::tet15})
    for (int k = 0; k < 2; ++k) {
      const Mesh mesh = sided(
          test::block(test::even(0, 2, 2), test::even(0, 1, 2), test::even(0, 1.5, 2)), cells);
      const Material law =
          k == 0 ? test::neo_hooke(0.05 * draw(random), 0.1) : test::stable(90, 0.1);
      const double traction = 0.08 * draw(random);
      const Ended pulled =
          solved(mesh, law, on_planes(mesh),
                 {{mesh.facet_sets.at("x_max"), Vec3(traction, 0, 0), 0, nullptr}}, 4);
      const double to = pulled.u[3 * mesh.node_sets.at("x_max").front()];
      CHECK(to > 0.1);
      std::vector<Prescribed> held = on_planes(mesh);
      for (int n : mesh.node_sets.at("x_max")) held.push_back({3 * n, to});
      Assembler body = test::equilibrium(mesh, {law}, usual_formulation(mesh.type),
                                         number_dofs(mesh.n_nodes(), held).dofs);
      const Ended moved = solved(mesh, law, held, {}, 4);
      CHECK((pulled.u - moved.u).lpNorm<Eigen::Infinity>() < 1e-7);
      body.pressures_from(moved.u);
      REQUIRE(body.assemble(moved.u, false));
      double force = 0;
      for (int n : mesh.node_sets.at("x_max")) force += body.f_int()[3 * n];
      CHECK(force == near(traction * 1.5, 1e-7));
    }
}

TEST_CASE(
    "uniform pressure all around makes J what the volume law says, with the area that is left") {
  const double d = 0.5, a1 = 0.1, p = 0.4;
  for (CellType cells : {CellType::hex8, CellType::hex27, CellType::tet15}) {
    Mesh mesh = sided(test::cube(2), cells);
    std::vector<Facet> facets;
    for (const char* side : {"x_max", "y_max", "z_max"})
      for (const Facet& f : mesh.facet_sets.at(side)) facets.push_back(f);
    const Ended end = solved(mesh, test::neo_hooke(a1, d), on_planes(mesh),
                             {{facets, Vec3::Zero(), p, nullptr}}, 4);
    // U = (J - 1)^2 / d: dU/dJ = 2 (J - 1)/d = -p; nothing isochoric
    const double stretch = std::cbrt(1 - 0.5 * p * d);
    for (int n : mesh.node_sets.at("x_max")) CHECK(end.u[3 * n] == near(stretch - 1, 1e-8));
  }
}

namespace {

// sigma_theta - sigma_r of an incompressible neo-Hooke tube, plane strain, over its thickness: the
// inside pressure
double tube_pressure(double mu, double A, double B, double a) {
  const int n = 20000;
  double sum = 0;
  for (int i = 0; i < n; ++i) {  // over R: r^2 = R^2 + a^2 - A^2, dr/r = R dR / r^2
    const double R = A + (B - A) * (i + 0.5) / n, r2 = R * R + a * a - A * A, l2 = r2 / (R * R);
    sum += mu * (l2 - 1 / l2) * R / r2 * (B - A) / n;
  }
  return sum;
}
double sphere_pressure(double mu, double A, double B, double a) {
  const int n = 20000;
  double sum = 0;
  for (int i = 0; i < n; ++i) {  // r^3 = R^3 + a^3 - A^3, 2 (sigma_theta - sigma_r)/r dr
    const double R = A + (B - A) * (i + 0.5) / n, r3 = R * R * R + a * a * a - A * A * A,
                 l = std::cbrt(r3) / R;
    sum += 2 * mu * (l * l - std::pow(l, -4)) * R * R / r3 * (B - A) / n;
  }
  return sum;
}

}  // namespace

namespace {

constexpr double shear = 0.1;

// root of the mean square, over all nodes, of what their radius misses
template <class Radius, class Right>
double missed(const Mesh& mesh, const Radius& radius, const Right& right) {
  double sum = 0;
  for (int i = 0; i < mesh.n_nodes(); ++i) sum += std::pow(radius(i) - right(i), 2);
  return std::sqrt(sum / mesh.n_nodes());
}

// a quarter of a tube between fixed planes, n cells through its wall, opened from 1 to 1.25 mm
double of_tube(int n, CellType cells) {
  const double A = 1, B = 2, a = 1.25, p = tube_pressure(shear, A, B, a);
  Mesh mesh =
      sided(test::block(test::even(A, B, n), test::even(0, 0.2, 1), test::even(0, 1, n)), cells);
  for (Vec3& X : mesh.X) {
    const double r = X[0], turn = 0.5 * std::numbers::pi * X[2];
    X = Vec3(r * std::cos(turn), X[1], r * std::sin(turn));
  }
  std::vector<Prescribed> held;
  for (const auto& [face, k] : {std::pair{"z_min", 2}, {"z_max", 0}, {"y_min", 1}, {"y_max", 1}})
    for (int i : mesh.node_sets.at(face)) held.push_back({3 * i + k, 0});
  const Ended end = solved(mesh, test::neo_hooke(0.5 * shear, 1e-6), held,
                           {{mesh.facet_sets.at("x_min"), Vec3::Zero(), p, nullptr}}, 5);
  const auto across = [](const Vec3& x) {
    return std::hypot(x[0], x[2]);
  };
  return missed(
      mesh, [&](int i) { return across(mesh.X[i] + end.u.segment<3>(3 * i)); },
      [&](int i) { return std::sqrt(std::pow(across(mesh.X[i]), 2) + a * a - A * A); });
}

// a quarter of a sixth of a shell (what a cone from the centre through a cube's face cuts out),
// opened from 1 to 1.15 mm
double of_shell(int n, CellType cells) {
  const double A = 1, B = 1.5, a = 1.15, p = sphere_pressure(shear, A, B, a);
  Mesh mesh =
      sided(test::block(test::even(0, 1, n), test::even(A, B, n), test::even(0, 1, n)), cells);
  std::vector<Vec3> out(mesh.X.size());
  for (std::size_t i = 0; i < mesh.X.size(); ++i) {
    const Vec3 X = mesh.X[i];
    out[i] =
        Vec3(std::tan(0.25 * std::numbers::pi * X[0]), 1, std::tan(0.25 * std::numbers::pi * X[2]))
            .normalized();
    mesh.X[i] = X[1] * out[i];
  }
  // on the slanting planes x = y, z = y nodes move radially, as everywhere: those planes are no
  // coordinate planes, so the radial displacement of the closed form is imposed there, in
  // proportion to nothing but the end of the path
  std::vector<Prescribed> held;
  std::vector<char> told(mesh.X.size() * 3, 0);
  const auto hold = [&](int node, int k, double to) {
    if (!std::exchange(told[3 * static_cast<std::size_t>(node) + static_cast<std::size_t>(k)], 1))
      held.push_back({3 * node + k, to});
  };
  for (const char* face : {"x_max", "z_max"})
    for (int i : mesh.node_sets.at(face)) {
      const double R = mesh.X[i].norm(), r = std::cbrt(R * R * R + a * a * a - A * A * A);
      for (int k = 0; k < 3; ++k) hold(i, k, (r - R) * out[i][k]);
    }
  for (const auto& [face, k] : {std::pair{"x_min", 0}, {"z_min", 2}})
    for (int i : mesh.node_sets.at(face)) hold(i, k, 0);
  const Ended end = solved(mesh, test::neo_hooke(0.5 * shear, 1e-6), held,
                           {{mesh.facet_sets.at("y_min"), Vec3::Zero(), p, nullptr}}, 4);
  return missed(
      mesh, [&](int i) { return (mesh.X[i] + end.u.segment<3>(3 * i)).norm(); },
      [&](int i) { return std::cbrt(std::pow(mesh.X[i].norm(), 3) + a * a * a - A * A * A); });
}

struct Fineness {
  CellType cells;
  std::vector<int> n;  // each twice the one before
  double order;
};

// the order from the last two; what is left is relative to how far the inner wall moves
void need_orders(const char* what, double (*error)(int, CellType), double moved,
                 const std::vector<Fineness>& all) {
  for (const Fineness& asked : all) {
    std::string said =
        std::string(what) + ", " + names(asked.cells)[static_cast<std::size_t>(asked.cells)];
    double before = 0, order = 0, left = 0;
    for (int n : asked.n) {
      left = error(n, asked.cells) / moved;
      said += "; " + std::to_string(n) + " cells " + std::to_string(1e6 * left) + "e-6";
      if (before > 0)
        order = std::log2(before / left), said += " (order " + std::to_string(order) + ")";
      before = left;
    }
    MESSAGE(said);
    CHECK(order > asked.order);
    CHECK(left < 4e-3);
  }
}

}  // namespace

TEST_CASE(
    "a thick-walled tube under inside pressure meets its closed form at order 2 with hex8, 3 with hex27") {
  need_orders("tube", of_tube, 0.25,
              {{CellType::hex8, {4, 8, 16}, 1.8}, {CellType::hex27, {2, 4, 8}, 3}});
}

TEST_CASE(
    "a spherical shell under inside pressure meets its closed form at order 2 with hex8, 3 with hex27") {
  need_orders("shell", of_shell, 0.15,
              {{CellType::hex8, {3, 6, 12}, 1.8}, {CellType::hex27, {1, 2, 4}, 3}});
}

TEST_CASE(
    "a pressure with a free rim takes at most 1.5 times the iterations of a dead load, and pushes where the surface has turned") {
  const Mesh mesh = sided(
      test::block(test::even(0, 4, 6), test::even(0, 1, 2), test::even(0, 2, 3)), CellType::hex8);
  std::vector<Prescribed> held;
  for (int n : mesh.node_sets.at("x_min"))
    for (int k = 0; k < 3; ++k) held.push_back({3 * n + k, 0});
  const Material law = test::neo_hooke(0.1, 1e-2);
  const double p = 1.5e-3;
  const auto& top = mesh.facet_sets.at("y_max");
  const Ended dead = solved(mesh, law, held, {{top, Vec3(0, -p, 0), 0, nullptr}}, 5, {});
  const Ended follows = solved(mesh, law, held, {{top, Vec3::Zero(), p, nullptr}}, 5, {});
  int tip = 0;
  for (int n : mesh.node_sets.at("x_max")) tip = n;
  CHECK(dead.u[3 * tip + 1] < -0.8);
  CHECK(follows.u[3 * tip] <
        dead.u[3 * tip] - 1e-3);  // the bent top is pushed back towards the wall
  CAPTURE(dead.iterations);
  CAPTURE(follows.iterations);
  CHECK(follows.iterations <= 1.5 * dead.iterations);
}

TEST_CASE(
    "a cube that suction on a free face pulls far needs as many iterations as under a dead load that pulls it as far") {
  for (CellType cells : {CellType::hex8, CellType::hex27}) {
    const Mesh mesh = sided(test::cube(2), cells);
    const double a1 = 0.1;
    const Material law = test::neo_hooke(a1, 1e-4);
    const auto& face = mesh.facet_sets.at("x_max");
    // sigma = 2 a1 (l^2 - 1/l); a dead traction is sigma / l
    const double l = 1.3, sigma = 2 * a1 * (l * l - 1 / l);
    const Ended follows =
        solved(mesh, law, on_planes(mesh), {{face, Vec3::Zero(), -sigma, nullptr}}, 4);
    const Ended dead =
        solved(mesh, law, on_planes(mesh), {{face, Vec3(sigma / l, 0, 0), 0, nullptr}}, 4);
    CAPTURE(follows.iterations);
    CAPTURE(dead.iterations);
    CHECK(follows.iterations <= 1.5 * dead.iterations);
    CHECK((follows.u - dead.u).lpNorm<Eigen::Infinity>() < 1e-6);
    for (int n : mesh.node_sets.at("x_max")) CHECK(follows.u[3 * n] == near(l - 1, 1e-3));
  }
}

TEST_CASE(
    "loads with histories of their own add up, and the body returns to rest when they are gone") {
  const Mesh mesh = sided(test::cube(2), CellType::hex8);
  const auto factor = std::make_shared<const std::vector<HistoryPoint<double>>>(
      std::vector<HistoryPoint<double>>{{0.5, 1.0}, {1, 0.0}});
  std::vector<Prescribed> held = on_planes(mesh);
  const Ended end = solved(mesh, test::stable(30, 1e-2), held,
                           {{mesh.facet_sets.at("x_max"), Vec3(0.05, 0, 0), 0, factor},
                            {mesh.facet_sets.at("y_max"), Vec3::Zero(), 0.02, factor}},
                           8);
  CHECK(end.u.lpNorm<Eigen::Infinity>() < 1e-9);
}
