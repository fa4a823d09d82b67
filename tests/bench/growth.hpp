// Time and memory against the size of the model: growth.csv, growth.svg and growth.png in the working folder.
#pragma once

#include "material/material.hpp"

namespace langer {
void measure_growth(const Material& skin);
}
