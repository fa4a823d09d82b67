// A homogeneous test that could be made next, with the stresses that a law predicts in it.
#pragma once

#include <optional>
#include <vector>

#include "identification/fit/fit.hpp"
#include "identification/statistics/study_config.hpp"

namespace langer {

// As many points as the largest of `tests`, whose weight it has as well: it is measured by the same
// device. It goes to the largest amount measured so far, but not beyond the stress that the
// material has borne. Nothing where the law has no state, for scenes, or without tests.
std::optional<Test> candidate_test(const CandidateChoice& choice, const Material& material,
                                   const std::vector<Test>& tests, Dilatation dilatation);

// The stress that the material has in a test; false where there is a state without one.
bool set_stress(Test& test, const Material& material, Dilatation dilatation);

}  // namespace langer
