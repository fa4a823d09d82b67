#include "random_scenes/parts.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace langer::test {

double rounded(double x) { return std::stod(fmt::format("{:.3g}", x)); }

std::string material(Draw& draw, double scale, int families) {
  const double mu = rounded(scale * draw.logarithmic(0.02, 0.5));  // half the shear modulus [MPa]
  const std::string matrices[]{
      fmt::format("neo_hooke: {{a1: {:g}}}", mu),
      fmt::format("yeoh: {{a1: {:g}, a2: {:g}, a3: {:g}}}", mu, 0.5 * mu, 0.2 * mu),
      fmt::format("gent: {{mu: {:g}, Jm: {:.3g}}}", 2 * mu, draw.uniform(5, 30)),
      fmt::format("ogden: {{mu1: {:g}, alpha1: {:.3g}}}", mu, draw.uniform(2, 6))};
  std::string fibres;
  const auto n = draw.below(static_cast<std::size_t>(families) + 1);
  for (std::size_t i = 0; i < n; ++i)
    fibres +=
        fmt::format("{}{{hgo: {{c1: {:g}, c2: {:.3g}}}, alpha: {:.3g}, kappa: {:.2g}}}",
                    i ? ", " : "", rounded(mu * draw.logarithmic(0.1, 3)), draw.uniform(0.1, 2),
                    draw.uniform(-90, 90), draw.coin() ? 0 : draw.uniform(0, 0.33));
  return fmt::format("{{matrix: {{{}}}, volume: {{quadratic: {{d: {:g}}}}}{}}}",
                     matrices[draw.below(4)], rounded(draw.logarithmic(1e-4, 1e-2) * 0.01 / mu),
                     n ? ", fibres: [" + fibres + "]" : "");
}

Pressed pressed(Draw& draw, double H_in_a_low, double H_in_a_high) {
  Pressed p;
  p.R = rounded(draw.logarithmic(0.5, 20));
  const double share = draw.uniform(0.05, 0.35);  // of the radius
  p.a = p.R * std::sqrt(share * (2 - share));
  p.H = rounded(p.a * draw.uniform(H_in_a_low, H_in_a_high));
  p.depth = rounded(std::min(share * p.R, 0.3 * p.H));
  p.a = std::sqrt(p.depth * (2 * p.R - p.depth));
  p.half = rounded(std::max(3 * p.H, draw.uniform(3, 6) * p.a));
  p.friction = draw.coin() ? 0 : rounded(draw.uniform(0.05, 1));
  return p;
}

std::string mesh_of(const Pressed& p, const std::string& more) {
  return fmt::format(
      "mesh: {{geometry: {{indented_block: {{origin: [{:g}, 0, {:g}], size: [{:g}, {:g}, {:g}], radius: {:g}, "
      "depth: {:g}}}}}{}}}\n",
      -p.half, -p.half, 2 * p.half, p.H, 2 * p.half, p.R, p.depth, more);
}

std::string block_of(const Pressed& p, const std::string& more) {
  return mesh_of(p, more) + "supports: [{on: bottom, hold: [x, y, z]}]\n";
}

std::string contact_of(const std::string& name, const std::string& shape, const Pressed& p,
                       const std::string& to) {
  return fmt::format("  {}: {{rigid: {}, friction: {:g}, motion: [{}]}}\n", name, shape, p.friction,
                     to);
}

std::string sphere_at(const Pressed& p, double x, double z) {
  return fmt::format("{{sphere: {{radius: {:g}, centre: [{:g}, {:.10g}, {:g}]}}}}", p.R, x,
                     p.H + p.R, z);
}

std::string down(const Pressed& p) { return fmt::format("{{t: 1, to: [0, {:g}, 0]}}", -p.depth); }

std::string of(const Pressed& p, const std::string& law, const std::string& contacts,
               const std::string& more) {
  return block_of(p, more) + "material: " + law + "\ncontacts:\n" + contacts + "stability: off\n";
}

std::string soft_matrix(Draw& draw, double mu, const std::string& more) {
  const std::string matrices[]{
      fmt::format("neo_hooke: {{a1: {:g}}}", mu),
      fmt::format("yeoh: {{a1: {:g}, a2: {:g}, a3: {:g}}}", mu, rounded(mu * draw.uniform(0.3, 3)),
                  0.5 * mu),
      fmt::format("ogden: {{mu1: {:g}, alpha1: {:.3g}}}", mu, draw.uniform(2, 6))};
  return fmt::format("{{matrix: {{{}}}, volume: {{quadratic: {{d: {:g}}}}}{}}}",
                     matrices[draw.below(3)], rounded(draw.logarithmic(1e-4, 1e-2) * 0.01 / mu),
                     more);
}

}  // namespace langer::test
