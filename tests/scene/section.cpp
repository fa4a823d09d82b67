// Sections: what an axisymmetric or plane-strain scene gives is what the body of three dimensions
// gives.
#include "scene/model/scene_section.hpp"

#include <doctest/doctest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>

#include "mechanics/material/uniaxial.hpp"
#include "mechanics/mesh/reference.hpp"
#include "mechanics/mesh/section.hpp"
#include "support/block.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"
#include "support/section.hpp"

using namespace langer;
using namespace langer::test;

namespace section_tests {

namespace {

constexpr double pi = std::numbers::pi;

// inner nodes moved within the plane, those behind them too
void distort_in_plane(Mesh& mesh, double amount) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-amount, amount);
  const int n = n_front(mesh);
  std::vector<char> outer(n, 0);
  for (const char* side : {"x_min", "x_max", "y_min", "y_max"})
    for (int i : mesh.node_sets.at(side)) outer[i] = 1;
  for (int i = 0; i < n; ++i) {
    if (outer[i]) continue;
    const Vec3 move(u(random), u(random), 0);
    for (int k = i; k < mesh.n_nodes(); k += n) mesh.X[k] += move;
  }
  for (int i = n; i < mesh.n_nodes(); ++i)
    if (mesh.section->of == SectionOf::axisymmetric)
      mesh.X[i][2] = mesh.section->depth * mesh.X[i][0] * (i / n) / (mesh.cell().layers - 1);
  REQUIRE(section_fault(mesh) == "");
}

}  // namespace

TEST_CASE("a cylinder pulled and one pressed by its ends have the state of a point, on any cells") {
  for (const char* cells : {"hex8", "hex27"})
    for (double way : {1.2, -0.9}) {
      CAPTURE(cells);
      CAPTURE(way);
      const SolveConfig config = config_of(
          "mesh: {geometry: {section: {of: axisymmetric, size: [2, 3], divisions: [3, 4]}}, cells: " +
          std::string(cells) + "}\n" + yeoh + tight +
          "supports: [{on: bottom, hold: [y]}]\nloads: [{on: top, displacement: {y: " +
          std::to_string(way) + "}}]\n");
      Mesh mesh = mesh_in(config);
      distort_in_plane(mesh, 0.15);
      const Ended r = run(config, mesh);
      const Uniaxial point = uniaxial(*config.material, 1 + way / 3);
      REQUIRE(point.converged);
      double worst = 0;
      for (int i = 0; i < mesh.n_nodes(); ++i) {
        const double u_r = (point.stretch[1] - 1) * mesh.X[i][0];
        worst = std::max(worst, std::abs(r.last().u[i][0] - u_r));
        worst = std::max(worst, std::abs(r.last().u[i][1] - way * mesh.X[i][1] / 3));
        worst =
            std::max(worst, std::abs(r.last().u[i][2] -
                                     (point.stretch[1] - 1) * mesh.X[i][2]));  // F_zz = 1 + u_r / r
      }
      CHECK(worst < 1e-9);
      const double force = point.sigma * pi * 4 * point.stretch[1] * point.stretch[1];
      CHECK(r.reaction("top")[1] == near(force, 1e-9));
      CHECK(r.reaction("bottom")[1] == near(-force, 1e-9));
    }
}

