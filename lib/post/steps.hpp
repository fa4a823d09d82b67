// Which state of a path is meant: "last", a row of the table ("0" is the unloaded state, "1" the first step),
// or "t=0.5": the first state at or beyond that place on the path.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace langer {

struct StepChoice {
  enum class By { last, row, t } by = By::last;
  int row = 0;
  double t = 0;
};

std::optional<StepChoice> parse_step(const std::string& text);  // nothing where it is none of the three

// row of the state chosen, t ascending from the unloaded state; -1 if there is none
int row_of(const StepChoice& choice, const std::vector<double>& t);

}  // namespace langer
