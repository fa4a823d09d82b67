// Cells cut beside larger ones: the mesh, what hangs in it, and the mechanics through hanging
// nodes.
#include "mechanics/mesh/cut.hpp"

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <random>
#include <set>

#include "mechanics/element/surface.hpp"
#include "mechanics/mesh/hanging.hpp"
#include "mechanics/mesh/quality.hpp"
#include "mechanics/mesh/select.hpp"
#include "results/store/mesh_file.hpp"
#include "scene/run/run.hpp"
#include "support/block.hpp"
#include "support/directions.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"
#include "support/section.hpp"

using namespace langer;

namespace {

// a cube of distorted cells, some of them cut at random, up to three times
CutMesh cut_at_random(unsigned seed, int passes = 3, double distortion = 0.05) {
  Mesh mesh = test::cube(3);
  test::distort(mesh, distortion, seed);
  mesh.node_sets.clear();
  name_sides(mesh);
  CutMesh cut(mesh);
  std::mt19937 random(seed);
  for (int pass = 0; pass < passes; ++pass) {
    std::vector<char> marked(static_cast<std::size_t>(cut.mesh().n_cells()), 0);
    for (char& m : marked) m = random() % 12 == 0;
    cut.cut(marked);
  }
  return cut;
}

// all outer nodes follow u = H X
Dofs moved_alike(const Mesh& mesh, const Mat3& H) {
  std::vector<Prescribed> prescribed;
  std::set<int> outer;
  for (const std::string& side : side_names())
    outer.insert(mesh.node_sets.at(side).begin(), mesh.node_sets.at(side).end());
  for (int n : outer)
    for (int k = 0; k < 3; ++k)
      prescribed.push_back({3 * n + k, (H * mesh.X[static_cast<std::size_t>(n)])[k]});
  return number_dofs(mesh.n_nodes(), prescribed, {}, mesh.hanging).dofs;
}

VecX field(const Mesh& mesh, const Mat3& H) {
  VecX u(3 * mesh.n_nodes());
  for (int i = 0; i < mesh.n_nodes(); ++i)
    u.segment<3>(3 * i) = H * mesh.X[static_cast<std::size_t>(i)];
  return u;
}

const Mat3 stretched = (Mat3() << 0.1, 0.04, -0.02, 0.0, -0.06, 0.03, 0.05, 0.02, 0.02).finished();

std::string pressed(const std::string& mesh, const std::string& more = "", double friction = 0) {
  return "mesh: {" + mesh +
         "}\nmaterial: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 0.01}}}\n"
         "supports: [{on: bottom, hold: [x, y, z]}]\nstability: off\n" +
         "contacts: {ball: {rigid: {sphere: {radius: 3, centre: [0, 7, 0]}}, friction: " +
         std::to_string(friction) +
         ", motion: [{t: 1, to: [0, -0.5, 0]}]}}\npath: {first: 0.25, largest: 0.25}\n"
         "solver: {newton: {relative: 1.0e-10}}\n" +
         more;
}
const std::string under_the_ball = "cuts: [{within: {cylinder: {axis: y, radius: 2.2}}, times: 1}]";
std::string block(int across, int along_y) {
  return "geometry: {block: {origin: [-8, 0, -8], size: [16, 4, 16], divisions: [" +
         std::to_string(across) + ", " + std::to_string(along_y) + ", " + std::to_string(across) +
         "]}}";
}

}  // namespace

TEST_CASE("a body whose cells are cut at random stays one body") {
  for (unsigned seed : {1u, 2u, 3u, 4u}) {
    CAPTURE(seed);
    const CutMesh cut = cut_at_random(seed);
    const Mesh& mesh = cut.mesh();
    REQUIRE(mesh.n_cells() > 100);
    REQUIRE(!mesh.hanging.empty());
    CHECK(hanging_fault(mesh) == "");
    CHECK(quality(mesh).volume == near(1, 1e-13));
    double area = 0;
    for (const Facet& facet : boundary(mesh)) area += nodal_areas(mesh, {facet}).sum();
    CHECK(area == near(6, 1e-13));
    std::vector<std::array<int, 2>> at(static_cast<std::size_t>(mesh.n_nodes()), {9, 0});
    for (int e = 0; e < mesh.n_cells(); ++e)
      for (int n : mesh.cell(e))
        at[n] = {std::min(at[n][0], cut.level(e)), std::max(at[n][1], cut.level(e))};
    for (const auto& [least, most] : at) CHECK(most - least <= 1);
  }
}

