// Two elastic spheres pressed together, against Hertz.
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

// A quarter of a block whose face towards the other body is that of a sphere. Cells are small where
// they touch, and grow outwards.
struct Cap {
  double radius;    // of the sphere [mm]
  bool faces_down;  // the upper body
  int cells;        // within the fine part
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

Mesh cap_mesh(const Cap& cap) {
  const std::vector<double> across = lines_outwards(cap.cells);
  std::vector<double> depth = across;
  if (!cap.faces_down) {
    depth.clear();
    for (auto y = across.rbegin(); y != across.rend(); ++y) depth.push_back(-*y);
  }
  Mesh mesh = block(across, depth, across);
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

double combined_modulus(double E, double nu) { return E / (1 - nu * nu); }

}  // namespace

TEST_CASE("two spheres of other radii and moduli touch as Hertz says") {
  const Cap lower{100, false, 6};
  const Cap upper{60, true, 5};
  auto loaded = read_config<SolveConfig>(
      parse_yaml("bodies:\n"
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
                 "scene.yaml"));
  BodiesScene scene{std::move(loaded.config), std::move(loaded.where), {}};
  expand_bodies(scene.config, scene.where.tree);
  scene.mesh = joined({{"a", cap_mesh(lower)}, {"b", cap_mesh(upper)}});
  double centre = 0;
  double smallest = 1e9;
  const auto each = [&](const Run& run, const StepRecord& step) {
    const SurfaceContact& surface = run.increment.surfaces()[0];
    for (const MortarNode& node : run.increment.surface_averages()[0]) {
      const auto i = static_cast<std::size_t>(node.candidate);
      const Vec3& X = run.mesh.X[static_cast<std::size_t>(surface.nodes[i])];
      const double off = std::hypot(X[0], X[2]);
      if (off >= smallest && off > 0) continue;
      smallest = off;
      centre = step.contacts.at("pair").r[i].dot(node.normal) / node.area;
    }
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
  CHECK(std::sqrt(area / std::numbers::pi) == near(radius, 0.5 * fine / 5 / radius));
}
