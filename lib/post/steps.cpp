#include "post/steps.hpp"

#include <charconv>
#include <cmath>

namespace langer {

std::optional<StepChoice> parse_step(const std::string& text) {
  StepChoice choice;
  if (text == "last") return choice;
  const char *begin = text.data(), *end = begin + text.size();
  const auto whole = [&](const auto& read) { return read.ec == std::errc{} && read.ptr == end; };
  if (text.starts_with("t=")) {
    choice.by = StepChoice::By::t;
    if (whole(std::from_chars(begin + 2, end, choice.t)) && std::isfinite(choice.t)) return choice;
    return {};
  }
  choice.by = StepChoice::By::row;
  if (whole(std::from_chars(begin, end, choice.row)) && choice.row >= 0) return choice;
  return {};
}

int row_of(const StepChoice& choice, const std::vector<double>& t) {
  const int n = static_cast<int>(t.size());
  if (choice.by == StepChoice::By::last) return n - 1;
  if (choice.by == StepChoice::By::row) return choice.row < n ? choice.row : -1;
  // t is a sum of increments: as many rounding errors as steps
  for (int i = 0; i < n; ++i)
    if (t[i] >= choice.t - 1e-12) return i;
  return -1;
}

}  // namespace langer
