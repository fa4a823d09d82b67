// The first lines of a report: what was done to which body, and which force resulted, with its
// error bar.
//
// The sentence is composed from the config that the solution file contains and from its last step
// (or the step of the greatest travel). An error bar is shown only if the solution has an error
// estimate for that number; see known_error.
#pragma once

#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "results/store/identity.hpp"
#include "results/store/solution_file.hpp"

namespace langer::report {

// One sentence, and facts in a table below it.
struct Answer {
  struct Fact {
    std::string name, text;
  };
  std::string sentence;
  std::vector<Fact> facts;
};

// A number of the summary with its estimated discretisation error in percent; NaN without an
// estimate. The number is the limit of the meshes where the solver gave that as its answer.
// Otherwise it is the sum of its limit and its errors in the summary; if they are missing,
// `fallback`. share: by how much the limit at the last step is larger than what was computed there;
// 1 where it is no answer.
struct KnownError {
  double value = 0, percent = 0, share = 1;
};
KnownError known_error(const std::vector<Summary>& summary, const std::string& name,
                       double fallback);

// A number to the digit that its error leaves known: of 9.497 with 1.6 % this is 9.50, with 9
// % 9.5. Without an error four digits.
std::string rounded(double value, double percent);

// label: the member of a sweep; empty for a single solution
Answer answer_of(const SolutionReader& solution, const std::string& label);

}  // namespace langer::report
