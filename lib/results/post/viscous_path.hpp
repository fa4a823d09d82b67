// The branch stresses of a viscous body's states, from the displacements of its steps one after
// another (element/viscous_points.hpp).
#pragma once

#include "results/post/nodal_fields.hpp"

namespace langer {

class ViscousPath {
 public:
  explicit ViscousPath(const Body& body);  // at rest
  // the step after the last one: u (n) [mm] at `time` [s]
  void add(const Body& body, double time, const std::vector<Vec3>& u);
  void tell(Body& body) const;  // its branch stresses now

 private:
  ViscousPoints points_;
  double time_ = 0;
  std::vector<Vec3> u_;
};

}  // namespace langer
