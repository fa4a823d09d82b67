// What a run says of the first place where its body gives way: the kind, and where on the path.
#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>

#include <fmt/format.h>

#include "accuracy/checks/free_surface.hpp"
#include "mechanics/material/ellipticity.hpp"
#include "support/drawn_instabilities.hpp"
#include "support/near.hpp"
#include "support/solved_scene.hpp"

using namespace langer;

namespace {

const Material soft{.matrix = {NeoHooke{0.01}}, .fibres = {}, .volume = QuadraticVolume{1e-4}};

// The stretch at which the surface condition is lost, by halving. F(s): of the stretch s along x,
// the surface normal is y.
template <class Deformation>
double critical_stretch(const Deformation& F, const Mat3& rotation = Mat3::Identity()) {
  double stable = 1;
  double unstable = 0.2;
  for (int i = 0; i < 50; ++i) {
    const double s = 0.5 * (stable + unstable);
    const Mat3 turned = rotation * F(s) * rotation.transpose();
    (surface_margin(soft, turned, rotation * Vec3::UnitY()) > 0 ? stable : unstable) = s;
  }
  return stable;
}

Mat3 stretches(double x, double y, double z) { return Vec3(x, y, z).asDiagonal(); }

struct Verdict {
  std::optional<CriticalPoint> critical;
  std::vector<TextResult> texts;
  std::vector<Summary> numbers;
  bool complete = false;
  double first_negative = 2;  // t
};

Verdict verdict_of(const std::string& scene, bool only_contact = false) {
  const SolveConfig config = test::config_of(scene);
  Run run(test::mesh_in(config), config, config.material, test::nowhere);
  RunWatch watch(run, config, test::nowhere, {});
  Verdict out;
  RunListener listener;
  listener.of_part = [&](StepRecord& step) {
    const bool goes_on = watch.of_part(step);
    if (step.scalars.at("negative_eigenvalues") != 0)
      out.first_negative = std::min(out.first_negative, step.t);
    return goes_on;
  };
  const RunEnd end = run.follow(listener);
  watch.locate(end, only_contact);
  out.complete = end.path.complete;
  out.critical = watch.critical();
  out.texts = watch.texts();
  out.numbers = watch.stability_summary();
  return out;
}

std::string pressed_block(double shorter, const std::string& more) {
  return fmt::format(
      "mesh: {{geometry: {{section: {{of: plane_strain, size: [4, 4], divisions: [4, 4]}}}}, cells: hex27}}\n"
      "material: {{matrix: {{neo_hooke: {{a1: 0.01}}}}, volume: {{quadratic: {{d: 1.0e-4}}}}}}\n"
      "supports: [{{on: bottom, hold: [y]}}, {{on: x_min, hold: [x]}}]\n"
      "loads: [{{on: x_max, displacement: {{x: -{}}}}}]\n"
      "homogeneous: off\nestimate: none\n{}",
      shorter, more);
}

std::string snapping_cap(double pressure, const std::string& more) {
  return fmt::format(
      "mesh: {{geometry: {{section: {{of: axisymmetric, size: [20, 1], divisions: [8, 1]}}}}, bend: 100, cells: hex27}}\n"
      "supports: [{{on: x_max, hold: [x, y]}}]\n"
      "loads: [{{on: top, pressure: {}}}]\n"
      "material: {{matrix: {{neo_hooke: {{a1: 0.1666666667}}}}, volume: {{quadratic: {{d: 1.0e-2}}}}}}\n{}",
      pressure, more);
}

}  // namespace

TEST_CASE("verdicts: the surface condition of neo-Hooke's law is Biot's, in any frame") {
  const Mat3 turned = Eigen::AngleAxisd(0.7, Vec3(1, 2, -0.5).normalized()).toRotationMatrix();
  for (const Mat3& rotation : {Mat3(Mat3::Identity()), turned}) {
    const auto plane_strain = [](double s) {
      return stretches(s, 1 / s, 1);
    };
    const auto equibiaxial = [](double s) {
      return stretches(s, 1 / (s * s), s);
    };
    const auto uniaxial = [](double s) {
      return stretches(s, 1 / std::sqrt(s), 1 / std::sqrt(s));
    };
    CHECK(critical_stretch(plane_strain, rotation) == near(0.54369, 1e-5));
    CHECK(critical_stretch(equibiaxial, rotation) == near(0.66614, 1e-5));
    CHECK(critical_stretch(uniaxial, rotation) == near(0.44375, 1e-5));
  }
}

