// The branch stresses of one viscous point along a homogeneous test (material/viscous.hpp).
#pragma once

#include <span>
#include <vector>

#include "mechanics/material/material.hpp"

namespace langer {

// What branches add to an increment: S = matrix S_matrix + fibres S_fibres + H
struct PointMemory {
  Amplified amplified;
  Vec6 H = Vec6::Zero();
};

// of the increment: a potential W of S, not the stored energy;  W = matrix W_matrix + fibres
// W_fibres + H : E,  D = 4 d2W/dC2
Response incremental(const Material& material, const Mat3& C, std::span<const Vec3> a,
                     const PointMemory& memory, bool with_tangent = true);

class ViscousPoint {
 public:
  ViscousPoint(const Material& material,
               std::vector<Vec3> fibres);  // at rest; refers to the material
  PointMemory begin(double seconds);       // an increment
  void accept(const Mat3& F);              // its end
  Vec6 branches() const;                   // sum Q_i [MPa]

 private:
  const Material& material_;
  std::vector<Vec3> a_;
  std::vector<ViscousBranch> branches_;
  std::vector<BranchStep> steps_;
  std::vector<Vec6> Q_, S_;  // of each branch
};

}  // namespace langer
