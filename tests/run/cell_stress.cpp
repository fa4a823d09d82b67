// The stress tensors of cells that `cell_stress` puts into a solution.
#include "scene/run/cell_stress.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "core/tensor/stress.hpp"
#include "scene/model/solve_config.hpp"
#include "support/block.hpp"
#include "support/near.hpp"
#include "support/solved_scene.hpp"

using namespace langer;

namespace {

const std::string neo_hooke =
    "material: {matrix: {neo_hooke: {a1: 0.2}}, volume: {quadratic: {d: 0.01}}}\n";
const std::string fibrous =
    "material: {matrix: {yeoh: {a1: 0.2, a2: 0.1, a3: 0.1}}, fibres: [{hgo: {c1: 0.3, c2: 0.5}, alpha: 30}], "
    "volume: {quadratic: {d: 1e-3}}";
const std::string held = "supports: [{on: bottom, hold: [x, y, z]}]\n";

Mat3 stress_of(const StepRecord& step, int e) {
  return Eigen::Map<const Mat3>(step.cell_fields.at("stress").data() + 9 * e);
}
double value_of(const StepRecord& step, int k, int e) {
  return step.cell_fields.at("principal_stress_" + std::to_string(k))[static_cast<std::size_t>(e)];
}
Vec3 direction_of(const StepRecord& step, int k, int e) {
  return Eigen::Map<const Vec3>(
      step.cell_fields.at("principal_direction_" + std::to_string(k)).data() + 3 * e);
}
double largest(const StepRecord& step) {
  double most = 0;
  for (double v : step.cell_fields.at("stress")) most = std::max(most, std::abs(v));
  return most;
}

struct Body3 {
  SolveConfig config;
  Mesh mesh;
  Scene scene;
  explicit Body3(const std::string& text, const std::optional<Mesh>& given = {})
      : config(test::config_of(text)),
        mesh(given ? *given : test::mesh_in(config)),
        scene(make_scene(config, mesh, config.material, test::nowhere)) {}

  StepRecord under(const Mat3& F) const {
    StepRecord step;
    for (const Vec3& X : mesh.X) step.u.push_back(F * X - X);
    CellStressRecorder(mesh, scene, CellStress::principal).add(step);
    return step;
  }
  // to the end of the path, the tensors with it
  std::vector<StepRecord> followed() const {
    Run run(mesh, config, config.material, test::nowhere,
            config.homogeneous == Homogeneous::automatic);
    CellStressRecorder recorder(run.mesh, run.scene, CellStress::principal);
    std::vector<StepRecord> steps;
    RunListener each;
    each.of_whole = [&](StepRecord& step, const SolveReport&) {
      recorder.add(step);
      steps.push_back(step);
    };
    REQUIRE(run.follow(each).path.complete);
    return steps;
  }
};

// of cells that are no cuboids, in a mesh of every kind
std::vector<Body3> bodies(const std::string& material) {
  std::vector<Body3> found;
  for (const CellType type : {CellType::hex8, CellType::hex27, CellType::tet15}) {
    Mesh mesh = test::block(test::even(0, 2, 2), test::even(0, 1, 2), test::even(0, 2, 2));
    for (Vec3& X : mesh.X) X += Vec3(0.1 * X[1] * X[2], 0.07 * X[0] * X[0], -0.05 * X[0] * X[1]);
    if (type != CellType::hex8) mesh = test::raised_block(mesh, type);
    found.emplace_back(
        material +
            "supports: [{on: x_min, hold: [x]}]\nloads: [{on: x_max, displacement: {x: 0.1}}]\n",
        mesh);
  }
  return found;
}

// the tensors of a step belong to what stands beside them, and the directions to the tensors
void check_fields(const Mesh& mesh, const StepRecord& step) {
  const double scale = largest(step);
  REQUIRE(scale > 0);
  for (int e = 0; e < mesh.n_cells(); ++e) {
    const auto i = static_cast<std::size_t>(e);
    const Mat3 sigma = stress_of(step, e);
    CHECK(std::abs(mean_stress(sigma) - step.cell_fields.at("pressure")[i]) <= 1e-9 * scale);
    CHECK(std::abs(von_mises(sigma) - step.cell_fields.at("von_mises")[i]) <= 1e-9 * scale);
    Mat3 again = Mat3::Zero(), unit = Mat3::Zero();
    for (int k = 1; k <= 3; ++k) {
      const Vec3 a = direction_of(step, k, e);
      again += value_of(step, k, e) * a * a.transpose(), unit += a * a.transpose();
    }
    CHECK((again - sigma).norm() <= 1e-12 * scale);
    CHECK((unit - Mat3::Identity()).norm() <= 1e-12);
    CHECK(value_of(step, 1, e) >= value_of(step, 2, e));
    CHECK(value_of(step, 2, e) >= value_of(step, 3, e));
  }
}

}  // namespace

