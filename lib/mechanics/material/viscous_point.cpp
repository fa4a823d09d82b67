#include "mechanics/material/viscous_point.hpp"

#include "core/tensor/kinematics.hpp"

namespace langer {

ViscousPoint::ViscousPoint(const Material& material, std::vector<Vec3> fibres)
    : material_(material),
      a_(std::move(fibres)),
      branches_(branches_of(material)),
      Q_(branches_.size(), Vec6::Zero()),
      S_(branches_.size(), Vec6::Zero()) {}

PointMemory ViscousPoint::begin(double seconds) {
  PointMemory memory;
  steps_.clear();
  for (std::size_t i = 0; i < branches_.size(); ++i) {
    const BranchStep step = branch_step(branches_[i], seconds);
    amplify(memory.amplified, branches_[i].of, step.follow);
    memory.H += step.keep * Q_[i] - step.follow * S_[i];
    steps_.push_back(step);
  }
  return memory;
}

void ViscousPoint::accept(const Mat3& F) {
  const Mat3 C = right_cauchy_green(F);
  Vec6 of[3];  // BranchOf
  for (const BranchOf kind : {BranchOf::all, BranchOf::matrix, BranchOf::fibres})
    of[static_cast<std::size_t>(kind)] = isochoric(material_, C, a_, only(kind), false).S;
  for (std::size_t i = 0; i < branches_.size(); ++i) {
    const Vec6& S = of[static_cast<std::size_t>(branches_[i].of)];
    Q_[i] = steps_[i].keep * Q_[i] + steps_[i].follow * (S - S_[i]);
    S_[i] = S;
  }
}

Vec6 ViscousPoint::branches() const {
  Vec6 sum = Vec6::Zero();
  for (const Vec6& Q : Q_) sum += Q;
  return sum;
}

}  // namespace langer
