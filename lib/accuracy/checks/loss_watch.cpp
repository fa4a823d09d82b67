#include "accuracy/checks/loss_watch.hpp"

#include <algorithm>
#include <cmath>

namespace langer {

// Where the line between two values, the second of which is negative, is 0. The load factor moves
// with t where it is t.
void LossWatch::move_to_root(CriticalPoint& point, const std::optional<Sample>& before,
                             const Sample& now) {
  if (!before || !(before->value > 0) || !std::isfinite(now.value)) return;
  const bool same = point.load_factor == point.t;
  point.t -= (now.t - before->t) * now.value / (now.value - before->value);
  if (same) point.load_factor = point.t;
}

void LossWatch::take(const StepRecord& record) {
  const auto value = [&](const char* name) {
    const auto found = record.scalars.find(name);
    return found == record.scalars.end() ? 0 : found->second;
  };
  const double stiffness = value("shear_stiffness_min");
  if (!material_ && stiffness < 0) {
    const Vec3 place(value("weakest_x"), value("weakest_y"), value("weakest_z"));
    material_ = point_between("loss of strong ellipticity", t_before_, record, place);
    move_to_root(*material_, stiffness_before_, {record.t, stiffness});
  }
  stiffness_before_ = Sample{record.t, stiffness};
  if (!stability_ && value("negative_eigenvalues") != 0)
    stability_ = point_between("loss of stability", t_before_, record);
  t_before_ = record.t;
  take_support(record);
}

void LossWatch::take_surface(const StepRecord& record, const BodyState& state, Run& run) {
  if (crease_) return;
  if (!surface_) surface_.emplace(run.body, run.reduction.scene().loads);
  const auto found = surface_->weakest(run.body, state, run.increment.contacts());
  if (found && found->margin < 0) {
    crease_ = point_between("crease", t_before_, record, found->place);
    move_to_root(*crease_, margin_before_, {record.t, found->margin});
  }
  margin_before_.reset();
  if (found) margin_before_ = Sample{record.t, found->margin};
}

void LossWatch::take_support(const StepRecord& record) {
  if (record.contacts.empty()) return;
  double pressed = 0;
  for (const auto& [name, contact] : record.contacts)
    for (const Vec3& r : contact.r) pressed += r.norm();
  support_.push_back({record.t, pressed});
  if (support_.size() > 2) support_.erase(support_.begin());
}

// By the line through the last two states.
std::optional<CriticalPoint> LossWatch::support(const RunEnd& end, double smallest) const {
  if (end.at != RunEnd::At::no_equilibrium || support_.empty()) return std::nullopt;
  const Sample& last = support_.back();
  double t = last.t;
  if (last.value > 0) {
    if (support_.size() < 2) return std::nullopt;
    const Sample& before = support_.front();
    const double fall = (before.value - last.value) / (last.t - before.t);
    if (!(fall > 0)) return std::nullopt;
    t = last.t + last.value / fall;
    const double increment = last.t - before.t;
    if (t - last.t > 2 * std::max(increment, smallest)) return std::nullopt;
  }
  CriticalPoint point;
  point.kind = "loss of support";
  point.t = point.load_factor = t;
  point.within = t - last.t;
  return point;
}

}  // namespace langer
