#include "results/store/population_record.hpp"

#include <fmt/format.h>

#include <sstream>

#include "results/store/matrices.hpp"

namespace langer {

namespace {

std::vector<std::string> lines_in(const h5::Group& group, const std::string& attribute) {
  std::vector<std::string> lines;
  std::istringstream in(group.text_attribute(attribute));
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

MatX square(const h5::Group& group, const std::string& name, std::size_t n) {
  const std::vector<double> values = group.read_finite(name, {n, n});
  using Rows = Eigen::Matrix<double, -1, -1, Eigen::RowMajor>;
  const auto size = static_cast<Eigen::Index>(n);
  return Eigen::Map<const Rows>(values.data(), size, size);
}

}  // namespace

void write_population(const h5::Group& root, const PopulationRecord& population) {
  const h5::Group group = root.make_group("population");
  group.attribute("names", fmt::format("{}", fmt::join(population.names, "\n")));
  group.attribute("keys", fmt::format("{}", fmt::join(population.keys, "\n")));
  group.attribute("units", fmt::format("{}", fmt::join(population.units, "\n")));
  group.attribute("links", fmt::format("{}", fmt::join(population.links, "\n")));
  write_vector(group, "lower", population.lower, "");
  write_vector(group, "upper", population.upper, "");
  write_vector(group, "median", population.median, "");
  write_matrix(group, "scatter", population.scatter, "");
  write_matrix(group, "median_covariance", population.median_covariance, "");
  group.write_scalar("sigma", population.sigma);
}

PopulationRecord read_population(const h5::Group& root) {
  const h5::Group group = root.group("population");
  PopulationRecord population;
  population.names = lines_in(group, "names");
  population.keys = lines_in(group, "keys");
  population.units = lines_in(group, "units");
  population.links = lines_in(group, "links");
  const std::size_t n = population.names.size();
  if (population.keys.size() != n || population.units.size() != n || population.links.size() != n) {
    group.refuse("names", "attributes of different length", "one line for each parameter");
  }
  population.lower = group.read_finite("lower", {n});
  population.upper = group.read_finite("upper", {n});
  const std::vector<double> median = group.read_finite("median", {n});
  population.median = Eigen::Map<const VecX>(median.data(), static_cast<Eigen::Index>(n));
  population.scatter = square(group, "scatter", n);
  population.median_covariance = square(group, "median_covariance", n);
  population.sigma = group.read_scalar("sigma");
  return population;
}

}  // namespace langer
