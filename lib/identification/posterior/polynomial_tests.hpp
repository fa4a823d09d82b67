// What costly tests, such as scenes, would measure: polynomials of the parameters, one for each
// value, fitted to the values and the slopes of runs. A posterior takes ten thousands of models,
// and over its width a model is smooth.
//   value_j(p) = sum_k c_jk H_k(z),   z = L^-1 (p - centre)
// L L^T is the covariance of the points, H_k are products of Hermite's polynomials of total degree
// up to `degree`. Least squares over the values and the slopes by z of all points.
#pragma once

#include <vector>

#include "identification/fit/fit.hpp"

namespace langer {

// The model of tests at one set of parameters.
struct ModelPoint {
  VecX p;
  VecX values;  // (m)
  MatX slope;   // (m, p), by p
};

// The coefficients of a polynomial of `degree` in `numbers` variables.
std::size_t coefficients(Eigen::Index numbers, int degree);

class PolynomialTests : public FurtherTests {
 public:
  // tests: what was measured and its weights, which the points are models of. Where values are more
  // than coefficients, fewer combinations of them that have the same sum of squares are kept.
  PolynomialTests(const FurtherTests& tests, const std::vector<ModelPoint>& points, int degree);

  const VecX& measured() const override { return measured_; }
  const VecX& weight() const override { return weight_; }
  const std::vector<Eigen::Index>& curves() const override { return curves_; }
  bool model(const VecX& p, VecX& values) override;
  bool slope(const VecX& p, MatX& J) override;
  int degree() const { return degree_; }

 private:
  VecX terms(const VecX& z) const;            // (coefficients) H_k
  MatX slopes_of_terms(const VecX& z) const;  // (coefficients, p), by z

  int degree_;
  std::vector<std::vector<int>> powers_;  // of each term, by variable
  VecX centre_;
  MatX to_z_;          // L^-1
  MatX coefficients_;  // (coefficients, values)
  VecX measured_, weight_;
  std::vector<Eigen::Index> curves_;
};

}  // namespace langer
