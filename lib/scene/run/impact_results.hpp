// What an impact leaves behind: contact time, greatest force and restitution, from the states of a
// path.
//   contact_time   from the first touch to the last parting: the smallest gap of two states without
//                  contact is followed to 0. The force near a touch is no straight line: that of a
//                  sphere grows with the power 3/2 of its travel
//   peak_force     greatest force of all indenters on the body
//   restitution    of an indenter with mass: its speed after the last parting over that at the first
//                  touch; of a thrown body the same of its momentum along the whole impulse, and of
//                  two bodies of the velocity between their centres
// Where deformable surfaces touch, the force is that between them, of several pairs the sum.
// Nothing is said of a path without contact, or that ends in contact (but its peak force).
// Where a run has derivatives (key `sensitivity`), those of the peak force and of the restitution
// of an indenter with mass are results, too: d_peak_force_d_<number>. The peak force is that of a
// step, so its derivative is that of the force there.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "results/store/provenance.hpp"
#include "scene/run/run.hpp"

namespace langer {

class ImpactResults {
 public:
  // inertia: of the run; without it the restitution of two bodies is not known
  ImpactResults(const Scene& scene, const Inertia* inertia);
  void add(const StepRecord& step);  // in the order of the path
  std::vector<Summary> summary() const;

 private:
  struct State {
    double time = 0, force = 0, speed = 0;
    double gap = 0;  // the smallest of all candidates [mm]
    Vec3 momentum = Vec3::Zero();
    Vec3 separation = Vec3::Zero();  // velocity of the first of two bodies from the second [mm/s]
    std::map<std::string, double> d_force, d_speed;  // by number
  };
  double touch_time(std::size_t first) const;
  double parting_time(std::size_t last) const;
  double restitution(std::size_t first, std::size_t last) const;
  void add_derivatives(std::size_t peak, std::size_t first, std::size_t last,
                       std::vector<Summary>& out) const;
  std::vector<State> states_;
  std::vector<std::string> surfaces_;                 // names of pairs of deformable surfaces
  std::vector<std::pair<std::string, double>> pair_;  // two bodies and their masses [t]; else empty
  bool moves_ = false, free_ = false;
};

}  // namespace langer
