// Scenes on cut meshes: what files, continued runs and results over the area of contact make of
// nodes that hang.
#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include "mechanics/mesh/cut.hpp"
#include "mechanics/mesh/hanging.hpp"
#include "results/post/contact_surface.hpp"
#include "support/block.hpp"
#include "support/directions.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"
#include "support/section.hpp"

using namespace langer;

namespace {

const std::string skin =
    "material: {matrix: {yeoh: {a1: 0.269, a2: 0.376, a3: 0.415}}, fibres: [{hgo: {c1: 0.317, c2: 1.1}, alpha: 60}], "
    "volume: {quadratic: {d: 1.0e-4}}}\n";
const std::string soft =
    "material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 0.01}}}\n";
const std::string viscous =
    "material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 0.01}}, viscous: [{tau: 1, gamma: 0.5}]}\n";

// a corner of it cut, with borders across the top
std::string block(const std::string& cuts, const std::string& sets = "") {
  return "mesh: {geometry: {block: {origin: [-4, 0, -4], size: [8, 3, 8], divisions: [5, 2, 5]}}, cuts: [" +
         cuts + "]" + sets + "}\nsupports: [{on: bottom, hold: [x, y, z]}]\nstability: off\n";
}
const std::string beside =
    "{within: {box: {from: [-4, 0, -4], to: [0.2, 3, 1.1]}}}, {within: {cylinder: {axis: y, through: [-1, 0, 0], "
    "radius: 1}}, times: 2}";
std::string ball(double mu, const std::string& motion = "[{t: 1, to: [0, -0.6, 0]}]") {
  return "contacts: {ball: {rigid: {sphere: {radius: 2.5, centre: [0.3, 5.5, -0.4]}}, friction: " +
         std::to_string(mu) + ", motion: " + motion +
         "}}\npath: {first: 0.2, largest: 0.2}\nsymmetry: none\n";
}

}  // namespace

TEST_CASE("a run continued on a cut mesh is the run, to the last bit") {
  for (
      const std::string& text :
      {block(beside) + skin + ball(0.34),
       block(beside) + skin + ball(0, "[{t: 0.5, to: [0, -0.5, 0]}, {t: 1, to: [0.4, -0.5, 0.1]}]"),
       block("{within: {cylinder: {axis: y, radius: 2}}}") + soft +
           "loads: [{on: top, displacement: {x: 0.4, y: -0.3}}]\npath: {first: 0.2, largest: 0.2}\n"}) {
    CAPTURE(text);
    const SolveConfig config = test::config_of(text);
    const Mesh mesh = test::mesh_in(config);
    REQUIRE(!mesh.hanging.empty());
    const Scene scene = make_scene(config, mesh, config.material, test::nowhere);
    const auto part = ReducedScene::find(config.symmetry, mesh, scene, test::nowhere);
    test::HowToSolve how{config.path, config.solver};
    const test::Solved whole = solved(mesh, scene, part, how);
    REQUIRE(whole.steps.size() >= 4);
    how.from = &whole.steps[2], how.before = &whole.steps[1];
    const test::Solved rest = solved(mesh, scene, part, how);
    REQUIRE(rest.steps.size() + 3 == whole.steps.size());
    for (std::size_t k = 0; k < rest.steps.size(); ++k) {
      const StepRecord &a = whole.steps[3 + k], &b = rest.steps[k];
      CHECK(a.iterations == b.iterations);
      CHECK((a.u == b.u));
      CHECK((a.reaction == b.reaction));
      CHECK((a.scalars == b.scalars));
      CHECK((a.cell_fields == b.cell_fields));
    }
    for (const HangingNode& h : mesh.hanging) {
      Vec3 mean = Vec3::Zero();
      for (int n : h.of) mean += 0.25 * whole.steps.back().u[static_cast<std::size_t>(n)];
      CHECK((mean - whole.steps.back().u[static_cast<std::size_t>(h.node)]).norm() < 1e-15);
    }
  }
}

