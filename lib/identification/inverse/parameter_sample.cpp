#include "identification/inverse/parameter_sample.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/random.hpp"
#include "core/base/text.hpp"
#include "core/tensor/dense.hpp"
#include "identification/population/untested_specimen.hpp"
#include "mechanics/material/parameters.hpp"

namespace langer {

namespace {

// The parameters whose variance the fit knows.
std::vector<Eigen::Index> with_variance(const FitRecord& fit) {
  std::vector<Eigen::Index> known;
  for (Eigen::Index i = 0; i < fit.covariance.rows(); ++i)
    if (std::isfinite(fit.covariance(i, i)) && fit.covariance(i, i) > 0) known.push_back(i);
  return known;
}

// Draw number `number` of the normal distribution of the parameters, put into their bounds. The
// same number always gives the same draw.
VecX drawn(const FitRecord& fit, int number) {
  VecX p(static_cast<Eigen::Index>(fit.parameters.size()));
  for (std::size_t i = 0; i < fit.parameters.size(); ++i)
    p[static_cast<Eigen::Index>(i)] = fit.parameters[i].value;
  const std::vector<Eigen::Index> open = with_variance(fit);
  Random random(1, static_cast<std::uint64_t>(number));
  VecX z(static_cast<Eigen::Index>(open.size()));
  for (double& one : z) one = random.normal();
  const VecX d = covariance_root(fit.covariance(open, open)) * z;
  for (std::size_t k = 0; k < open.size(); ++k) {
    const FittedParameter& of = fit.parameters[static_cast<std::size_t>(open[k])];
    p[open[k]] = std::clamp(p[open[k]] + d[static_cast<Eigen::Index>(k)], of.lower, of.upper);
  }
  return p;
}

}  // namespace

std::string reason_without_samples(const MaterialFile& file, int number) {
  if (!file.fit) return "no fit";
  if (file.fit->population) return "";
  if (file.fit->sets.rows() > 0) {
    if (number <= file.fit->sets.rows()) return "";
    return fmt::format("{} sets", file.fit->sets.rows());
  }
  if (with_variance(*file.fit).empty()) {
    return "a fit without standard errors of its parameters";
  }
  return "";
}

// A bootstrap set of the fit if it has some, else a draw from its covariance.
ParameterSample sample_of(const MaterialFile& file, int number) {
  const FitRecord& fit = *file.fit;
  VecX p;
  if (fit.population) {
    Random random(1, static_cast<std::uint64_t>(number));
    p = UntestedSpecimens(*fit.population).draw(random);
  } else if (fit.sets.rows() > 0) {
    p = fit.sets.row(number - 1).transpose();
  } else {
    p = drawn(fit, number);
  }
  ParameterSample sample{file.material, {}, ""};
  const std::vector<MaterialParameter> numbers = parameters(sample.law);
  for (std::size_t i = 0; i < fit.parameters.size(); ++i)
    for (const MaterialParameter& one : numbers) {
      if (one.name != fit.parameters[i].name) continue;
      *one.value = p[static_cast<Eigen::Index>(i)];
      sample.values.push_back({"parameter_" + one.name, *one.value, one.unit});
      std::string unit;
      if (one.unit != unit::none) unit = " " + one.unit;
      append(sample.words, ", ", fmt::format("{} = {:.5g}{}", one.name, *one.value, unit));
    }
  TiedNumbers(sample.law, resolved(fit.ties).ties).follow();
  if (fit.population) {
    sample.words = fmt::format("specimen {} of the population: {}", number, sample.words);
    return sample;
  }
  sample.words =
      fmt::format("parameters {} of those that the fit leaves open: {}", number, sample.words);
  return sample;
}

}  // namespace langer
