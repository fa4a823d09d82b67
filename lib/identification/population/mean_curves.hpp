// The mean of the curves of several specimens: what is often fitted in place of each of them. The
// parameters of a mean curve are not the mean of parameters, as laws are not linear in them.
#pragma once

#include <vector>

#include "identification/fit/test_data.hpp"

namespace langer {

// Tests of one name are averaged at the points of the first specimen, as far as all specimens that
// have the test reach. Tests with times, and those whose deformation does not grow, are left out.
std::vector<Test> mean_curves(const std::vector<std::vector<Test>>& of_specimens);

}  // namespace langer
