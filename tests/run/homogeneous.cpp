// A body that deforms alike everywhere is solved on one hexahedron, and what it then says of the
// mesh is what the mesh says.
#include "scene/run/homogeneous.hpp"

#include <doctest/doctest.h>

#include <random>
#include <regex>

#include "accuracy/checks/run_watch.hpp"
#include "scene/run/equilibrium_by.hpp"
#include "scene/run/step_record.hpp"
#include "support/block.hpp"
#include "support/directions.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"
#include "support/solved_scene.hpp"

using namespace langer;

namespace {

struct Case {
  CellType cells = CellType::hex8;
  std::vector<double> angles{0};  // of the fibres [deg]
  Formulation formulation = Formulation::mean_dilatation;
  bool distorted = true;
};

Mesh mesh_of(const Case& c) {
  Mesh mesh = test::block(test::even(1, 5, 3), test::even(0, 1, 2), test::even(-1, 2, 2));
  if (c.distorted) test::distort(mesh, 0.1);
  return c.cells == CellType::hex8 ? mesh : test::raised_block(mesh, c.cells);
}

// three faces slide, the fourth is pulled by 20 %, the others are free
Scene scene_of(const Case& c, const Mesh& mesh) {
  Scene scene;
  scene.formulation = c.cells == CellType::hex8 ? c.formulation : usual_formulation(c.cells);
  Material material = test::stable(0, 1e-3);
  const auto fibre = material.fibres.at(0);
  material.fibres.clear();
  for (double angle : c.angles)
    material.fibres.push_back(fibre), material.fibres.back().alpha_deg = angle;
  scene.materials = {material};
  scene.directions = test::directions(mesh, scene.materials);
  std::vector<Prescribed> held;
  for (const auto& [face, k, value] :
       {std::tuple{"x_min", 0, 0.}, {"y_min", 1, 0.}, {"z_min", 2, 0.}, {"x_max", 0, 0.8}})
    for (int i : mesh.node_sets.at(face)) held.push_back({3 * i + k, value});
  scene.dofs = number_dofs(mesh.n_nodes(), held).dofs;
  return scene;
}

SolveConfig in_four_steps() {
  SolveConfig config;
  config.path.first = config.path.largest = 0.25;
  config.solver = NewtonOptions{25, 1e-11};
  return config;
}

std::vector<StepRecord> at_a_point(HomogeneousScene& point, const SolveConfig& config) {
  Assembler body = point.assembler();
  Increment increment(body, {}, {});
  std::vector<StepRecord> steps;
  const PathReport report = load_path(
      config.path, 0, std::nullopt, {},
      [&](double t) {
        increment.begin(t);
        return equilibrium_by(point.solver(), increment);
      },
      [&](double, double taken, double next, const SolveReport& step) {
        increment.accept();
        const auto whole = point.whole(step_record(increment, body, taken, next, step));
        REQUIRE(whole.has_value());
        // what a run that goes on starts from
        CHECK((point.reduced(*whole).u - increment.accepted().u).lpNorm<Eigen::Infinity>() < 1e-12);
        steps.push_back(*whole);
        return true;
      });
  CHECK(report.complete);
  return steps;
}

bool is_homogeneous(const Mesh& mesh, const Scene& scene) {
  return HomogeneousScene::find(mesh, scene, in_four_steps()) != nullptr;
}

}  // namespace

