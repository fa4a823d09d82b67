// A scene solved on the part of the body that decides the rest gives what the whole body gives.
#include "scene/model/scene_symmetry.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "mechanics/mesh/select.hpp"
#include "support/block.hpp"
#include "support/directions.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"
#include "support/solved_scene.hpp"

using namespace langer;

namespace symmetry_tests {

using test::largest_difference, test::nowhere;

namespace {

struct Case {
  int nx = 8, nz = 8;
  double alpha = 60;           // [deg]
  Vec3 to = Vec3(0, -0.5, 0);  // of the indenter [mm]
  double mu = 0.34;
  Vec3 side = Vec3::Zero();  // of the indenter's place
  SymmetryChoice symmetry = SymmetryChoice::automatic;
  CellType cells = CellType::hex8;
};

Mesh mesh_of(const Case& c) {
  Mesh mesh = test::block(c.nx % 2 ? test::even(-6, 6, c.nx) : test::graded(6, c.nx, 0.8),
                          test::even(0, 4, 3),
                          c.nz % 2 ? test::even(-6, 6, c.nz) : test::graded(6, c.nz, 0.8));
  if (c.cells != CellType::hex8) mesh = test::raised_block(mesh, c.cells);
  for (Vec3& X : mesh.X) X += Vec3(3, 0, -2);  // the middle is anywhere
  return mesh;
}

Scene scene_of(const Case& c, const Mesh& mesh) {
  Scene scene;
  scene.formulation = usual_formulation(mesh.type);
  scene.materials = {test::table1(c.alpha, 1e-4)};
  scene.directions = test::directions(mesh, scene.materials);
  std::vector<Prescribed> held;
  for (int i : mesh.node_sets.at("y_min"))
    for (int k = 0; k < 3; ++k) held.push_back({3 * i + k, 0});
  scene.dofs = number_dofs(mesh.n_nodes(), held).dofs;
  RigidContact contact{
      "ball", Sphere{2.5, {3 + c.side[0], 6.5, -2 + c.side[2]}}, c.mu, {}, {{1, c.to}}};
  for (int i : mesh.node_sets.at("y_max"))
    if (std::hypot(mesh.X[i][0] - 3, mesh.X[i][2] + 2) < 3.5) contact.nodes.push_back(i);
  scene.contacts = {contact};
  return scene;
}

test::HowToSolve in_four_steps() {
  test::HowToSolve how;
  how.path.first = how.path.largest = 0.25;
  how.solver = NewtonOptions{.relative = 1e-10};  // what is compared to 1e-8 is solved to more
  return how;
}

// u within 1e-8 mm, forces within 1e-8 N; returns how many times fewer unknowns
double compare(const Case& c) {
  CAPTURE(c.nx);
  CAPTURE(c.nz);
  CAPTURE(c.alpha);
  const Mesh mesh = mesh_of(c);
  const Scene scene = scene_of(c, mesh);
  const auto part = ReducedScene::find(c.symmetry, mesh, scene, nowhere);
  REQUIRE(part.has_value());
  const test::Solved whole = solved(mesh, scene, std::nullopt, in_four_steps()),
                     few = solved(mesh, scene, part, in_four_steps());
  REQUIRE(whole.steps.size() == few.steps.size());
  for (std::size_t s = 0; s < whole.steps.size(); ++s) {
    const StepRecord &a = whole.steps[s], &b = few.steps[s];
    CHECK(largest_difference(a.u, b.u) < 1e-8);
    CHECK(largest_difference(a.reaction, b.reaction) < 1e-8);
    CHECK(largest_difference(a.contacts.at("ball").r, b.contacts.at("ball").r) < 1e-8);
    CHECK((a.force_ind - b.force_ind).norm() < 1e-8);
    CHECK(a.scalars.at("energy") == near(b.scalars.at("energy"), 1e-9));
    for (const auto& [name, values] : a.cell_fields)
      for (std::size_t e = 0; e < values.size(); ++e)
        CHECK(values[e] == near(b.cell_fields.at(name)[e], 1e-7, 1e-12));  // J - 1 is small
    CHECK(a.contacts.at("ball").status == b.contacts.at("ball").status);
  }
  CHECK(whole.steps.back().force_ind.norm() > 0.5);
  return static_cast<double>(whole.free) / few.free;
}

}  // namespace

TEST_CASE(
    "a quarter under aligned fibres and half a body turned by 180 degrees under any others give what the whole body gives") {
  CHECK(compare({.alpha = 0}) > 3);
  CHECK(compare({.alpha = 90}) > 3);
  CHECK(compare({.alpha = 60}) > 1.7);
  CHECK(compare({.alpha = 60, .to = Vec3(0, -0.5, 0), .mu = 0}) > 1.7);
}

TEST_CASE(
    "cells that lie across a plane of symmetry, or on the axis of the turn, count with their share") {
  CHECK(compare({.nx = 8, .nz = 7, .alpha = 60}) > 1.7);
  CHECK(compare({.nx = 7, .nz = 8, .alpha = 30}) > 1.7);
  CHECK(compare({.nx = 7, .nz = 7, .alpha = 60}) > 1.5);
  CHECK(compare({.nx = 7, .nz = 8, .alpha = 0}) > 2.5);
  CHECK(compare({.nx = 7, .nz = 7, .alpha = 90}) > 2.2);
}

TEST_CASE("parts of meshes of hex27 too give what the whole body gives") {
  CHECK(compare({.nx = 4, .nz = 4, .alpha = 90, .cells = CellType::hex27}) > 3);
  CHECK(compare({.nx = 4, .nz = 3, .alpha = 60, .cells = CellType::hex27}) > 1.7);
}

TEST_CASE("an indenter drawn along the fibres leaves one mirror plane") {
  CHECK(compare({.alpha = 0, .to = Vec3(0.3, -0.4, 0)}) > 1.7);
  CHECK(compare({.alpha = 0, .to = Vec3(0, -0.4, 0.3)}) > 1.7);
}

TEST_CASE(
    "both ends pulled apart: the part takes the displacements of its own nodes, not of their images") {
  const Mesh mesh = test::block(test::even(-2, 2, 4), test::even(0, 1, 1), test::even(-1, 1, 2));
  for (bool other_first : {false, true}) {
    Scene scene;
    scene.formulation = usual_formulation(mesh.type);
    scene.materials = {test::table1(0, 1e-4)};
    scene.directions = test::directions(mesh, scene.materials);
    std::vector<Prescribed> pulled;
    for (const auto& [side, by] : {std::pair{"x_min", -0.2}, {"x_max", 0.2}})
      for (int n : mesh.node_sets.at(side))
        pulled.insert(pulled.end(), {{3 * n, by}, {3 * n + 1, 0}, {3 * n + 2, 0}});
    if (other_first) std::reverse(pulled.begin(), pulled.end());
    scene.dofs = number_dofs(mesh.n_nodes(), pulled).dofs;
    for (SymmetryChoice symmetry : {SymmetryChoice::mirror_x, SymmetryChoice::quarter}) {
      const auto part = ReducedScene::find(symmetry, mesh, scene, nowhere);
      REQUIRE(part.has_value());
      const Dofs& dofs = part->scene().dofs;
      REQUIRE(!dofs.prescribed.empty());
      for (const Prescribed& p : dofs.prescribed)
        if (p.dof % 3 == 0 && p.value != 0) CHECK(p.value * part->mesh().X[p.dof / 3][0] > 0);
      const auto whole = solved(mesh, scene, std::nullopt, in_four_steps()),
                 few = solved(mesh, scene, part, in_four_steps());
      CHECK(largest_difference(whole.last().u, few.last().u) < 1e-8);
      CHECK(largest_difference(whole.last().reaction, few.last().reaction) < 1e-8);
    }
  }
}

TEST_CASE(
    "what is not symmetric is not reduced, and a symmetry that is asked for and not there is refused with what breaks it") {
  const auto words = [](const Case& c) -> std::string {
    const Mesh mesh = mesh_of(c);
    Scene scene = scene_of(c, mesh);
    try {
      return ReducedScene::find(c.symmetry, mesh, scene, nowhere) ? "found" : "none";
    } catch (const Failure& failure) {
      return failure.what();
    }
  };
  CHECK(words({.side = Vec3(0.1, 0, 0)}) == "none");
  CHECK(words({.to = Vec3(0.1, -0.4, 0)}) == "none");  // oblique fibres
  CHECK(words({.alpha = 60, .symmetry = SymmetryChoice::none}) == "none");
  CHECK(words({.alpha = 60, .symmetry = SymmetryChoice::mirror_x}).find("fibres") !=
        std::string::npos);
  CHECK(words({.alpha = 0, .side = Vec3(0.1, 0, 0), .symmetry = SymmetryChoice::quarter})
            .find("indenter \"ball\"") != std::string::npos);
  CHECK(words({.alpha = 0, .to = Vec3(0.1, -0.4, 0), .symmetry = SymmetryChoice::half_turn})
            .find("path") != std::string::npos);

  const Case c{.alpha = 0};
  const Mesh mesh = mesh_of(c);
  Scene scene = scene_of(c, mesh);
  scene.dofs = number_dofs(mesh.n_nodes(), {{3 * mesh.node_sets.at("y_min")[0], 0.0}})
                   .dofs;  // one corner held
  CHECK(!ReducedScene::find(SymmetryChoice::automatic, mesh, scene, nowhere));
  scene = scene_of(c, mesh);
  scene.directions = Directions(true);
  for (int e = 0; e < mesh.n_cells(); ++e)
    scene.directions.append({e == 5 ? Vec3(0.6, 0, 0.8) : Vec3(1, 0, 0)});
  CHECK(!ReducedScene::find(SymmetryChoice::automatic, mesh, scene, nowhere));
}

namespace {

// A block whose left end is clamped and whose right end is pulled by `to`.
struct Pulled {
  CellType cells = CellType::hex8;
  double alpha = 0;  // of one family of fibres [deg]
  Vec3 to = Vec3(0.6, 0, 0);
  bool holds_and_goes_back = false;
  double traction = 0;  // on top, along y [MPa]
  int across = 2;       // cells of the thickness
};

Scene pulled_scene(const Pulled& c, const Mesh& mesh) {
  Scene scene;
  scene.formulation = usual_formulation(mesh.type);
  scene.materials = {test::table1(c.alpha, 1e-4)};
  std::get<HgoFibre>(scene.materials[0].fibres[0].law).c1 = 0.2;
  scene.directions = test::directions(mesh, scene.materials);
  LoadFactor factor;
  if (c.holds_and_goes_back)
    factor = std::make_shared<const std::vector<HistoryPoint<double>>>(
        std::vector<HistoryPoint<double>>{{0.5, 1}, {0.75, 1}, {1, -0.2}});
  std::vector<Prescribed> held;
  for (int i : mesh.node_sets.at("x_min"))
    for (int k = 0; k < 3; ++k) held.push_back({3 * i + k, 0});
  for (int i : mesh.node_sets.at("x_max"))
    for (int k = 0; k < 3; ++k) held.push_back({3 * i + k, c.to[k], factor});
  scene.dofs = number_dofs(mesh.n_nodes(), held).dofs;
  if (c.traction != 0) {
    SurfaceLoad load;
    load.facets = mesh.facet_sets.at("y_max");
    load.traction = Vec3(0, c.traction, 0);
    scene.loads = {load};
  }
  return scene;
}

Mesh strip(const Pulled& c) {
  Mesh mesh = test::block(test::even(0, 4, 6), test::even(0, 1, c.across), test::even(-1, 1, 4));
  if (c.cells != CellType::hex8) mesh = test::raised_block(mesh, c.cells);
  name_sides(mesh);
  return mesh;
}

// The words of the symmetry; the part gives what the whole body gives.
std::string compared(const Pulled& c) {
  CAPTURE(c.alpha);
  const Mesh mesh = strip(c);
  const Scene scene = pulled_scene(c, mesh);
  const auto part = ReducedScene::find(SymmetryChoice::automatic, mesh, scene, nowhere);
  if (!part) return "";
  const test::Solved whole = solved(mesh, scene, std::nullopt, in_four_steps()),
                     few = solved(mesh, scene, part, in_four_steps());
  REQUIRE(whole.steps.size() == few.steps.size());
  for (std::size_t s = 0; s < whole.steps.size(); ++s) {
    CHECK(largest_difference(whole.steps[s].u, few.steps[s].u) < 1e-8);
    CHECK(largest_difference(whole.steps[s].reaction, few.steps[s].reaction) < 1e-8);
  }
  // to continue from a step of the whole body
  const StepRecord& last = whole.steps.back();
  StepRecord of_part = few.steps.back();
  const BodyState state = part->reduced(last);
  of_part.u.clear();
  for (Eigen::Index i = 0; i < state.u.size(); i += 3) of_part.u.push_back(state.u.segment<3>(i));
  of_part.reaction.assign(of_part.u.size(), Vec3::Zero());
  CHECK(largest_difference(part->whole(of_part).u, last.u) < 1e-8);
  return part->words();
}

}  // namespace

TEST_CASE("one end held, the other pulled: symmetric as seen from half way between them") {
  CHECK(compared({}).starts_with("mirror x and mirror z and mirror y through (2, 0.5, 0)"));
  CHECK(compared({.alpha = 30}).starts_with("half turn about y and mirror y"));
  CHECK(compared({.alpha = 30, .to = Vec3(0.4, 0, 0.3)}).starts_with("half turn about y and"));
  CHECK(compared({.to = Vec3(0, 0.4, 0)}).starts_with("mirror z through"));
  CHECK(compared({.to = Vec3(-0.1, 0, 0.5), .holds_and_goes_back = true}).starts_with("half turn"));
  CHECK(compared({.alpha = 30, .holds_and_goes_back = true}).starts_with("half turn about y and"));
  CHECK(compared({.alpha = 90, .traction = 0.01}).starts_with("mirror x and mirror z through"));
  CHECK(compared({.cells = CellType::hex27, .alpha = 45}).starts_with("half turn about y and"));
  CHECK(compared({.cells = CellType::hex27, .across = 1}).starts_with("mirror x and mirror z and"));
}

TEST_CASE("where something says where a body is in space, its symmetry is that seen from rest") {
  const Pulled c{.alpha = 30};
  const Mesh mesh = strip(c);
  const auto words = [&](const Scene& scene, ReducedScene::Seen seen) {
    const auto part =
        ReducedScene::find(SymmetryChoice::automatic, mesh, scene, nowhere, nullptr, seen);
    return part ? part->words() : "";
  };
  const auto half_way = ReducedScene::Seen::from_half_way;
  Scene scene = pulled_scene(c, mesh);
  REQUIRE(words(scene, half_way).starts_with("half turn"));
  CHECK(words(scene, ReducedScene::Seen::from_rest).starts_with("mirror y"));
  SUBCASE("an indenter") {
    scene.contacts = {RigidContact{
        "ball", Sphere{1, {2, 2.1, 0}}, 0, mesh.node_sets.at("y_max"), {{1, Vec3(0, -0.1, 0)}}}};
    CHECK(words(scene, half_way) == "");
  }
  SUBCASE("inertia") {
    scene.motion = InertiaOptions{};
    CHECK(words(scene, half_way).starts_with("mirror y"));
  }
  SUBCASE("ends that move in their own times") {
    for (Prescribed& p : scene.dofs.prescribed)
      if (p.value == 0 && p.dof % 3 == 0) {
        p.value = -0.2;
        p.factor = std::make_shared<const std::vector<HistoryPoint<double>>>(
            std::vector<HistoryPoint<double>>{{0.5, 1}, {1, 1}});
      }
    CHECK(words(scene, half_way).starts_with("mirror y"));
  }
}

TEST_CASE("a reduced run continues from what was written of the whole body") {
  const Case c{.alpha = 60};
  const Mesh mesh = mesh_of(c);
  const Scene scene = scene_of(c, mesh);
  const auto part = ReducedScene::find(c.symmetry, mesh, scene, nowhere);
  REQUIRE(part.has_value());
  const StepRecord record = solved(mesh, scene, part, in_four_steps()).last();
  const BodyState state = part->reduced(record);
  REQUIRE(state.r.size() == 1);
  double kept = 0, all = 0;
  for (const Vec3& r : state.r[0]) kept += r[1];
  for (const Vec3& r : record.contacts.at("ball").r) all += r[1];
  CHECK(kept == near(all, 1e-12));
  for (int i = 0; i < part->mesh().n_nodes(); ++i)
    if (part->scene().dofs.tie[i].of != i) CHECK(state.u.segment<3>(3 * i).isZero(0));
}

}  // namespace symmetry_tests
