// A specimen that was not tested, as a population foretells it: normal on the scale of the links,
//   phi ~ N(median, scatter between specimens + covariance of the median)
#pragma once

#include "core/base/random.hpp"
#include "identification/population/link.hpp"
#include "results/store/material_file.hpp"

namespace langer {

Link link_of(const PopulationRecord& population, std::size_t at);
MatX covariance_of_untested(const PopulationRecord& population);  // (p, p), of phi

class UntestedSpecimens {
 public:
  explicit UntestedSpecimens(const PopulationRecord& population);

  VecX median() const;              // (p) numbers of the median specimen
  VecX draw(Random& random) const;  // (p) numbers of one specimen

 private:
  VecX backward(const VecX& phi) const;

  std::vector<Link> links_;
  VecX median_;  // of phi
  MatX root_;    // R R^T is the covariance of phi
};

}  // namespace langer
