// Whether the states of a run can be believed, as its config asks: stability, contact on the whole
// surface, rounding and locking.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "accuracy/checks/contact_watch.hpp"
#include "accuracy/checks/result_watch.hpp"
#include "accuracy/checks/stability_watch.hpp"
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

  // of a mesh that a hexahedron stands for, where its stability is looked at; else nullptr
  const Statics* of_mesh() const { return mesh_ ? &*mesh_ : nullptr; }

  const std::string& unstable() const { return unstable_; }  // why the path ended
  const std::string& last_said() const {
    return last_said_;
  }  // of the last state's stability; empty where it is stable

  std::vector<std::string> warnings() const;
  // at the end of the path; throws Failure(config) where a facet is entered and no force said
  std::vector<std::string> contact_warnings() const;
  std::vector<Summary> contact_summary() const;
  std::vector<Summary> stability_summary() const;

 private:
  std::optional<StabilityReport> looked(
      const StepRecord& record);  // nothing where the mesh does not balance

  Run& run_;
  std::optional<Statics> mesh_;
  StabilityCheck when_;
  OnUnstable on_unstable_;
  StabilityWatch stability_;
  ResultWatch result_;
  std::optional<ContactWatch> contact_;
  std::string unstable_, last_said_;
};

}  // namespace langer
