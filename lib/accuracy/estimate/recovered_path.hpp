// Error bars of a run without a second solution, on any mesh: `estimate: recovery`, and the default
// of bodies to which it applies.
//
// Stresses of finite elements jump from element to element. A smooth field through their averages
// at the nodes is more accurate [ZZ87], and the energy of the difference estimates the error:
//   a force under prescribed movements is too large by about the share of the energy that the
//   difference holds (results/post/recovery.hpp)
// Where stresses are singular (p = 1 in error_estimate.hpp) the bar is three times that. Added are
// effects that no stress shows:
//   cells       of nodes that stick where they touch, at least as in an estimate by refinement
//   scatter     of nodes that come into contact one by one
//   increments  with friction 0.04 of the force times the square of the longest increment's share
//               of the path: no estimate, but the largest effect in the refinement study
//               (docs/work_precision.md)
#pragma once

#include <memory>

#include "accuracy/checks/recording.hpp"
#include "accuracy/estimate/error_estimate.hpp"
#include "results/post/recovery.hpp"

namespace langer {

// Why these bars are not to be trusted for such a scene; empty where they are. Of layers of several
// materials they told a sixth of the error (make accuracy-random BARS=default).
std::string why_not_recovered(const Run& run);

// Whether a config without `estimate` gets them: also of moderate size, and nowhere of one cell's
// thickness.
bool recovered_by_default(const SolveConfig& config, const Run& run);

// Forces and greatest von Mises stress of a state. energy_share: of recovered_energy_share()
std::vector<ErrorEstimate> recovered_errors(const SolveConfig& config, const RecoveredError& error,
                                            const StepForces& forces,
                                            const std::vector<Valued>& found, double residual);

class RecoveredPath {
 public:
  // Refers to run; nobody follows it unless `wanted`.
  RecoveredPath(const Run& run, const SolveConfig& config, bool wanted);
  bool wanted() const { return body_ != nullptr; }
  Observer beside(Observer observer);
  // With an accuracy that is asked for, of_cells too; and nothing else where the bars are not to be
  // trusted. resolved: contact is, by the cells (accuracy/checks/contact_watch.hpp)
  PathErrors errors(const StepRecord& last, const std::vector<Valued>& found,
                    bool resolved = true) const;

 private:
  void look_at(const StepRecord& whole);
  bool unloaded() const;
  ErrorEstimate judged_step(const std::vector<ErrorEstimate>& steps,
                            const ErrorEstimate& last) const;
  std::vector<double> parts(const RecoveredError& error, const std::vector<ErrorEstimate>& errors,
                            const StepRecord& last) const;

  const Run& run_;
  SolveConfig config_;
  std::unique_ptr<Body> body_;
  std::vector<StepForces> path_;
  std::vector<double> residuals_;
  std::vector<std::pair<double, double>> shares_;  // t before the end, of the energy
};

}  // namespace langer
