// Names and units in solution.h5 that its writer and its reader share.                              docs/schema.md
#pragma once

#include <algorithm>
#include <array>
#include <string>

namespace langer::solution {

// cell arrays that belong to the mesh, not to a step
inline constexpr std::array static_cells{"body", "e_x", "e_y", "e_z"};
// histories that every step has; further ones are StepRecord::scalars
inline constexpr std::array histories{"t",         "increment",    "iterations",    "residual",    "u_ind",
                                      "force_ind", "contact_open", "contact_stick", "contact_slip"};
inline constexpr std::array status_words{"open", "stick", "slip"};

template <std::size_t n>
bool among(const std::array<const char*, n>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// a cell array that no step has
inline bool is_static(const std::string& name) { return among(static_cells, name) || name.starts_with("fibre_"); }

inline std::string unit_of(const std::string& name) {
  for (const char* word : {"von_mises", "pressure", "sigma", "stress", "shear_stiffness"})
    if (name.starts_with(word)) return "MPa";
  for (const char* word : {"penetration", "gap", "u_", "weakest_x", "weakest_y", "weakest_z"})
    if (name.starts_with(word)) return "mm";
  for (const char* word : {"force", "reaction"})
    if (name.starts_with(word)) return "N";
  for (const char* word : {"energy", "driving_force"})
    if (name.starts_with(word)) return "N mm";
  return "-";
}

}  // namespace langer::solution
