// Skin of two layers sucked into the hole of a plate, on its section: heights of the dome, and
// holes that are the same on all cells.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/select.hpp"
#include "scene/model/scene_section.hpp"
#include "support/block.hpp"
#include "support/near.hpp"
#include "support/section.hpp"

using namespace langer;
using namespace langer::test;

namespace suction_tests {

namespace {

std::string layers(int across, double a1_above) {
  const auto law = [](double a1) {
    return "{material: {matrix: {neo_hooke: {a1: " + std::to_string(a1) +
           "}}, volume: {quadratic: {d: 1.0e-3}}}}";
  };
  return "mesh:\n  geometry: {section: {of: axisymmetric, size: [12, 4], divisions: [" +
         std::to_string(across) + ", " + std::to_string(across / 3) +
         "]}}\n  points: {apex: [0, 4, 0]}\n  sets: {hole: {of: top, within: {cylinder: {axis: y, radius: 2}}}}\n"
         "  bodies: [{name: below, thickness: 3}, {name: above, thickness: 1}]\n"
         "supports: [{on: bottom, hold: [x, y]}]\n"
         "contacts: {plate: {on: top, rigid: {aperture: {radius: 2, edge: 0.5, face: [0, 4, 0]}}, friction: 0, "
         "motion: [{t: 0.2, to: [0, -0.1, 0]}, {t: 1, to: [0, -0.1, 0]}]}}\n"
         "loads: [{on: hole, pressure: [{t: 0.2, to: 0}, {t: 1, to: -0.01}]}]\n"
         "materials: {below: " +
         law(0.012) + ", above: " + law(a1_above) + "}\npath: {first: 0.1, largest: 0.2}\n";
}

// A quarter of a disc around y in m x m cells around the axis, whose sides go over into rings from
// R/2 on, and rings beyond: lines through each of `rings`, the first of which is R. Sets and
// supports as the section's, and the planes x = 0 and z = 0.
Mesh quarter_disc(int m, const std::vector<double>& rings, const std::vector<double>& heights) {
  const auto corner = [&](int i, int j) {  // of the middle, 0 <= i, j <= m
    const double xi = static_cast<double>(i) / m, eta = static_cast<double>(j) / m,
                 s = std::max(xi, eta);
    if (s == 0) return Vec3(0, 0, 0);
    const double turn = 0.25 * std::numbers::pi * (xi >= eta ? eta / xi : 2 - xi / eta),
                 round = 0.5 * s;
    return Vec3(0.5 * rings[0] *
                ((1 - round) * 0.85 * Vec3(xi, 0, eta) +
                 round * s * Vec3(std::cos(turn), 0, std::sin(turn))));
  };
  std::vector<Vec3> flat;
  std::vector<std::array<int, 4>> cells;
  const auto square = [&](int i, int j) {
    return j * (m + 1) + i;
  };
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= m; ++i) flat.push_back(corner(i, j));
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < m; ++i)
      cells.push_back({square(i, j), square(i + 1, j), square(i + 1, j + 1), square(i, j + 1)});
  // from the x axis to the z axis along what borders the middle, then ring by ring
  std::vector<int> inner;
  for (int k = 0; k <= 2 * m; ++k) inner.push_back(k <= m ? square(m, k) : square(2 * m - k, m));
  const std::vector<int> border = inner;
  const int within = m / 2;  // rings of cells between the middle and R
  for (int r = 0; r < within + static_cast<int>(rings.size()) - 1; ++r) {
    std::vector<int> outer;
    for (int k = 0; k <= 2 * m; ++k) {
      const double turn = 0.25 * std::numbers::pi * k / m,
                   share = std::min(1.0, (r + 1.0) / within);
      const double radius = r < within ? rings[0] : rings[static_cast<std::size_t>(r - within + 1)];
      const Vec3 out = radius * Vec3(std::cos(turn), 0, std::sin(turn));
      outer.push_back(static_cast<int>(flat.size()));
      flat.push_back((1 - share) *
                         flat[static_cast<std::size_t>(border[static_cast<std::size_t>(k)])] +
                     share * out);
    }
    for (std::size_t k = 0; k + 1 < inner.size(); ++k)
      cells.push_back({inner[k], outer[k], outer[k + 1], inner[k + 1]});
    inner = outer;
  }
  Mesh mesh;
  const int floor = static_cast<int>(flat.size());
  for (double y : heights)
    for (const Vec3& x : flat)
      mesh.X.emplace_back(std::abs(x[0]) < 1e-12 ? 0 : x[0], y, std::abs(x[2]) < 1e-12 ? 0 : x[2]);
  for (int k = 0; k + 1 < static_cast<int>(heights.size()); ++k)
    for (const auto& [a, b, c, d] : cells)  // x, then y, then z
      for (int n : {a, b, b + floor, a + floor, d, c, c + floor, d + floor})
        mesh.connectivity.push_back(n + k * floor);
  mesh.bodies = {"skin"};
  mesh.body.assign(static_cast<std::size_t>(mesh.n_cells()), 0);
  mesh.frames.assign(mesh.body.size(), Mat3::Identity());
  name_sides(mesh);
  mesh.node_sets["apex"] = {(static_cast<int>(heights.size()) - 1) * floor};
  for (const Facet& facet : mesh.facet_sets.at("top")) {
    const std::vector<int> nodes = facet_nodes(mesh, facet);
    if (std::all_of(nodes.begin(), nodes.end(), [&](int n) {
          return std::hypot(mesh.X[n][0], mesh.X[n][2]) < rings[0] + 1e-9;
        }))
      mesh.facet_sets["hole"].push_back(facet);
  }
  for (const Facet& facet : mesh.facet_sets.at("hole"))
    for (int n : facet_nodes(mesh, facet)) mesh.node_sets["hole"].push_back(n);
  auto& hole = mesh.node_sets["hole"];
  std::sort(hole.begin(), hole.end());
  hole.erase(std::unique(hole.begin(), hole.end()), hole.end());
  return mesh;
}

