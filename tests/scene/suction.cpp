// Skin of two layers sucked into the hole of a plate, on its section: heights of the dome, and holes that are the same on all cells.
#include <doctest/doctest.h>

#include <cmath>

#include "scene/section.hpp"
#include "support/block.hpp"
#include "support/section.hpp"

using namespace langer;
using namespace langer::test;

namespace {

std::string layers(int across, double a1_above) {
  const auto law = [](double a1) {
    return "{material: {matrix: {neo_hooke: {a1: " + std::to_string(a1) + "}}, volume: {quadratic: {d: 1.0e-3}}}}";
  };
  return "mesh:\n  geometry: {section: {of: axisymmetric, size: [12, 4], divisions: [" + std::to_string(across) + ", " +
         std::to_string(across / 3) +
         "]}}\n  points: {apex: [0, 4, 0]}\n  sets: {hole: {of: top, within: {cylinder: {axis: y, radius: 2}}}}\n"
         "  bodies: [{name: below, thickness: 3}, {name: above, thickness: 1}]\n"
         "supports: [{on: bottom, hold: [x, y]}]\n"
         "contacts: {plate: {on: top, rigid: {aperture: {radius: 2, edge: 0.5, face: [0, 4, 0]}}, friction: 0, "
         "motion: [{t: 0.2, to: [0, -0.1, 0]}, {t: 1, to: [0, -0.1, 0]}]}}\n"
         "loads: [{on: hole, pressure: [{t: 0.2, to: 0}, {t: 1, to: -0.01}]}]\n"
         "materials: {below: " +
         law(0.012) + ", above: " + law(a1_above) + "}\npath: {first: 0.1, largest: 0.2}\n";
}

double height(const std::string& text) {
  const Ended end = run(text);
  return end.last().u[static_cast<std::size_t>(end.mesh.node_sets.at("apex")[0])][1];
}

}  // namespace

TEST_CASE("the dome of a soft layer on a stiff one, and of a stiff one on a soft one, converges at order 2 or faster") {
  for (double a1 : {0.004, 0.036}) {
    const double coarse = height(layers(48, a1)), middle = height(layers(96, a1)), fine = height(layers(192, a1));
    const double order = std::log2((coarse - middle) / (middle - fine));
    MESSAGE("a1 above " << a1 << " MPa: " << coarse << ", " << middle << ", " << fine << " mm, order " << order);
    CHECK(fine > 0.05);
    CHECK(order > 1.7);
  }
}

TEST_CASE("holes, rings and layers of a section are the same whatever the numbers of its cells") {
  for (int across : {10, 13, 17, 29}) {
    const Mesh mesh = mesh_in(config_of(
        "mesh:\n  geometry: {section: {of: axisymmetric, size: [12, 4], divisions: [" + std::to_string(across) +
        ", 7]}}\n  sets:\n    hole: {of: top, within: {cylinder: {axis: y, radius: 2.2}}}\n"
        "    ring: {of: top, within: {cylinder: {axis: y, radius: 6.1, beyond: 2.2}}}\n"
        "  bodies: [{name: below, thickness: 2.9}, {name: above, thickness: 1.1}]\n"
        "material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 1.0e-3}}}\nsupports: [{on: bottom, hold: [x, y]}]\nloads: [{on: hole, pressure: -0.001}]\n"));
    double hole = 0, inside = 12, ring = 0, border = 0;
    for (int n : mesh.node_sets.at("hole")) hole = std::max(hole, mesh.X[n][0]);
    for (int n : mesh.node_sets.at("ring")) inside = std::min(inside, mesh.X[n][0]), ring = std::max(ring, mesh.X[n][0]);
    for (int e = 0; e < mesh.n_cells(); ++e)
      for (int n : mesh.cell(e))
        if (mesh.body[e] == 0) border = std::max(border, mesh.X[n][1]);
    CHECK(hole == 2.2);
    CHECK(inside == 2.2);
    CHECK(ring == 6.1);
    CHECK(border == doctest::Approx(2.9).epsilon(1e-12));
  }
}