TEST_CASE(
    "a cylinder stretched along its radius and its axis stores the energy of its volume, and pulls as its law says") {
  for (const char* cells : {"hex8", "hex27"}) {
    CAPTURE(cells);
    const SolveConfig config = config_of(
        "mesh: {geometry: {section: {of: axisymmetric, size: [2, 3], divisions: [4, 3]}}, cells: " +
        std::string(cells) + "}\n" + yeoh + tight +
        "supports: [{on: bottom, hold: [y]}]\nloads: [{on: top, displacement: {y: -0.75}}, {on: x_max, displacement: {x: 0.3}}]\n");
    Mesh mesh = mesh_in(config);
    distort_in_plane(mesh, 0.1);
    const Ended r = run(config, mesh);
    const Vec3 stretch(1.15, 0.75, 1.15);
    const Mat3 C = stretch.cwiseProduct(stretch).asDiagonal();
    const Response point = response(*config.material, C, std::span<const Vec3>{});
    CHECK(r.last().scalars.at("energy") == near(point.W * pi * 4 * 3, 1e-9));
    CHECK(r.reaction("top")[1] == near(0.75 * point.S[1] * pi * 4, 1e-9));
    CHECK(r.reaction("x_max")[0] == near(1.15 * point.S[0] * 2 * pi * 2 * 3, 1e-9));
  }
}

TEST_CASE(
    "a thick tube widened from inside converges to the closed form with the order of its cells") {
  // incompressible, no movement along the axis: r^2 = R^2 + C, pressure inside less outside =
  // integral of (sigma_theta - sigma_r)/r
  const double mu = 2 * 0.5, inner = 1, outer = 2, u = 0.5,
               C = (inner + u) * (inner + u) - inner * inner;
  const auto slope = [&](double R) {
    const double r = std::sqrt(R * R + C), lambda = r / R;
    return mu * (lambda * lambda - 1 / (lambda * lambda)) / r * (R / r);  // dr = R/r dR
  };
  double pressure = 0;
  constexpr int n = 2000;
  for (int i = 0; i < n; ++i) {
    const double a = inner + (outer - inner) * i / n, b = inner + (outer - inner) * (i + 1) / n;
    pressure += (slope(a) + 4 * slope(0.5 * (a + b)) + slope(b)) * (b - a) / 6;
  }
  const double force = pressure * 2 * pi * (inner + u) * 0.5;  // over a height of 0.5
  for (const auto& [type, order] : {std::pair{"hex8", 2.0}, {"hex27", 4.0}}) {
    const std::string cells = type;
    CAPTURE(cells);
    std::vector<double> errors;
    for (int divisions : {3, 6}) {  // beyond, what rounding leaves at this d is seen
      const Ended r = run(
          "mesh: {geometry: {section: {of: axisymmetric, origin: [1, 0], size: [1, 0.5], divisions: [" +
          std::to_string(divisions) + ", 1]}}, cells: " + cells +
          "}\nmaterial: {matrix: {neo_hooke: {a1: 0.5}}, volume: {quadratic: {d: 1.0e-7}}}\n" +
          tight +
          "supports: [{on: bottom, hold: [y]}, {on: top, hold: [y]}]\nloads: [{on: x_min, displacement: {x: 0.5}}]\n");
      errors.push_back(std::abs(r.reaction("x_min")[0] / force - 1));
      for (int i : r.mesh.node_sets.at("x_max"))
        CHECK(r.last().u[i][0] == near(std::sqrt(4 + C) - 2, 1e-6));
    }
    MESSAGE(std::string(cells) << ": error of the pressure " << errors[0] << ", " << errors[1]);
    CHECK(std::log2(errors[0] / errors[1]) > order - 0.2);
    CHECK(errors[1] < 0.02);
  }
}

