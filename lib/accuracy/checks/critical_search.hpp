// Which increments of a run may hold a critical point, and the search in them
// (checks/critical_point.hpp). It keeps the last two states of the path, the increment in which the
// number of negative eigenvalues grows, and those in which the run may have jumped.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "accuracy/checks/critical_point.hpp"
#include "scene/run/run.hpp"

namespace langer {

class CriticalSearch {
 public:
  explicit CriticalSearch(Run& run) : run_(run) {}  // refers to the run

  // One state after the other. doubtful: tangents of the increment were not positive definite, or
  // nothing is known of them
  void take(StateOnPath state, bool doubtful);
  // The first suspect that is a jump, unless an earlier critical point is known.
  void search_jump();
  // breaking: movements that break the symmetry of a reduced body are counted
  void search_bifurcation(const RunEnd& end, bool breaking);

  const std::optional<CriticalPoint>& found() const { return found_; }
  void know(CriticalPoint point) { found_ = std::move(point); }
  bool jumped() const { return jump_.has_value(); }
  std::string jump_in_words() const;

 private:
  struct Crossing {  // the last two states before it, and the one after
    StateOnPath before, first, last;
  };
  struct Suspect {
    Crossing states;
    double faster = 0;  // rate of the movement, relative to that of the increment before
  };
  void take_jump(const StateOnPath& state, bool doubtful);

  Run& run_;
  std::optional<StateOnPath> before_, last_;
  std::optional<Crossing> crossing_;  // the first one with more negative eigenvalues
  // The last state is far from the others: near a limit point the movement grows without a jump, so
  // the first suspect need not be the jump.
  std::vector<Suspect> suspects_;
  std::optional<Crossing> jump_;  // that of the suspects which the search has confirmed
  std::optional<CriticalPoint> found_;
};

}  // namespace langer
