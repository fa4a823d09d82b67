// What a reader asks first of a solution: what was done to which body, and what force came of it,
// with the error that is known of it.
#pragma once

#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "results/store/identity.hpp"
#include "results/store/solution_file.hpp"

namespace langer::report {

struct Answer {
  struct Fact {
    std::string name, text;
  };
  std::string sentence;
  std::vector<Fact> facts;
};

// Estimated error of a number of the summary in percent of it, as cells and increments make it; NaN
// where nothing was estimated. `of`: the number, where limit and parts do not tell it.
struct KnownError {
  double value = 0, percent = 0;
};
KnownError known_error(const std::vector<Summary>& summary, const std::string& name, double of);

// label: of the member, "" where there is one alone
Answer answer_of(const SolutionReader& solution, const std::string& label);

}  // namespace langer::report
