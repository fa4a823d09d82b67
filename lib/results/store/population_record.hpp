// What is known of a population of specimens: how their parameters scatter.
//   phi = link(parameter),   phi of a specimen ~ N(median, scatter)
//   /population/{median, scatter, median_covariance, sigma, lower, upper}
//                     attributes `names`, `keys`, `units`, `links`: one a line, in the order of the
//                     parameters
#pragma once

#include <string>
#include <vector>

#include "core/hdf5/h5.hpp"
#include "core/tensor/types.hpp"

namespace langer {

struct PopulationRecord {
  std::vector<std::string> names, keys, units, links;  // links: identity, log, logit
  std::vector<double> lower, upper;                    // of logit
  VecX median;                                         // phi
  MatX scatter;                                        // Omega
  MatX median_covariance;                              // of `median`
  double sigma = 0;                                    // of one weighted value
};

void write_population(const h5::Group& root, const PopulationRecord& population);
PopulationRecord read_population(const h5::Group& root);

}  // namespace langer
