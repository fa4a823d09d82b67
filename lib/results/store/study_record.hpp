// The identifiability of a fit and the stability of its material in material.h5. docs/schema.md
//   /identifiability/{noise, residual_correlation, effective_values, error, correlation, singular,
//                     combination}
//                     attribute `words`: the combination in words
//   /identifiability/profiles/<name>/{value, rise, interval}
//                     attributes low_open, high_open
//   /identifiability/bootstrap/{samples, interval}
//   /identifiability/advice/{worst, gain, relative}
//                     attribute `tests`
//   /stability/{amount, angle, stretch, plane, safe_hencky, hencky_end, slope_loss,
//               ellipticity_loss, end, nominal, slope, ellipticity}
//                     attribute `verdict`
//   /fitted_range/{I1_bar, I4_bar}
//                     largest values that the tests reach
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/hdf5/h5.hpp"
#include "core/tensor/types.hpp"
#include "mechanics/material/stability.hpp"

namespace langer {

// The profile of chi-squared along one parameter, and its 95 % interval; an end is open if the
// profile does not reach the limit there.
struct ProfileRecord {
  std::vector<double> value, rise;
  double low = 0, high = 0;
  bool low_open = false, high_open = false;
};

// A further test and by how much it would reduce the standard errors.
struct AdviceRecord {
  std::string test;
  double worst = 0, gain = 0;
  std::vector<double> relative;
};

// What the data of a fit determine about its parameters, in the order of `names`.
struct IdentifiabilityRecord {
  std::vector<std::string> names;
  std::vector<double> value, size;
  double noise = 0;
  double rho = 0;               // correlation of residuals from value to value
  double effective = 0;         // number of independent values that they count as
  std::vector<bool> symmetric;  // angles of symmetry, which have no standard error
  VecX error, singular;
  MatX correlation, combination;
  std::string words;  // description of the least identifiable combination
  std::vector<ProfileRecord> profiles;
  MatX bootstrap;  // (n, p)
  // The bootstrap is that of the linearised model; noise is in standard deviations of the tests.
  bool linearised = false;
  VecX bootstrap_low, bootstrap_high;
  std::vector<AdviceRecord> advice;
};

// The stability map of the material and its verdict in words.
struct StabilityRecord {
  StabilityMap map;
  std::string verdict;
};

// The largest invariants in the tests: a body beyond them is outside the data of the fit.
struct FittedRange {
  double I1_bar = 0;
  std::vector<double> I4_bar;  // of each fibre family
};

// The parts of a study; those that were not asked for are empty.
struct StudyRecord {
  std::optional<IdentifiabilityRecord> identifiability;
  std::optional<StabilityRecord> stability;
  std::optional<FittedRange> range;
};

void write_study(const h5::Group& root, const StudyRecord& study);
// Reads the range, the verdict and safe_hencky alone, which other stages need.
StudyRecord read_study(const h5::Group& root);

}  // namespace langer