TEST_CASE("plane strain is a layer of the block held along z on both faces") {
  for (const CellType cells : {CellType::hex8, CellType::hex27}) {
    const SolveConfig config = config_of(
        "mesh: {geometry: {section: {of: plane_strain, size: [3, 2], divisions: [4, 3], thickness: 0.7}}, cells: " +
        std::string(cells == CellType::hex8 ? "hex8" : "hex27") + "}\n" + yeoh + tight +
        "supports: [{on: bottom, hold: [x, y]}]\nloads: [{on: top, displacement: {x: 0.8, y: -0.3}}]\n");
    const Mesh mesh = mesh_in(config);
    const Ended flat = run(config, mesh);
    Mesh layer = test::block(test::even(0, 3, 4), test::even(0, 2, 3), {0, 0.7});
    if (cells != CellType::hex8) layer = test::raised_block(layer, cells);
    layer.node_sets["bottom"] = layer.node_sets["y_min"],
    layer.node_sets["top"] = layer.node_sets["y_max"];
    for (int i = 0; i < layer.n_nodes(); ++i) layer.node_sets["all"].push_back(i);
    SolveConfig held = config;
    held.supports.push_back({"all", {Axis::z}});
    const Ended deep = run(held, layer);
    REQUIRE(flat.steps.size() == deep.steps.size());
    double worst = 0;
    int met = 0;
    for (int i = 0; i < mesh.n_nodes(); ++i)
      for (int j = 0; j < layer.n_nodes(); ++j)
        if ((mesh.X[i] - layer.X[j]).norm() < 1e-12)
          worst = std::max(worst, (flat.last().u[i] - deep.last().u[j]).norm()), ++met;
    CHECK(met == mesh.n_nodes());
    CHECK(worst < 1e-10);
    for (int k : {0, 1}) CHECK(flat.reaction("top")[k] == near(deep.reaction("top")[k], 1e-10));
    CHECK(flat.last().scalars.at("energy") == near(deep.last().scalars.at("energy"), 1e-10));
  }
}

TEST_CASE(
    "the tangent of a section is the slope of its forces, and its forces are the slope of its energy") {
  for (const char* cells : {"hex8", "hex27"})
    for (const char* of : {"axisymmetric", "plane_strain"}) {
      CAPTURE(cells);
      CAPTURE(of);
      const SolveConfig config = config_of(
          "mesh: {geometry: {section: {of: " + std::string(of) +
          ", size: [2, 1], divisions: [2, 2]}}, cells: " + cells + "}\n" + yeoh +
          "supports: [{on: bottom, hold: [y]}]\nloads: [{on: top, displacement: {y: 0.1}}]\n");
      Mesh mesh = mesh_in(config);
      distort_in_plane(mesh, 0.05);
      const Scene whole = make_scene(config, mesh, config.material, nowhere);
      const auto part = ReducedScene::find(config.symmetry, mesh, whole, nowhere);
      REQUIRE(part.has_value());
      const Reduction reduction(mesh, whole, part);  // body refers to it
      Assembler body = reduction.assembler();
      const Dofs& dofs = body.dofs();
      std::mt19937 random(5);
      std::uniform_real_distribution<double> small(-0.02, 0.02);
      VecX u = VecX::Zero(dofs.n);
      for (int dof : dofs.free) u[dof] = small(random);
      body.pressures_from(u);
      REQUIRE(body.assemble(u, true));
      const Pattern& pattern = body.pattern();
      const std::vector<double> K = body.K();
      const VecX f = body.f_int();
      const double h = 1e-6;
      double worst = 0, slope = 0, stiffest = 0, most = 0;
      for (int c = 0; c < dofs.n_free(); ++c) {
        VecX plus = u, minus = u;
        plus[dofs.free[c]] += h, minus[dofs.free[c]] -= h;
        REQUIRE(body.assemble(plus, false));
        const VecX f_plus = body.f_int();
        const double W_plus = body.W();
        REQUIRE(body.assemble(minus, false));
        slope = std::max(slope, std::abs((W_plus - body.W()) / (2 * h) - f[dofs.free[c]]));
        most = std::max(most, std::abs(f[dofs.free[c]]));
        for (int k = pattern.column_start[c]; k < pattern.column_start[c + 1]; ++k) {
          const int dof = dofs.free[pattern.row[k]];
          worst = std::max(worst, std::abs((f_plus[dof] - body.f_int()[dof]) / (2 * h) - K[k]));
          stiffest = std::max(stiffest, std::abs(K[k]));
        }
      }
      CHECK(stiffest > 1);
      CHECK(worst < 1e-7 * stiffest);
      CHECK(slope < 1e-7 * most);
    }
}

