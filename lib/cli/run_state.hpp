// The state of a run's folder: which steps are done, failed or not run, their time and memory, and
// why make would run one again.
//
// There is no data base of runs. The state is read from the generated Makefile (which steps there
// are), the logs of --log (time, memory, exit code), the times of files (as make does) and the
// configs in the result files (which keys have changed). So it is right also after a run was
// copied, interrupted, or partly deleted by hand.
#pragma once

#include <string>
#include <vector>

namespace langer {

// A rule of a run's Makefile.
struct MadeBy {
  std::string target;
  std::vector<std::string> prerequisites;  // the config first; relative to the folder
  std::string stage;
};
// The rules of the Makefile that langer-plan wrote (pipeline/plan/makefile.cpp); throws
// Failure(input) if there is none.
std::vector<MadeBy> rules_of(const std::string& folder);

// Time and memory of one step, from its log.
struct StepTimes {
  std::string step;  // folder and output without ending: alpha_030/solve/solution
  std::string log;
  int exit = -1;                     // -1: the log has no end: running, or killed
  double wall = 0, cpu = 0, MB = 0;  // s, s, largest memory
  std::string last;                  // the last message
};
// Sorted by step; throws Failure(input) without a Makefile.
std::vector<StepTimes> times_of(const std::string& folder);
std::string times_text(const std::vector<StepTimes>& times, bool failed_only);

// Why make would run a step again.
struct StepReasons {
  std::string target;
  std::vector<std::string> reasons;  // empty: up to date
};
std::vector<StepReasons> explain(const std::string& folder);
std::string explain_text(const std::vector<StepReasons>& steps);

}  // namespace langer
