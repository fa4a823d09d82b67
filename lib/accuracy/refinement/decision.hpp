// What follows from the estimated errors of a solution.
//
//   Level     cells and increments of the model (AccuracyLevel in accuracy.hpp)
//   Estimate  errors of its solution (PathErrors in accuracy/estimate/error_estimate.hpp)
//   Decision  accept: the errors are within the request, or no accuracy is requested
//             refine: another level is to be solved
//             stop:   the request is not met, and `reason` says why no further level is solved
#pragma once

#include <string>

namespace langer {

struct Decision {
  enum class Action { accept, refine, stop };
  Action action = Action::accept;
  std::string reason = {};  // of stop; empty if the estimate alone decides
};

}  // namespace langer
