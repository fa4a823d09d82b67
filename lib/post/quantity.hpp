// What a column of a curve may hold: word, unit, meaning with its sign, and what it is measured at; `langer describe columns` prints it.
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
  const char* meaning;  // with its sign
};

inline constexpr auto quantity_lines = [] {
  using enum Quantity;
  return std::to_array<QuantityLine>({
      {t, "t", "-", "path parameter", Of::step, "place on the path from 0 to 1, at which the step was accepted"},
      {increment, "increment", "-", "increment of the path parameter", Of::step, "of t, with which the step was found"},
      {newton_iterations, "newton_iterations", "-", "iterations of the step", Of::step, "tangents that the step took"},
      {residual, "residual", "-", "relative residual", Of::step,
       "norm of the residual over that of the reactions, at the accepted state; never negative"},
      {negative_eigenvalues, "negative_eigenvalues", "-", "negative eigenvalues of the constrained tangent", Of::step,
       "their number; more than 0: the equilibrium is unstable; -1: the tangent is singular to the last digit"},
      {shear_stiffness_min, "shear_stiffness_min", "MPa", "smallest shear stiffness", Of::step,
       "smallest over all Gauss points and directions; negative where strong ellipticity is lost"},
      {unstable_volume, "unstable_volume", "-", "share of the volume without strong ellipticity", Of::step,
       "share of the reference volume where shear_stiffness_min is negative, 0 to 1"},
      {outside_fit, "outside_fit", "-", "share of the volume beyond the fitted tests", Of::step,
       "share of the reference volume whose invariants lie beyond the fitted tests, 0 to 1"},
      {driving_force, "driving_force", "N mm", "work per unit of the path", Of::step,
       "of imposed displacements; positive where they do work on the body"},
      {energy, "energy", "N mm", "stored energy", Of::step,
       "stored in the whole body, 0 at rest; of a section that of the whole circle, or of the slab"},
      {work, "work", "N mm", "work of the indenter and of imposed displacements", Of::step,
       "done on the body since rest; positive where indenter and imposed displacements press or pull against it"},
      {dissipated, "dissipated", "N mm", "energy taken by friction", Of::step, "by friction since rest; never negative"},
      {balance, "balance", "-", "work neither stored nor dissipated, relative", Of::step,
       "(work - energy - dissipated) over the largest work so far: error of the increments"},
      {u_ind, "u_ind", "mm", "indenter travel", Of::indenter,
       "length of the displacement of the indenter from its start; never negative"},
      {u_ind_x, "u_ind_x", "mm", "indenter travel along x", Of::indenter, "positive along +x"},
      {u_ind_y, "u_ind_y", "mm", "indenter travel along y", Of::indenter,
       "positive along +y, out of the body where it is pressed from above"},
      {u_ind_z, "u_ind_z", "mm", "indenter travel along z", Of::indenter, "positive along +z"},
      {path, "path", "mm", "path of the indenter", Of::indenter,
       "length of the way that the indenter has gone, there and back counted twice; never negative"},
      {force, "force", "N", "force resisting the indenter", Of::indenter,
       "positive where the body resists the travel; at rest, where there is no direction, its length"},
      {force_x, "force_x", "N", "force on the indenter along x", Of::indenter, "of the body on the indenter, positive along +x"},
      {force_y, "force_y", "N", "force on the indenter along y", Of::indenter,
       "of the body on the indenter, positive along +y: upwards where it is pressed from above"},
      {force_z, "force_z", "N", "force on the indenter along z", Of::indenter, "of the body on the indenter, positive along +z"},
      {contact_nodes, "contact_nodes", "-", "nodes in contact", Of::indenter,
       "number of candidates that touch, sticking or slipping"},
      {stick_nodes, "stick_nodes", "-", "sticking nodes", Of::indenter, "number"},
      {slip_nodes, "slip_nodes", "-", "slipping nodes", Of::indenter, "number"},
      {penetration, "penetration", "mm", "largest penetration", Of::indenter,
       "greatest depth of a node inside the indenter, or gap where there is a reaction; never negative"},
      {cone, "cone", "-", "distance from the friction cone", Of::indenter,
       "greatest of |r_t| - friction r_n and of -r_n, over the largest reaction; never negative"},
      {complementarity, "complementarity", "-", "contact complementarity residual", Of::indenter,
       "what is left of the contact law, over the largest reaction times motion; never negative"},
      {u_x, "u_x", "mm", "displacement u_x", Of::nodes, "mean over the nodes, positive along +x"},
      {u_y, "u_y", "mm", "displacement u_y", Of::nodes, "mean over the nodes, positive along +y"},
      {u_z, "u_z", "mm", "displacement u_z", Of::nodes, "mean over the nodes, positive along +z"},
      {sigma_xx, "sigma_xx", "MPa", "Cauchy stress σ_{xx}", Of::point, "positive in tension"},
      {sigma_yy, "sigma_yy", "MPa", "Cauchy stress σ_{yy}", Of::point, "positive in tension"},
      {sigma_zz, "sigma_zz", "MPa", "Cauchy stress σ_{zz}", Of::point, "positive in tension"},
      {sigma_xy, "sigma_xy", "MPa", "Cauchy stress σ_{xy}", Of::point, "positive where the face of normal +x is drawn along +y"},
      {sigma_yz, "sigma_yz", "MPa", "Cauchy stress σ_{yz}", Of::point, "positive where the face of normal +y is drawn along +z"},
      {sigma_xz, "sigma_xz", "MPa", "Cauchy stress σ_{xz}", Of::point, "positive where the face of normal +x is drawn along +z"},
      {sigma_1, "sigma_1", "MPa", "greatest principal stress", Of::point, "positive in tension"},
      {sigma_2, "sigma_2", "MPa", "middle principal stress", Of::point, "positive in tension"},
      {sigma_3, "sigma_3", "MPa", "least principal stress", Of::point, "positive in tension"},
      {von_mises, "von_mises", "MPa", "von Mises stress", Of::point, "of the averaged Cauchy stress; never negative"},
      {pressure, "pressure", "MPa", "mean stress", Of::point,
       "tr(sigma)/3, the mean stress: positive in tension, the opposite of a hydrostatic pressure"},
      {J, "J", "-", "volume ratio J", Of::point,
       "det F, deformed over reference volume; 1 at rest; at nodes within the values of the points of their cells"},
      {fibre_stretch, "fibre_stretch", "-", "fibre stretch", Of::point, "sqrt(I4_bar), isochoric; 1 at rest, above 1 in tension"},
      {eps_xx, "eps_xx", "-", "strain ε_{xx}", Of::set,
       "engineering: mean u_x of the set over the length; positive where it moves along +x"},
      {eps_yy, "eps_yy", "-", "strain ε_{yy}", Of::set,
       "engineering: mean u_y of the set over the length; positive where it moves along +y"},
      {eps_zz, "eps_zz", "-", "strain ε_{zz}", Of::set,
       "engineering: mean u_z of the set over the length; positive where it moves along +z"},
      {reaction_x, "reaction_x", "N", "reaction along x", Of::set,
       "sum over the set of the force on the body from supports and contact, positive along +x"},
      {reaction_y, "reaction_y", "N", "reaction along y", Of::set,
       "sum over the set of the force on the body from supports and contact, positive along +y"},
      {reaction_z, "reaction_z", "N", "reaction along z", Of::set,
       "sum over the set of the force on the body from supports and contact, positive along +z"},
      {von_mises_max, "von_mises_max", "MPa", "greatest von Mises stress", Of::body, "over all Gauss points; never negative"},
      {von_mises_max_x, "von_mises_max_x", "mm", "x of the greatest von Mises stress", Of::body, "place in the reference state"},
      {von_mises_max_y, "von_mises_max_y", "mm", "y of the greatest von Mises stress", Of::body, "place in the reference state"},
      {von_mises_max_z, "von_mises_max_z", "mm", "z of the greatest von Mises stress", Of::body, "place in the reference state"},
      {pressure_min, "pressure_min", "MPa", "least mean stress", Of::body,
       "tr(sigma)/3 over all Gauss points: negative in compression"},
      {pressure_max, "pressure_max", "MPa", "greatest mean stress", Of::body,
       "tr(sigma)/3 over all Gauss points: positive in tension"},
      {fibre_stretch_max, "fibre_stretch_max", "-", "greatest fibre stretch", Of::body,
       "sqrt(I4_bar) over all Gauss points and families; 1 at rest"},
      {J_min, "J_min", "-", "smallest J", Of::body, "det F over all Gauss points; 1 at rest"},
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
