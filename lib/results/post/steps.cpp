#include "results/post/steps.hpp"

#include <charconv>
#include <cmath>

namespace langer {

std::optional<StepChoice> parse_step(const std::string& text) {
  StepChoice choice;
  if (text == "last") return choice;
  const char* const begin = text.data();
  const char* const end = begin + text.size();
  // The number must reach to the end of the text.
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

namespace {

// t is a sum of increments, and a number in a config may be rounded to six digits.
constexpr double close = 6e-7;

// The column that a choice by value refers to.
const std::vector<double>& column_of(const StepChoice& choice, const std::vector<double>& t,
                                     const std::vector<double>& u_ind) {
  if (choice.by == StepChoice::By::t) return t;
  return u_ind;
}

}  // namespace

int row_of(const StepChoice& choice, const std::vector<double>& t,
           const std::vector<double>& u_ind) {
  const int n = static_cast<int>(t.size());
  if (choice.by == StepChoice::By::last) return n - 1;
  if (choice.by == StepChoice::By::row) {
    if (choice.row < n) return choice.row;
    return -1;
  }
  const std::vector<double>& reached = column_of(choice, t, u_ind);
  for (std::size_t i = 0; i < reached.size(); ++i)
    if (reached[i] >= choice.value - close) return static_cast<int>(i);
  return -1;
}

bool is_exact(const StepChoice& choice, int row, const std::vector<double>& t,
              const std::vector<double>& u_ind) {
  if (row < 0) return false;
  if (choice.by == StepChoice::By::last || choice.by == StepChoice::By::row) return true;
  return std::abs(column_of(choice, t, u_ind)[row] - choice.value) <= close;
}

}  // namespace langer
