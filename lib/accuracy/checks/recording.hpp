// A run whose steps are written to solution.h5 one by one, and which continues where an earlier run
// of the same task was stopped.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "accuracy/checks/progress.hpp"
#include "accuracy/checks/run_watch.hpp"
#include "scene/run/cell_stress.hpp"
#include "scene/run/impact_results.hpp"
#include "scene/run/step_forces.hpp"

namespace langer {

// Follows a run and adds to its records, for example derivatives. Each function may be empty.
struct Observer {
  // Called with each step of an earlier run that is continued, in order.
  std::function<void(const StepRecord& whole)> kept = {};
  // Wraps the listener of the run: the result is called instead of `listener`.
  std::function<RunListener(RunListener listener)> along = {};
};

class Recording {
 public:
  // Refers to run and watch, which are put after the last step that is kept. Throws Failure(input)
  // where the file cannot be written.
  Recording(Run& run, RunWatch& watch, const SolveConfig& config, const Identity& identity,
            const std::string& output, Observer observer = {});

  int n_steps() const { return file_.n_steps(); }
  bool continues() const { return resumed_.has_value(); }

  // To the end of the path; what the watch warns of is said. Every step is written before the next
  // one begins. loose: motions that only contact holds, in words. Throws Failure(config,
  // not_converged) for a state that is not to be kept, Failure(not_converged) or one with the
  // signal's code where the end was not reached.
  RunEnd follow(const Voice& voice, Progress& progress, const std::string& loose);
  double seconds() const { return seconds_; }  // of CPU, for writing
  // at each step, those that were kept too; empty where the config asks for no estimate by
  // refinement
  const std::vector<StepForces>& forces() const { return forces_; }

  // Contact time, greatest force and restitution of a body in motion.
  std::vector<Summary> impact_summary() const { return impact_.summary(); }

  [[noreturn]] void stopped_in_estimate() const;

  void write_vibration(const VibrationRecord& record) { file_.write_vibration(record); }
  void finish(const std::vector<Summary>& said, const SolutionWriter::Histories& found_later) {
    std::vector<Summary> all = said;
    if (const auto& critical = watch_.critical()) {
      all.push_back({"critical_t", critical->t, "-"});
      all.push_back({"critical_is_bifurcation", critical->kind == "bifurcation" ? 1.0 : 0.0, "-"});
      if (critical->angle) all.push_back({"critical_wave_angle", *critical->angle, "deg"});
      if (!critical->mode.empty())
        file_.write_vibration(
            {{}, {}, CriticalRecord{critical->t, critical->kind, critical->mode}});
    }
    file_.finish(continues() ? std::nullopt : std::optional(cost_so_far()), all, found_later);
  }

 private:
  // Collects the forces of a step where the config asks for an estimate by refinement, else empty.
  std::function<void(const StepRecord&)> collector(const SolveConfig& config);
  // As `good`; a step that is kept goes through all that looks at steps, as if it were made now.
  SolutionWriter::StillGood with_replay(SolutionWriter::StillGood good);
  bool with_other_settings() const;  // the steps that it continues were made
  RunEnd along_the_path(Progress& progress);
  void need_the_end(const RunEnd& end, const std::string& loose) const;

  Run& run_;
  RunWatch& watch_;
  std::string output_, config_;
  Observer observer_;
  CellStressRecorder stress_;
  ImpactResults impact_;
  std::function<void(const StepRecord&)> collect_;
  std::vector<StepForces> forces_;
  SolutionWriter file_;
  std::optional<StepRecord> resumed_;
  double seconds_ = 0;
};

}  // namespace langer
