// Supports, loads, histories and indenters that are unlike those of the refinement study.
#include <fmt/format.h>

#include <algorithm>

#include "random_scenes/parts.hpp"

namespace langer::test {

namespace {

// about the same number of cells along each axis in proportion to the lengths, `most` along x
std::string divisions_of(double x, double y, double z, int most) {
  const auto n = [&](double length) {
    return std::clamp(static_cast<int>(std::lround(most * length / x)), 4, 2 * most);
  };
  return fmt::format("[{}, {}, {}]", most, n(y), n(z));
}

// A plane strip that is held along y on a part of its bottom, as behind a notch.
std::string notch(Draw& draw) {
  const double L = rounded(draw.logarithmic(4, 20)), h = rounded(L * draw.uniform(0.4, 0.8));
  const int across = 4 * static_cast<int>(3 + draw.below(3));
  const int held = across / 4 * static_cast<int>(1 + draw.below(3));  // cells
  const double ratio = draw.uniform(0.1, 0.3);
  return fmt::format(
             "mesh:\n  geometry: {{section: {{of: plane_strain, size: [{:g}, {:g}], divisions: [{}, "
             "{}], thickness: 2}}}}\n"
             "  sets: {{held: {{of: bottom, within: {{box: {{from: [0, 0, -1], to: [{:.12g}, 0, "
             "3]}}}}}}}}\n"
             "supports: [{{on: held, hold: [y]}}, {{on: x_min, hold: [x]}}]\n"
             "loads: [{{on: top, displacement: {{y: {:g}}}}}]\n",
             L, h, across, std::max(4, static_cast<int>(std::lround(across * h / L))),
             L * held / across, rounded(ratio * h)) +
         "material: " + material(draw, 1, 0) + "\nstability: off\n";
}

// A sheet that is held at its four rims, with nothing below it; a sphere presses on its middle.
std::string held_sheet(Draw& draw) {
  Pressed p;
  p.R = rounded(draw.logarithmic(1, 10));
  p.H = rounded(p.R * draw.uniform(0.3, 1));
  p.half = rounded(p.H * draw.uniform(4, 8));
  p.depth = rounded(p.H * draw.uniform(0.2, 0.6));
  p.friction = 0;
  const std::string law = material(draw, 1, 1);
  return mesh_of(p) +
         "supports: [{on: x_min, hold: [x, y, z]}, {on: x_max, hold: [x, y, z]}, {on: z_min, hold: "
         "[x, y, z]}, {on: z_max, hold: [x, y, z]}]\nmaterial: " +
         law + "\ncontacts:\n" + contact_of("ball", sphere_at(p, 0, 0), p, down(p)) +
         "stability: off\n";
}

// Two layers that are glued to each other, of contrast 1/50 to 50, pulled along their border or
// sheared across it.
std::string glued(Draw& draw) {
  const double L = rounded(draw.logarithmic(4, 20)), h = rounded(L * draw.uniform(0.3, 0.8)),
               w = rounded(L * draw.uniform(0.3, 0.8));
  const double below = rounded(h * draw.uniform(0.3, 0.7));
  const double contrast = draw.logarithmic(1. / 50, 50);
  const std::string first = material(draw, 1 / std::sqrt(contrast), 1),
                    second = material(draw, std::sqrt(contrast), 1);
  const double u = rounded(L * draw.uniform(0.05, 0.3));
  const bool sheared = draw.coin();
  return fmt::format(
      "mesh:\n  geometry: {{block: {{size: [{:g}, {:g}, {:g}], divisions: {}}}}}\n"
      "  bodies: [{{name: below, thickness: {:g}}}, {{name: above, thickness: {:.12g}}}]\n"
      "supports: [{{on: {}, hold: [x, y, z]}}]\n"
      "loads: [{{on: {}, displacement: {{x: {:g}, y: 0, z: 0}}}}]\n"
      "materials: {{below: {{material: {}}}, above: {{material: {}}}}}\nstability: off\n",
      L, h, w, divisions_of(L, h, w, 10), below, h - below, sheared ? "bottom" : "x_min",
      sheared ? "top" : "x_max", u, first, second);
}

// A pressure on a rectangle of the top of a block; a point of the top that it moves.
std::string patch(Draw& draw) {
  const double L = rounded(draw.logarithmic(4, 20)), h = rounded(L * draw.uniform(0.3, 0.8)),
               w = rounded(L * draw.uniform(0.5, 1));
  const double half_x = rounded(L * draw.uniform(0.1, 0.25)),
               half_z = rounded(w * draw.uniform(0.1, 0.3));
  const double mu = rounded(draw.logarithmic(0.01, 0.2));
  const double pressure = rounded(2 * mu * draw.uniform(0.1, 0.5));
  return fmt::format(
      "mesh:\n  geometry: {{block: {{origin: [{:g}, 0, {:g}], size: [{:g}, {:g}, {:g}], divisions: "
      "{}}}}}\n"
      "  points: {{middle: [0, {:g}, 0]}}\n"
      "  sets: {{patch: {{of: top, within: {{box: {{from: [{:g}, {:g}, {:g}], to: [{:g}, {:g}, "
      "{:g}]}}}}}}}}\n"
      "supports: [{{on: bottom, hold: [x, y, z]}}]\n"
      "loads: [{{on: patch, pressure: {:g}}}]\nmaterial: {}\nstability: off\n",
      -0.5 * L, -0.5 * w, L, h, w, divisions_of(L, h, w, 10), h, -half_x, h, -half_z, half_x, h,
      half_z, pressure, soft_matrix(draw, mu));
}

// The top of a block is glued to a plate with a rectangular opening, into which it is sucked.
std::string opening(Draw& draw) {
  const double half_x = rounded(draw.logarithmic(0.5, 4)),
               half_z = rounded(half_x * draw.uniform(0.5, 1.5));
  const double a = std::max(half_x, half_z), half = rounded(a * draw.uniform(2, 3)),
               h = rounded(a * draw.uniform(0.7, 2));
  const double mu = rounded(draw.logarithmic(0.01, 0.2));
  const double pressure = rounded(2 * mu * draw.uniform(0.2, 1));
  const auto side = [&](const char* name, double x0, double z0, double x1, double z1) {
    return fmt::format(
        "    {}: {{of: top, within: {{box: {{from: [{:g}, {:g}, {:g}], to: [{:g}, {:g}, {:g}]}}}}}}\n",
        name, x0, h, z0, x1, h, z1);
  };
  return fmt::format(
             "mesh:\n  geometry: {{block: {{origin: [{:g}, 0, {:g}], size: [{:g}, {:g}, {:g}], "
             "divisions: [12, {}, 12]}}}}\n"
             "  points: {{apex: [0, {:g}, 0]}}\n  sets:\n",
             -half, -half, 2 * half, h, 2 * half,
             std::max(4, static_cast<int>(std::lround(6 * h / half))), h) +
         side("hole", -half_x, -half_z, half_x, half_z) +
         side("west", -half, -half, -half_x, half) + side("east", half_x, -half, half, half) +
         side("north", -half_x, half_z, half_x, half) +
         side("south", -half_x, -half, half_x, -half_z) +
         "supports: [{on: bottom, hold: [x, y, z]}, {on: west, hold: [x, y, z]}, {on: east, hold: "
         "[x, y, z]}, {on: north, hold: [x, y, z]}, {on: south, hold: [x, y, z]}]\n" +
         fmt::format("loads: [{{on: hole, pressure: {:g}}}]\nmaterial: {}\nstability: off\n",
                     -pressure, soft_matrix(draw, mu));
}

// A block whose top is turned about its axis.
std::string twist(Draw& draw) {
  const double w = rounded(draw.logarithmic(2, 10)), h = rounded(w * draw.uniform(0.4, 1.2)),
               d = rounded(w * draw.uniform(0.5, 1));
  const double angle = rounded(draw.uniform(5, 40));
  return fmt::format(
      "mesh: {{geometry: {{block: {{origin: [{:g}, 0, {:g}], size: [{:g}, {:g}, {:g}], divisions: "
      "{}}}}}}}\n"
      "supports: [{{on: bottom, hold: [x, y, z]}}]\n"
      "loads: [{{on: top, rotation: {{angle: {:g}, through: [0, {:g}, 0]}}}}]\n"
      "material: {}\nstability: off\n",
      -0.5 * w, -0.5 * d, w, h, d, divisions_of(w, h, d, 8), angle, h, material(draw));
}

// A sphere that is pushed with a given force.
std::string pushed(Draw& draw) {
  const Pressed p = pressed(draw, 1.2, 3);
  const double mu = rounded(draw.logarithmic(0.01, 0.2));
  const double hertz = 16. / 3 * 2 * mu * std::sqrt(p.R) * std::pow(p.depth, 1.5);
  const std::string top = fmt::format(
      ", sets: {{contact: {{of: top, within: {{cylinder: {{axis: y, radius: {:g}}}}}}}}}",
      rounded(1.3 * p.a));
  return block_of(p, top) + "material: " + soft_matrix(draw, mu) +
         fmt::format(
             "\ncontacts:\n  ball: {{on: contact, rigid: {}, friction: {:g}, control: {{force: {:g}}}}}\n"
             "stability: off\n",
             sphere_at(p, 0, 0), p.friction, rounded(0.7 * hertz));
}

// An adhesive sphere that is pressed on a disc and drawn off. Its bonds bear a fifth of the shear
// modulus to three fifths.
std::string pull_off(Draw& draw) {
  const double R = rounded(draw.logarithmic(1, 10)), H = rounded(R * draw.uniform(0.6, 1.5));
  const double mu = rounded(draw.logarithmic(0.01, 0.2)), G = 2 * mu;
  const double work = rounded(G * R * draw.logarithmic(5e-4, 2e-3));
  const double strength = G * draw.uniform(0.2, 0.6);
  const double depth = rounded(R * draw.uniform(0.01, 0.02));
  const double a = std::sqrt(2 * R * depth);
  return fmt::format(
      "mesh: {{geometry: {{indented_disc: {{size: [{:g}, {:g}], radius: {:g}, depth: {:g}, edge: "
      "0.05}}}}, sets: {{contact: {{of: top, within: {{cylinder: {{axis: y, radius: {:g}}}}}}}}}}}\n"
      "supports: [{{on: bottom, hold: [x, y]}}]\nmaterial: {}\n"
      "contacts:\n  ball: {{on: contact, rigid: {{sphere: {{radius: {:g}, centre: [0, {:.10g}, "
      "0]}}}}, adhesion: {{work: {:g}, stiffness: {:g}}}, motion: [{{t: 0.3, to: [0, {:g}, 0]}}, "
      "{{t: 1, to: [0, {:g}, 0]}}]}}\n"
      "path: {{first: 0.05, largest: 0.05}}\nsolver: {{newton: {{iterations: 12}}}}\nstability: off\n",
      rounded(1.5 * H), H, R, depth, rounded(1.3 * a), soft_matrix(draw, mu), R, H + R, work,
      rounded(strength * strength / work), -depth, rounded(0.8 * depth));
}

// A viscous disc under a sphere that comes down and stays there.
std::string hold(Draw& draw) {
  const Pressed p = pressed(draw, 0.6, 3);
  const double mu = rounded(draw.logarithmic(0.01, 0.2));
  const double tau = rounded(draw.logarithmic(0.1, 10)), ramp = rounded(tau * draw.uniform(0.1, 2)),
               held = rounded(tau * draw.uniform(1, 10));
  const std::string viscous =
      fmt::format(", viscous: [{{tau: {:g}, gamma: {:.2g}}}, {{tau: {:g}, gamma: {:.2g}}}]", tau,
                  draw.uniform(0.1, 1), rounded(5 * tau), draw.uniform(0.1, 1));
  return fmt::format(
      "mesh: {{geometry: {{indented_disc: {{size: [{:g}, {:g}], radius: {:g}, depth: {:g}}}}}}}\n"
      "supports: [{{on: bottom, hold: [x, y]}}]\nmaterial: {}\n"
      "contacts:\n  ball: {{rigid: {}, friction: {:g}, motion: [{{s: {:g}, to: [0, {:g}, 0]}}, {{s: "
      "{:g}, to: [0, {:g}, 0]}}]}}\n"
      "path: {{seconds: {:g}}}\nstability: off\n",
      p.half, p.H, p.R, p.depth, soft_matrix(draw, mu, viscous), sphere_at(p, 0, 0), p.friction,
      ramp, -p.depth, ramp + held, -p.depth, ramp + held);
}

// A block that is stretched along x first and then indented.
std::string stretched(Draw& draw) {
  Pressed p = pressed(draw, 1, 2);
  p.half = rounded(std::max(1.5 * p.H, 3 * p.a));
  const double stretch = draw.uniform(1.03, 1.2), end = rounded(p.half * (stretch - 1));
  const double sunk = p.H * (1 - 1 / std::sqrt(stretch));  // of the top, about
  const std::string law = material(draw, 1, 1);
  return mesh_of(p) +
         fmt::format(
             "supports: [{{on: bottom, hold: [y]}}, {{on: z_min, hold: [z]}}]\n"
             "loads: [{{on: x_min, displacement: {{x: [{{t: 0.5, to: {0:g}}}, {{t: 1, to: {0:g}}}]}}}}, "
             "{{on: x_max, displacement: {{x: [{{t: 0.5, to: {1:g}}}, {{t: 1, to: {1:g}}}]}}}}]\n",
             -end, end) +
         "material: " + law + "\ncontacts:\n" +
         contact_of("ball", sphere_at(p, 0, 0), p,
                    fmt::format("{{t: 0.5, to: [0, {:g}, 0]}}, {{t: 1, to: [0, {:g}, 0]}}",
                                -rounded(sunk), -rounded(sunk + p.depth))) +
         "stability: off\n";
}

// Two equal spheres that nearly touch each other.
std::string close_spheres(Draw& draw) {
  Pressed p = pressed(draw, 1, 2);
  const double apart = rounded(p.R * draw.uniform(1.02, 1.2));
  p.half = rounded(p.half + apart);
  const std::string law = material(draw, 1, 1);
  return of(p, law,
            contact_of("left", sphere_at(p, -apart, 0), p, down(p)) +
                contact_of("right", sphere_at(p, apart, 0), p, down(p)));
}

// An STL file of this name (tools.hpp), whose lowest point is its origin, is pressed on the middle.
std::string scanned(const Pressed& p, const std::string& law, const std::string& file, double scale,
                    double rounding) {
  const std::string shape =
      fmt::format("{{facets: {{file: {}, scale: {:g}, rounding: {:g}, move: [0, {:.10g}, 0]}}}}",
                  file, scale, rounding, p.H + rounding);
  return of(p, law, contact_of("tool", shape, p, down(p)));
}

std::string tilted_ellipsoid(Draw& draw) {
  const Pressed p = pressed(draw, 1, 3);
  const int tilts[]{10, 25, 40};
  const std::string law = material(draw, 1, 1);
  // rounder than its cells are long: else nodes slip over the edges of the file one by one
  return scanned(p, law, fmt::format("ellipsoid_{}.stl", tilts[draw.below(3)]), rounded(0.6 * p.R),
                 rounded(0.4 * p.R));
}

std::string stl_punch(Draw& draw) {
  Pressed p = pressed(draw, 1.5, 4);
  const double half_width = rounded(0.6 * p.a),
               rounding = rounded(half_width * draw.uniform(0.2, 0.5));
  p.depth = rounded(0.5 * p.depth);
  const std::string law = material(draw, 1, 1);
  return scanned(p, law, "frustum.stl", half_width, rounding);
}

// A round sheet with a hole whose outer rim is pulled outwards; the rim of the hole moves.
std::string pulled_hole(Draw& draw) {
  const double R = rounded(draw.logarithmic(0.5, 5)), width = rounded(R * draw.uniform(1, 4)),
               h = rounded(R * draw.uniform(0.2, 1));
  const double mu = rounded(draw.logarithmic(0.01, 0.2));
  const double traction = rounded(2 * mu * draw.uniform(0.2, 1));
  return fmt::format(
      "mesh:\n  geometry: {{section: {{of: axisymmetric, origin: [{:g}, 0], size: [{:g}, {:g}], "
      "divisions: [{}, 4]}}}}\n  points: {{rim: [{:g}, {:g}, 0]}}\n"
      "supports: [{{on: bottom, hold: [y]}}]\n"
      "loads: [{{on: x_max, pressure: {:g}}}]\nmaterial: {}\nstability: off\n",
      R, width, h, std::max(4, static_cast<int>(std::lround(4 * width / h))), R, h, -traction,
      soft_matrix(draw, mu));
}

}  // namespace

const Makers& further_kinds() {
  static const Makers all{{"notch", notch},
                          {"held_sheet", held_sheet},
                          {"glued", glued},
                          {"patch", patch},
                          {"opening", opening},
                          {"twist", twist},
                          {"pushed", pushed},
                          {"pull_off", pull_off},
                          {"hold", hold},
                          {"stretched", stretched},
                          {"close_spheres", close_spheres},
                          {"tilted_ellipsoid", tilted_ellipsoid},
                          {"stl_punch", stl_punch},
                          {"pulled_hole", pulled_hole}};
  return all;
}

}  // namespace langer::test
