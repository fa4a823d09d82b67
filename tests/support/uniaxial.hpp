// One uniaxial curve, read and fitted: the paper's task.                                  [A23] eqs
// 35-36 A curve of one test along the fibre does not determine a fibre term: see the correlation.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "identification/fit/fit.hpp"
#include "mechanics/material/uniaxial.hpp"

namespace langer::test {

struct Curve {
  std::vector<double> strain;  // lambda - 1 [-]
  std::vector<double> stress;  // [MPa]
  StressMeasure measure = StressMeasure::cauchy;
};

inline Curve parse_curve(const std::string& text, const std::string& shown_name) {
  const Test test = parse_tests(text, shown_name, {}).front();
  Curve curve{{}, test.stress_x, test.measure};
  for (double stretch : test.first) curve.strain.push_back(engineering_strain(stretch));
  return curve;
}

struct UniaxialFitOptions {
  Dilatation dilatation = Dilatation::incompressible;
  int starts = 20;
  unsigned seed = 1;
};

inline FitResult fit_uniaxial(const Curve& curve, const Material& law,
                              const std::vector<FreeParameter>& free,
                              const UniaxialFitOptions& options = {}) {
  Test test;
  test.name = "curve", test.measure = curve.measure, test.stress_x = curve.stress;
  for (double e : curve.strain) test.first.push_back(1 + e);
  return fit({law, free, {test}, options.dilatation}, {options.starts, options.seed});
}

// |model - stress| in percent of the largest |stress|: mean and maximum
struct CurveError {
  double mean_percent = 0, max_percent = 0;
};

inline CurveError curve_error(const std::vector<double>& model, const std::vector<double>& stress) {
  CurveError e;
  double largest = 0;
  for (double s : stress) largest = std::max(largest, std::abs(s));
  for (std::size_t i = 0; i < stress.size(); ++i) {
    const double percent = 100 * std::abs(model[i] - stress[i]) / largest;
    e.mean_percent += percent / static_cast<double>(stress.size());
    e.max_percent = std::max(e.max_percent, percent);
  }
  return e;
}

}  // namespace langer::test
