// Errors by dual solutions: what they are made of, and against those of finer cells.
#include "accuracy/estimate/dual_estimate.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "mechanics/mesh/section.hpp"
#include "mechanics/solve/state_tangent.hpp"
#include "results/post/patches.hpp"
#include "support/block.hpp"
#include "support/directions.hpp"
#include "support/estimate_of.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"
#include "support/section.hpp"

using namespace langer;

namespace {

struct Estimated {
  std::vector<Valued> found;
  std::vector<ErrorEstimate> errors;
  const ErrorEstimate& of(const std::string& name) const { return test::estimate_of(errors, name); }
};
Estimated by_dual_solutions(const std::string& text) {
  const SolveConfig config = test::config_of(text);
  Run run(test::mesh_in(config), config, config.material, test::nowhere);
  const RunEnd end = run.follow();
  REQUIRE(end.path.complete);
  const std::vector<Valued> found = valued(config, run.scene, run.mesh, end.last);
  return {found, dual_errors(config, run, end.last, found).at_end};
}

double value_of(const std::string& text, const std::string& name) {
  const SolveConfig config = test::config_of(text);
  for (const Valued& v : end_of_path(config, config.material, test::nowhere))
    if (v.name == name) return v.value;
  FAIL(name);
  return 0;
}

std::string cantilever(const char* cells, const char* divisions) {
  return std::string("mesh: {cells: ") + cells +
         ", geometry: {block: {size: [10, 2, 2], divisions: " + divisions +
         "}}, points: {tip: [10, 2, 2]}}\n"
         "material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 1.0e-4}}}\n"
         "supports: [{on: x_min, hold: [x, y, z]}]\nloads: [{on: x_max, force: {y: 0.004}}]\npath: "
         "{steps: 1}\n";
}

}  // namespace

TEST_CASE("patches give polynomials and their gradients exactly, up to the surface") {
  for (CellType type : {CellType::hex8, CellType::hex27, CellType::tet15}) {
    CAPTURE(static_cast<int>(type));
    const bool cubic = type != CellType::hex8;
    Mesh mesh = test::cube(4);
    test::distort(mesh, 0.03);
    if (cubic) mesh = test::raised_block(mesh, type);
    const Body body = test::body(mesh, {test::neo_hooke(0.1, 1e-3)}, usual_formulation(type));
    const Patches patches(body);
    CHECK(patches.share_without_interior() == 0);
    MatX u(mesh.n_nodes(), 1);
    for (int i = 0; i < mesh.n_nodes(); ++i) {
      const Vec3& X = mesh.X[static_cast<std::size_t>(i)];
      u(i, 0) = X[0] * X[0] + 2 * X[0] * X[1] - X[2] * X[2] + (cubic ? X[0] * X[0] * X[1] : 0);
    }
    std::vector<MatX> p;
    for (int e = 0; e < mesh.n_cells(); ++e) {
      MatX points(cubic ? mesh.cell().n_gauss : 1, 1);
      for (Eigen::Index g = 0; g < points.rows(); ++g) {
        Vec3 X = cubic ? gauss_position(mesh, e, static_cast<int>(g)) : Vec3(Vec3::Zero());
        for (int a : mesh.cell(e))
          if (!cubic) X += mesh.X[static_cast<std::size_t>(a)] / 8;
        points(g, 0) = X[0] - 3 * X[1] + (cubic ? X[1] * X[2] : 0);
      }
      p.push_back(points);
    }
    const Patches::Smooth smooth_u = patches.fit_nodal_fields(u),
                          smooth_p = patches.fit_gauss_fields(p);
    double off = 0;
    for (int e = 0; e < mesh.n_cells(); ++e)
      for (int g = 0; g < mesh.cell().n_gauss; ++g) {
        const Vec3 X = gauss_position(mesh, e, g);
        const Vec3 right(2 * X[0] + 2 * X[1] + (cubic ? 2 * X[0] * X[1] : 0),
                         2 * X[0] + (cubic ? X[0] * X[0] : 0), -2 * X[2]);
        off = std::max(off, (smooth_u.gradients(e, g).row(0).transpose() - right).norm());
        off = std::max(off, std::abs(smooth_p.values(e, g)(0, 0) -
                                     (X[0] - 3 * X[1] + (cubic ? X[1] * X[2] : 0))));
      }
    CHECK(off < 1e-8);
  }
}

TEST_CASE("the movement with an indenter is the derivative of the states along its path") {
  constexpr double depth = 0.5, step = 1e-5;
  std::vector<std::vector<Vec3>> u;
  std::vector<double> force;
  for (double at : {depth - step, depth + step}) {
    const test::Ended end =
        test::run(test::indentation(test::disc(0.25, "hex8"), test::ball(0, at) + test::tight));
    u.push_back(end.last().u), force.push_back(end.last().force_ind[1]);
  }
  const SolveConfig config = test::config_of(
      test::indentation(test::disc(0.25, "hex8"), test::ball(0, depth) + test::tight));
  Run run(test::mesh_in(config), config, config.material, test::nowhere);
  REQUIRE(run.follow().path.complete);
  ParameterChange by;
  by.indenters = {-Vec3::UnitY()};
  const StateTangent tangent(run.increment, run.increment.accepted());
  const auto movement = tangent.derivative(by, tangent.of_rest(), tangent.of_rest());
  REQUIRE(movement);
  double most = 0, off = 0, dr = 0;
  for (int i = 0; i < n_front(run.mesh); ++i) {
    const Vec3 right =
        (u[1][static_cast<std::size_t>(i)] - u[0][static_cast<std::size_t>(i)]) / (2 * step);
    most = std::max(most, right.norm()),
    off = std::max(off, (movement->u.segment<3>(3 * i) - right).norm());
  }
  CHECK(most > 0.9);
  CHECK(off < 1e-4 * most);
  for (const Vec3& r : movement->r[0]) dr -= r[1];
  CHECK(dr == near((force[1] - force[0]) / (2 * step), 1e-4));
}