TEST_CASE(
    "one hexahedron gives displacements, reactions, cell fields and energy of the whole mesh to 1e-8") {
  for (const Case& c : {Case{},
                        {CellType::hex8, {}},
                        {CellType::hex8, {90}},
                        {CellType::hex8, {40, -40}},
                        {CellType::hex27, {0}, {}, false},
                        {CellType::tet15, {0}, {}, false},
                        {CellType::hex8, {0}, Formulation::displacement}}) {
    CAPTURE(static_cast<int>(c.cells));
    CAPTURE(c.angles.size());
    const Mesh mesh = mesh_of(c);
    const Scene scene = scene_of(c, mesh);
    const SolveConfig config = in_four_steps();
    const auto point = HomogeneousScene::find(mesh, scene, config);
    REQUIRE(point);
    const std::vector<StepRecord> ours = at_a_point(*point, config);
    test::HowToSolve how;
    how.path = config.path, how.solver = config.solver;
    const test::Solved theirs = test::solved(mesh, scene, std::nullopt, how);
    REQUIRE(ours.size() == theirs.steps.size());
    for (std::size_t s = 0; s < ours.size(); ++s) {
      const StepRecord &a = ours[s], &b = theirs.steps[s];
      CHECK(a.t == b.t);
      double u = 0, force = 0, most = 0;
      for (std::size_t i = 0; i < a.u.size(); ++i) {
        u = std::max(u, (a.u[i] - b.u[i]).norm());
        force = std::max(force, (a.reaction[i] - b.reaction[i]).norm()),
        most = std::max(most, b.reaction[i].norm());
      }
      CHECK(most > 0);
      CHECK(u < 1e-8);
      CHECK(force < 1e-8 * most);
      REQUIRE(a.cell_fields.size() == b.cell_fields.size());
      for (const auto& [name, values] : b.cell_fields) {
        const auto named = name;
        CAPTURE(named);
        REQUIRE(a.cell_fields.at(name).size() == values.size());
        double scale = 0, worst = 0;
        for (std::size_t e = 0; e < values.size(); ++e) {
          scale = std::max(scale, std::abs(values[e]));
          worst = std::max(worst, std::abs(values[e] - a.cell_fields.at(name)[e]));
        }
        CHECK(worst < 1e-8 * scale);
      }
      for (const char* scalar : {"energy", "J_min"})
        CHECK(std::abs(a.scalars.at(scalar) / b.scalars.at(scalar) - 1) < 1e-8);
    }
  }
}

TEST_CASE(
    "a block under uniform tractions and pressures is solved at a point, and gives what its mesh gives") {
  const auto scene = [](const char* loads) {
    return test::config_of(
        "mesh: {geometry: {block: {size: [3, 2, 2], divisions: [3, 2, 2]}}, cells: hex8}\n"
        "material: {matrix: {yeoh: {a1: 0.269, a2: 0.376, a3: 0.415}}, volume: {quadratic: {d: 1.0e-2}}}\n"
        "supports: [{on: x_min, hold: [x]}, {on: bottom, hold: [y]}, {on: z_min, hold: [z]}]\npath: {steps: 4}\nloads: " +
        std::string(loads) + "\n");
  };
  const auto states = [](const SolveConfig& config, bool at_a_point, bool& reduced) {
    Run run(test::mesh_in(config), config, config.material, test::nowhere, at_a_point);
    reduced = run.reduction.kind() == Reduction::Kind::homogeneous;
    std::vector<StepRecord> steps;
    RunListener each;
    each.of_whole = [&](const StepRecord& step, const SolveReport&) {
      steps.push_back(step);
    };
    REQUIRE(run.follow(each).path.complete);
    return steps;
  };
  for (
      const char* loads :
      {"[{on: x_max, traction: {x: 0.3}}]",
       "[{on: x_max, force: {x: 1}}, {on: top, pressure: [{t: 0.5, to: 0.1}, {t: 1, to: 0.1}]}]"}) {
    CAPTURE(loads);
    bool reduced = false;
    const auto point = states(scene(loads), true, reduced);
    CHECK(reduced);
    const auto mesh = states(scene(loads), false, reduced);
    CHECK_FALSE(reduced);
    REQUIRE(point.size() == mesh.size());
    for (std::size_t i = 0; i < point.size(); ++i) {
      CHECK(test::largest_difference(point[i].u, mesh[i].u) < 1e-6);
      CHECK(test::largest_difference(point[i].reaction, mesh[i].reaction) < 1e-6);
      CHECK(point[i].scalars.at("energy") == near(mesh[i].scalars.at("energy"), 1e-6));
    }
  }
  bool reduced = true;
  states(scene("[{on: x_max, traction: {y: 0.01}}]"), true, reduced);  // bends
  CHECK_FALSE(reduced);
}

