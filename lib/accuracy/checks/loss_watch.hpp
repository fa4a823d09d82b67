// Verdicts that need no search along the path: the first steps in which a body loses strong
// ellipticity in a point, the surface condition at a free face (a crease), stability, or its
// support. Each is known to an increment.
#pragma once

#include <optional>
#include <vector>

#include "accuracy/checks/critical_point.hpp"
#include "accuracy/checks/free_surface.hpp"
#include "scene/run/run.hpp"

namespace langer {

class LossWatch {
 public:
  // One step after the other.
  void take(const StepRecord& record);
  // Of an elastic body. The condition is local: where it is violated, waves of any short length
  // grow, shorter than the elements can show.
  void take_surface(const StepRecord& record, const BodyState& state, Run& run);

  std::optional<CriticalPoint> material() const { return material_; }
  std::optional<CriticalPoint> surface() const { return crease_; }
  std::optional<CriticalPoint> stability() const { return stability_; }
  // A body that contact alone restrains: its reactions fall to 0 within what is left of the path
  // after the last state. smallest: increment of the path
  std::optional<CriticalPoint> support(const RunEnd& end, double smallest) const;

 private:
  struct Sample {
    double t = 0, value = 0;
  };
  static void move_to_root(CriticalPoint& point, const std::optional<Sample>& before,
                           const Sample& now);
  void take_support(const StepRecord& record);

  std::optional<CriticalPoint> material_, crease_, stability_;
  std::optional<FreeSurface> surface_;
  double t_before_ = 0;
  std::optional<Sample> stiffness_before_, margin_before_;
  std::vector<Sample> support_;  // sum of all contact reactions in the last two steps [N]
};

}  // namespace langer