TEST_CASE("what has no section is refused by name") {
  const auto words = [](const std::string& of, const std::string& more,
                        const std::string& contact = "") -> std::string {
    const SolveConfig config = config_of(
        "mesh: {geometry: {section: {of: " + of + ", size: [5, 2], divisions: [4, 2]}}}\n" +
        (more.find("material") == std::string::npos ? yeoh : "") + more +
        "supports: [{on: bottom, hold: [x, y, z]}]\n" +
        (contact.empty() ? "" : "contacts: {tool: {on: top, " + contact + "}}\n"));
    try {
      make_scene(config, mesh_in(config), config.material, nowhere);
      return "taken";
    } catch (const Failure& failure) {
      return failure.what();
    }
  };
  const auto holds = [](const std::string& text, const char* part) {
    CAPTURE(text);
    return text.find(part) != std::string::npos;
  };
  const std::string down = "motion: [{t: 1, to: [0, -0.1, 0]}]";
  CHECK(words("axisymmetric", "", "rigid: {sphere: {radius: 1, centre: [0, 3, 0]}}, " + down) ==
        "taken");
  CHECK(
      holds(words("axisymmetric", "", "rigid: {sphere: {radius: 1, centre: [0.1, 3, 0]}}, " + down),
            "contacts.tool.rigid"));
  CHECK(holds(
      words(
          "axisymmetric", "",
          "rigid: {sphere: {radius: 1, centre: [0, 3, 0]}}, motion: [{t: 1, to: [0.1, -0.1, 0]}]"),
      "contacts.tool.motion[0].to: found [0.1, -0.1, 0], on an axisymmetric section; expected a movement along y"));
  CHECK(words("axisymmetric", "",
              "rigid: {plane: {point: [0, 2, 0], normal: [0, -1, 0]}}, " + down) == "taken");
  CHECK(holds(words("axisymmetric", "",
                    "rigid: {plane: {point: [0, 4, 0], normal: [0.1, -1, 0]}}, " + down),
              "contacts.tool.rigid"));
  CHECK(holds(words("axisymmetric", "",
                    "rigid: {ellipsoid: {half_axes: [1, 1, 2], centre: [0, 3, 0]}}, " + down),
              "contacts.tool.rigid"));
  CHECK(holds(
      words("axisymmetric", "",
            "rigid: {cylinder: {radius: 1, edge: 0.1, face: [0, 2, 0], axis: [1, 0, 0]}}, " + down),
      "contacts.tool.rigid"));
  CHECK(words("plane_strain", "",
              "rigid: {plane: {point: [0, 4, 0], normal: [0.1, -1, 0]}}, "
              "motion: [{t: 1, to: [0.1, -0.1, 0]}]") == "taken");
  CHECK(holds(words("plane_strain", "", "rigid: {sphere: {radius: 1, centre: [0, 3, 1]}}, " + down),
              "contacts.tool.rigid"));
  CHECK(holds(
      words(
          "plane_strain", "",
          "rigid: {sphere: {radius: 1, centre: [0, 3, 0]}}, motion: [{t: 1, to: [0, -0.1, 0.1]}]"),
      "motion[0].to"));
  const auto fibres = [](double c1, double alpha, double kappa) {
    return "material: {matrix: {neo_hooke: {a1: 0.5}}, fibres: [{hgo: {c1: " + std::to_string(c1) +
           ", c2: 1}, alpha: " + std::to_string(alpha) +
           ", kappa: " + (kappa > 0 ? std::string("0.33333333333333331") : "0") +
           "}], volume: {quadratic: {d: 1.0e-3}}}\nloads: [{on: top, displacement: {y: 0.1}}]\n";
  };
  CHECK(holds(words("axisymmetric", fibres(0.1, 0, 0)), "fibres in the body \"skin\""));
  CHECK(words("axisymmetric", fibres(0, 0, 0)) == "taken");
  CHECK(words("axisymmetric", fibres(0.1, 0, 1)) == "taken");
  CHECK(words("plane_strain", fibres(0.1, 0, 0)) == "taken");
  CHECK(words("plane_strain", fibres(0.1, 90, 0)) == "taken");
  CHECK(holds(words("plane_strain", fibres(0.1, 30, 0)), "fibres in the plane, along z"));
  CHECK(holds(words("axisymmetric", "loads: [{on: top, displacement: {y: 0.1, z: 0.1}}]\n"),
              "loads[0].displacement.z"));
  CHECK(holds(
      words("axisymmetric", "symmetry: quarter\nloads: [{on: top, displacement: {y: 0.1}}]\n"),
      "symmetry: found quarter"));
  CHECK(words("axisymmetric", "symmetry: auto\nloads: [{on: top, displacement: {y: 0.1}}]\n") ==
        "taken");
}

