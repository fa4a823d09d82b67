// Tells when a body leaves what its material is known for: the range of the tests it was fitted to, or strong ellipticity.
//   fitted range  Ī1 and each fibre's Ī4 up to the largest values in the tests; only where the material comes from a fit
//   ellipticity   looked at in the points beyond the radius within which every state is stable (material/stability.hpp)
#pragma once

#include <string>
#include <vector>

#include "assembly/equilibrium.hpp"
#include "solve/statics.hpp"
#include "store/study_record.hpp"

namespace langer {

StudyRecord study_from(const std::string& material_file);  // nothing in a YAML file

class RangeWatch {
 public:
  explicit RangeWatch(StudyRecord study) : study_(std::move(study)) {}
  void look(const Equilibrium& body, const BodyState& state);  // each accepted step: when the fitted range is left
  // of the last state: how much of the volume is outside, how far, where
  std::vector<std::string> warnings(const Equilibrium& body, const BodyState& state) const;

 private:
  StudyRecord study_;
  double left_at_ = -1;  // t of the first step outside the fitted range
};

}  // namespace langer
