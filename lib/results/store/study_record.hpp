// What data tell about a fit, and where its law is stable, in material.h5. docs/schema.md
//   /identifiability/{noise, residual_correlation, effective_values, error, correlation, singular, combination}   attribute `words` of /identifiability
//   /identifiability/profiles/<name>/{value, rise, interval}   attributes low_open, high_open
//   /identifiability/bootstrap/{samples, interval}
//   /identifiability/advice/{worst, gain, relative}            attribute `tests`
//   /stability/{amount, angle, stretch, plane, safe_hencky, hencky_end, slope_loss, ellipticity_loss, end,
//              nominal, slope, ellipticity}                attribute `verdict`
//   /fitted_range/{I1_bar, I4_bar}                             largest values that the tests reach
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/hdf5/h5.hpp"
#include "core/tensor/types.hpp"
#include "mechanics/material/stability.hpp"

namespace langer {

struct ProfileRecord {
  std::vector<double> value, rise;
  double low = 0, high = 0;
  bool low_open = false, high_open = false;
};

struct AdviceRecord {
  std::string test;
  double worst = 0, gain = 0;
  std::vector<double> relative;
};

struct IdentifiabilityRecord {
  std::vector<std::string> names;
  std::vector<double> value, size;
  double noise = 0;
  double rho = 0, effective = 0;  // correlation of residuals from value to value; number of values
                                  // that they count as
  std::vector<bool> symmetric;    // angles of symmetry, which have no standard error
  VecX error, singular;
  MatX correlation, combination;
  std::string words;  // of the least felt combination
  std::vector<ProfileRecord> profiles;
  MatX bootstrap;           // (n, p)
  bool linearised = false;  // the bootstrap is that of the linearised model; noise is in standard
                            // deviations of the tests
  VecX bootstrap_low, bootstrap_high;
  std::vector<AdviceRecord> advice;
};

struct StabilityRecord {
  StabilityMap map;
  std::string verdict;
};

// The largest invariants in the tests: what a body may reach without leaving them.
struct FittedRange {
  double I1_bar = 0;
  std::vector<double> I4_bar;  // of each fibre family
};

struct StudyRecord {
  std::optional<IdentifiabilityRecord> identifiability;
  std::optional<StabilityRecord> stability;
  std::optional<FittedRange> range;
};

void write_study(const h5::Group& root, const StudyRecord& study);
// range and safe_hencky of the map alone: what other stages ask for
StudyRecord read_study(const h5::Group& root);

}  // namespace langer
