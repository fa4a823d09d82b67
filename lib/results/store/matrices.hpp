// Matrices and vectors of Eigen as datasets, row by row, each with its unit.
#pragma once

#include <Eigen/Dense>
#include <span>
#include <string>
#include <vector>

#include "core/hdf5/h5.hpp"
#include "core/tensor/types.hpp"

namespace langer {

inline void write_matrix(const h5::Group& group, const std::string& name, const MatX& A,
                         const std::string& unit) {
  const Eigen::Matrix<double, -1, -1, Eigen::RowMajor> rows = A;
  group.write<double>(name,
                      {static_cast<std::size_t>(A.rows()), static_cast<std::size_t>(A.cols())},
                      std::span(rows.data(), static_cast<std::size_t>(rows.size())), unit);
}

inline void write_vector(const h5::Group& group, const std::string& name,
                         const std::vector<double>& x, const std::string& unit) {
  group.write<double>(name, {x.size()}, x, unit);
}

inline void write_vector(const h5::Group& group, const std::string& name, const VecX& x,
                         const std::string& unit) {
  const auto n = static_cast<std::size_t>(x.size());
  group.write<double>(name, {n}, std::span(x.data(), n), unit);
}

}  // namespace langer