TEST_CASE("verdicts: a pressed block is creased at Biot's stretch, while its cells are stable") {
  const Verdict found = verdict_of(pressed_block(2, ""));
  REQUIRE(found.critical);
  CHECK(found.critical->kind == "crease");
  REQUIRE(found.critical->place);
  CHECK((*found.critical->place)[1] == near(4));  // on the top
  // between two steps by a line
  CHECK(1 - 0.5 * found.critical->t == near(0.54369, 0.01));
  CHECK(found.first_negative > found.critical->t);
  REQUIRE(found.texts.size() == 2);
  CHECK(found.texts[0].name == "critical_kind");
  CHECK(found.texts[0].text == "crease");

  const Verdict less = verdict_of(pressed_block(1.6, ""));
  CHECK_FALSE(less.critical);
  CHECK(less.texts.empty());
}

TEST_CASE("verdicts: a face that is held, moved or pressed upon is not creased") {
  const Verdict held = verdict_of(
      "mesh: {geometry: {section: {of: plane_strain, size: [4, 4], divisions: [4, 4]}}, cells: hex27}\n"
      "material: {matrix: {neo_hooke: {a1: 0.01}}, volume: {quadratic: {d: 1.0e-4}}}\n"
      "supports: [{on: bottom, hold: [y]}, {on: x_min, hold: [x]}]\n"
      "loads: [{on: x_max, displacement: {x: -2}}, {on: top, displacement: {y: 4}}]\n"
      "homogeneous: off\nestimate: none\n");
  if (held.critical) CHECK(held.critical->kind != "crease");
}

TEST_CASE(
    "verdicts: a body that is lifted off its ground loses its support where no force is left") {
  const Verdict found = verdict_of(
      "mesh: {geometry: {block: {origin: [-2, 0, -2], size: [4, 2, 4], divisions: [2, 1, 2]}}, "
      "points: {a: [0, 0, 0], b: [2, 0, 0]}}\n"
      "material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 1.0e-3}}}\n"
      "supports: [{on: a, hold: [x, z]}, {on: b, hold: [z]}]\n"
      "contacts: {ground: {on: bottom, rigid: {plane: {point: [0, 0, 0], normal: [0, 1, 0]}}, "
      "motion: [{t: 1, to: [0, 0, 0]}]}}\n"
      "loads: [{on: top, force: {y: [{t: 0.4, to: -0.4}, {t: 1, to: 0.4}]}}]\n"
      "symmetry: none\nestimate: none\n",
      true);
  CHECK_FALSE(found.complete);
  REQUIRE(found.critical);
  CHECK(found.critical->kind == "loss of support");
  CHECK(found.critical->t == near(0.7, 1e-3));
}

TEST_CASE("verdicts: a law that softens loses strong ellipticity in a body whose faces are moved") {
  // All faces are moved along their normals, so that no neck forms.
  const Verdict found = verdict_of(
      "mesh: {geometry: {block: {size: [2, 2, 2], divisions: [2, 2, 2]}}}\n"
      "material: {matrix: {yeoh: {a1: 0.05, a2: -0.01, a3: 0}}, volume: {quadratic: {d: 1.0e-3}}}\n"
      "supports: [{on: x_min, hold: [x]}, {on: y_min, hold: [y]}, {on: z_min, hold: [z]}]\n"
      "loads: [{on: x_max, displacement: {x: 2}}, {on: y_max, displacement: {y: -0.678}}, "
      "{on: z_max, displacement: {z: -0.678}}]\n"
      "homogeneous: off\nestimate: none\n");
  REQUIRE(found.critical);
  CHECK(found.critical->kind == "loss of strong ellipticity");
  REQUIRE(found.critical->place);
  // where the least shear stiffness of this deformation changes its sign
  const Material law{
      .matrix = {Yeoh{0.05, -0.01, 0}}, .fibres = {}, .volume = QuadraticVolume{1e-3}};
  double low = 0;
  double high = 1;
  for (int i = 0; i < 40; ++i) {
    const double t = 0.5 * (low + high);
    const Mat3 F = stretches(1 + t, 1 - 0.339 * t, 1 - 0.339 * t);
    (smallest_shear_stiffness(law, F, {}).value > 0 ? low : high) = t;
  }
  CHECK(found.critical->t == near(low, 0.01));
}