TEST_CASE("sets of a cut mesh are those of its places") {
  const Mesh mesh = cut_at_random(5).mesh();
  Mesh again = mesh;
  again.node_sets.clear(), again.facet_sets.clear();
  name_sides(again);
  for (const std::string& side : side_names()) {
    CAPTURE(side);
    CHECK(mesh.node_sets.at(side) == again.node_sets.at(side));
    const auto keys = [&](const std::vector<Facet>& facets) {
      std::set<std::pair<int, int>> out;
      for (const Facet& f : facets) out.insert({f.cell, f.local});
      return out;
    };
    CHECK(keys(mesh.facet_sets.at(side)) == keys(again.facet_sets.at(side)));
  }
}

TEST_CASE("a body that deforms alike does so through hanging nodes") {
  for (Formulation formulation : {Formulation::mean_dilatation, Formulation::displacement})
    for (unsigned seed : {1u, 7u}) {
      const Mesh mesh = cut_at_random(seed).mesh();
      Assembler body = test::equilibrium(mesh, {test::neo_hooke(0.1, 1e-3)}, formulation,
                                         moved_alike(mesh, stretched));
      const VecX u = field(mesh, stretched);
      body.pressures_from(u);
      REQUIRE(body.assemble(u, false));
      double held = 0, left = 0;
      for (const Prescribed& p : body.dofs().prescribed)
        held = std::max(held, std::abs(body.f_int()[p.dof]));
      for (int dof : body.dofs().free) left = std::max(left, std::abs(body.f_int()[dof]));
      CHECK(body.dofs().n_free() > 100);
      CHECK(left < 1e-12 * held);
      for (const HangingNode& h : mesh.hanging)
        CHECK(body.f_int().segment<3>(3 * h.node).isZero(0));
    }
}

TEST_CASE("the tangent through hanging nodes is the derivative of the forces") {
  const Mesh mesh = cut_at_random(2).mesh();
  Assembler body = test::equilibrium(mesh, {test::neo_hooke(0.1, 1e-2)},
                                     Formulation::mean_dilatation, moved_alike(mesh, stretched));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> about(-1, 1);
  VecX u = field(mesh, stretched), v = VecX::Zero(body.dofs().n_free()), du = VecX::Zero(u.size());
  for (int row = 0; row < v.size(); ++row) {
    const int dof = body.dofs().free[static_cast<std::size_t>(row)];
    u[dof] += 0.003 * about(random), du[dof] = v[row] = about(random);
  }
  const auto forces = [&](const VecX& at) {
    body.pressures_from(at);
    REQUIRE(body.assemble(at, false));
    return VecX(body.f_int());
  };
  const double eps = 1e-6;
  const VecX difference = (forces(u + eps * du) - forces(u - eps * du)) / (2 * eps);
  body.pressures_from(u);
  REQUIRE(body.assemble(u, true));
  const VecX Kv = body.K_times(v);
  double error = 0;
  for (int row = 0; row < v.size(); ++row)
    error = std::max(
        error, std::abs(Kv[row] - difference[body.dofs().free[static_cast<std::size_t>(row)]]));
  CHECK(error < 1e-7 * Kv.lpNorm<Eigen::Infinity>());
}

TEST_CASE("more cells that are cut store less energy, down to that of all of them") {
  // nested spaces; formulation: displacement, since a minimum is asked for
  const auto energy = [](const std::string& cuts, int n) {
    const std::string text =
        "mesh: {geometry: {block: {size: [2, 1, 1], divisions: [" + std::to_string(2 * n) + ", " +
        std::to_string(n) + ", " + std::to_string(n) + "]}}" + cuts +
        "}\nformulation: displacement\nmaterial: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 1}}}\n"
        "supports: [{on: x_min, hold: [x, y, z]}]\nloads: [{on: x_max, displacement: {x: 0.1, y: 0.1, z: 0}}]\n"
        "path: {steps: 1}\nstability: off\nsolver: {newton: {relative: 1.0e-11}}\n";
    const SolveConfig config = test::config_of(text);
    Run run(test::mesh_in(config), config, config.material, test::nowhere);
    const RunEnd end = run.follow();
    REQUIRE(end.path.complete);
    return end.last.scalars.at("energy");
  };
  const double coarse = energy("", 3), fine = energy("", 6);
  const double one = energy(", cuts: [{within: {box: {from: [0, 0, 0], to: [0.3, 1, 1]}}}]", 3);
  const double two = energy(
      ", cuts: [{within: {box: {from: [0, 0, 0], to: [0.3, 1, 1]}}}, {within: {box: {from: [1.7, 0, 0], to: [2, 1, 1]}}}]",
      3);
  const double all = energy(", cuts: [{within: {box: {from: [0, 0, 0], to: [2, 1, 1]}}}]", 3);
  CHECK(coarse > one);
  CHECK(one > two);
  CHECK(two > fine);
  CHECK(all == near(fine, 1e-10));
  CHECK(coarse - two > 0.5 * (coarse - fine));  // what is cut is where the energy is
}

