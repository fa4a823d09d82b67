// A run whose steps are kept in solution.h5 as they are made, and which goes on where one of the same task was stopped.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "run/progress.hpp"
#include "run/run_watch.hpp"
#include "run/step_forces.hpp"

namespace langer {

class Recording {
 public:
  // Refers to run and watch, which are put after the last step that is kept. Throws Failure(input) where the file cannot be written.
  Recording(Run& run, RunWatch& watch, const SolveConfig& config, const Identity& identity, const std::string& output);

  int n_steps() const { return file_.n_steps(); }
  bool continues() const { return resumed_.has_value(); }
  bool with_other_settings() const;  // the steps that it continues were made

  // Every step is written before the next one begins. Throws Failure(config, not_converged) for a state that is not to be kept.
  RunEnd follow(Progress& progress);
  double seconds() const { return seconds_; }  // of CPU, for writing
  // at each step, those that were kept too; empty where the config asks for no estimate by refinement
  const std::vector<StepForces>& forces() const { return forces_; }

  // Failure(not_converged), or one with the signal's code, where the end of the path was not reached; loose: motions that only
  // contact holds, in words.
  void need_the_end(const RunEnd& end, const std::string& loose) const;
  [[noreturn]] void stopped_in_estimate() const;

  void finish(const std::optional<Cost>& cost, const std::vector<Summary>& said, const SolutionWriter::Histories& found_later) {
    file_.finish(cost, said, found_later);
  }

 private:
  Run& run_;
  RunWatch& watch_;
  std::string output_, config_;
  std::function<void(const StepRecord&)> collect_;
  std::vector<StepForces> forces_;
  SolutionWriter file_;
  std::optional<StepRecord> resumed_;
  double seconds_ = 0;
};

}  // namespace langer
