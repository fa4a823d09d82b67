// What a column of a curve may hold: word, unit, meaning, and what it is measured at.
//   of the step     one number of the whole state, nothing to name
//   of the indenter the same, and there must be a contact
//   of nodes        mean over the nodes of a named set (an observation point is a set of one node)
//   of a point      the same, from the row of values of post/fields.hpp
//   of a set        reaction summed, or movement averaged, over a named set
//   of the body     an extreme over all Gauss points; its place is the reference position [mm]
// Signs: stress and pressure positive in tension; force positive where the body resists the indenter's travel.
#pragma once

#include <array>
#include <string>

namespace langer {

enum class Of { step, indenter, nodes, point, set, body };

// clang-format off
enum class Quantity {
  t, increment, newton_iterations, residual,
  negative_eigenvalues, shear_stiffness_min, unstable_volume, outside_fit, driving_force, energy, work, dissipated, balance,
  u_ind, u_ind_x, u_ind_y, u_ind_z, path, force, force_x, force_y, force_z,
  contact_nodes, stick_nodes, slip_nodes, penetration, cone, complementarity,
  u_x, u_y, u_z,
  sigma_xx, sigma_yy, sigma_zz, sigma_xy, sigma_yz, sigma_xz, sigma_1, sigma_2, sigma_3,
  von_mises, pressure, J, fibre_stretch,
  eps_xx, eps_yy, eps_zz, reaction_x, reaction_y, reaction_z,
  von_mises_max, von_mises_max_x, von_mises_max_y, von_mises_max_z,
  pressure_min, pressure_max, fibre_stretch_max, J_min
};
// clang-format on

struct QuantityLine {
  Quantity quantity;
  const char* word;
  const char* unit;
  const char* label;  // on the axis of a figure
  Of of;
};

inline constexpr auto quantity_lines = [] {
  using enum Quantity;
  return std::to_array<QuantityLine>({
      {t, "t", "-", "path parameter", Of::step},
      {increment, "increment", "-", "increment of the path parameter", Of::step},
      {newton_iterations, "newton_iterations", "-", "iterations of the step", Of::step},
      {residual, "residual", "-", "relative residual", Of::step},
      {negative_eigenvalues, "negative_eigenvalues", "-", "negative eigenvalues of the constrained tangent", Of::step},
      {shear_stiffness_min, "shear_stiffness_min", "MPa", "smallest shear stiffness", Of::step},
      {unstable_volume, "unstable_volume", "-", "share of the volume without strong ellipticity", Of::step},
      {outside_fit, "outside_fit", "-", "share of the volume beyond the fitted tests", Of::step},
      {driving_force, "driving_force", "N mm", "work per unit of the path", Of::step},
      {energy, "energy", "N mm", "stored energy", Of::step},
      {work, "work", "N mm", "work of the indenter and of imposed displacements", Of::step},
      {dissipated, "dissipated", "N mm", "energy taken by friction", Of::step},
      {balance, "balance", "-", "work neither stored nor dissipated, relative", Of::step},
      {u_ind, "u_ind", "mm", "indenter travel", Of::indenter},
      {u_ind_x, "u_ind_x", "mm", "indenter travel along x", Of::indenter},
      {u_ind_y, "u_ind_y", "mm", "indenter travel along y", Of::indenter},
      {u_ind_z, "u_ind_z", "mm", "indenter travel along z", Of::indenter},
      {path, "path", "mm", "path of the indenter", Of::indenter},
      {force, "force", "N", "force resisting the indenter", Of::indenter},
      {force_x, "force_x", "N", "force on the indenter along x", Of::indenter},
      {force_y, "force_y", "N", "force on the indenter along y", Of::indenter},
      {force_z, "force_z", "N", "force on the indenter along z", Of::indenter},
      {contact_nodes, "contact_nodes", "-", "nodes in contact", Of::indenter},
      {stick_nodes, "stick_nodes", "-", "sticking nodes", Of::indenter},
      {slip_nodes, "slip_nodes", "-", "slipping nodes", Of::indenter},
      {penetration, "penetration", "mm", "largest penetration", Of::indenter},
      {cone, "cone", "-", "distance from the friction cone", Of::indenter},
      {complementarity, "complementarity", "-", "contact complementarity residual", Of::indenter},
      {u_x, "u_x", "mm", "displacement u_x", Of::nodes},
      {u_y, "u_y", "mm", "displacement u_y", Of::nodes},
      {u_z, "u_z", "mm", "displacement u_z", Of::nodes},
      {sigma_xx, "sigma_xx", "MPa", "Cauchy stress σ_{xx}", Of::point},
      {sigma_yy, "sigma_yy", "MPa", "Cauchy stress σ_{yy}", Of::point},
      {sigma_zz, "sigma_zz", "MPa", "Cauchy stress σ_{zz}", Of::point},
      {sigma_xy, "sigma_xy", "MPa", "Cauchy stress σ_{xy}", Of::point},
      {sigma_yz, "sigma_yz", "MPa", "Cauchy stress σ_{yz}", Of::point},
      {sigma_xz, "sigma_xz", "MPa", "Cauchy stress σ_{xz}", Of::point},
      {sigma_1, "sigma_1", "MPa", "greatest principal stress", Of::point},
      {sigma_2, "sigma_2", "MPa", "middle principal stress", Of::point},
      {sigma_3, "sigma_3", "MPa", "least principal stress", Of::point},
      {von_mises, "von_mises", "MPa", "von Mises stress", Of::point},
      {pressure, "pressure", "MPa", "mean stress", Of::point},
      {J, "J", "-", "volume ratio J", Of::point},
      {fibre_stretch, "fibre_stretch", "-", "fibre stretch", Of::point},
      {eps_xx, "eps_xx", "-", "strain ε_{xx}", Of::set},
      {eps_yy, "eps_yy", "-", "strain ε_{yy}", Of::set},
      {eps_zz, "eps_zz", "-", "strain ε_{zz}", Of::set},
      {reaction_x, "reaction_x", "N", "reaction along x", Of::set},
      {reaction_y, "reaction_y", "N", "reaction along y", Of::set},
      {reaction_z, "reaction_z", "N", "reaction along z", Of::set},
      {von_mises_max, "von_mises_max", "MPa", "greatest von Mises stress", Of::body},
      {von_mises_max_x, "von_mises_max_x", "mm", "x of the greatest von Mises stress", Of::body},
      {von_mises_max_y, "von_mises_max_y", "mm", "y of the greatest von Mises stress", Of::body},
      {von_mises_max_z, "von_mises_max_z", "mm", "z of the greatest von Mises stress", Of::body},
      {pressure_min, "pressure_min", "MPa", "least mean stress", Of::body},
      {pressure_max, "pressure_max", "MPa", "greatest mean stress", Of::body},
      {fibre_stretch_max, "fibre_stretch_max", "-", "greatest fibre stretch", Of::body},
      {J_min, "J_min", "-", "smallest J", Of::body},
  });
}();

constexpr const QuantityLine& line_of(Quantity quantity) { return quantity_lines[static_cast<std::size_t>(quantity)]; }
constexpr bool lines_in_order() {
  for (std::size_t i = 0; i < quantity_lines.size(); ++i)
    if (quantity_lines[i].quantity != static_cast<Quantity>(i)) return false;
  return static_cast<std::size_t>(Quantity::J_min) + 1 == quantity_lines.size();
}
static_assert(lines_in_order(), "one line per quantity, in the order of the enum");

constexpr auto names(Quantity) {
  std::array<const char*, quantity_lines.size()> words{};
  for (std::size_t i = 0; i < words.size(); ++i) words[i] = quantity_lines[i].word;
  return words;
}

constexpr bool needs_place(Quantity quantity) {
  const Of of = line_of(quantity).of;
  return of == Of::nodes || of == Of::point || of == Of::set;
}

// place of a quantity in its group of components, e.g. 1 for u_y in the group that begins with u_x
constexpr int component_of(Quantity quantity, Quantity first) { return static_cast<int>(quantity) - static_cast<int>(first); }

}  // namespace langer
