// Which state of a path is meant: "last", a row of the table ("0" is the unloaded state, "1" the
// first step), or "t=0.5", "u_ind=0.5": the first state at or beyond that place on the path, or
// that travel of the indenter [mm].
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace langer {

struct StepChoice {
  enum class By { last, row, t, u_ind } by = By::last;
  int row = 0;
  double value = 0;  // of t or u_ind
};

std::optional<StepChoice> parse_step(const std::string& text);  // nothing where it is none of these

// row of the state chosen, t ascending from the unloaded state; -1 if there is none
int row_of(const StepChoice& choice, const std::vector<double>& t,
           const std::vector<double>& u_ind = {});
// whether that row is there and not beyond it, to nine digits
bool is_exact(const StepChoice& choice, int row, const std::vector<double>& t,
              const std::vector<double>& u_ind);

}  // namespace langer