TEST_CASE("forces on a cut body balance, and turn with the body") {
  for (double mu : {0.0, 0.3}) {
    const test::Ended end = test::run(block(beside) + skin + ball(mu) + test::tight);
    Vec3 all = Vec3::Zero();  // supports and contact
    for (const Vec3& r : end.last().reaction) all += r;
    const Vec3 force = end.last().force_ind;
    CHECK(force.norm() > 0.05);
    CHECK(all.norm() < 1e-9 * force.norm());
    CHECK((end.reaction("bottom") - force).norm() < 1e-9 * force.norm());
  }
  // a turned body has no stress anywhere
  Mesh mesh = test::cube(3);
  test::distort(mesh, 0.05, 4);
  CutMesh cut(mesh);
  std::vector<char> marked(27, 0);
  marked[0] = marked[14] = 1;
  cut.cut(marked);
  REQUIRE(!cut.mesh().hanging.empty());
  const Mat3 H =
      Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix() - Mat3::Identity();
  Assembler body =
      test::equilibrium(cut.mesh(), {test::neo_hooke(0.1, 1e-3)}, Formulation::mean_dilatation,
                        number_dofs(cut.mesh().n_nodes(), {}, {}, cut.mesh().hanging).dofs);
  VecX u(3 * cut.mesh().n_nodes());
  for (int i = 0; i < cut.mesh().n_nodes(); ++i)
    u.segment<3>(3 * i) = H * cut.mesh().X[static_cast<std::size_t>(i)];
  body.pressures_from(u);
  REQUIRE(body.assemble(u, false));
  CHECK(body.f_int().lpNorm<Eigen::Infinity>() < 1e-12);
}

TEST_CASE(
    "pressure over the area of contact is that of the same forces, across the border of cut cells") {
  // a rigid plane on a layer that slides on its base: pressed alike everywhere, at any node
  const std::string text =
      "mesh: {geometry: {block: {origin: [-4, 0, -4], size: [8, 3, 8], divisions: [6, 3, 6]}}, cuts: [" +
      beside +
      "]}\nsupports: [{on: bottom, hold: [y]}, {on: x_min, hold: [x]}, {on: z_min, hold: [z]}]\nstability: off\n" +
      soft +
      "contacts: {plate: {on: top, rigid: {plane: {point: [0, 3, 0], normal: [0, -1, 0]}}, friction: 0, motion: [{t: 1, to: [0, -0.3, "
      "0]}]}}\npath: {steps: 2}\nsymmetry: none\n" +
      test::tight;
  const test::Ended end = test::run(text);
  const RigidContact& plate = end.scene.contacts.at(0);
  const ContactPerArea state =
      ContactSurface(end.mesh, plate.nodes).at(end.last().u, end.last().contacts.at("plate"));
  Vec3 low = Vec3::Constant(1e9), high = -low;
  for (std::size_t i = 0; i < end.mesh.X.size(); ++i) {
    const Vec3 x = end.mesh.X[i] + end.last().u[i];
    low = low.cwiseMin(x), high = high.cwiseMax(x);
  }
  const double area = (high[0] - low[0]) * (high[2] - low[2]);
  CHECK(area > 64.5);
  CHECK(state.area == near(area, 1e-9));
  const double pressure = end.last().force_ind.norm() / area;
  CHECK(state.pressure_max == near(pressure, 1e-8));
  for (int n : end.mesh.node_sets.at("top"))
    CHECK(state.pressure[static_cast<std::size_t>(n)] == near(pressure, 1e-8));
}

TEST_CASE("a viscous body that is pulled alike relaxes alike through hanging nodes") {
  const auto ends = [](const std::string& cuts) {
    const std::string text =
        "mesh: {geometry: {block: {size: [2, 2, 2], divisions: [3, 3, 3]}}" + cuts +
        "}\nsupports: [{on: x_min, hold: [x]}, {on: bottom, hold: [y]}, {on: z_min, hold: [z]}]\n" +
        viscous +
        "loads: [{on: x_max, displacement: {x: [{t: 0.2, to: 0.4}, {t: 1, to: 0.4}]}}]\n"
        "path: {seconds: 5, steps: 10}\nstability: off\n" +
        test::tight;
    return test::run(text);
  };
  const test::Ended plain = ends(""),
                    cut = ends(", cuts: [{within: {box: {from: [0, 0, 0], to: [0.6, 1, 2]}}}]");
  REQUIRE(!cut.mesh.hanging.empty());
  CHECK((plain.reaction("x_max") - cut.reaction("x_max")).norm() <
        1e-9 * plain.reaction("x_max").norm());
}
