// Two elastic spheres pressed together, against Hertz, and drawn along each other, against Cattaneo
// and Mindlin.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "mechanics/mesh/select.hpp"
#include "mortar/bodies.hpp"
#include "support/block.hpp"
#include "support/near.hpp"

using namespace langer;
using namespace langer::test;

namespace {

// A quarter of a block whose face towards the other body is that of a sphere, or the half of it in
// z > 0. Cells are small where they touch, and grow outwards.
struct Cap {
  double radius;    // of the sphere [mm]
  bool faces_down;  // the upper body
  int cells;        // within the fine part
  bool half = false;
};

constexpr double fine = 0.45;  // half width of the fine part [mm]
constexpr double wide = 4;     // half width and height [mm]

// lines from 0 to `wide`: even in the fine part, then growing
std::vector<double> lines_outwards(int cells) {
  std::vector<double> lines = even(0, fine, cells);
  double step = fine / cells;
  while (lines.back() < wide) {
    step *= 1.9;
    lines.push_back(lines.back() + step);
  }
  lines.back() = wide;
  return lines;
}

// the same to both sides
std::vector<double> to_both_sides(const std::vector<double>& lines) {
  std::vector<double> both;
  for (auto x = lines.rbegin(); x + 1 != lines.rend(); ++x) both.push_back(-*x);
  both.insert(both.end(), lines.begin(), lines.end());
  return both;
}

Mesh cap_mesh(const Cap& cap) {
  const std::vector<double> across = lines_outwards(cap.cells);
  std::vector<double> depth = across;
  if (!cap.faces_down) {
    depth.clear();
    for (auto y = across.rbegin(); y != across.rend(); ++y) depth.push_back(-*y);
  }
  Mesh mesh = block(cap.half ? to_both_sides(across) : across, depth, across);
  const std::string face = cap.faces_down ? "y_min" : "y_max";
  for (int node : mesh.node_sets.at(face)) {
    const Vec3& X = mesh.X[static_cast<std::size_t>(node)];
    if (std::hypot(X[0], X[2]) < 1.2 * fine) mesh.node_sets["touch"].push_back(node);
  }
  mesh.facet_sets["touch"] = facets_within(mesh, boundary(mesh), mesh.node_sets.at("touch"));
  // the face bends away from the other body, less so with the distance from it
  for (Vec3& X : mesh.X) {
    const double sag = (X[0] * X[0] + X[2] * X[2]) / (2 * cap.radius);
    const double share = 1 - std::abs(X[1]) / wide;
    X[1] += (cap.faces_down ? sag : -sag) * share;
  }
  return mesh;
}

// Two bodies "a" below and "b" above, whose meshes are caps.
BodiesScene caps_scene(const std::string& text, const Cap& lower, const Cap& upper) {
  auto loaded = read_config<SolveConfig>(parse_yaml(text, "scene.yaml"));
  BodiesScene scene{std::move(loaded.config), std::move(loaded.where), {}};
  expand_bodies(scene.config, scene.where.tree);
  scene.mesh = joined({{"a", cap_mesh(lower)}, {"b", cap_mesh(upper)}});
  return scene;
}

struct Centre {
  // tractions at the node closest to the middle, along the normal and along x [MPa]; along z it is
  // held by the plane of symmetry
  double normal = 0, tangential = 0;
};

// the node of `on` of the first surface that is closest to the axis
Centre centre_of(const Run& run, const StepRecord& step, const std::string& contact) {
  const SurfaceContact& surface = run.increment.surfaces()[0];
  Centre centre;
  double smallest = 1e9;
  for (const MortarNode& node : run.increment.surface_averages()[0]) {
    const auto i = static_cast<std::size_t>(node.candidate);
    const Vec3& X = run.mesh.X[static_cast<std::size_t>(surface.nodes[i])];
    const double off = std::hypot(X[0], X[2]);
    if (off >= smallest) continue;
    smallest = off;
    const Vec3 r = step.contacts.at(contact).r[i];
    const double normal = r.dot(node.normal);
    centre = {normal / node.area, std::abs(r[0] - normal * node.normal[0]) / node.area};
  }
  return centre;
}

// The radius at which the pressure vanishes, if p^2 falls with the square of the distance from the
// axis as Hertz says: from a line through the nodes in contact, weighted with their areas.
double radius_of_pressure(const Run& run, const StepRecord& step, const std::string& contact) {
  const SurfaceContact& surface = run.increment.surfaces()[0];
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const MortarNode& node : run.increment.surface_averages()[0]) {
    const auto i = static_cast<std::size_t>(node.candidate);
    const Vec3& X = run.mesh.X[static_cast<std::size_t>(surface.nodes[i])];
    const double p = step.contacts.at(contact).r[i].dot(node.normal) / node.area;
    if (p <= 0) continue;
    const double r2 = X[0] * X[0] + X[2] * X[2];
    n += node.area;
    x += node.area * r2;
    y += node.area * p * p;
    xx += node.area * r2 * r2;
    xy += node.area * r2 * p * p;
  }
  const double slope = (n * xy - x * y) / (n * xx - x * x);
  return std::sqrt((x - y / slope) / n);
}

double combined_modulus(double E, double nu) { return E / (1 - nu * nu); }

}  // namespace

