// What Morris and Sobol share: models for several threads, points of a group taken together,
// intervals from resampling.
//   rows are parameters, columns are points of the curve
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "identification/sensitivity/one_at_a_time.hpp"

namespace langer {

using CurveMaker = std::function<ParametricCurve()>;  // a model of its own for each thread

struct Estimate {
  MatX value, low, high;  // 95 % between low and high
};

enum class Sequence { sobol, random };
constexpr auto names(Sequence) { return std::array{"sobol", "random"}; }

struct SamplingOptions {
  std::uint64_t seed = 1;
  Sequence sequence = Sequence::sobol;   // of Sobol's samples
  int threads = 1;                       // changes nothing but the time
  int resamples = 500;                   // of the bootstrap
  std::vector<std::vector<int>> groups;  // points taken together, such as those of a zone of strain
  std::function<void(double)> progress;  // is called with the part done, 0 to 1
};

// the points between the ends of each zone, as zone_means takes them
std::vector<std::vector<int>> points_in(const std::vector<double>& x,
                                        const std::vector<Zone>& zones);

// Percentiles 2.5 and 97.5 over resamples, entry by entry; NaN entries are left out.
class Resamples {
 public:
  void add(const MatX& estimate) { all_.push_back(estimate); }
  Estimate around(const MatX& value) const;

 private:
  std::vector<MatX> all_;
};

}  // namespace langer
