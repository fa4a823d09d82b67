// Storage and loss of a periodic test: first harmonics of two columns over the last cycle.
//   x(t) = Re X exp(i w t), y(t) = Re Y exp(i w t), w = 2 pi / period
//   Y / X = storage + i loss,   tan delta = loss / storage
// The shape of the cycle may be any: the first harmonic of a triangle has the same ratio as a sine,
// if the material is linear. Between states both columns are straight lines.
#pragma once

#include <string>
#include <vector>

#include "core/base/fields.hpp"

namespace langer {

// The listing `cycle`: two columns and the duration of a cycle.
struct CycleChoice {
  std::string of, over;
  double period = 0;
  static void fields(auto& v) {
    v(&CycleChoice::of, "of", unit::none,
      "name of the column of the response, such as a stress, a force or a reaction", required);
    v(&CycleChoice::over, "over", unit::none,
      "name of the column of the excitation, such as a strain or the indenter's travel", required);
    v(&CycleChoice::period, "period", unit::s,
      "duration of a cycle; the last one ends with the path", required, positive);
  }
};

// The complex modulus of the last cycle.
struct Cycle {
  double storage = 0, loss = 0;  // [unit of y over that of x]
  // Relative change of storage + i loss since the cycle before; NaN if there is only one cycle.
  double change = 0;
  double tan_delta() const { return loss / storage; }
};

// The seconds must ascend and span at least a period.
Cycle last_cycle(const std::vector<double>& seconds, const std::vector<double>& x,
                 const std::vector<double>& y, double period);

}  // namespace langer
