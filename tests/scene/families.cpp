// Families and whose angles hold: what a body says of itself, what stands at the top, a field, and
// c1 = 0.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <random>

#include "scene/model/scene_section.hpp"
#include "support/block.hpp"
#include "support/near.hpp"
#include "support/solved_scene.hpp"

using namespace langer;

namespace families_tests {

using test::config_of, test::nowhere;

namespace {

struct Ended {
  Scene scene;
  StepRecord last;
  double force = 0;  // of x_max along x [N]
};

Ended run(const std::string& text, const Mesh& mesh) {
  const SolveConfig config = config_of(text);
  Ended out{make_scene(config, mesh, config.material, nowhere), {}, 0};
  out.last =
      test::solved(mesh, out.scene, ReducedScene::find(config.symmetry, mesh, out.scene, nowhere),
                   {config.path, config.solver})
          .steps.back();
  for (int n : mesh.node_sets.at("x_max")) out.force += out.last.reaction[n][0];
  return out;
}

const std::string pulled =
    "supports: [{on: x_min, hold: [x]}, {on: y_min, hold: [y]}, {on: z_min, hold: [z]}]\n"
    "loads: [{on: x_max, displacement: {x: 0.2}}]\npath: {steps: 2}\nsolver: {newton: {relative: 1.0e-11}}\n";

std::string family(double c1, double alpha) {
  return fmt::format("{{hgo: {{c1: {}, c2: 0.3}}, alpha: {}}}", c1, alpha);
}
std::string law(const std::vector<std::string>& families) {
  return fmt::format(
      "{{matrix: {{neo_hooke: {{a1: 0.05}}}}, fibres: [{}], volume: {{quadratic: {{d: 1e-3}}}}}}",
      fmt::join(families, ", "));
}

// lower and upper half in y
Mesh two_layers() {
  Mesh mesh = test::block(test::even(0, 1, 2), test::even(0, 1, 2), test::even(0, 1, 2));
  mesh.bodies = {"a", "b"};
  mesh.body.resize(mesh.n_cells());
  for (int e = 0; e < mesh.n_cells(); ++e) mesh.body[e] = cell_centre(mesh, e)[1] > 0.5;
  return mesh;
}

}  // namespace

TEST_CASE(
    "A family with c1 = 0 keeps its place under a field: force and columns go through it without a jump") {
  const Mesh mesh = test::cube(2);
  // ../shared/cases/fibre_c1_zero.yaml
  const auto known = [&](double c1) {
    return run("material: " + law({family(c1, 0), family(0.3, 90)}) +
                   "\nfibre_field: {formula: {alpha: \"0\"}}\n" + pulled,
               mesh)
        .force;
  };
  CHECK(known(0) == near(0.0506, 2e-3));
  CHECK(known(0) == near(known(1e-9), 1e-6));

  std::mt19937 random(5);
  std::uniform_real_distribution<double> angle(-90, 90), slope(-60, 60);
  for (int n = 0; n < 8; ++n) {
    const int families = 2 + n % 2, slack = n % families;
    const double at[] = {angle(random), angle(random), angle(random)};
    const std::string field =
        fmt::format("fibre_field: {{formula: {{alpha: \"{} + {}*x + {}*z\"}}}}\n", angle(random),
                    slope(random), slope(random));
    const auto with = [&](double c1) {
      std::vector<std::string> all;
      for (int k = 0; k < families; ++k)
        all.push_back(family(k == slack ? c1 : 0.1 + 0.1 * k, at[k]));
      return run("material: " + law(all) + "\n" + field + pulled, mesh);
    };
    const Ended none = with(0), little = with(1e-9);
    CAPTURE(n);
    CHECK(none.force == near(little.force, 1e-6));
    REQUIRE(none.scene.materials[0].fibres.size() == static_cast<std::size_t>(families));
    for (int e = 0; e < mesh.n_cells(); ++e) {
      const auto a = none.scene.directions.of(e), of_little = little.scene.directions.of(e);
      REQUIRE(a.size() == static_cast<std::size_t>(families));
      for (int k = 0; k < families; ++k) CHECK((a[k] - of_little[k]).norm() == 0);
    }
    for (const auto& [name, values] : little.last.cell_fields) {
      const auto named = name;
      CAPTURE(named);
      REQUIRE(none.last.cell_fields.count(name) == 1);
      for (std::size_t e = 0; e < values.size(); ++e)
        CHECK(none.last.cell_fields.at(name)[e] == near(values[e], 1e-6));
    }
    CHECK(none.scene.families() == families - 1);
  }
}

TEST_CASE(
    "Families with c1 = 0 cost nothing and refuse nothing: the state is that of a law without them, to the last bit") {
  const Mesh mesh = test::cube(2);
  const Ended without = run("material: " + law({family(0.2, 30)}) + "\n" + pulled, mesh);
  const Ended with =
      run("material: " +
              law({family(0, 10), family(0.2, 30), family(0, 77), family(0, 1), family(0, 2)}) +
              "\n" + pulled,
          mesh);
  REQUIRE(with.last.u.size() == without.last.u.size());
  for (std::size_t i = 0; i < with.last.u.size(); ++i) CHECK(with.last.u[i] == without.last.u[i]);
  // their directions break no symmetry
  const std::string slanted = "material: " + law({family(0, 30)}) +
                              "\nsymmetry: mirror_x\nloads: [{on: y_max, displacement: {y: 0.1}}]\n"
                              "supports: [{on: y_min, hold: [x, y, z]}]\n";
  CHECK(ReducedScene::find(
      SymmetryChoice::mirror_x, mesh,
      make_scene(config_of(slanted), mesh, config_of(slanted).material, nowhere), nowhere));
}

TEST_CASE(
    "A body's own angles, or those of its own material, hold under a field or angles at the top") {
  const Mesh mesh = two_layers();
  const std::string stiff = law({family(0.3, 0)}), top = "material: " + stiff + "\n",
                    field = "fibre_field: {formula: {alpha: \"90\"}}\n";
  const auto in_a_and_b = [&](const std::string& text) {
    const Scene scene =
        make_scene(config_of(text + pulled), mesh, config_of(text + pulled).material, nowhere);
    std::array<double, 2> along{-1, -1};  // share of the direction along x
    for (int e = 0; e < mesh.n_cells(); ++e)
      along[mesh.body[e]] = std::abs(scene.directions.of(e)[0][0]);
    return along;
  };
  const auto is = [](const std::array<double, 2>& found, double a, double b) {
    CHECK(found[0] == near(a, 1e-9, 1e-15));  // the cosine of 90 degrees rounds to 6e-17
    CHECK(found[1] == near(b, 1e-9, 1e-15));
  };
  is(in_a_and_b(top + field + "materials: {b: {fibre_angles: [0]}}\n"), 0, 1);
  is(in_a_and_b(top + field + "materials: {b: {material: " + stiff + "}}\n"), 0, 1);
  is(in_a_and_b(top + field + "materials: {b: {material: " + stiff + ", fibre_angles: [60]}}\n"), 0,
     0.5);
  is(in_a_and_b(top + field + "materials: {b: {fibre_field: {formula: {alpha: \"60\"}}}}\n"), 0,
     0.5);
  is(in_a_and_b(top + "materials: {b: {fibre_field: {formula: {alpha: \"60\"}}}}\n"), 1, 0.5);
  is(in_a_and_b(top + "fibre_angles: [60]\nmaterials: {b: {material: " + stiff + "}}\n"), 0.5, 1);
  // a field alone in both, body by body: forces of the layers add up
  const auto force = [&](double a, double b) {
    return run(top +
                   fmt::format(
                       "fibre_field: {{formula: {{alpha: \"{}\"}}}}\nmaterials: {{b: {{fibre_angles: [{}]}}}}\n",
                       a, b) +
                   pulled,
               mesh)
        .force;
  };
  CHECK(force(90, 0) == near(force(0, 90), 1e-6));
  CHECK(force(90, 0) > 1.2 * force(90, 90));
}

TEST_CASE("Angles and fields that nothing takes are refused at their key") {
  const Mesh mesh = two_layers();
  const std::string own = "{material: " + law({family(0.3, 0)}) + "}",
                    top = "material: " + law({family(0.3, 0)}) + "\n";
  const auto holds = [](const std::string& said, const std::string& part) {
    CAPTURE(said);
    CHECK(said.find(part) != std::string::npos);
  };
  const std::string both = "materials: {a: " + own + ", b: " + own + "}\n",
                    field = "fibre_field: {formula: {alpha: \"90\"}}\n";
  holds(test::said_of_scene(both + field + pulled, mesh), "fibre_field: no body takes it");
  holds(test::said_of_scene(both + "fibre_angles: [20]\n" + pulled, mesh),
        "fibre_angles: no body takes it");
  holds(test::said_of_scene(top + field + "fibre_angles: [20]\n" + pulled, mesh),
        "fibre_angles: found together with fibre_field");
  holds(test::said_of_scene(top + "fibre_field: null\nfibre_angles: [20]\n" + pulled, mesh),
        "accepted");
}

}  // namespace families_tests
