// Scenes in motion, as a config describes them: closed forms of impact and friction, and twins.
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "scene/run/impact_results.hpp"
#include "support/near.hpp"
#include "support/section.hpp"

using namespace langer;
using namespace langer::test;

namespace {

double summed(const Ended& run, const std::string& name) {
  ImpactResults results(run.scene, nullptr);
  for (const StepRecord& step : run.steps) results.add(step);
  for (const Summary& one : results.summary()) {
    if (one.name == name) return one.value;
  }
  FAIL("no result " << name);
  return 0;
}

double scalar(const StepRecord& step, const std::string& name) { return step.scalars.at(name); }

// Change of energy that no work explains, over the energy in the system.
double unexplained(const Ended& run) {
  double largest = 0;
  double energy = 0;
  for (const StepRecord& step : run.steps) {
    largest = std::max(largest, std::abs(scalar(step, "energy_balance")));
    energy = std::max(energy, scalar(step, "mechanical_energy"));
  }
  return largest / energy;
}

const std::string rubber =
    "material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 2}}}\n";

// A block of 2 x 4 x 1 mm that stands on its clamped bottom.
std::string column(const std::string& cells) {
  return "mesh:\n  geometry: {block: {origin: [0, 0, 0], size: [2, 4, 1], divisions: [2, 4, 1]}}\n  cells: " +
         cells + "\nsupports: [{on: bottom, hold: [x, y, z]}]\nsymmetry: none\nstability: off\n";
}

}  // namespace

TEST_CASE("a sphere bounces from a deep block with the force and in the time of Hertz") {
  const double R = 10, G = 1, mass = 2182.6e-6, v = 0.5887;
  const Ended r = run(
      "mesh:\n  geometry: {indented_disc: {size: [60, 60], radius: 10, depth: 0.02, edge: 0.2}}\n  cells: hex27\n"
      "  sets: {contact: {of: top, within: {cylinder: {axis: y, radius: 0.7}}}}\n"
      "material: {matrix: {neo_hooke: {a1: 0.5}}, volume: {quadratic: {d: 1.0e-5}}}\n"
      "supports: [{on: bottom, hold: [x, y]}]\nstability: off\n"
      "contacts: {ball: {on: contact, rigid: {sphere: {radius: 10, centre: [0, 70.0005, 0]}},\n"
      "  free: {mass_g: 2182.6, velocity: [0, -0.5887, 0]}}}\n"
      "dynamics: {density_kg_m3: 10, step: 0.0025}\npath: {seconds: 0.1075}\n");
  const double k = 16. / 3 * G * std::sqrt(R);
  const double depth = std::pow(5 * mass * v * v / (4 * k), 0.4);
  CHECK(summed(r, "peak_force") == near(k * std::pow(depth, 1.5), 0.01));
  CHECK(summed(r, "contact_time") == near(2.9433 * depth / v, 2e-3));
  CHECK(summed(r, "restitution") == near(1, 2e-3));
  // the first increment is cut where the ball touches
  CHECK(scalar(r.steps.front(), "time") == near(0.0005 / v, 1e-6));
  CHECK(scalar(r.steps[1], "time") == near(0.0005 / v + 0.0025, 1e-6));
}

TEST_CASE("a nearly incompressible block is hit without an increment that fails") {
  const Ended r = run(
      "mesh:\n  geometry: {block: {origin: [-4, 0, -4], size: [8, 3, 8], divisions: [8, 4, 8]}}\n"
      "  sets: {contact: {of: top, within: {cylinder: {axis: y, radius: 2.4}}}}\n"
      "supports: [{on: bottom, hold: [x, y, z]}]\nsymmetry: none\n"
      "material: {matrix: {yeoh: {a1: 0.05, a2: 0.05}}, volume: {quadratic: {d: 1.0e-3}}}\n"
      "contacts: {ball: {on: contact, rigid: {sphere: {radius: 2.5, centre: [0, 5.52, 0]}},\n"
      "  friction: 0.3, free: {mass_g: 2, velocity: [0, -300, 0]}}}\n"
      "dynamics: {density_kg_m3: 1100, step: 2.5e-4}\npath: {seconds: 5.0e-3}\n");
  CHECK(r.steps.size() == 21);  // 20, and one that is cut at the touch
}

