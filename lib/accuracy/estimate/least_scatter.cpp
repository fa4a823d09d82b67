#include "accuracy/estimate/least_scatter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "scene/model/supports.hpp"

namespace langer {

namespace {

constexpr double most = 0.5;  // of a value: more says only that it is not known

double greatest_friction(const SolveConfig& config) {
  double greatest = 0;
  for (const auto& [name, contact] : config.contacts)
    greatest = std::max(greatest, contact.friction);
  return greatest;
}

// 1 where all of the contact but its edge sticks.
double share_that_sticks(const SolveConfig& config) {
  constexpr double all_stick = 0.2;  // friction from which on that is so
  return std::min(1.0, greatest_friction(config) / all_stick);
}

// How many times the radius of a punch is that of its edge; 1 of round indenters.
double sharpness(const SolveConfig& config) {
  double sharpest = 1;
  for (const auto& [name, contact] : config.contacts)
    sharpest = std::max(sharpest, edge_sharpness(contact.rigid.value()));
  return sharpest;
}

// The cells' length in radii of the contact: its nodes fill a disc, or a radius of a section.
double length_in_contact(double touching, bool section) {
  if (section) return 1 / touching;
  return std::sqrt(std::numbers::pi / touching);
}

bool all_are_round(const SolveConfig& config) {
  return std::ranges::all_of(config.contacts, [](const auto& contact) {
    return force_order(contact.second.rigid.value()) == 2;
  });
}

}  // namespace

// Spheres: make work-precision. Sections: langer-random-scenes FOLDER kind=section.
double one_by_one(double touching, bool section) {
  if (touching < 1) return 0;
  if (section) return std::min(most, 0.6 / (touching * touching));
  return std::min(most, 3.1 * std::pow(touching, -1.5));
}

double bond_by_bond(double touching, bool section) {
  if (!section || touching < 1) return one_by_one(touching, section);
  return std::min(most, 0.25 / (touching * touching));
}

// Between nodes, a thin incompressible layer yields to the indenter. So a force is too small by a
// share that goes to and fro from mesh to mesh. The fit of three meshes triples it
// (docs/study_estimates.md, "Thin layers").
double on_thin_layer(const SolveConfig& config) {
  constexpr double thin = 1;   // thickness in radii of the contact
  constexpr double thick = 2;  // where the layer no longer counts
  constexpr double longest = 6.5;
  if (!config.mesh || has_nothing_below(config) || !all_are_round(config)) return 1;
  const auto* block = std::get_if<IndentedBlock>(&config.mesh->geometry);
  if (!block) return 1;
  const double thickness = block->size[1] / block->contact_radius();
  const double share = std::clamp((thick - thickness) / (thick - thin), 0.0, 1.0);
  return 1 + (longest - 1) * share;
}

double shear_at_edge(const SolveConfig& config, double touching) {
  if (touching < 1) return 0;
  return share_that_sticks(config) * std::min(most, 1.6 / touching);
}

// Drawn spheres with 14 nodes in contact missed 0.5 % (langer-random-scenes FOLDER kind=section).
double shear_on_section(const SolveConfig& config, double touching, bool section) {
  if (!section || touching < 1) return 0;
  return std::min(most, share_that_sticks(config) / (touching * touching));
}

// Where the cells are as long as the rounding of a punch's edge, what touches ends anywhere on it
// (docs/work_precision.md).
double round_an_edge(const SolveConfig& config, double touching, bool section) {
  const double sharp = sharpness(config);
  if (sharp <= 1 || touching < 1) return 0;
  if (section) return std::min(most, sharp / (touching * touching));
  return std::min(most, 0.8 * sharp / touching);
}

// The greatest stress below an indenter lies between points of the cells, wherever these are. By
// how much it may be missed is a share of the cells' length in contact radii. Under a punch it lies
// at the rounded edge, in as many cells fewer as that is shorter than the punch.
double between_points(const SolveConfig& config, double touching, bool section) {
  if (touching < 1) return 0;
  return sharpness(config) * std::min(most, 0.6 * length_in_contact(touching, section));
}

// The stress of a stiff layer on a soft one is largest at its faces, where cells find it from their
// middle. A skin of two, eight and sixteen hex8 had 0.78, 0.13 and 0.06 of its value too little, up
// to 1.6 of a cell's share of the layer (docs/accuracy.md).
double across_few_cells(const SolveConfig& config) {
  if (!config.mesh || config.mesh->bodies.size() < 2) return 0;
  if (!has_numbers_of_cells(config.mesh->geometry)) return 0;
  const std::vector<int> n = numbers_of_cells(config.mesh->geometry);
  double thickness = 0;
  double thinnest = std::numeric_limits<double>::infinity();
  for (const LayerConfig& layer : config.mesh->bodies) {
    thickness += layer.thickness;
    thinnest = std::min(thinnest, layer.thickness);
  }
  const double cells = std::max(1.0, n[1] * thinnest / thickness);
  return 1.6 / cells;
}

namespace {

// How many times as long as wide a contact is, at most: for radii of curvature R1, R2 about
// (R1 / R2)^(2/3), and those of an ellipsoid are in the ratio of its half axes squared.
double slenderness(const SolveConfig& config) {
  double most_slender = 1;
  for (const auto& [name, contact] : config.contacts) {
    const Indenter shape = contact.rigid.value();
    const auto* ellipsoid = std::get_if<Ellipsoid>(&shape);
    if (!ellipsoid) continue;
    const auto [least, largest] = std::ranges::minmax(ellipsoid->half_axes);
    most_slender = std::max(most_slender, std::pow(largest / least, 4.0 / 3));
  }
  return most_slender;
}

}  // namespace

// Beside an indenter the surface of a nearly incompressible layer rises by a part of the travel.
// Points beside eight drawn spheres and an ellipsoid of 3 : 1 missed up to 0.036 of the travel
// times the cells' length in radii of the contact, of a slender one in half its width.
double beside_contact(const SolveConfig& config, double touching, bool section) {
  if (touching < 1) return 0;
  const double length = length_in_contact(touching, section);
  return 0.045 * std::min(1.0, length * std::sqrt(slenderness(config)));
}

// At the edges of a clamped face errors are of first order. Where values on three meshes go to and
// fro, other errors of few cells hide them: drawn blocks of four hex27 across missed up to 0.022 of
// a cell's share of the width (langer-random-scenes FOLDER kind=shear).
double beside_clamps(const SolveConfig& config) {
  if (!config.mesh || !has_numbers_of_cells(config.mesh->geometry)) return 0;
  int fewest = 0;
  for (int n : numbers_of_cells(config.mesh->geometry))
    if (n > 1 && (fewest == 0 || n < fewest)) fewest = n;
  if (fewest == 0) return 0;
  return 0.03 / fewest;
}

}  // namespace langer
