// Names, units and meanings of the datasets of solution.h5, which its writer and its readers share.
// docs/schema.md
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace langer::solution {

// Arrays of elements that belong to the mesh, not to a step.
inline constexpr std::array static_cells{"body", "e_x", "e_y", "e_z"};
// Histories that every step has. Further ones are StepRecord::scalars.
inline constexpr std::array histories{"t",           "increment", "iterations",   "residual",
                                      "u_ind",       "force_ind", "contact_open", "contact_stick",
                                      "contact_slip"};
// Histories of a motion that are not 0 at the beginning, which is no step: their values there.
inline constexpr const char* at_start_suffix = "_at_start";
inline constexpr std::array status_words{"open", "stick", "slip"};
// Whether a history has whole numbers: iterations, and candidates by their status.
inline bool is_count(const std::string& history) {
  return history == "iterations" || std::ranges::any_of(status_words, [&](const char* status) {
           return history == std::string("contact_") + status;
         });
}

template <std::size_t n>
bool among(const std::array<const char*, n>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Whether an array of elements is the same in all steps.
inline bool is_static(const std::string& name) {
  return among(static_cells, name) || name.starts_with("fibre_");
}

// The names of /history and of the fields in /VTKHDF, with unit and meaning. * stands for the
// name of a contact or set.
struct HistoryLine {
  const char *name, *unit, *meaning;
};
inline constexpr auto history_lines = std::to_array<HistoryLine>({
    {"t", "-", "place on the path from 0 to 1"},
    {"increment", "-", "of t, with which the step was found"},
    {"iterations", "-", "tangents that the step factorized"},
    {"residual", "-", "norm of the residual over that of the reactions; never negative"},
    {"next_increment", "-", "of t, with which the next step begins"},
    {"J_min", "-", "smallest det F over all Gauss points; 1 at rest"},
    {"energy", "N mm",
     "stored in the body, 0 at rest; in a viscous one what it stores once it has relaxed"},
    {"viscous_work", "N mm",
     "done against viscous branches since rest: dissipated, or stored until they relax"},
    {"time", "s", "since the beginning of the path"},
    {"kinetic_energy", "N mm", "of a body in motion, and of an indenter with mass; never negative"},
    {"kinetic_energy_at_start", "N mm", "the same at the beginning of the path"},
    {"mechanical_energy", "N mm",
     "kinetic and stored energy, work against viscous branches and loss to Rayleigh's damping"},
    {"damped_energy", "N mm", "lost to Rayleigh's damping since the beginning"},
    {"energy_balance", "N mm",
     "change of the mechanical energy since the beginning without the work of supports, loads, "
     "weight and indenters: what the time scheme gains; negative where it loses"},
    {"momentum_*_at_start", "N s", "the same at the beginning of the path"},
    {"momentum_*", "N s",
     "of the body in motion along that axis; of several bodies each, and the sum"},
    {"indenter_velocity", "mm/s", "of an indenter with mass, along its direction"},
    {"indenter_velocity_at_start", "mm/s", "the same at the beginning of the path"},
    {"indenter_acceleration", "mm/s^2", "of an indenter with mass, along its direction"},
    {"indenter_carried", "mm/s^2", "what the time scheme carries on of that acceleration"},
    {"u_ind", "mm", "displacement of the first indenter: x, y, z"},
    {"force_ind", "N", "of the body on the indenter, of several their sum: x, y, z"},
    {"force_error", "N",
     "half width of the error bar of the force, by refinement, or of its limit where force_limit_share is there; never negative"},
    {"force_limit_share", "-",
     "limit of the force on ever finer meshes over that on this one, where the limit is the answer to accuracy"},
    {"force_*_limit_share", "-", "of several indenters: the same of the force on that one"},
    {"torque_*_limit_share", "-", "the same of that torque"},
    {"travel_*_limit_share", "-", "the same of the travel of that indenter under a given force"},
    {"force_*_error", "N",
     "of several indenters: half width of the error bar of the force on that one; never negative"},
    {"reaction_*_error", "N",
     "half width of the error bar of the reaction of that set, which is moved; never negative"},
    {"torque_*_error", "N mm", "half width of the error bar of that torque; never negative"},
    {"pull_off_error", "N",
     "half width of the error bar of the greatest pull so far, by refinement; never negative"},
    {"apex_height_error", "mm",
     "half width of the error bar of the height of the apex, where accuracy.of names it; never negative"},
    {"von_mises_max_error", "MPa",
     "half width of the error bar of the greatest von Mises stress, where accuracy.of names it; never negative"},
    {"displacement_*_error", "mm",
     "half width of the error bar of the displacement of that point, where accuracy.of names it; never negative"},
    {"torque_*", "N mm",
     "of that indenter or set on the body about its axis; positive in the sense of a positive "
     "angle"},
    {"angle_*", "deg", "by which that indenter or set has turned about its axis (right-hand rule)"},
    {"force_deviation", "N",
     "standard deviation of the force from the covariance of the fitted parameters (uncertainty: "
     "linear)"},
    {"force_*_deviation", "N", "of several indenters: the same of the force on that one"},
    {"reaction_*_deviation", "N", "the same of the reaction of that set, which is moved"},
    {"force_*_x", "N", "of the body on that indenter, positive along +x"},
    {"force_*_y", "N", "of the body on that indenter, positive along +y"},
    {"force_*_z", "N", "of the body on that indenter, positive along +z"},
    {"force_*", "N",
     "of several: of the body on that indenter, against its displacement; positive where the body "
     "resists"},
    {"travel_*", "mm", "of that indenter along the direction of its given force"},
    {"contact_open", "-", "number of candidates without contact"},
    {"contact_stick", "-", "number of candidates that stick"},
    {"contact_slip", "-", "number of candidates that slip"},
    {"adhesion_stored", "N mm", "in the bonds of indenters that adhere"},
    {"adhesion_dissipated", "N mm",
     "since rest, by bonds that broke: work of adhesion times area, and their viscous dissipation"},
    {"energy_released", "N mm",
     "since rest, in jumps: the part that bonds that break suddenly cannot dissipate, including "
     "the friction of the jump"},
    {"work_of_jumps", "N mm",
     "since rest: done by indenter and loads in increments that hold a jump"},
    {"bonded_area", "mm^2",
     "of the candidates of indenters that adhere: sum of area at rest times intensity"},
    {"penetration", "mm",
     "greatest depth of a node inside an indenter, or gap at a node with a reaction; never "
     "negative"},
    {"penetration_between_nodes", "mm",
     "greatest depth of any point of the body's boundary inside an indenter; never negative"},
    {"penetration_*", "mm",
     "of two deformable surfaces: deepest node of either inside the other; never negative"},
    {"contact_area_*", "mm2",
     "of two deformable surfaces: area of the nodes of `on` that touch; never negative"},
    {"pressure_max_*", "MPa",
     "of two deformable surfaces: greatest normal reaction over the area of its node"},
    {"cone", "-",
     "greatest of |r_t| - friction r_n and of -r_n, over the largest reaction; never negative"},
    {"complementarity", "-",
     "residual of the contact conditions, over the largest reaction times motion; never negative"},
    {"negative_eigenvalues", "-",
     "of the constrained tangent; more than 0: unstable; -1: singular to the last digit"},
    {"signs_of_whole_body", "-",
     "1: negative_eigenvalues counts all movements of the body; 0: those that keep its symmetry, or lie in its section"},
    {"shear_stiffness_min", "MPa",
     "smallest over all Gauss points; negative where strong ellipticity is lost"},
    {"weakest_x", "mm", "place of shear_stiffness_min in the reference state"},
    {"weakest_y", "mm", "place of shear_stiffness_min in the reference state"},
    {"weakest_z", "mm", "place of shear_stiffness_min in the reference state"},
    {"weakest_cell", "-", "element of shear_stiffness_min, from 0"},
    {"unstable_volume", "-", "fraction of the reference volume without strong ellipticity, 0 to 1"},
    {"outside_fit", "-", "fraction of the reference volume beyond the fitted tests, 0 to 1"},
    {"isochoric_fibre_stretch_min", "-", "smallest sqrt(I4_bar) over all Gauss points; 1 at rest"},
    {"isochoric_fibre_stretch_max", "-", "greatest sqrt(I4_bar) over all Gauss points; 1 at rest"},
    {"driving_force", "N mm",
     "work of imposed displacements per unit of t; positive where they do work on the body"},
    {"load_factor", "-",
     "of a path with arc lengths: what multiplies all loads and imposed displacements"},
    {"load_pressure", "MPa", "of a surface that is given a volume; positive into the body"},
    {"load_pressure_*", "MPa", "the same of each set, where there are several"},
    {"pumped_volume", "mm^3", "that such a surface has swept since rest; positive into the body"},
    {"pumped_volume_*", "mm^3", "the same of each set, where there are several"},
    {"branch", "-", "of `branch`: 0 before the bifurcation, then the sign of the mode"},
    {"volume_change", "-", "greatest |V / V0 - 1| of an element; never negative"},
    {"d_*", "-",
     "of `sensitivity`: derivative of the quantity, in the unit of its name, with respect to the "
     "number behind _d_, per its unit"},
});
// The fields of elements.
inline constexpr auto field_lines = std::to_array<HistoryLine>({
    {"velocity", "mm/s", "of a node of a body in motion: x, y, z"},
    {"acceleration", "mm/s^2", "of a node of a body in motion: x, y, z"},
    {"carried", "mm/s^2",
     "what the time scheme carries on: the averaged acceleration of generalised_alpha; of theta a "
     "force in N"},
    {"J", "-", "mean det F of an element; 1 at rest"},
    {"pressure", "MPa", "tr(sigma)/3 of an element, the mean stress: positive in tension"},
    {"von_mises", "MPa", "of an element's mean Cauchy stress; never negative"},
    {"stress", "MPa",
     "Cauchy stress of an element, mean over its Gauss points: xx xy xz yx yy yz zx zy zz; "
     "positive in tension"},
    {"principal_stress_*", "MPa",
     "of that stress: 1 the greatest, 3 the least; positive in tension"},
    {"principal_direction_*", "-",
     "unit vector along that principal stress; its sign has no meaning"},
    {"I4_bar", "-",
     "of the first fibre family of an element, isochoric; 1 at rest, above 1 in tension"},
});

// The number of components of a field of elements.
constexpr int components_of(std::string_view name) {
  if (name == "stress") return 9;
  if (name.starts_with("principal_direction_")) return 3;
  return 1;
}

// The shape of a row of such a field: a scalar has none.
template <class Shape>
Shape row_shape(std::string_view name) {
  const int components = components_of(name);
  if (components == 1) return {};
  return {static_cast<std::size_t>(components)};
}

// Whether a name fits a pattern with at most one *, which stands for one or more letters.
constexpr bool matches(std::string_view name, std::string_view pattern) {
  const std::size_t star = pattern.find('*');
  if (star == pattern.npos) return name == pattern;
  return name.size() >= pattern.size() && name.starts_with(pattern.substr(0, star)) &&
         name.ends_with(pattern.substr(star + 1));
}

// The first line whose pattern a name fits, or nullptr.
constexpr const HistoryLine* line_of(std::string_view name) {
  for (const HistoryLine& line : history_lines)
    if (matches(name, line.name)) return &line;
  for (const HistoryLine& line : field_lines)
    if (matches(name, line.name)) return &line;
  return nullptr;
}

inline std::string unit_of(std::string_view name) {
  const HistoryLine* line = line_of(name);
  if (line) return line->unit;
  return "-";
}

}  // namespace langer::solution
