// The branch stresses of a viscous body along its path. The solution does not store them: they are
// computed again from the displacements, step after step (element/viscous_points.hpp).
#pragma once

#include "results/post/nodal_fields.hpp"

namespace langer {

// Follows the branches of all Gauss points from rest. States must be added in the order of the
// path, all of them, because each step depends on the one before.
class ViscousPath {
 public:
  explicit ViscousPath(const Body& body);  // at rest
  // Adds the step after the last one: u (n) [mm] at `time` [s].
  void add(const Body& body, double time, const std::vector<Vec3>& u);
  // Gives the body its present branch stresses.
  void update(Body& body) const;

 private:
  ViscousPoints points_;
  double time_ = 0;
  std::vector<Vec3> u_;
};

}  // namespace langer
