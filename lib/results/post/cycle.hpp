// Storage and loss of a periodic test: first harmonics of two columns over the last cycle.
//   x(t) = Re X exp(i w t), y(t) = Re Y exp(i w t), w = 2 pi / period;   Y / X = storage + i loss,   tan delta = loss / storage
// Whatever the shape of the cycle: of a linear material a triangle's first harmonic has the ratio
// that a sine has. Between states both columns are straight lines.
#pragma once

#include <string>
#include <vector>

#include "core/base/fields.hpp"

namespace langer {

struct CycleChoice {
  std::string of, over;
  double period = 0;
  static void fields(auto& v) {
    v(&CycleChoice::of, "of", unit::none,
      "name of the column that answers, such as a stress, a force or a reaction", required);
    v(&CycleChoice::over, "over", unit::none,
      "name of the column that drives, such as a strain or the indenter's travel", required);
    v(&CycleChoice::period, "period", unit::s,
      "duration of a cycle; the last one ends with the path", required, positive);
  }
};

struct Cycle {
  double storage = 0, loss = 0;  // [unit of y over that of x]
  double change =
      0;  // of storage + i loss since the cycle before, relative; not a number where there is none
  double tan_delta() const { return loss / storage; }
};

// seconds ascend and span a period at least
Cycle last_cycle(const std::vector<double>& seconds, const std::vector<double>& x,
                 const std::vector<double>& y, double period);

}  // namespace langer
