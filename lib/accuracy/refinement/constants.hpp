// The constants of `accuracy`: first levels, limits of a refinement and margins.
//
// Each has the command by which it was measured. Repeat it after a change of the elements, of the
// contact or of an estimate. "Limit of experience" marks the edge of what was ever run.
#pragma once

#include "accuracy/refinement/accuracy.hpp"

namespace langer::refinement {

// Levels of the refinement study for isotropic scenes without friction: `make work-precision`,
// force_error in <scene>/levels.csv (h17-4steps, h15-4steps, q35-4steps, q25-5steps). The errors
// include what neighbouring meshes add: with few nodes in contact, one node more or less touches
// by chance.
constexpr AccuracyLevel smooth_levels[]{{CellType::hex8, 0.175, 0.25, 2},
                                        {CellType::hex8, 0.15, 0.25, 1},
                                        {CellType::hex27, 0.3536, 0.25, 0.5},
                                        {CellType::hex27, 0.25, 0.2, 0.2}};

// Levels for scenes with friction or fibres: `make work-precision` (h17-4steps to h09-4steps), the
// worse of the scenes with friction, and a quarter more for scenes unlike them (`make accuracy`).
// Shorter increments cost more and are not more accurate: they remove an error that compensates
// that of the mesh. The level of 1 % has five increments: with four, the estimate is just above
// 1 % and the mesh would be refined in vain.
constexpr AccuracyLevel other_levels[]{
    {CellType::hex8, 0.175, 0.25, 2.7},  {CellType::hex8, 0.15, 0.25, 1.8},
    {CellType::hex8, 0.14, 0.25, 1.5},   {CellType::hex8, 0.125, 0.25, 1.2},
    {CellType::hex8, 0.11, 0.2, 1},      {CellType::hex8, 0.1, 0.25, 0.7},
    {CellType::hex8, 0.0884, 0.25, 0.55}};

// Where the limit of the meshes may be the answer, a level is tried whose own error is larger by
// this factor than what is asked for: the limit is closer than the value (docs/study_estimates.md).
constexpr double limit_is_closer = 1.5;
// Without friction and fibres, from 1 % on: below that, single nodes in contact decide the bar.
constexpr double limit_is_closer_smooth = 2;
constexpr double enough_for_smooth_limit = 1;  // requested error [%]

// First levels of scenes that the study does not contain. With friction, the estimates on larger
// elements were half the error: `make work-precision`, docs/work_precision.md.
constexpr AccuracyLevel coarsest{CellType::hex8, 0.175, 0.25, 0};
constexpr double resolves_friction = 0.14;  // mesh size [contact radii] that resolves that shear
constexpr AccuracyLevel coarsest_with_friction{CellType::hex8, 0.125, 0.25, 0};
constexpr AccuracyLevel bent{CellType::hex27, 0.5, 0.25, 0};       // sheets that bend
constexpr AccuracyLevel to_be_cut{CellType::hex8, 0.25, 0.25, 0};  // locally refined meshes
constexpr AccuracyLevel of_disc{CellType::hex8, 0.07, 0.25, 0};    // sections
constexpr double enough_for_coarsest = 2;  // requested error [%] from which `coarsest` suffices

// A sheet with nothing below it bends as far as its rims: longest hex27 there, in its thickness
// (`langer-random-scenes FOLDER kind=held_sheet`).
constexpr double longest_of_sheet = 0.7;

// Limits of experience.
constexpr double finest_of_block = 0.04;  // mesh size [contact radii]
constexpr double finest_of_disc = 0.01;
constexpr double most_hex8 = 6e4;  // elements solved, if their size is no share of a contact radius
constexpr int most_cut = 150'000;  // elements of a locally refined mesh
constexpr double shortest_step = 0.01;  // increment, as a share of the path

// From one level to the next. `make accuracy` and `make accuracy-random` check the result. The
// factors keep a step so small that the next estimate can correct this one.
constexpr double target = 0.8;              // aimed-at error, as a share of the request
constexpr double most_cells_more = 8;       // factor of the number of elements
constexpr double most_increments_more = 3;  // factor of the number of increments
constexpr double cost_of_length = 5;    // power of 1 / mesh size with which time grows (log of -v)
constexpr double rough = 5;             // an estimate above this [%] may be too large ...
constexpr double too_large = 4;         // ... by this factor
constexpr double doubtful = 2;          // and any other by this one
constexpr double clearly_better = 0.9;  // a level whose error is below this share of the next one's
constexpr double worth_a_forecast = 1e4;  // elements: smaller meshes take a few seconds

// Local refinement (`make adaptive`): shares of the sum of the element errors, and of the elements.
constexpr double least_marked_error = 0.3;
constexpr double most_marked_error = 0.9;
constexpr double least_marked_cells = 1.0 / 7;  // fewer would not even double the mesh

// Sections instead of blocks: accuracy of their elements in docs/sections.md, measured with
// pipelines/axisymmetric.yaml. Elements linear in both directions have to be smaller.
constexpr double section_edge_hex27 = 0.125;  // [contact radii]
constexpr double section_edge_hex8 = 0.0442;
constexpr double finest_of_section = 0.04;

}  // namespace langer::refinement
