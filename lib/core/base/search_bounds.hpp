// Where a fit searches a number, in the listing of the material model that has the number:
//   v(&Gent::Jm, "Jm", unit::none, "...", required, positive, SearchBounds{0.1, 200});
// A number without such bounds has those of its unit (identification/setup/fit_config.cpp).
// The bounds apply where the config of a fit names none, and only within the range of the number.
#pragma once

namespace langer {

struct SearchBounds {
  double low = 0;
  double high = 0;
  // With `bounds: admissible` the number keeps the sign of its start value and at least this size.
  // 0: the sign may change.
  double least_size = 0;
  // Random starts are drawn more often near the lower bound: large exponents all act alike.
  bool small_values_first = false;
};

// Another number of the same term whose sign this one has if `bounds: admissible` is chosen. The
// terms of Ogden's model are stable if mu_p alpha_p >= 0.
struct SignOf {
  const char* key;
};

}  // namespace langer