TEST_CASE(
    "cell stress: simple shear of a neo-Hookean body, 2 W1 (B - I1/3), directions at tan 2 theta = 2 / gamma") {
  const double gamma = 0.6, mu = 0.4;
  Mat3 F = Mat3::Identity();
  F(0, 1) = gamma;
  const Mat3 B = F * F.transpose(), exact = mu * (B - B.trace() / 3 * Mat3::Identity());
  const double theta = 0.5 * std::atan2(2, gamma);
  for (const Body3& body : bodies(neo_hooke)) {
    const StepRecord step = body.under(F);
    for (int e = 0; e < body.mesh.n_cells(); ++e) {
      CHECK((stress_of(step, e) - exact).norm() < 1e-12);
      CHECK(stress_of(step, e)(0, 1) == near(mu * gamma));
      CHECK(std::abs(direction_of(step, 1, e).dot(Vec3(std::cos(theta), std::sin(theta), 0))) ==
            near(1, 1e-12));
      CHECK(std::abs(direction_of(step, 2, e)[2]) == near(1, 1e-12));
      CHECK(value_of(step, 1, e) == near(principal_stresses(exact)[0], 1e-12));
    }
  }
}

TEST_CASE(
    "cell stress: a body that is turned after it was deformed has its tensors and directions turned") {
  Mat3 F;
  F << 1.2, 0.3, 0.1, -0.1, 0.9, 0.2, 0.05, 0.1, 1.05;
  const Mat3 R = (Eigen::AngleAxisd(1.1, Vec3(1, 2, -0.5).normalized())).toRotationMatrix();
  for (const Body3& body : bodies(fibrous + "}\n")) {
    const StepRecord step = body.under(F), turned = body.under(R * F);
    for (int e = 0; e < body.mesh.n_cells(); ++e) {
      CHECK((stress_of(turned, e) - R * stress_of(step, e) * R.transpose()).norm() <=
            1e-12 * largest(step));
      for (int k = 1; k <= 3; ++k) {
        CHECK(value_of(turned, k, e) == near(value_of(step, k, e), 1e-10));
        CHECK(std::abs(direction_of(turned, k, e).dot(R * direction_of(step, k, e))) ==
              near(1, 1e-10));
      }
    }
  }
}

TEST_CASE(
    "cell stress: uniaxial tension, the force over the deformed area along x and nothing across") {
  for (const char* cells : {"hex8", "hex27"})
    for (const char* homogeneous : {"auto", "off"}) {
      const Body3 body(
          std::string(
              "mesh: {geometry: {block: {size: [4, 2, 3], divisions: [2, 2, 2]}}, cells: ") +
          cells +
          "}\nsupports: [{on: x_min, hold: [x]}, {on: y_min, hold: [y]}, {on: z_min, hold: [z]}]\n"
          "loads: [{on: x_max, displacement: {x: 1.2}}]\nsolver: {newton: {relative: 1e-12}}\nhomogeneous: " +
          homogeneous + "\n" + neo_hooke);
      const StepRecord step = body.followed().back();
      double force = 0;
      for (int node : body.mesh.node_sets.at("x_max"))
        force += step.reaction[static_cast<std::size_t>(node)][0];
      const double across = 1 + step.u.back()[1] / 2, along = 1.3, J = along * across * across;
      // sigma_xx - sigma_yy of 2 W1 J^(-5/3) dev B, where sigma_yy = 0
      const double exact = 0.4 * std::pow(J, -5.0 / 3) * (along * along - across * across);
      CHECK(exact == near(force / (6 * across * across), 1e-9));
      for (int e = 0; e < body.mesh.n_cells(); ++e) {
        CHECK((stress_of(step, e) - exact * Vec3::UnitX() * Vec3::UnitX().transpose()).norm() <=
              1e-9 * exact);
        CHECK(std::abs(direction_of(step, 1, e)[0]) == near(1, 1e-9));
      }
      check_fields(body.mesh, step);
    }
}

