#include "identification/population/untested_specimen.hpp"

#include "core/tensor/dense.hpp"

namespace langer {

Link link_of(const PopulationRecord& population, std::size_t at) {
  Link link;
  link.lower = population.lower[at];
  link.upper = population.upper[at];
  for (const LinkKind kind : {LinkKind::identity, LinkKind::log, LinkKind::logit})
    if (population.links[at] == names(kind)[static_cast<std::size_t>(kind)]) link.kind = kind;
  return link;
}

MatX covariance_of_untested(const PopulationRecord& population) {
  return population.scatter + population.median_covariance;
}

UntestedSpecimens::UntestedSpecimens(const PopulationRecord& population)
    : median_(population.median), root_(covariance_root(covariance_of_untested(population))) {
  for (std::size_t i = 0; i < population.links.size(); ++i)
    links_.push_back(link_of(population, i));
}

VecX UntestedSpecimens::backward(const VecX& phi) const {
  VecX numbers(phi.size());
  for (Eigen::Index i = 0; i < phi.size(); ++i)
    numbers[i] = links_[static_cast<std::size_t>(i)].backward(phi[i]);
  return numbers;
}

VecX UntestedSpecimens::median() const { return backward(median_); }

VecX UntestedSpecimens::draw(Random& random) const {
  VecX z(median_.size());
  for (double& one : z) one = random.normal();
  return backward(median_ + root_ * z);
}

}  // namespace langer
