// What a run's folder tells of itself: which steps are done, failed or left, what they took, and
// why make would run one again. Read from the generated Makefile, the logs (--log) and the files'
// own configs.
#pragma once

#include <string>
#include <vector>

namespace langer {

// A rule of a run's Makefile.
struct MadeBy {
  std::string target;
  std::vector<std::string> prerequisites;  // the config first; as the folder sees them
  std::string stage;
};
std::vector<MadeBy> rules_of(
    const std::string& folder);  // throws Failure(input) without a Makefile of ours

struct StepTimes {
  std::string step;  // folder and output without ending: alpha_030/solve/solution
  std::string log;
  int exit = -1;                     // -1: the log has no end: running, or killed
  double wall = 0, cpu = 0, MB = 0;  // s, s, at most
  std::string last;                  // what was said last
};
std::vector<StepTimes> times_of(
    const std::string& folder);  // ascending by step; throws Failure(input) without a Makefile
std::string times_text(const std::vector<StepTimes>& times, bool failed_only);

struct StepReasons {
  std::string target;
  std::vector<std::string> reasons;  // none: up to date
};
std::vector<StepReasons> explain(const std::string& folder);
std::string explain_text(const std::vector<StepReasons>& steps);

}  // namespace langer