TEST_CASE("a section continues from what was written of it") {
  const SolveConfig config = config_of(indentation(disc(0.35, "hex27"), ball(0.34)));
  const Mesh mesh = mesh_in(config);
  const Ended r = run(config, mesh);
  const auto part = ReducedScene::find(config.symmetry, mesh, r.scene, nowhere);
  const BodyState state = part->reduced(r.last());
  const StepRecord& last = r.last();
  REQUIRE(state.r.size() == 1);
  REQUIRE(state.r[0].size() == last.contacts.at("ball").r.size());
  for (std::size_t i = 0; i < state.r[0].size(); ++i)
    CHECK(state.r[0][i] == last.contacts.at("ball").r[i]);
  for (int i = 0; i < mesh.n_nodes(); ++i)
    CHECK(Vec3(state.u.segment<3>(3 * i)) == (i < n_front(mesh) ? last.u[i] : Vec3(Vec3::Zero())));
}

TEST_CASE(
    "fibres along the axis of a cylinder pull as those of a bar do; a degree off it they are refused") {
  const auto written = [](const std::string& name, double degrees) {
    const std::string path = (std::filesystem::temp_directory_path() /
                              ("langer_section_" + std::to_string(getpid()) + name))
                                 .string();
    std::ofstream(path) << "x,y,z,a_x,a_y,a_z\n0,0,0," << std::sin(degrees * pi / 180) << ","
                        << std::cos(degrees * pi / 180) << ",0\n";
    return path;
  };
  const std::string along = written("along.csv", 0), off = written("off.csv", 1);
  const auto scene = [](const std::string& geometry, const std::string& file,
                        const std::string& sides) {
    return "mesh: {geometry: " + geometry + "}\nfibre_field: {points: {file: " + file +
           "}}\nmaterial: {matrix: {neo_hooke: {a1: 0.1}}, fibres: [{hgo: {c1: 0.3, c2: 0.5}}], volume: {quadratic: {d: 1.0e-3}}}\n"
           "supports: [{on: bottom, hold: [y]}" +
           sides + "]\nloads: [{on: top, displacement: {y: 0.3}}]\npath: {steps: 2}\n" + tight;
  };
  const std::string cylinder = "{section: {of: axisymmetric, size: [1.5, 1], divisions: [3, 2]}}";
  const double bar = run(scene("{block: {size: [1, 1, 1], divisions: [1, 1, 1]}}", along,
                               ", {on: x_min, hold: [x]}, {on: z_min, hold: [z]}"))
                         .reaction("top")[1];
  const double round = run(scene(cylinder, along, "")).reaction("top")[1];
  CHECK(bar > 0.1);
  CHECK(round == near(pi * 1.5 * 1.5 * bar, 1e-8));
  const SolveConfig config = config_of(scene(cylinder, off, ""));
  CHECK(test::said_of_scene(scene(cylinder, off, ""), mesh_in(config)).find("fibres along y") !=
        std::string::npos);
  std::filesystem::remove(along), std::filesystem::remove(off);
}

}  // namespace section_tests
