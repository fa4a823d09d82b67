// Which material model? Laws are fitted to the same tests and compared by what they predict.
//
// A law with more numbers always follows the tests more closely. Two measures say whether it has
// learned more about the tissue:
//   left-out error   each test is predicted from a fit to the others
//   AICc             likelihood of all tests, less a price for each number
// The table is ordered by the left-out error where there are two tests or more, otherwise by AICc.
//
// Two laws cannot be told apart where neither measure does: their errors over the tests do not
// differ by more than chance (Student's paired test, 5 %), and their AICc differs by less than 4.
// The test that would tell them apart is the candidate in which one law, fitted again to the data
// together with what the other predicts there, misses by most (T-optimal design [AF75]).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "identification/setup/fit_config.hpp"
#include "results/store/record_table.hpp"

namespace langer {

struct LawOutcome {
  std::string name;
  FitConfig config;  // of a fit with this law alone
  FitProblem problem;
  FitResult fit;
  std::string failed;              // why there is no optimum; empty: there is one
  std::vector<double> left_out;    // of each test, share of its largest stress; NaN: unknown
  double left_out_error = 0;       // root mean square over the tests
  bool elliptic = false;           // in every state of the tests
  std::string lost;                // where it is lost first
  bool indistinguishable = false;  // from the first
  bool same_prediction = false;    // as the first, within chance
  int terms = 0;                   // of a law that was discovered; 0: another
};

struct Separation {
  std::string test;
  double deviations = 0;  // by which the worse law would miss, in standard deviations of the noise
};

struct LawComparison {
  std::vector<LawOutcome> laws;         // the best first
  bool by_prediction = false;           // what the order is by
  std::vector<Separation> separations;  // of the best two, the best test first
};

using LawProgress = std::function<void(const std::string& law)>;

// The fits of `laws` of a config. Throws Failure(not_converged) where none has an optimum.
LawComparison compare_laws(const FitConfig& config, const LawProgress& progress = {});

// The laws of one, two, ... terms of `discover`, and what they reach. The first of `laws` is the
// one that is chosen.
LawComparison discover_terms(const FitConfig& config, const LawProgress& progress = {});

RecordTable law_table(const LawComparison& comparison);   // laws: law, parameters, aicc, ...
RecordTable term_table(const LawComparison& comparison);  // terms: the front over their number
std::string separation_csv(const LawComparison& comparison);
std::vector<std::string> law_lines(const LawComparison& comparison);

}  // namespace langer