TEST_CASE("what does not deform alike everywhere is solved as it is") {
  const Case usual;
  const Mesh mesh = mesh_of(usual);
  const Scene scene = scene_of(usual, mesh);
  REQUIRE(is_homogeneous(mesh, scene));
  SUBCASE("fibres that turn the body, between faces that do not") {
    CHECK_FALSE(is_homogeneous(mesh, scene_of({CellType::hex8, {45}}, mesh)));
  }
  SUBCASE(
      "ends that may not become thinner: one hexahedron stays linear, the mesh does not balance; clamped ends leave it nothing") {
    for (const int components : {1, 2}) {
      std::vector<Prescribed> held = scene.dofs.prescribed;
      for (const char* face : {"x_min", "x_max"})
        for (int i : mesh.node_sets.at(face))
          for (int k = 1; k <= components; ++k) held.push_back({3 * i + k, 0});
      Scene clamped = scene;
      clamped.dofs = number_dofs(mesh.n_nodes(), held).dofs;
      CHECK_FALSE(is_homogeneous(mesh, clamped));
    }
  }
  SUBCASE("a support that is less than a face") {
    std::vector<Prescribed> held = scene.dofs.prescribed;
    held.push_back({3 * mesh.node_sets.at("z_max").back() + 2, 0});
    Scene pinned = scene;
    pinned.dofs = number_dofs(mesh.n_nodes(), held).dofs;
    CHECK_FALSE(is_homogeneous(mesh, pinned));
  }
  SUBCASE("two materials") {
    Mesh layers = mesh;
    layers.bodies = {"a", "b"};
    for (int e = 0; e < layers.n_cells(); e += 2) layers.body[e] = 1;
    Scene two = scene;
    two.materials.push_back(test::stable(0, 1e-2));
    CHECK_FALSE(is_homogeneous(layers, two));
  }
  SUBCASE("fibres that turn from cell to cell") {
    Scene turning = scene;
    turning.directions = Directions(true);
    for (int e = 0; e < mesh.n_cells(); ++e)
      turning.directions.append({Vec3(std::cos(0.01 * e), 0, std::sin(0.01 * e))});
    CHECK_FALSE(is_homogeneous(mesh, turning));
  }
  SUBCASE("contact") {
    Scene touched = scene;
    touched.contacts = {RigidContact{
        "ball", Sphere{1, {3, 3, 0}}, 0, mesh.node_sets.at("y_max"), {{1, Vec3(0, -0.1, 0)}}}};
    CHECK_FALSE(is_homogeneous(mesh, touched));
  }
  SUBCASE("a body that is no box") {
    Mesh bent = mesh;
    bent.X[static_cast<std::size_t>(bent.node_sets.at("y_max").front())][1] += 0.01;
    CHECK_FALSE(is_homogeneous(bent, scene));
  }
}

namespace {

struct Judged {
  std::vector<StepRecord> steps;
  std::vector<std::string> warnings;
  std::vector<Summary> summary;
  std::string unstable;
  bool at_a_point = false;
};

Judged judged(const std::string& text, bool at_a_point) {
  SolveConfig config = test::config_of(text);
  config.symmetry = SymmetryChoice::none;  // all of the mesh
  Run run(test::mesh_in(config), config, config.material, test::nowhere, at_a_point);
  RunWatch watch(run, config, test::nowhere, {});
  Judged out;
  out.at_a_point = run.reduction.kind() == Reduction::Kind::homogeneous;
  RunListener listener;
  listener.of_part = [&](StepRecord& step) {
    return watch.of_part(step);
  };
  listener.of_whole = [&](StepRecord& step, const SolveReport& report) {
    CHECK(!watch.of_whole(step, report));
    out.steps.push_back(step);
  };
  run.follow(listener);
  // which of equal cells is the weakest is a matter of rounding
  const std::regex place(R"( (near|in cell \d+ at) \([^)]*\) mm)");
  for (const std::string& line : watch.warnings())
    out.warnings.push_back(std::regex_replace(line, place, ""));
  out.unstable = std::regex_replace(watch.unstable(), place, "");
  out.summary = watch.stability_summary();
  return out;
}

}  // namespace

