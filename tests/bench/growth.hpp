// Time and memory against the size of the model: growth.csv, growth.svg and growth.png in the
// working folder.
#pragma once

#include "mechanics/material/material.hpp"

namespace langer {
void measure_growth(const Material& skin);
// The same without a factor in this process, or by the ranks that were started together: mpirun -n
// 2 langer-bench ranks
void measure_ranks(const Material& skin);
}  // namespace langer
