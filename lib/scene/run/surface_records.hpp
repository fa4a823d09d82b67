// What a record says of deformable surfaces in contact.
#pragma once

#include "mechanics/solve/increment.hpp"
#include "results/store/solution_file.hpp"

namespace langer {

// Reactions, gaps and states at the nodes of each non-mortar side, and scalars:
//   force_<name>_x, _y, _z   force of `on` against the other surface [N]; added to force_ind
//   force_<name>             its length [N]
//   contact_area_<name>      area of the nodes that touch, in the averages' own measure [mm^2]
//   pressure_max_<name>      largest normal reaction over the area of its node [MPa]
//   penetration_<name>       deepest node of either side inside the other [mm]
void record_surfaces(const Increment& increment, StepRecord& record);

}  // namespace langer
