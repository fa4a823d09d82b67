// Increments of a viscous body: the branch stresses at its Gauss points, from one accepted state to
// the next (element/viscous_points.hpp). An elastic body has none of this, and every function is
// then without effect.
//   begin(seconds)   the history stress H of the increment, which every assembly adds
//   end(u)           branch stresses at the displacements found; returns the error of the time step
//   accept(u0, u)    the state found becomes the one that the next increment begins with
#pragma once

#include <functional>
#include <optional>

#include "mechanics/assembly/body_model.hpp"
#include "mechanics/element/viscous_points.hpp"

namespace langer {

class ViscousState {
 public:
  explicit ViscousState(const BodyModel& body);  // refers to the body

  bool present() const { return points_.has_value(); }
  // True if element e has viscous branches.
  bool present(int e) const { return points_ && points_->has(e); }
  const std::optional<ViscousPoints>& points() const { return points_; }

  void begin(double seconds);
  // Small movements away from the accepted state: each branch answers with `follow` of its
  // isochoric stress, and what it bears there stays.
  void begin_small_movements(const std::function<double(const ViscousBranch&)>& follow);
  double end(const VecX& u);
  void accept(const VecX& u0, const VecX& u);
  double work() const;  // integral of the branch stresses over the strain since rest [N mm]

 private:
  const BodyModel& body_;
  std::optional<ViscousPoints> points_;
};

}  // namespace langer
