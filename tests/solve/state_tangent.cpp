// Direct differentiation of accepted states against central differences of whole paths.
#include "mechanics/solve/state_tangent.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "mechanics/nonlinear/kinsol.hpp"
#include "mechanics/nonlinear/load_path.hpp"
#include "support/block.hpp"
#include "support/directions.hpp"
#include "support/laws.hpp"

using namespace langer;

namespace state_tangent_tests {

namespace {

enum Number { a1, a3, c1, c2, kappa, alpha, d, friction };

struct Pressed {
  CellType cells = CellType::hex8;
  Formulation formulation = Formulation::mean_dilatation;
  double mu = 0;
  bool pushed = false, kinsol = false, loose = false, sideways = false;
  double above = 0, depth = 0.5, d = 1e-3;
  int steps = 4;
  double pressure = 0;
};

Material law_of(const Pressed& scene, Number number, double by) {
  Material m = test::stable(30, scene.d);
  Yeoh& yeoh = std::get<Yeoh>(m.matrix[0]);
  HgoFibre& fibre = std::get<HgoFibre>(m.fibres[0].law);
  m.fibres[0].kappa = 0.1,
  m.fibres[0].tension_switch =
      FibreSwitch::off;  // a difference over the switch is none of a derivative
  if (number == a1) yeoh.a1 += by;
  if (number == a3) yeoh.a3 += by;
  if (number == c1) fibre.c1 += by;
  if (number == c2) fibre.c2 += by;
  if (number == kappa) m.fibres[0].kappa += by;
  if (number == alpha) m.fibres[0].alpha_deg += by;
  if (number == d) std::get<QuadraticVolume>(m.volume).d += by;
  return m;
}

double step_of(const Pressed& scene, Number number) {
  return number == d ? 1e-5 * scene.d : number == alpha ? 1e-2 : 1e-5;
}

struct Found {
  std::vector<BodyState> states;
  std::vector<StateDerivative> derivatives;
  std::vector<VecX> reactions, d_reactions;
  std::vector<std::vector<ContactStatus>> status;
};

Mesh mesh_of(const Pressed& scene) {
  const bool quadratic = scene.cells != CellType::hex8;
  const Mesh linear = test::block(test::graded(3, quadratic ? 4 : 6, 0.8), test::even(0, 3, 2),
                                  test::graded(3, quadratic ? 4 : 6, 0.8));
  return quadratic ? test::raised_block(linear, scene.cells) : linear;
}

Found run(const Pressed& scene, Number number, double by, bool differentiate) {
  const Mesh mesh = mesh_of(scene);
  std::vector<Prescribed> held;
  for (int i : mesh.node_sets.at("y_min"))
    for (int k = 0; k < 3; ++k)
      if (k > 0 || !scene.loose) held.push_back({3 * i + k, 0});
  RigidContact contact{"ball",
                       Sphere{3, {0.1, 6 + scene.above, -0.05}},
                       scene.mu + (number == Number::friction ? by : 0),
                       {},
                       {},
                       {}};
  const Vec3 end(scene.sideways ? 0.4 : 0, -scene.depth - scene.above, 0);
  if (scene.sideways)
    contact.motion = {{0.5, Vec3(0, end[1], 0)}, {1, end}};
  else if (!scene.pushed)
    contact.motion = {{1, end}};
  if (scene.pushed) contact.control = ForceControl{-Vec3::UnitY(), {0.3, nullptr}};
  for (int i : mesh.node_sets.at("y_max"))
    if (std::hypot(mesh.X[i][0], mesh.X[i][2]) < 3) contact.nodes.push_back(i);
  Assembler body = test::equilibrium(mesh, {law_of(scene, number, by)}, scene.formulation,
                                     number_dofs(mesh.n_nodes(), held).dofs);
  IncrementOptions options;
  options.gap_tolerance = 3e-13,
  options.law_tolerance = 3e-13;  // at 1e-13 rounding decides whether a pushed path ends
  Increment increment(body, {contact}, options);
  LoadPathOptions path;
  path.steps = scene.steps;
  NewtonOptions tight;
  tight.relative = 1e-13;
  Found out;
  BodyState last = increment.accepted(), earlier = last;
  StateDerivative rest;
  rest.u = VecX::Zero(last.u.size());
  std::vector<StateDerivative> d_last(2, rest);
  const PathReport report = load_path(
      path, 0, {}, {},
      [&](double t) {
        increment.begin(t);
        Problem problem = increment.problem();
        problem.begins_again = false;  // paths that are compared are found alike
        return scene.kinsol ? kinsol(problem, increment.free_balance(), increment.trial(),
                                     {.relative = 1e-12})
                            : newton(problem, increment.trial(), tight);
      },
      [&](double, double, double, const SolveReport&) {
        increment.accept();
        out.states.push_back(increment.accepted()), out.reactions.push_back(increment.reactions());
        out.status.push_back(increment.defects()[0].status);
        if (!differentiate) return true;
        ParameterChange change;
        change.f = VecX::Zero(rest.u.size());
        const VecX& u = increment.accepted().u;
        if (number == friction) {
          change.mu = {1};
        } else {
          const double h = step_of(scene, number);
          for (double side : {1., -1.}) {
            const Material law = law_of(scene, number, side * h);
            body.set_materials({law}, make_directions(mesh, {fibre_angles(law)}));
            body.pressures_from(u), body.assemble(u, false);
            change.f += side / (2 * h) * body.f_int();
          }
          const Material law = law_of(scene, number, 0);
          body.set_materials({law}, make_directions(mesh, {fibre_angles(law)}));
        }
        const StateTangent tangent(increment, earlier);
        const auto found = tangent.derivative(change, d_last[0], d_last[1]);
        REQUIRE(found);
        out.derivatives.push_back(*found),
            out.d_reactions.push_back(tangent.reactions({change}, {*found})[0]);
        earlier = last, last = increment.accepted();
        d_last = {*found, d_last[0]};
        return true;
      });
  CAPTURE(report.why);
  REQUIRE(report.complete);
  return out;
}

// largest deviation of u' and of the reactions' derivatives at any step, relative; nothing where a
// contact changes its state
std::optional<double> deviation(const Pressed& scene, Number number, double h) {
  const Found here = run(scene, number, 0, true), plus = run(scene, number, h, false),
              minus = run(scene, number, -h, false);
  double worst = 0;
  for (std::size_t i = 0; i < here.states.size(); ++i) {
    if (plus.status[i] != here.status[i] || minus.status[i] != here.status[i]) return std::nullopt;
    const VecX du = (plus.states[i].u - minus.states[i].u) / (2 * h),
               dr = (plus.reactions[i] - minus.reactions[i]) / (2 * h);
    worst = std::max(worst, (here.derivatives[i].u - du).norm() / du.norm());
    worst = std::max(worst, (here.d_reactions[i] - dr).norm() / dr.norm());
    if (scene.pushed) {
      const double travel = (plus.states[i].travel - minus.states[i].travel) / (2 * h);
      worst = std::max(worst, std::abs(here.derivatives[i].travel - travel) / std::abs(travel));
    }
  }
  return worst;
}

// Rounding leaves as much of a path whatever the step is: a change of d has to be large against it
// (half the step, twice the deviation). A pushed body that only friction holds jumps to another
// place at 3e-5.
double difference_step(const Pressed& scene, Number number) {
  if (scene.pushed && scene.loose && number == a1) return 3e-7;
  return number == d ? 1e-3 * scene.d : number == alpha ? 1e-2 : number == c2 ? 3e-3 : 3e-5;
}

}  // namespace

TEST_CASE(
    "derivatives of frictionless states are those of whole paths to 1e-5, in every cell and formulation") {
  for (Pressed scene :
       {Pressed{}, Pressed{.formulation = Formulation::displacement, .d = 0.1},
        Pressed{.cells = CellType::hex27, .formulation = Formulation::linear_dilatation},
        Pressed{
            .cells = CellType::tet15, .formulation = Formulation::linear_dilatation, .depth = 0.3}})
    for (Number number : {a1, c1, c2, kappa, alpha, d}) {
      CAPTURE(static_cast<int>(scene.cells));
      CAPTURE(static_cast<int>(number));
      const auto off = deviation(scene, number, difference_step(scene, number));
      if (off) CHECK(*off < 1e-5);
    }
}

TEST_CASE(
    "derivatives under friction are those of whole paths to 1e-3, the touch and the slip before included") {
  for (Pressed scene :
       {Pressed{.mu = 0.3}, Pressed{.mu = 0.15, .above = 0.05},
        Pressed{.mu = 0.3, .sideways = true},
        Pressed{
            .cells = CellType::hex27, .formulation = Formulation::linear_dilatation, .mu = 0.2}})
    for (Number number : {a1, c1, alpha, friction}) {
      CAPTURE(scene.mu);
      CAPTURE(static_cast<int>(number));
      const auto off = deviation(scene, number, difference_step(scene, number));
      if (off) CHECK(*off < 1e-3);
    }
}

TEST_CASE(
    "derivatives of a pushed indenter, of a body held by contact and of KINSOL's states are those of whole paths") {
  for (Pressed scene :
       {Pressed{.pushed = true}, Pressed{.mu = 0.3, .pushed = true, .above = 0.1},
        Pressed{.mu = 0.3, .loose = true}, Pressed{.mu = 0.3, .pushed = true, .loose = true},
        Pressed{.kinsol = true}, Pressed{.mu = 0.2, .kinsol = true}})
    for (Number number : {a1, alpha, friction}) {
      if (number == friction && scene.mu == 0) continue;
      CAPTURE(scene.mu);
      CAPTURE(scene.pushed);
      CAPTURE(scene.loose);
      CAPTURE(static_cast<int>(number));
      const auto off = deviation(scene, number, difference_step(scene, number));
      if (off) CHECK(*off < (scene.mu > 0 ? 1e-3 : 1e-5));
    }
}

}  // namespace state_tangent_tests
