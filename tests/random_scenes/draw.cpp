#include "random_scenes/draw.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "random_scenes/parts.hpp"

namespace langer::test {

namespace {

std::string centred(Draw& draw) {
  const Pressed p = pressed(draw, 1.2, 4);
  return of(p, material(draw), contact_of("ball", sphere_at(p, 0, 0), p, down(p)));
}

std::string beside(Draw& draw) {
  const Pressed p = pressed(draw, 1, 3);
  const double room = p.half - 1.3 * p.a;
  return of(p, material(draw),
            contact_of("ball",
                       sphere_at(p, rounded(draw.uniform(-room, room)),
                                 rounded(draw.uniform(-room, room))),
                       p, down(p)));
}

std::string thin(Draw& draw) {
  const Pressed p = pressed(draw, 0.2, 0.8);
  return of(p, material(draw), contact_of("ball", sphere_at(p, 0, 0), p, down(p)));
}

std::string layered(Draw& draw) {
  const Pressed p = pressed(draw, 1, 3);
  const double top = rounded(p.H * draw.uniform(0.2, 0.7));
  const std::string layers = fmt::format(
      ", bodies: [{{name: below, thickness: {:.10g}}}, {{name: above, thickness: {:g}}}]",
      p.H - top, top);
  const double contrast = draw.logarithmic(0.05, 20);
  const std::string below = material(draw, 1 / std::sqrt(contrast)),
                    above = material(draw, std::sqrt(contrast));
  return block_of(p, layers) + "materials: {below: {material: " + below +
         "}, above: {material: " + above + "}}\ncontacts:\n" +
         contact_of("ball", sphere_at(p, 0, 0), p, down(p)) + "stability: off\n";
}

std::string plane(Draw& draw) {
  const double H = rounded(draw.logarithmic(1, 10)), half = rounded(H * draw.uniform(0.5, 1.5));
  const double friction = draw.coin() ? 0 : rounded(draw.uniform(0.05, 1));
  return fmt::format(
      "mesh: {{geometry: {{block: {{origin: [{:g}, 0, {:g}], size: [{:g}, {:g}, {:g}], divisions: [8, 6, 8]}}}}}}\n"
      "supports: [{{on: bottom, hold: [x, y, z]}}]\nmaterial: {}\ncontacts:\n"
      "  press: {{rigid: {{plane: {{point: [0, {:g}, 0], normal: [0, -1, 0]}}}}, friction: {:g}, motion: [{{t: 1, to: "
      "[0, {:g}, 0]}}]}}\nstability: off\n",
      -half, -half, 2 * half, H, 2 * half, material(draw), H, friction,
      -rounded(draw.uniform(0.05, 0.25) * H));
}

std::string punch(Draw& draw) {
  const Pressed p = pressed(draw, 1.5, 4);
  const double radius = rounded(0.8 * p.a), edge = rounded(radius * draw.uniform(0.1, 0.5));
  const std::string shape =
      fmt::format("{{cylinder: {{radius: {:g}, edge: {:g}, face: [0, {:g}, 0], axis: [0, 1, 0]}}}}",
                  radius, edge, p.H);
  return of(
      p, material(draw),
      contact_of("punch", shape, p, fmt::format("{{t: 1, to: [0, {:g}, 0]}}", -0.5 * p.depth)));
}

std::string ellipsoid(Draw& draw) {
  const Pressed p = pressed(draw, 1, 3);
  const std::string shape = fmt::format(
      "{{ellipsoid: {{half_axes: [{:g}, {:g}, {:g}], centre: [0, {:.10g}, 0]}}}}",
      rounded(p.R * draw.uniform(0.7, 1.6)), p.R, rounded(p.R * draw.uniform(0.7, 1.6)), p.H + p.R);
  return of(p, material(draw), contact_of("egg", shape, p, down(p)));
}

std::string two_spheres(Draw& draw) {
  Pressed p = pressed(draw, 1, 2);
  const double apart = rounded(p.a * draw.uniform(1.5, 3));
  p.half = rounded(p.half + apart);
  return of(p, material(draw, 1, 1),
            contact_of("left", sphere_at(p, -apart, 0), p, down(p)) +
                contact_of("right", sphere_at(p, apart, 0), p,
                           fmt::format("{{t: 1, to: [0, {:g}, 0]}}", -rounded(0.7 * p.depth))));
}

std::string drawn_aside(Draw& draw) {
  Pressed p = pressed(draw, 1, 2);
  p.friction = rounded(draw.uniform(0.05, 0.6));
  return of(p, material(draw, 1, 1),
            contact_of("ball", sphere_at(p, 0, 0), p,
                       fmt::format("{{t: 0.5, to: [0, {0:g}, 0]}}, {{t: 1, to: [{1:g}, {0:g}, 0]}}",
                                   -p.depth, rounded(0.5 * p.a))));
}

std::string pulled(Draw& draw, bool across) {
  const double L = rounded(draw.logarithmic(2, 40)), w = rounded(L * draw.uniform(0.15, 0.7)),
               h = rounded(w * draw.uniform(0.2, 1));
  const double u = rounded(L * draw.uniform(0.1, 0.5));
  const auto n = [&](double length) {
    return std::max(4, static_cast<int>(std::lround(10 * length / L)));
  };
  return fmt::format(
      "mesh: {{geometry: {{block: {{size: [{:g}, {:g}, {:g}], divisions: [{}, {}, {}]}}}}}}\n"
      "supports: [{{on: x_min, hold: [x, y, z]}}]\nloads: [{{on: x_max, displacement: {{x: {:g}, y: 0, z: {:g}}}}}]\n"
      "material: {}\nstability: off\n",
      L, h, w, n(L), n(h), n(w), across ? 0 : u, across ? 0.5 * u : 0, material(draw));
}

std::string disc_of(const Pressed& p, const std::string& layers = "") {
  return fmt::format(
      "mesh: {{geometry: {{indented_disc: {{size: [{:g}, {:g}], radius: {:g}, depth: {:g}}}}}{}}}\n"
      "supports: [{{on: bottom, hold: [x, y]}}]\n",
      p.half, p.H, p.R, p.depth, layers);
}

std::string section(Draw& draw) {
  const Pressed p = pressed(draw, 0.6, 3);
  return disc_of(p) + "material: " + material(draw, 1, 0) + "\ncontacts:\n" +
         contact_of("ball", sphere_at(p, 0, 0), p, down(p)) + "stability: off\n";
}

// Indenters of revolution on a disc of one layer or two, of which the upper one is softer or
// stiffer. The punch's rounded edge is a tenth of its radius to half of it; the plane is wider than
// the disc.
enum class On { ball, punch, ellipsoid, plane };
std::string pressed_disc(Draw& draw, On shape, bool thin, bool layered) {
  const Pressed p = thin ? pressed(draw, 0.2, 0.8) : pressed(draw, 1, 4);
  std::string layers, laws = "material: " + material(draw, 1, 0) + "\n";
  if (layered) {
    const double top = rounded(p.H * draw.uniform(0.2, 0.7)), contrast = draw.logarithmic(0.05, 20);
    layers = fmt::format(
        ", bodies: [{{name: below, thickness: {:.10g}}}, {{name: above, thickness: {:g}}}]",
        p.H - top, top);
    laws = "materials: {below: {material: " + material(draw, 1 / std::sqrt(contrast), 0) +
           "}, above: {material: " + material(draw, std::sqrt(contrast), 0) + "}}\n";
  }
  const double radius = rounded(0.8 * p.a), edge = rounded(radius * draw.uniform(0.1, 0.5));
  const std::string shapes[]{
      sphere_at(p, 0, 0),
      fmt::format("{{cylinder: {{radius: {:g}, edge: {:g}, face: [0, {:g}, 0], axis: [0, 1, 0]}}}}",
                  radius, edge, p.H),
      fmt::format("{{ellipsoid: {{half_axes: [{0:g}, {1:g}, {0:g}], centre: [0, {2:.10g}, 0]}}}}",
                  rounded(p.R * draw.uniform(0.7, 1.6)), p.R, p.H + p.R),
      fmt::format("{{plane: {{point: [0, {:g}, 0], normal: [0, -1, 0]}}}}", p.H)};
  const std::string to =
      fmt::format("{{t: 1, to: [0, {:g}, 0]}}",
                  shape == On::punch || shape == On::plane ? -0.5 * p.depth : -p.depth);
  return disc_of(p, layers) + laws + "contacts:\n" +
         contact_of("tool", shapes[static_cast<std::size_t>(shape)], p, to) + "stability: off\n";
}

// Skin that is sucked into a hole, on its section: under a ring that is stuck to it, or a plate
// with a rounded edge that is pressed on, without friction or with it. Layers: the upper one softer
// or stiffer. The rim of the hole is named or not.
std::string sucked(Draw& draw, bool plate, bool layered) {
  const double R = rounded(draw.logarithmic(0.5, 5)), H = rounded(R * draw.uniform(0.6, 3)),
               width = rounded(R * draw.uniform(3, 6));
  const double mu = rounded(draw.logarithmic(0.005, 0.2)),
               pressure = rounded(2 * mu * draw.uniform(0.2, 1.5));
  const int across = 8 * static_cast<int>(std::lround(width / R)),
            down = std::max(8, static_cast<int>(std::lround(H / width * across)));
  const double top =
      H * static_cast<int>(std::max(2L, std::lround(down * draw.uniform(0.2, 0.7)))) / down;
  const double contrast = layered ? draw.logarithmic(2, 20) : 1;
  const bool soft_above = draw.coin(), rim = draw.coin();
  std::string text = fmt::format(
      "mesh:\n  geometry: {{section: {{of: axisymmetric, size: [{:g}, {:g}], divisions: [{}, {}]}}}}\n"
      "  points: {{apex: [0, {:g}, 0]{}}}\n  sets:\n    hole: {{of: top, within: {{cylinder: {{axis: y, radius: {:g}}}}}}}\n",
      width, H, across, down, H, rim ? fmt::format(", rim: [{:g}, {:g}, 0]", R, H) : "", R);
  if (!plate)
    text += fmt::format(
        "    ring: {{of: top, within: {{cylinder: {{axis: y, radius: {:g}, beyond: {:g}}}}}}}\n",
        3 * R, R);
  if (layered)
    text += fmt::format(
        "  bodies: [{{name: below, thickness: {:.12g}}}, {{name: above, thickness: {:.12g}}}]\n",
        H - top, top);
  text += fmt::format("supports: [{{on: bottom, hold: [x, y]}}{}]\n",
                      plate ? "" : ", {on: ring, hold: [x, y]}");
  if (layered)
    text += fmt::format("materials: {{below: {{material: {}}}, above: {{material: {}}}}}\n",
                        soft_matrix(draw, soft_above ? contrast * mu : mu / contrast),
                        soft_matrix(draw, mu));
  else
    text += "material: " + soft_matrix(draw, mu) + "\n";
  if (!plate)
    return text + fmt::format("loads: [{{on: hole, pressure: {:g}}}]\nstability: off\n", -pressure);
  const double edge = rounded(R * draw.uniform(0.1, 0.4)),
               depth = rounded(H * draw.uniform(0.01, 0.05));
  const double friction = draw.coin() ? 0 : rounded(draw.uniform(0.05, 1));
  return text +
         fmt::format(
             "contacts:\n  plate: {{on: top, rigid: {{aperture: {{radius: {:g}, edge: {:g}, face: [0, {:g}, 0]}}}}, friction: "
             "{:g}, motion: [{{t: 0.2, to: [0, {:g}, 0]}}, {{t: 1, to: [0, {:g}, 0]}}]}}\n"
             "loads: [{{on: hole, pressure: [{{t: 0.2, to: 0}}, {{t: 1, to: {:g}}}]}}]\nstability: off\n",
             R, edge, H, friction, -depth, -depth, -pressure);
}

const Makers& of_suction() {
  static const Makers all{{"ring",
                           [](Draw& draw) {
                             return sucked(draw, false, false);
                           }},
                          {"plate",
                           [](Draw& draw) {
                             return sucked(draw, true, false);
                           }},
                          {"ring_layers",
                           [](Draw& draw) {
                             return sucked(draw, false, true);
                           }},
                          {"plate_layers", [](Draw& draw) {
                             return sucked(draw, true, true);
                           }}};
  return all;
}
const Makers& of_sections() {
  static const Makers all{{"ball",
                           [](Draw& draw) {
                             return pressed_disc(draw, On::ball, false, false);
                           }},
                          {"punch",
                           [](Draw& draw) {
                             return pressed_disc(draw, On::punch, false, false);
                           }},
                          {"thin",
                           [](Draw& draw) {
                             return pressed_disc(draw, On::ball, true, false);
                           }},
                          {"layered",
                           [](Draw& draw) {
                             return pressed_disc(draw, On::ball, false, true);
                           }},
                          {"punch_layers",
                           [](Draw& draw) {
                             return pressed_disc(draw, On::punch, false, true);
                           }},
                          {"ellipsoid",
                           [](Draw& draw) {
                             return pressed_disc(draw, On::ellipsoid, false, false);
                           }},
                          {"punch_thin",
                           [](Draw& draw) {
                             return pressed_disc(draw, On::punch, true, false);
                           }},
                          {"plane", [](Draw& draw) {
                             return pressed_disc(draw, On::plane, false, false);
                           }}};
  return all;
}
const Makers& usual_kinds() {
  static const Makers all{{"centred", centred},
                          {"beside", beside},
                          {"thin", thin},
                          {"layered", layered},
                          {"plane", plane},
                          {"punch", punch},
                          {"ellipsoid", ellipsoid},
                          {"two_spheres", two_spheres},
                          {"drawn_aside", drawn_aside},
                          {"tension",
                           [](Draw& draw) {
                             return pulled(draw, false);
                           }},
                          {"shear",
                           [](Draw& draw) {
                             return pulled(draw, true);
                           }},
                          {"section", section}};
  return all;
}

// all of them
const Makers& makers() {
  static const Makers all = [] {
    Makers kinds = usual_kinds();
    kinds.insert(kinds.end(), further_kinds().begin(), further_kinds().end());
    return kinds;
  }();
  return all;
}

}  // namespace

std::vector<std::string> names_of_kinds() {
  std::vector<std::string> names;
  for (const auto& [name, make] : makers()) names.push_back(name);
  return names;
}

DrawnScene drawn_scene(std::uint64_t seed, int number, const std::string& kind_of) {
  const Makers& all = kind_of == "suction"   ? of_suction()
                      : kind_of == "section" ? of_sections()
                                             : makers();
  auto drawn = all.begin() + number % static_cast<std::ptrdiff_t>(all.size());
  const auto named =
      std::find_if(all.begin(), all.end(), [&](const auto& kind) { return kind.first == kind_of; });
  if (named != all.end()) drawn = named;
  Draw draw(seed * 1000003 + static_cast<std::uint64_t>(number));
  return {fmt::format("{:03}_{}", number, drawn->first), drawn->second(draw)};
}

}  // namespace langer::test
