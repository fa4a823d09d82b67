// What a fit leaves open in results, from a sweep over sets of its parameters: spread of each
// quantity, which parameter it comes from, and bands of curves. Beside the linear band
// (inverse/uncertainty.hpp), which it checks.
//   deviation, mean        of the members
//   low, high              percentiles 2.5 and 97.5
//   without p_j            deviation sqrt(1 - r_j^2), r_j the correlation with p_j: what would be left if p_j were known
#pragma once

#include <string>
#include <vector>

#include "core/hdf5/h5.hpp"
#include "pipeline/sweep/gather.hpp"
#include "pipeline/sweep/sweep_figure.hpp"

namespace langer {

struct Spread {
  std::string name, unit;
  double mean = 0, deviation = 0, low = 0, high = 0;
  struct Part {
    std::string name;
    double without = 0;
  };
  std::vector<Part> parts = {};  // the one that would help most first
};

// Columns parameter_<name>, one for each that varies: what each member's set says.
std::vector<SweepColumn> sampled_parameters(const std::vector<std::vector<Summary>>& sets);
// of a column with two values at least; NaN are left out
Spread spread_of(const SweepColumn& column, const std::vector<SweepColumn>& parameters);
std::string spread_csv(const std::vector<Spread>& all);
std::string in_words(
    const Spread& spread);  // "force 0.31 N +- 24 %, 95 % in 0.2 to 0.4; 5.1 % if c1 were known"

// at each x of the first member, the others read between their rows
Band band_of(const std::string& figure, const std::vector<const Column*>& x,
             const std::vector<const Column*>& y);

// /spread/<quantity>/{mean, deviation, interval, without}, attribute `order` of each: the
// parameters /bands/<figure>_<y>/{x, mean, deviation, interval}, attributes x, y of each: their
// names
void write_spread(const h5::Group& root, const std::vector<Spread>& all,
                  const std::vector<Band>& bands);

}  // namespace langer