TEST_CASE("under a sphere the quarter of a cut body is its whole, with friction and without") {
  for (double friction : {0.0, 0.4}) {
    CAPTURE(friction);
    const auto force = [&](const std::string& symmetry, int across) {
      const SolveConfig config = test::config_of(pressed(block(across, 3) + ", " + under_the_ball,
                                                         "symmetry: " + symmetry + "\n", friction));
      Run run(test::mesh_in(config), config, config.material, test::nowhere);
      for (int n : run.scene.contacts[0].nodes)
        for (const HangingNode& h : run.mesh.hanging) CHECK(n != h.node);
      const RunEnd end = run.follow();
      REQUIRE(end.path.complete);
      return end.last.force_ind.norm();
    };
    for (int across : {12, 13}) {  // planes between cells, and through them
      CAPTURE(across);
      const double whole = force("none", across);
      CHECK(force("quarter", across) == near(whole, 1e-8));
      CHECK(force("half_turn", across) == near(whole, 1e-8));
    }
  }
}

TEST_CASE("cells cut under a sphere do what short cells everywhere do") {
  const auto force = [](const std::string& mesh) {
    const SolveConfig config = test::config_of(pressed(mesh, "symmetry: auto\n"));
    Run run(test::mesh_in(config), config, config.material, test::nowhere);
    const RunEnd end = run.follow();
    REQUIRE(end.path.complete);
    return end.last.force_ind.norm();
  };
  const double coarse = force(block(16, 4)), fine = force(block(32, 8));
  const double cut = force(block(16, 4) + ", cuts: [{within: {cylinder: {axis: y, radius: 3}}}]");
  CHECK(std::abs(cut - fine) < 0.1 * std::abs(coarse - fine));
}

TEST_CASE("the file of a mesh keeps what hangs in it") {
  const Mesh mesh = cut_at_random(3).mesh();
  const std::string path =
      std::filesystem::temp_directory_path() / ("cut_" + std::to_string(getpid()) + ".h5");
  write_mesh(path, mesh, {});
  const Mesh read = read_mesh(path).mesh;
  std::filesystem::remove(path);
  REQUIRE(read.hanging.size() == mesh.hanging.size());
  for (std::size_t i = 0; i < read.hanging.size(); ++i) {
    CHECK(read.hanging[i].node == mesh.hanging[i].node);
    CHECK(read.hanging[i].of == mesh.hanging[i].of);
  }
}

TEST_CASE(
    "what ends in the middle of a facet, or was never tried on cut cells, is refused by name") {
  const auto refused = [](const std::string& text) -> std::string {
    try {
      const SolveConfig config = test::config_of(text);
      make_scene(config, test::mesh_in(config), config.material, test::nowhere);
    } catch (const Failure& failure) {
      return failure.what();
    }
    return "";
  };
  const std::string start =
      "mesh: {geometry: {block: {size: [4, 4, 4], divisions: [4, 4, 4]}}, cuts: [{within: {box: {from: [0, 0, 0], to: "
      "[1.9, 1.9, 1.9]}}}]";
  const std::string law =
      "}\nmaterial: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 1}}}\nloads: [{on: top, displacement: {y: -0.1}}]\n";
  CHECK(refused(start +
                ", sets: {part: {of: bottom, within: {box: {from: [0, 0, 0], to: [2, 0, 2.4]}}}}" +
                law + "supports: [{on: part, hold: [x, y, z]}]\n") == "");
  CHECK(refused(start +
                ", sets: {part: {of: bottom, within: {box: {from: [0, 0, 0], to: [2, 0, 2]}}}}" +
                law + "supports: [{on: part, hold: [x, y, z]}]\n") == "");
  CHECK(refused(
            start +
            ", sets: {part: {of: bottom, within: {box: {from: [0.4, 0, 0.4], to: [3, 0, 1.6]}}}}" +
            law + "supports: [{on: part, hold: [x, y, z]}]\n")
            .find("middle of an edge or a facet") != std::string::npos);
  const std::string held = "supports: [{on: bottom, hold: [x, y, z]}]\n";
  CHECK(
      refused(
          "mesh: {geometry: {block: {size: [4, 4, 4], divisions: [4, 4, 4]}}, cuts: [{within: {box: {from: [0, 0, 0], to: "
          "[4, 4, 4]}}, times: 8}]" +
          law + held)
          .find("cells; expected at most 4000000") != std::string::npos);
  CHECK(refused(start + law + held + "sensitivity: [matrix.neo_hooke.a1]\n")
            .find("derivatives, next to cells that are cut") != std::string::npos);
  const std::string pressure = "loads: [{on: top, pressure: 0.01}]\n",
                    alone = law.substr(0, law.find("loads"));
  CHECK(refused(start + alone + held + pressure)
            .find("force on a surface, next to cells that are cut") != std::string::npos);
}
