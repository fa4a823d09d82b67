// What a measured file says of itself: kind, columns, measures, units, fibre angle, weight, range;
// the keys of an item of the fit's `data`. It stands in the CSV, in comments between two lines `#
// ---`
//   # ---
//   # kind: biaxial
//   # columns: {strain_x: lambda_x, strain_z: lambda_z, stress_x: P_x_MPa, stress_z: P_z_MPa}
//   # ---
// or in a file beside it with the same name and the ending .yaml, not in both. A file beside it
// that is something else, as its keys show (the fit's own config, fit.yaml beside fit.csv), is left
// alone.
#pragma once

#include "core/config/tree.hpp"

namespace langer {

// The keys that a CSV's header gives, with their places in that file; a null tree if it has none.
// Throws Failure(config) where the block is not closed or is no map.
Tree csv_header(const std::string& text, const std::string& shown_name);

// Adds to an item of `data` what its file says and the item does not. A file that cannot be read is
// left to those who need it.
void add_keys_of_measured_file(Tree& item);

}  // namespace langer
