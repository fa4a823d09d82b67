// The part that each cell has in an error bar. Cells with large parts are cut
// (accuracy/refinement/adaptive_cells.hpp).
#pragma once

#include "accuracy/estimate/error_estimate.hpp"

namespace langer {

// those with a node that an indenter touches
std::vector<int> touched_cells(const Run& run, const StepRecord& last);

// `smooth` times what the fields tell of each, without sign, and `of_contact` in equal parts of
// those that are touched
std::vector<double> parts_of(const std::vector<double>& of_cell, double smooth,
                             const std::vector<int>& touched, double of_contact);

// Share of the cells that have a corner inside of the body, of a section inside of its plane.
double with_a_corner_inside(const Mesh& mesh);
inline constexpr const char* across_one_cell =
    "a layer of one cell says nothing about smooth fields across it";

// nothing but equal parts, since nothing is known
PathErrors to_be_cut_everywhere(const Mesh& mesh, const std::string& why);

}  // namespace langer