TEST_CASE("verdicts: the first unstable increment of a strut, a film and a cap contains its load") {
  test::InstabilityDraw draw(3);
  for (int i = 0; i < 3; ++i) {
    const test::DrawnInstability drawn = draw.next(i);
    CAPTURE(drawn.scene);
    REQUIRE(drawn.critical_t > 0);
    const test::FoundInstability found = test::find_instability(drawn.scene);
    CHECK(drawn.critical_t >= found.before * (1 - drawn.unsure));
    CHECK(drawn.critical_t <= found.after * (1 + drawn.unsure));
    REQUIRE(found.critical);
    CHECK(found.critical->t == near(drawn.critical_t, 0.02));
  }
}

// With dead loads a cap may snap to a distant state that is stable. Whether and where Newton's
// method finds one changes with the increments and with rounding; the verdict must not.
TEST_CASE("verdicts: a cap that snaps has its limit point, however its increments fall") {
  const double whole = 2e-4;
  const Verdict along = verdict_of(
      snapping_cap(whole, "path: {first: 0.02, largest: 0.05, arc_length: {length: 3}}\n"));
  REQUIRE(along.critical);
  const double limit = whole * along.critical->load_factor;
  CHECK(limit == near(8.938e-5, 1e-3));

  for (int i = 0; i < 24; ++i) {
    const double pressure = 1.1e-4 * std::pow(1.21, i);
    CAPTURE(pressure);
    const Verdict found = verdict_of(snapping_cap(pressure, ""));
    REQUIRE(found.critical);
    CHECK(found.critical->kind == "limit point of load");
    CHECK(pressure * found.critical->t == near(limit, 2e-3));
  }
  CHECK_FALSE(verdict_of(snapping_cap(0.98 * limit, "")).critical);
}

TEST_CASE("verdicts: on_unstable: stop ends a path that has jumped") {
  const Verdict stopped = verdict_of(snapping_cap(1.665e-4, "on_unstable: stop\n"));
  REQUIRE(stopped.critical);
  CHECK(stopped.critical->kind == "limit point of load");
  CHECK_FALSE(stopped.complete);
}

// A stiffening or softening body, and one whose load has a kink, move faster without a jump.
TEST_CASE("verdicts: a movement that grows is no jump") {
  for (const char* const traction :
       {"{x: 0.03}", "{x: [{t: 0.3, to: 0.001}, {t: 1, to: 0.03}]}",
        "{x: [{t: 0.3, to: 0.005}, {t: 0.6, to: 0.005}, {t: 1, to: 0.02}]}"}) {
    CAPTURE(traction);
    const Verdict found = verdict_of(
        "mesh: {geometry: {block: {origin: [0, 0, 0], size: [4, 1, 1], divisions: [2, 1, 1]}}}\n"
        "supports: [{on: x_min, hold: [x]}, {on: y_min, hold: [y]}, {on: z_min, hold: [z]}]\n"
        "homogeneous: off\n"
        "material: {matrix: {neo_hooke: {a1: 0.01}}, volume: {quadratic: {d: 1.0e-2}}}\n"
        "loads: [{on: x_max, traction: " +
        std::string(traction) + "}]\n");
    CHECK_FALSE(found.critical);
    CHECK(found.complete);
  }
}