TEST_CASE(
    "a state at a point is judged as the mesh that it stands for: the same verdicts in words, steps and summary") {
  std::mt19937 random(41);
  std::uniform_real_distribution<double> part(0, 1);
  int unstable = 0, stopped = 0;
  for (int n = 0; n < 12; ++n) {
    CAPTURE(n);
    const double c1 = -0.5 * part(random), pull = 0.5 + 1.5 * part(random);
    const char* angles[] = {
        "{hgo: {c1: C, c2: 0.3}, alpha: 0}", "{hgo: {c1: C, c2: 0.3}, alpha: 90}",
        "{hgo: {c1: C, c2: 0.3}, alpha: 50}, {hgo: {c1: C, c2: 0.3}, alpha: -50}"};
    const std::string fibres =
        std::regex_replace(angles[n % 3], std::regex("C"), std::to_string(c1));
    const std::string text =
        "mesh: {geometry: {block: {size: [4, 1, 2], divisions: [4, 2, 2]}}, cells: " +
        std::string(n % 4 == 3 ? "hex27" : "hex8") +
        "}\nmaterial: {matrix: {yeoh: {a1: 0.269, a2: 0.1}}, fibres: [" + fibres +
        "], volume: {quadratic: {d: 1.0e-3}}}\n"
        "supports: [{on: x_min, hold: [x]}, {on: y_min, hold: [y]}, {on: z_min, hold: [z]}]\n"
        "loads: [{on: x_max, displacement: {x: " +
        std::to_string(pull) +
        "}}]\npath: {steps: 5}\nsolver: {newton: {relative: 1.0e-9}}\nstability: " +
        (n % 5 == 4 ? "last" : "each_step") + "\non_unstable: " + (n % 6 == 5 ? "stop" : "warn") +
        "\n";
    const Judged point = judged(text, true), mesh = judged(text, false);
    REQUIRE(point.at_a_point);
    REQUIRE(!mesh.at_a_point);
    CHECK(point.unstable == mesh.unstable);
    REQUIRE(point.warnings.size() == mesh.warnings.size());
    for (std::size_t i = 0; i < mesh.warnings.size(); ++i)
      CHECK(point.warnings[i] == mesh.warnings[i]);
    unstable += !mesh.warnings.empty(), stopped += !mesh.unstable.empty();
    REQUIRE(point.summary.size() == mesh.summary.size());
    for (std::size_t i = 0; i < mesh.summary.size(); ++i)
      CHECK(point.summary[i].value == near(mesh.summary[i].value, 1e-6));
    REQUIRE(point.steps.size() == mesh.steps.size());
    for (std::size_t s = 0; s < mesh.steps.size(); ++s)
      for (const char* name :
           {"negative_eigenvalues", "shear_stiffness_min", "unstable_volume", "driving_force",
            "isochoric_fibre_stretch_min", "isochoric_fibre_stretch_max"}) {
        CAPTURE(name);
        REQUIRE(point.steps[s].scalars.count(name) == mesh.steps[s].scalars.count(name));
        if (mesh.steps[s].scalars.count(name))
          CHECK(point.steps[s].scalars.at(name) == near(mesh.steps[s].scalars.at(name), 1e-6));
      }
  }
  CHECK(unstable > 2);
  CHECK(unstable < 12);
  MESSAGE(unstable, " with warnings, ", stopped, " stopped");
}