double height(const std::string& text) {
  const Ended end = run(text);
  return end.last().u[static_cast<std::size_t>(end.mesh.node_sets.at("apex")[0])][1];
}

}  // namespace

TEST_CASE(
    "the dome of a soft layer on a stiff one, and of a stiff one on a soft one, converges at order 2 or faster") {
  for (double a1 : {0.004, 0.036}) {
    const double coarse = height(layers(48, a1)), middle = height(layers(96, a1)),
                 fine = height(layers(192, a1));
    const double order = std::log2((coarse - middle) / (middle - fine));
    MESSAGE("a1 above " << a1 << " MPa: " << coarse << ", " << middle << ", " << fine
                        << " mm, order " << order);
    CHECK(fine > 0.05);
    CHECK(order > 1.7);
  }
}

TEST_CASE(
    "a body of revolution under a plate with a hole: section and block have one dome and one force, within what cells leave open") {
  const auto scene = [](const std::string& mesh, const std::string& supports) {
    return mesh +
           "material: {matrix: {yeoh: {a1: 0.012, a2: 0.03, a3: 0.01}}, volume: {quadratic: {d: 1.0e-3}}}\n" +
           "supports: [{on: bottom, hold: [x, y, z]}" + supports +
           "]\ncontacts: {plate: {on: top, rigid: {aperture: {radius: 2, edge: 0.5, face: [0, 3, 0]}}, friction: 0.3, "
           "motion: [{t: 0.2, to: [0, -0.1, 0]}, {t: 1, to: [0, -0.1, 0]}]}}\n"
           "loads: [{on: hole, pressure: [{t: 0.2, to: 0}, {t: 1, to: -0.03}]}]\npath: {first: 0.2, largest: 0.2}\n";
  };
  struct Found {
    double apex, force;
  };
  const auto of = [](const Ended& end, double share) {
    return Found{end.last().u[static_cast<std::size_t>(end.mesh.node_sets.at("apex")[0])][1],
                 end.last().force_ind[1] / share};
  };
  const auto section = [&](int across) {
    return of(
        run(scene(
            "mesh:\n  geometry: {section: {of: axisymmetric, size: [6, 3], divisions: [" +
                std::to_string(across) + ", " + std::to_string(across / 2) +
                "]}}\n  points: {apex: [0, 3, 0]}\n  sets: {hole: {of: top, within: {cylinder: {axis: y, radius: 2}}}}\n",
            "")),
        1);
  };
  const auto block = [&](int m) {
    std::vector<double> rings, heights;
    for (int k = 0; k <= 3 * m; ++k) rings.push_back(2 + 4.0 * k / (3 * m));
    for (int k = 0; k <= 2 * m; ++k) heights.push_back(1.5 * k / m);
    const SolveConfig config =
        config_of(scene("", ", {on: x_min, hold: [x]}, {on: z_min, hold: [z]}"));
    return of(run(config, quarter_disc(m, rings, heights)), 0.25);
  };
  const Found rough = section(48), flat = section(96), coarse = block(4), fine = block(8);
  MESSAGE("section: " << rough.apex << ", " << flat.apex << " mm, " << rough.force << ", "
                      << flat.force << " N; block: " << coarse.apex << ", " << fine.apex << " mm, "
                      << coarse.force << ", " << fine.force << " N");
  // heights are of order 2, the force of the plate of order 1
  const auto limit = [](double longer, double shorter, int order) {
    return shorter + (shorter - longer) / ((1 << order) - 1);
  };
  const double apex = limit(coarse.apex, fine.apex, 2), force = limit(coarse.force, fine.force, 1);
  CHECK(std::abs(apex - limit(rough.apex, flat.apex, 2)) < std::abs(fine.apex - apex));
  CHECK(std::abs(force - limit(rough.force, flat.force, 1)) < 0.1 * std::abs(fine.force - force));
  CHECK(apex > 0.1);
}

TEST_CASE("holes, rings and layers of a section are the same whatever the numbers of its cells") {
  for (int across : {10, 13, 17, 29}) {
    const Mesh mesh = mesh_in(config_of(
        "mesh:\n  geometry: {section: {of: axisymmetric, size: [12, 4], divisions: [" +
        std::to_string(across) +
        ", 7]}}\n  sets:\n    hole: {of: top, within: {cylinder: {axis: y, radius: 2.2}}}\n"
        "    ring: {of: top, within: {cylinder: {axis: y, radius: 6.1, beyond: 2.2}}}\n"
        "  bodies: [{name: below, thickness: 2.9}, {name: above, thickness: 1.1}]\n"
        "material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 1.0e-3}}}\nsupports: [{on: bottom, hold: [x, y]}]\nloads: [{on: hole, pressure: -0.001}]\n"));
    double hole = 0, inside = 12, ring = 0, border = 0;
    for (int n : mesh.node_sets.at("hole")) hole = std::max(hole, mesh.X[n][0]);
    for (int n : mesh.node_sets.at("ring"))
      inside = std::min(inside, mesh.X[n][0]), ring = std::max(ring, mesh.X[n][0]);
    for (int e = 0; e < mesh.n_cells(); ++e)
      for (int n : mesh.cell(e))
        if (mesh.body[e] == 0) border = std::max(border, mesh.X[n][1]);
    CHECK(hole == 2.2);
    CHECK(inside == 2.2);
    CHECK(ring == 6.1);
    CHECK(border == near(2.9, 1e-12));
  }
}

}  // namespace suction_tests
