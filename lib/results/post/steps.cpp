#include "results/post/steps.hpp"

#include <charconv>
#include <cmath>

namespace langer {

std::optional<StepChoice> parse_step(const std::string& text) {
  StepChoice choice;
  if (text == "last") return choice;
  const char *begin = text.data(), *end = begin + text.size();
  const auto whole = [&](const auto& read) {
    return read.ec == std::errc{} && read.ptr == end;
  };
  for (const auto& [word, by] :
       {std::pair{std::string("t="), StepChoice::By::t}, {"u_ind=", StepChoice::By::u_ind}}) {
    if (!text.starts_with(word)) continue;
    choice.by = by;
    if (whole(std::from_chars(begin + word.size(), end, choice.value)) &&
        std::isfinite(choice.value))
      return choice;
    return {};
  }
  choice.by = StepChoice::By::row;
  if (whole(std::from_chars(begin, end, choice.row)) && choice.row >= 0) return choice;
  return {};
}

int row_of(const StepChoice& choice, const std::vector<double>& t,
           const std::vector<double>& u_ind) {
  const int n = static_cast<int>(t.size());
  if (choice.by == StepChoice::By::last) return n - 1;
  if (choice.by == StepChoice::By::row) return choice.row < n ? choice.row : -1;
  const std::vector<double>& reached = choice.by == StepChoice::By::t ? t : u_ind;
  // t is a sum of increments: as many rounding errors as steps
  for (std::size_t i = 0; i < reached.size(); ++i)
    if (reached[i] >= choice.value - 1e-12) return static_cast<int>(i);
  return -1;
}

bool is_exact(const StepChoice& choice, int row, const std::vector<double>& t,
              const std::vector<double>& u_ind) {
  if (choice.by == StepChoice::By::last || choice.by == StepChoice::By::row) return row >= 0;
  return row >= 0 &&
         std::abs((choice.by == StepChoice::By::t ? t : u_ind)[row] - choice.value) <= 1e-9;
}

}  // namespace langer