TEST_CASE(
    "the error of an indenter's force is within a factor of two of the true one, and its bar holds "
    "it") {
  const auto scene = [](double edge) {
    return test::indentation(test::disc(edge, "hex8"), test::ball(0));
  };
  const double right = value_of(scene(0.02), "force");
  for (double edge : {0.0885, 0.05}) {
    CAPTURE(edge);
    const ErrorEstimate e = by_dual_solutions(scene(edge)).of("force");
    const double error = e.of.value - right;
    CAPTURE(e.cells);
    CAPTURE(error);
    CHECK(e.cells > 0.5 * error);
    CHECK(e.cells < 2 * error);
    CHECK(std::abs(error) <= e.total());
  }
}

TEST_CASE("the error of a displacement under a force has its sign and size") {
  const double right = value_of(cantilever("hex27", "[14, 3, 3]"), "displacement_tip");
  const ErrorEstimate e =
      by_dual_solutions(cantilever("hex8", "[20, 4, 4]")).of("displacement_tip");
  const double error = e.of.value - right;
  CAPTURE(e.cells);
  CAPTURE(error);
  CHECK(error < 0);
  CHECK(e.cells < 0.5 * error);
  CHECK(e.cells > 2 * error);
}

TEST_CASE("a displacement where a load ends has a longer bar than one beside it") {
  const auto share = [](const std::string& patch) {
    const Estimated found = by_dual_solutions(
        "mesh: {geometry: {block: {origin: [-3, 0, -3], size: [6, 2, 6], divisions: [12, 4, 12]}},\n"
        "  sets: {patch: {of: top, within: {box: {from: [-1, 1.9, -1], to: " +
        patch +
        "}}}},\n"
        "  points: {corner: [1, 2, 1]}}\n"
        "material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 1.0}}}\n"
        "supports: [{on: bottom, hold: [x, y, z]}]\n"
        "loads: [{on: patch, traction: {y: -0.001}}]\npath: {steps: 1}\n");
    return found.of("displacement_corner").scatter / found.of("displacement_corner").of.value;
  };
  CHECK(share("[1, 2.1, 1]") > 3 * share("[1.5, 2.1, 1.5]"));
}

TEST_CASE("symmetry leaves the errors of reactions and forces as they are") {
  const std::string pulled =
      "mesh: {geometry: {block: {size: [4, 4, 4], divisions: [4, 4, 4]}}}\n"
      "material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 1.0e-2}}}\n"
      "supports: [{on: x_min, hold: [y, z]}, {on: x_max, hold: [y, z]}]\n"
      "loads: [{on: x_min, displacement: {x: -0.4}}, {on: x_max, displacement: {x: 0.4}}]\npath: "
      "{steps: 1}\n";
  const std::string pressed =
      "mesh: {geometry: {block: {origin: [-2, 0, -2], size: [4, 2, 4], divisions: [16, 6, 16]}}}\n"
      "material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 1.0e-2}}}\n"
      "supports: [{on: bottom, hold: [x, y, z]}]\n"
      "contacts: {ball: {on: top, rigid: {sphere: {radius: 2, centre: [0, 4, 0]}}, motion: [{t: 1, "
      "to: [0, -0.4, 0]}]}}\n"
      "path: {steps: 2}\n";
  const std::string at_points =  // in each quarter
      "mesh: {geometry: {block: {origin: [-3, 0, -3], size: [6, 2, 6], divisions: [12, 4, 12]}},\n"
      "  sets: {patch: {of: top, within: {box: {from: [-1, 1.9, -1], to: [1, 2.1, 1]}}}},\n"
      "  points: {a: [-1, 2, -0.5], b: [1.5, 2, -1.5], c: [-0.5, 2, 1], d: [0.5, 2, 0.5]}}\n"
      "material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 1.0e-2}}}\n"
      "supports: [{on: bottom, hold: [x, y, z]}]\n"
      "loads: [{on: patch, traction: {y: -0.01}}]\npath: {steps: 2}\n";
  for (const std::string& scene : {pulled, pressed, at_points}) {
    CAPTURE(scene);
    const Estimated whole = by_dual_solutions(scene + "homogeneous: off\nsymmetry: none\n");
    const Estimated part = by_dual_solutions(scene + "homogeneous: off\nsymmetry: auto\n");
    REQUIRE(part.errors.size() >= whole.errors.size());
    for (const ErrorEstimate& e : whole.errors) {
      const ErrorEstimate& of_part = part.of(e.of.name);
      CHECK(of_part.cells == near(e.cells, 1e-3));
      // a force at a point acts on its images, too, and parts of opposite signs meet in an element
      const bool at_a_point = e.of.unit == unit::mm;
      CHECK(of_part.scatter <= 1.001 * e.scatter);
      CHECK(of_part.scatter >= (at_a_point ? 0.6 : 0.999) * e.scatter);
    }
  }
}

TEST_CASE("where no scene of the kind was measured the estimate says so") {
  const std::string geometry = test::disc(0.25, "hex8");
  CHECK_THROWS_WITH_AS(by_dual_solutions(test::indentation(geometry, test::ball(0.3))),
                       doctest::Contains("no derivative of an energy"), Failure);
  CHECK_THROWS_WITH_AS(
      by_dual_solutions(test::indentation(geometry, test::ball(0) + "formulation: displacement\n")),
      doctest::Contains("formulation"), Failure);
  CHECK_THROWS_WITH_AS(by_dual_solutions(test::indentation(geometry, test::ball(0, -0.1))),
                       doctest::Contains("no indenter touches"), Failure);
}