TEST_CASE(
    "cell stress: of a part that symmetry leaves, the whole body has the tensors of the whole solve") {
  const auto pressed = [](const std::string& symmetry, const std::string& material) {
    return Body3(
        "mesh: {geometry: {block: {origin: [-3, 0, -3], size: [6, 2, 6], divisions: [4, 2, 4]}}, "
        "sets: {contact: {of: top, within: {cylinder: {axis: y, radius: 2.6}}}}}\n" +
        held +
        "contacts: {ball: {on: contact, rigid: {sphere: {radius: 3, centre: [0, 5, 0]}}, motion: [{t: 1, to: [0, -0.4, 0]}]}}\n"
        "path: {first: 0.5, largest: 0.5}\nsolver: {newton: {relative: 1e-11}}\n" +
        material + "symmetry: " + symmetry + "\n");
  };
  for (const auto& [symmetry, material] :
       {std::pair<const char*, std::string>{"quarter", neo_hooke},
        {"half_turn", fibrous + "}\n"}}) {
    const Body3 whole = pressed("none", material), part = pressed(symmetry, material);
    const StepRecord a = whole.followed().back(), b = part.followed().back();
    double sheared = 0;
    for (int e = 0; e < whole.mesh.n_cells(); ++e) {
      CHECK((stress_of(a, e) - stress_of(b, e)).norm() <= 1e-6 * largest(a));
      sheared = std::max(sheared, std::abs(stress_of(a, e)(0, 2)));
    }
    CHECK(sheared > 1e-2 * largest(a));  // there was something whose sign can be wrong
    check_fields(part.mesh, b);
  }
}

TEST_CASE("cell stress: a tube's section has radial, axial and hoop stress along x, y and z") {
  // u_r = c (r - ri), plane faces held along y: hoop stretch u_r / r is known at each place
  const Body3 body(
      "mesh: {geometry: {section: {of: axisymmetric, origin: [2, 0], size: [1, 0.5], divisions: [8, 1]}}, cells: hex27}\n"
      "supports: [{on: x_min, hold: [x]}, {on: y_min, hold: [y]}, {on: y_max, hold: [y]}]\n"
      "loads: [{on: x_max, displacement: {x: 0.2}}]\n" +
      neo_hooke);
  const StepRecord step = body.followed().back();
  for (int e = 0; e < body.mesh.n_cells(); ++e) {
    const Mat3 sigma = stress_of(step, e);
    for (const auto& [i, j] : {std::pair{0, 1}, {0, 2}, {1, 2}})
      CHECK(std::abs(sigma(i, j)) <= 1e-4 * largest(step));
    double r = 0, u = 0, slope = 0;
    const auto nodes = body.mesh.cell(e);
    std::vector<std::pair<double, double>> line;
    for (int n : nodes)
      line.emplace_back(body.mesh.X[static_cast<std::size_t>(n)][0],
                        step.u[static_cast<std::size_t>(n)][0]);
    const auto [first, last] = std::minmax_element(line.begin(), line.end());
    r = (first->first + last->first) / 2, u = (first->second + last->second) / 2;
    slope = (last->second - first->second) / (last->first - first->first);
    const double lr = 1 + slope, lt = 1 + u / r, J = lr * lt;
    const double difference =
        0.4 * std::pow(J, -5.0 / 3) * (lr * lr - lt * lt);  // radial less hoop
    CHECK(sigma(0, 0) - sigma(2, 2) == near(difference, 5e-3));
  }
  check_fields(body.mesh, step);
}

TEST_CASE(
    "cell stress: of a viscous body with fibres they are those of pressure and von Mises beside them, at every step") {
  for (const char* cells : {"hex8", "hex27"}) {
    const Body3 body(
        std::string("mesh: {geometry: {block: {size: [4, 2, 4], divisions: [2, 2, 2]}}, cells: ") +
        cells + "}\n" + held +
        "loads: [{on: top, displacement: {x: 0.8, y: 0.2}}]\npath: {steps: 4, seconds: 3}\n" +
        fibrous + ", viscous: [{tau: 0.5, gamma: 0.8}, {tau: 20, gamma: 0.4, of: matrix}]}\n");
    const std::vector<StepRecord> steps = body.followed();
    REQUIRE(steps.size() == 4);
    for (const StepRecord& step : steps) check_fields(body.mesh, step);
    // a run that goes on has them, too
    CellStressRecorder again(body.mesh, body.scene, CellStress::tensor);
    for (std::size_t i = 0; i < 3; ++i) again.kept(steps[i]);
    StepRecord last = steps[3];
    last.cell_fields.clear();
    again.add(last);
    CHECK(last.cell_fields.size() == 1);
    CHECK(last.cell_fields.at("stress") == steps[3].cell_fields.at("stress"));
  }
}

TEST_CASE("cell stress: nothing is added where nothing was asked for") {
  const Body3 body = bodies(neo_hooke).front();
  StepRecord step;
  step.u.assign(body.mesh.X.size(), Vec3::Zero());
  CellStressRecorder(body.mesh, body.scene, std::nullopt).add(step);
  CHECK(step.cell_fields.empty());
  CHECK(body.under(Mat3::Identity()).cell_fields.size() == 7);
}