TEST_CASE("two spheres of other radii and moduli touch as Hertz says") {
  const Cap lower{100, false, 9};
  const Cap upper{60, true, 8};
  const BodiesScene scene = caps_scene(
      "bodies:\n"
      "  a: {mesh: {geometry: {block: {size: [1, 1, 1], divisions: [1, 1, 1]}}}}\n"
      "  b: {mesh: {geometry: {block: {size: [1, 1, 1], divisions: [1, 1, 1]}}}}\n"
      "materials:\n"
      "  a: {material: {matrix: {neo_hooke: {a1: 1}}, volume: {quadratic: {d: 0.6}}}}\n"
      "  b: {material: {matrix: {neo_hooke: {a1: 2}}, volume: {quadratic: {d: 0.3}}}}\n"
      "supports:\n"
      "  - {on: a_y_min, hold: [x, y, z]}\n"
      "  - {on: a_x_min, hold: [x]}\n"
      "  - {on: a_z_min, hold: [z]}\n"
      "  - {on: b_x_min, hold: [x]}\n"
      "  - {on: b_z_min, hold: [z]}\n"
      "loads:\n"
      "  - {on: b_y_max, displacement: {x: 0, y: -0.0042, z: 0}}\n"
      "contacts: {pair: {on: b_touch, against: a_touch}}\n"
      "path: {first: 0.5, largest: 0.5}\n",
      lower, upper);
  double centre = 0;
  double profile = 0;
  const auto each = [&](const Run& run, const StepRecord& step) {
    centre = centre_of(run, step, "pair").normal;
    profile = radius_of_pressure(run, step, "pair");
  };
  const BodiesSolution solution = solved(scene, each);
  const StepRecord& last = solution.last();
  // G = 2 a1, K = 2 / d
  double compliance = 0;
  for (double G : {2.0, 4.0}) {
    const double K = G * 2 / 1.2;
    const double E = 9 * K * G / (3 * K + G);
    compliance += 1 / combined_modulus(E, (3 * K - 2 * G) / (6 * K + 2 * G));
  }
  const double R = 1 / (1 / lower.radius + 1 / upper.radius);
  const double force = 4 * last.scalars.at("force_pair_y");  // of the whole spheres
  const double radius = std::cbrt(3 * std::abs(force) * R * compliance / 4);
  const double pressure = 1.5 * std::abs(force) / (std::numbers::pi * radius * radius);
  const double area = 4 * last.scalars.at("contact_area_pair");
  CHECK(radius > 0.6 * fine);
  CHECK(radius < fine);
  CHECK(centre == near(pressure, 0.01));
  CHECK(profile == near(radius, 0.01));
  // nodes at the edge count with all of their area
  CHECK(std::sqrt(area / std::numbers::pi) == near(radius, 0.5 * fine / upper.cells / radius));
}

namespace {

// Pressed first and then drawn sideways by a force T below mu P, equal spheres stick within a
// radius c = a (1 - T / (mu P))^(1/3). In the middle the tangential traction is mu p (1 - c/a).
void draw_spheres(int cells, double tolerance) {
  constexpr double mu = 0.3;
  const std::string material =
      "{material: {matrix: {neo_hooke: {a1: 1}}, volume: {quadratic: {d: 0.6}}}}\n";
  const BodiesScene scene = caps_scene(
      "bodies:\n"
      "  a: {mesh: {geometry: {block: {size: [1, 1, 1], divisions: [1, 1, 1]}}}}\n"
      "  b: {mesh: {geometry: {block: {size: [1, 1, 1], divisions: [1, 1, 1]}}}}\n"
      "materials:\n  a: " +
          material + "  b: " + material +
          "supports:\n"
          "  - {on: a_y_min, hold: [x, y, z]}\n"
          "  - {on: a_z_min, hold: [z]}\n"
          "  - {on: b_z_min, hold: [z]}\n"
          "loads:\n"
          "  - {on: b_y_max, displacement: {x: [{t: 0.2, to: 0}, {t: 1, to: 0.9e-3}], "
          "y: [{t: 0.2, to: -2.2e-3}, {t: 1, to: -2.2e-3}], z: 0}}\n"
          "contacts: {pair: {on: b_touch, against: a_touch, friction: 0.3}}\n"
          "path: {first: 0.1, largest: 0.1}\n",
      {100, false, cells + 1, true}, {100, true, cells, true});
  int compared = 0;
  const auto each = [&](const Run& run, const StepRecord& step) {
    const double P = std::abs(step.scalars.at("force_pair_y"));
    const double T = std::abs(step.scalars.at("force_pair_x"));
    const double share = T / (mu * P);
    if (share < 0.3 || share > 0.65) return;
    ++compared;
    const Centre centre = centre_of(run, step, "pair");
    const double sticking = std::cbrt(1 - share);  // c / a
    CAPTURE(share);
    CHECK(centre.tangential / centre.normal == near(mu * (1 - sticking), tolerance));
  };
  solved(scene, each);
  CHECK(compared > 1);
}

}  // namespace

TEST_CASE("two spheres drawn along each other stick in the middle as Cattaneo and Mindlin say") {
  draw_spheres(5, 0.03);
}

// Takes a minute: build/bin/test_mortar -ns -tc="*on fine cells"
TEST_CASE("two spheres drawn along each other: the same on fine cells" * doctest::skip()) {
  draw_spheres(10, 0.01);
}
