// All checks of the states of a run, as its config asks for them: stability (stability_watch.hpp,
// critical_point.hpp), contact on the whole surface (contact_watch.hpp), rounding and locking
// (result_watch.hpp). A run calls it after every increment.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/checks/contact_watch.hpp"
#include "accuracy/checks/critical_point.hpp"
#include "accuracy/checks/free_surface.hpp"
#include "accuracy/checks/result_watch.hpp"
#include "accuracy/checks/stability_watch.hpp"
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
  const Statics* of_mesh() const {
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
  const std::optional<CriticalPoint>& critical() const { return critical_; }
  void know(CriticalPoint point) { critical_ = std::move(point); }  // where the path leaves another

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
  void take_state(StateOnPath state, bool doubtful);
  void take_jump(const StateOnPath& state, bool doubtful);
  void take_turning(const StepRecord& record);
  bool kink_between(double from, double to) const;
  void take_losses(const StepRecord& record);
  void take_surface(const StepRecord& record, const BodyState& state);
  void take_support(const StepRecord& record);
  void locate_bifurcation(const RunEnd& end);
  void search_jump();
  std::optional<CriticalPoint> support_lost(const RunEnd& end) const;

  Run& run_;
  StabilityCheck when_;
  OnUnstable on_unstable_;
  bool breaking_at_each_step_;   // movements that break the symmetry, not at the end only
  std::optional<Statics> mesh_;  // of a homogeneous body, whose stability is that of its mesh
  std::optional<SymmetryBreaking> breaking_;
  StabilityWatch stability_;
  ResultWatch result_;
  std::optional<ContactWatch> contact_;
  std::string unstable_, last_said_;

  // The last two states, and the first three of which the last has more negative eigenvalues.
  LocateCritical locate_;
  std::optional<StateOnPath> before_, last_;
  struct Crossing {
    StateOnPath before, first, last;
  };
  struct Suspect {
    Crossing states;
    double faster = 0;  // rate of the movement, relative to that of the increment before
  };
  std::optional<Crossing> crossing_;
  // Three states, of which the last is far from the others: near a limit point the movement grows
  // without a jump, so the first suspect need not be the jump.
  std::vector<Suspect> suspects_;
  std::optional<Crossing> jump_;  // that of the suspects which the search has confirmed
  int n_indefinite_ = 0;          // tangents of iterations up to the last state
  std::optional<CriticalPoint> critical_;
  // A load that is a result has an extremum: a limit point of it.
  struct Turning {
    std::string name, unit;
    double t = 0, value = 0;
    bool greatest = false;
  };
  std::vector<Turning> turnings_;
  struct Sample {
    double t = 0, value = 0;
  };
  std::map<std::string, std::vector<Sample>> samples_;  // the last two, by name

  // The first steps in which something is lost, known to an increment: strong ellipticity in a
  // point, the surface condition at a free face, stability.
  std::optional<CriticalPoint> material_lost_, surface_lost_, stability_lost_;
  std::optional<FreeSurface> surface_;
  double t_looked_ = 0;  // of the step before
  std::optional<Sample> stiffness_before_, margin_before_;
  static void move_to_root(CriticalPoint& point, const std::optional<Sample>& before,
                           const Sample& now);
  std::vector<Sample> support_;  // sum of all contact reactions in the last two steps [N]
};

}  // namespace langer
