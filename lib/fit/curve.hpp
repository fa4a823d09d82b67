// A measured uniaxial curve, read from CSV by the names of its columns (fit/test_data.hpp).
#pragma once

#include <string>
#include <vector>

#include "fit/test_data.hpp"
#include "material/uniaxial.hpp"

namespace langer {

struct Curve {
  std::vector<double> strain;  // lambda - 1 [-]
  std::vector<double> stress;  // [MPa]
  StressMeasure measure = StressMeasure::cauchy;
  std::size_t size() const { return strain.size(); }
};

Curve read_curve(const std::string& path);                                  // throws Failure(input)
Curve parse_curve(const std::string& text, const std::string& shown_name);  // for tests
Test test_of(const Curve& curve, const std::string& name);

}  // namespace langer