TEST_CASE("a block thrown along a wall slides on Coulomb's cone and stops after v^2 / (2 mu g)") {
  const std::string block =
      "mesh:\n  geometry: {block: {origin: [0, 0, 0], size: [4, 2, 1], divisions: [4, 2, 1]}}\n"
      "material: {matrix: {neo_hooke: {a1: 1}}, volume: {quadratic: {d: 0.2}}}\n"
      "supports: [{on: z_min, hold: [z]}, {on: z_max, hold: [z]}]\nsymmetry: none\nstability: off\n"
      "contacts: {wall: {on: bottom, rigid: {plane: {point: [0, 0, 0], normal: [0, 1, 0]}}, friction: 0.3,\n"
      "  motion: [{t: 1, to: [0, 0, 0]}]}}\npath: {seconds: 0.04}\n";
  for (const char* scheme : {"generalised_alpha", "theta"}) {
    const Ended r = run(block +
                        "dynamics: {density_kg_m3: 1000, velocity: [100, 0, 0], "
                        "gravity: [0, -9810, 0], step: 5.0e-4, scheme: " +
                        scheme + "}\n");
    CAPTURE(scheme);
    double moved = 0;
    for (int node : r.mesh.node_sets.at("top")) moved += r.last().u[node][0];
    moved /= static_cast<double>(r.mesh.node_sets.at("top").size());
    // rocking shifts the load between the corners while the block stops
    CHECK(moved == near(100. * 100 / (2 * 0.3 * 9810), 5e-3));
    int sliding = 0;
    for (const StepRecord& step : r.steps) {
      if (scalar(step, "time") > 0.03) break;
      CHECK(step.force_ind[0] == near(-0.3 * step.force_ind[1], 1e-6));
      ++sliding;
    }
    CHECK(sliding > 50);
  }
}

TEST_CASE("pressures that follow the surface, gravity and viscous branches balance in energy") {
  const std::string dynamics =
      "dynamics: {density_kg_m3: 1000, gravity: [2000, -9810, 0], step: 4.0e-6}\npath: {seconds: 4.0e-4}\n";
  const std::string pressed = "loads: [{on: top, pressure: [{t: 0.5, to: 0.03}, {t: 1, to: 0}]}]\n";
  CHECK(unexplained(run(column("hex8") + rubber + pressed + dynamics)) < 2e-4);
  CHECK(unexplained(run(column("hex27") + rubber + pressed + dynamics)) < 1e-3);
  const std::string viscous =
      "material: {matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 2}}, "
      "viscous: [{tau: 1.0e-4, gamma: 0.5}]}\n";
  const Ended r = run(column("hex8") + viscous + pressed + dynamics);
  CHECK(unexplained(r) < 2e-3);
  CHECK(scalar(r.last(), "viscous_work") > 0.02 * scalar(r.last(), "mechanical_energy"));
}

TEST_CASE("layers of one material and density move as one body, and others otherwise") {
  const auto layered = [](const std::string& bodies, const std::string& materials,
                          const std::string& densities) {
    return run(
        "mesh:\n  geometry: {block: {origin: [0, 0, 0], size: [2, 4, 1], divisions: [2, 4, 1]}}\n" +
        bodies + materials +
        "supports: [{on: bottom, hold: [x, y, z]}]\nsymmetry: none\nstability: off\n"
        "dynamics: {density_kg_m3: 1000, velocity: [500, 200, 0], step: 1.0e-5" +
        densities + "}\npath: {seconds: 2.0e-4}\n");
  };
  const std::string bodies =
      "  bodies: [{name: fat, thickness: 2}, {name: dermis, thickness: 2}]\n";
  const std::string law = "{matrix: {neo_hooke: {a1: 0.1}}, volume: {quadratic: {d: 2}}}";
  const std::string both =
      "materials: {fat: {material: " + law + "}, dermis: {material: " + law + "}}\n";
  const Ended one = layered("", rubber, "");
  const Ended two = layered(bodies, both, "");
  const Ended light = layered(bodies, both, ", densities_kg_m3: {fat: 500}");
  // the same sums in another order
  CHECK(largest_difference(one.last().u, two.last().u) < 1e-12);
  CHECK(largest_difference(one.last().u, light.last().u) > 1e-3);
  const double ratio = scalar(light.steps.front(), "kinetic_energy_at_start") /
                       scalar(one.steps.front(), "kinetic_energy_at_start");
  CHECK(ratio > 0.75);  // clamped nodes of the lower half carry a part of its mass
  CHECK(ratio < 0.85);
}

