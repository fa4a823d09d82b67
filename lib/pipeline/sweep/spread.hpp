// The uncertainty of results from the uncertainty of fitted parameters, by Monte Carlo sampling.
//
// A sweep solves the same scene with many sets of parameters, drawn from the covariance of the fit.
// The results of its members have
//   mean, deviation        mean and standard deviation
//   low, high              percentiles 2.5 and 97.5
//   without p_j            deviation sqrt(1 - r_j^2), with r_j the correlation of the result with
//                          p_j: the standard deviation that would remain if p_j were known
// The method has no assumption of linearity, so it checks the linear band of
// inverse/uncertainty.hpp, which needs derivatives only.
#pragma once

#include <string>
#include <vector>

#include "core/hdf5/h5.hpp"
#include "pipeline/sweep/gather.hpp"
#include "pipeline/sweep/sweep_figure.hpp"

namespace langer {

// Mean, standard deviation, 95 % interval and the important parameters of one quantity.
struct Spread {
  std::string name, unit;
  double mean = 0, deviation = 0, low = 0, high = 0;
  struct Part {
    std::string name;
    double without = 0;
  };
  std::vector<Part> parts = {};  // by rising `without`: the most important parameter first
};

// The columns parameter_<name> of all members, one for each parameter that varies.
std::vector<SweepColumn> sampled_parameters(const std::vector<std::vector<Summary>>& sets);
// The spread of one column. Members without a value (NaN) are left out; with less than two values
// the spread is NaN.
Spread spread_of(const SweepColumn& column, const std::vector<SweepColumn>& parameters);
std::string spread_csv(const std::vector<Spread>& all);
// "force 0.31 N +- 24 % (parameters), 95 % in 0.2 to 0.4; 5.1 % if c1 were known"
std::string in_words(const Spread& spread);

// The band of a curve at each x of the first member. The curves of the others are interpolated
// between their rows.
Band band_of(const std::string& figure, const std::vector<const Column*>& x,
             const std::vector<const Column*>& y);

// Writes
//   /spread/<quantity>/{mean, deviation, interval, without}, with the attribute `order`: the
//                      parameters
//   /bands/<figure>_<y>/{x, mean, deviation, interval}, with the attributes x and y: their names
void write_spread(const h5::Group& root, const std::vector<Spread>& all,
                  const std::vector<Band>& bands);

}  // namespace langer
