// The choice of a state of a path: "last", a row of the table ("0" is the unloaded state, "1" the
// first step), or "t=0.5" and "u_ind=0.5", the first state at or beyond that path parameter or
// travel of the indenter [mm].
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace langer {

// How a state is chosen, with the number for it.
struct StepChoice {
  enum class By { last, row, t, u_ind } by = By::last;
  int row = 0;
  double value = 0;  // of t or u_ind
};

std::optional<StepChoice> parse_step(const std::string& text);  // nothing if it is none of these

// The row of the chosen state, or -1. t ascends from the unloaded state.
int row_of(const StepChoice& choice, const std::vector<double>& t,
           const std::vector<double>& u_ind = {});
// Whether the row exists and is exactly at the chosen place, to six digits.
bool is_exact(const StepChoice& choice, int row, const std::vector<double>& t,
              const std::vector<double>& u_ind);

}  // namespace langer
