// The parameters of a material by their YAML path: matrix.yeoh.a1, fibres[0].hgo.c1,
// fibres[0].alpha, volume.quadratic.d. If a matrix term occurs twice, the path has its index:
// matrix[1].yeoh.a1. Fits and sensitivity analyses choose their parameters from this list.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/search_bounds.hpp"
#include "mechanics/material/material.hpp"

namespace langer {

struct MaterialParameter {
  std::string key;   // path
  std::string name;  // last word of the path, with a number if it occurs again: a1, c1, alpha,
                     // c1_2; exp_pow_alpha to distinguish it from the angle alpha
  std::string unit;
  Range range;  // that the law allows
  double* value = nullptr;
  std::optional<SearchBounds> search;  // of a fit, where they do not follow from the unit
  std::string sign_of;                 // path of a number whose sign an admissible value has

  // of matrix or fibres: the energy of a state and its stress are linear in it
  bool modulus() const { return unit == langer::unit::MPa && !key.starts_with("volume."); }
};

// pointers into `material`, in the order of its listing
std::vector<MaterialParameter> parameters(Material& material);

}  // namespace langer