TEST_CASE("a section in plane strain moves as the slab of its thickness") {
  const std::string thrown =
      rubber +
      "stability: off\ndynamics: {density_kg_m3: 1000, velocity: [500, 200, 0], step: 1.0e-5}\n"
      "path: {seconds: 2.0e-4}\n";
  const Ended section = run(
      "mesh:\n  geometry: {section: {of: plane_strain, size: [2, 4], divisions: [2, 4], thickness: 1}}\n"
      "supports: [{on: bottom, hold: [x, y]}]\n" +
      thrown);
  const Ended slab =
      run("mesh:\n  geometry: {block: {origin: [0, 0, 0], size: [2, 4, 1], divisions: [2, 4, 1]}}\n"
          "supports: [{on: bottom, hold: [x, y]}, {on: z_min, hold: [z]}, {on: z_max, hold: [z]}]\n"
          "symmetry: none\n" +
          thrown);
  const auto top = [](const Ended& r) {
    Vec3 sum = Vec3::Zero();
    for (int node : r.mesh.node_sets.at("top")) sum += r.last().u[static_cast<std::size_t>(node)];
    return Vec3(sum / static_cast<double>(r.mesh.node_sets.at("top").size()));
  };
  CHECK((top(section) - top(slab)).norm() < 1e-9 * top(slab).norm());
  CHECK(scalar(section.last(), "kinetic_energy") ==
        near(scalar(slab.last(), "kinetic_energy"), 1e-9));
}

TEST_CASE("two indenters that are mirror images press a block in motion alike") {
  const Ended r = run(
      "mesh:\n  geometry: {block: {origin: [-4, 0, -1], size: [8, 3, 2], divisions: [8, 3, 2]}}\n" +
      rubber +
      "supports: [{on: bottom, hold: [x, y, z]}]\nsymmetry: none\nstability: off\n"
      "contacts:\n"
      "  left: {on: top, rigid: {sphere: {radius: 1.5, centre: [-2, 4.5, 0]}}, motion: [{t: 1, to: [0, -0.3, 0]}]}\n"
      "  right: {on: top, rigid: {sphere: {radius: 1.5, centre: [2, 4.5, 0]}}, motion: [{t: 1, to: [0, -0.3, 0]}]}\n"
      "dynamics: {density_kg_m3: 1000, step: 2.0e-5}\npath: {seconds: 6.0e-4}\n");
  for (const StepRecord& step : r.steps) {
    const double left = scalar(step, "force_left_y");
    CHECK(scalar(step, "force_right_y") == near(left, 1e-6, 1e-9));
  }
  CHECK(std::abs(scalar(r.last(), "force_left_y")) > 1e-3);
  CHECK(unexplained(r) < 2e-3);
}

TEST_CASE("steps that follow from an error keep it from microseconds to seconds") {
  // A column swings with its first shear period; stiffer by 1e12, it does so 1e6 times faster.
  for (double scale : {1e-6, 1., 1e6}) {
    const double stiff = 0.1 / (scale * scale);
    const auto text = [&](const char* error) {
      return column("hex8") +
             fmt::format(
                 "material: {{matrix: {{neo_hooke: {{a1: {:g}}}}}, volume: {{quadratic: {{d: {:g}}}}}}}\n"
                 "dynamics: {{density_kg_m3: 1000, velocity: [{:g}, 0, 0], error: {}}}\npath: {{seconds: {:g}}}\n",
                 stiff, 0.2 / stiff, 300 / scale, error, 1.5e-3 * scale);
    };
    const auto top = [](const Ended& r) {
      return r.last().u[static_cast<std::size_t>(r.mesh.node_sets.at("top").front())][0];
    };
    const Ended loose = run(text("0.2%"));
    const Ended close = run(text("0.02%"));
    const double size = 300 * 1.5e-3;
    CHECK(std::abs(top(loose) - top(close)) < 0.002 * size);
    CHECK(close.steps.size() > 2 * loose.steps.size());
  }
}
