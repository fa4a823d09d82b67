// All checks of the states of a run, as its config asks for them. A run calls it after every
// increment.
//   stability_watch.hpp   negative eigenvalues, strong ellipticity
//   critical_search.hpp   where on the path the body becomes unstable, or the run jumps
//   turning_points.hpp    extrema of a load that is a result
//   loss_watch.hpp        creases, support, and what else needs no search
//   contact_watch.hpp     contact on the whole surface
//   result_watch.hpp      rounding and locking
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "accuracy/checks/contact_watch.hpp"
#include "accuracy/checks/critical_search.hpp"
#include "accuracy/checks/loss_watch.hpp"
#include "accuracy/checks/result_watch.hpp"
#include "accuracy/checks/stability_watch.hpp"
#include "accuracy/checks/turning_points.hpp"
#include "mechanics/solve/symmetry_breaking.hpp"
#include "results/store/text_result.hpp"
#include "scene/run/run.hpp"

namespace langer {

class RunWatch {
 public:
  // Refers to the run; tests: what its material was fitted to.
  // Throws Failure(config) where an indenter starts inside the body.
  RunWatch(Run& run, const SolveConfig& config, const Run::Where& where, StudyRecord tests);

  void kept(const StepRecord& step);  // of an earlier run, one after the other
  bool of_part(StepRecord& record);   // an accepted state; false where the path has to end there
  // the same, balanced; throws Failure(config) for a force that means nothing; what is returned
  // says why it is not to be kept
  std::optional<Error> of_whole(StepRecord& record, const SolveReport& report);

  // The mesh of a homogeneous body, if its stability is checked; else nullptr.
  const Increment* of_mesh() const {
    if (mesh_) return &*mesh_;
    return nullptr;
  }

  // Tangents that are factorized after each step for the movements that break the symmetry of a
  // reduced body, and for those that keep it; 0: none but those of the solution
  int signatures_at_each_step() const;

  const std::string& unstable() const { return unstable_; }  // why the path ended
  const std::string& last_said() const {
    return last_said_;
  }  // of the last state's stability; empty where it is stable

  // At the end of the path: finds the first critical point that lies on it, if the config asks for
  // it. The run is left at its end. only_contact: nothing else restrains the body in some direction
  void locate(const RunEnd& end, bool only_contact = false);
  const std::optional<CriticalPoint>& critical() const { return search_.found(); }
  void know(CriticalPoint point) {
    search_.know(std::move(point));
  }  // where the path leaves another

  std::vector<std::string> warnings() const;
  std::vector<std::string> notes() const;
  // at the end of the path; throws Failure(config) where a facet is entered and no force said
  std::vector<std::string> contact_warnings() const;
  std::vector<Summary> contact_summary() const;
  std::vector<Summary> stability_summary() const;
  std::vector<TextResult> texts() const;  // of stability: kind and symmetry of the critical point

 private:
  // nothing where the mesh does not balance
  std::optional<StabilityReport> report_of(const StepRecord& record);
  std::optional<StabilityReport> report_of_point(const StepRecord& record);
  bool breaking_at(bool at_end) const;
  bool follows_states() const;
  void take_losses(const StepRecord& record, const BodyState* state);

  Run& run_;
  struct Asked {
    StabilityCheck when;
    LocateCritical locate;
    OnUnstable on_unstable;
    bool breaking_at_each_step;  // movements that break the symmetry, not at the end only
  };
  Asked asked_;
  std::optional<Increment> mesh_;  // of a homogeneous body, whose stability is that of its mesh
  std::optional<SymmetryBreaking> breaking_;
  StabilityWatch stability_;
  ResultWatch result_;
  std::optional<ContactWatch> contact_;
  std::string unstable_, last_said_;

  CriticalSearch search_;
  int n_indefinite_ = 0;  // tangents of iterations up to the last state
  TurningPoints turning_;
  LossWatch losses_;
};

}  // namespace langer
