// Names, units and meanings in solution.h5 that its writer and its readers share. docs/schema.md
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace langer::solution {

// cell arrays that belong to the mesh, not to a step
inline constexpr std::array static_cells{"body", "e_x", "e_y", "e_z"};
// histories that every step has; further ones are StepRecord::scalars
inline constexpr std::array histories{"t",           "increment", "iterations",   "residual",
                                      "u_ind",       "force_ind", "contact_open", "contact_stick",
                                      "contact_slip"};
inline constexpr std::array status_words{"open", "stick", "slip"};

template <std::size_t n>
bool among(const std::array<const char*, n>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// a cell array that no step has
inline bool is_static(const std::string& name) {
  return among(static_cells, name) || name.starts_with("fibre_");
}

// What /history and /VTKHDF hold of every step, with unit and meaning; * stands for the name of a
// contact.
struct HistoryLine {
  const char *name, *unit, *meaning;
};
inline constexpr auto history_lines = std::to_array<HistoryLine>({
    {"t", "-", "place on the path from 0 to 1"},
    {"increment", "-", "of t, with which the step was found"},
    {"iterations", "-", "tangents that the step took"},
    {"residual", "-", "norm of the residual over that of the reactions; never negative"},
    {"next_increment", "-", "of t, with which the next step begins"},
    {"J_min", "-", "smallest det F over all Gauss points; 1 at rest"},
    {"energy", "N mm",
     "stored in the body, 0 at rest; in a viscous one what it stores once it has relaxed"},
    {"viscous_work", "N mm",
     "done against viscous branches since rest: dissipated, or in them until they relax"},
    {"time", "s", "since the beginning of the path"},
    {"u_ind", "mm", "displacement of the first indenter: x, y, z"},
    {"force_ind", "N", "of the body on the indenter, of several their sum: x, y, z"},
    {"force_error", "N", "half width of the error bar of the force, by refinement; never negative"},
    {"force_*_error", "N",
     "of several indenters: half width of the error bar of the force on that one; never negative"},
    {"reaction_*_error", "N",
     "half width of the error bar of the reaction of that set, which is moved; never negative"},
    {"torque_*_error", "N mm", "half width of the error bar of that torque; never negative"},
    {"torque_*", "N mm",
     "with which that indenter, or that set, turns the body about its axis; positive in the sense of a positive angle"},
    {"angle_*", "deg",
     "by which that indenter, or that set, has turned, by the right hand about its axis"},
    {"force_deviation", "N",
     "standard deviation of the force by what a fit does not know of its parameters (uncertainty: linear)"},
    {"force_*_deviation", "N", "of several indenters: the same of the force on that one"},
    {"reaction_*_deviation", "N", "the same of the reaction of that set, which is moved"},
    {"force_*_x", "N", "of the body on that indenter, positive along +x"},
    {"force_*_y", "N", "of the body on that indenter, positive along +y"},
    {"force_*_z", "N", "of the body on that indenter, positive along +z"},
    {"force_*", "N",
     "of several: of the body on that indenter, against its displacement; positive where the body resists"},
    {"travel_*", "mm", "of that indenter along the direction of its given force"},
    {"contact_open", "-", "number of candidates that do not touch"},
    {"contact_stick", "-", "number of candidates that stick"},
    {"contact_slip", "-", "number of candidates that slip"},
    {"adhesion_stored", "N mm", "in the bonds of indenters that adhere"},
    {"adhesion_dissipated", "N mm",
     "since rest, by bonds that came loose: work of adhesion times area, and what their viscosity took"},
    {"energy_released", "N mm",
     "since rest, in jumps: what bonds that let go at once could not take, friction then included"},
    {"work_of_jumps", "N mm",
     "since rest: done by indenter and loads in increments that hold a jump"},
    {"bonded_area", "mm^2",
     "of the candidates of indenters that adhere: sum of area at rest times intensity"},
    {"penetration", "mm",
     "greatest depth of a node inside an indenter, or gap where there is a reaction; never negative"},
    {"penetration_between_nodes", "mm",
     "greatest depth of any point of the body's boundary inside an indenter; never negative"},
    {"cone", "-",
     "greatest of |r_t| - friction r_n and of -r_n, over the largest reaction; never negative"},
    {"complementarity", "-",
     "what is left of the contact law, over the largest reaction times motion; never negative"},
    {"negative_eigenvalues", "-",
     "of the constrained tangent; more than 0: unstable; -1: singular to the last digit"},
    {"signs_of_whole_body", "-",
     "1: negative_eigenvalues counts all movements of the body; 0: those that keep its symmetry, or lie in its section"},
    {"shear_stiffness_min", "MPa",
     "smallest over all Gauss points; negative where strong ellipticity is lost"},
    {"weakest_x", "mm", "place of shear_stiffness_min in the reference state"},
    {"weakest_y", "mm", "place of shear_stiffness_min in the reference state"},
    {"weakest_z", "mm", "place of shear_stiffness_min in the reference state"},
    {"weakest_cell", "-", "cell of shear_stiffness_min, from 0"},
    {"unstable_volume", "-", "share of the reference volume without strong ellipticity, 0 to 1"},
    {"outside_fit", "-", "share of the reference volume beyond the fitted tests, 0 to 1"},
    {"isochoric_fibre_stretch_min", "-", "smallest sqrt(I4_bar) over all Gauss points; 1 at rest"},
    {"isochoric_fibre_stretch_max", "-", "greatest sqrt(I4_bar) over all Gauss points; 1 at rest"},
    {"driving_force", "N mm",
     "work of imposed displacements per unit of t; positive where they do work on the body"},
    {"volume_change", "-", "greatest |V / V0 - 1| of a cell; never negative"},
    {"d_*", "-",
     "of `sensitivity`: derivative of the quantity, in the unit of its name, with respect to the number behind _d_, per its unit"},
});
// and of cells
inline constexpr auto field_lines = std::to_array<HistoryLine>({
    {"J", "-", "mean det F of a cell; 1 at rest"},
    {"pressure", "MPa", "tr(sigma)/3 of a cell, the mean stress: positive in tension"},
    {"von_mises", "MPa", "of a cell's mean Cauchy stress; never negative"},
    {"stress", "MPa",
     "Cauchy stress of a cell, mean over its Gauss points: xx xy xz yx yy yz zx zy zz; positive in tension"},
    {"principal_stress_*", "MPa",
     "of that stress: 1 the greatest, 3 the least; positive in tension"},
    {"principal_direction_*", "-",
     "unit vector along that principal stress; its sign means nothing"},
    {"I4_bar", "-",
     "of a cell and its first fibre family, isochoric; 1 at rest, above 1 in tension"},
});

// numbers in a row of a field of cells
constexpr int components_of(std::string_view name) {
  return name == "stress" ? 9 : name.starts_with("principal_direction_") ? 3 : 1;
}

// the line of a name; none where nobody has written one
constexpr const HistoryLine* line_of(std::string_view name) {
  const auto is_of = [name](const HistoryLine& line) {
    const std::string_view pattern = line.name;
    const std::size_t star = pattern.find('*');
    return star == pattern.npos
               ? name == pattern
               : name.size() >= pattern.size() && name.starts_with(pattern.substr(0, star)) &&
                     name.ends_with(pattern.substr(star + 1));
  };
  for (const HistoryLine& line : history_lines)
    if (is_of(line)) return &line;
  for (const HistoryLine& line : field_lines)
    if (is_of(line)) return &line;
  return nullptr;
}

inline std::string unit_of(std::string_view name) {
  const HistoryLine* line = line_of(name);
  return line ? line->unit : "-";
}

}  // namespace langer::solution
