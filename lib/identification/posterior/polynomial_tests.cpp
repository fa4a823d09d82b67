#include "identification/posterior/polynomial_tests.hpp"

#include <cmath>

#include "core/tensor/dense.hpp"

namespace langer {

namespace {

// All exponents of `numbers` variables whose sum is at most `degree`, the constant first.
std::vector<std::vector<int>> exponents(std::size_t numbers, int degree) {
  std::vector<std::vector<int>> all;
  std::vector<int> one(numbers, 0);
  int sum = 0;
  for (;;) {
    all.push_back(one);
    // counts up like the digits of a number, and carries where the sum would exceed the degree
    std::size_t at = 0;
    while (at < numbers && sum == degree) {
      sum -= one[at];
      one[at] = 0;
      ++at;
    }
    if (at == numbers) return all;
    ++one[at];
    ++sum;
  }
}

// Hermite's polynomials of a standard normal number, of mean square 1:
//   sqrt(k + 1) h_(k+1) = z h_k - sqrt(k) h_(k-1),   h_k' = sqrt(k) h_(k-1)
std::vector<double> hermite(double z, int degree) {
  std::vector<double> h{1};
  for (int k = 0; k < degree; ++k) {
    double next = z * h.back();
    if (k > 0) next -= std::sqrt(k) * h[static_cast<std::size_t>(k) - 1];
    h.push_back(next / std::sqrt(k + 1));
  }
  return h;
}

std::vector<std::vector<double>> hermite_of_each(const VecX& z, int degree) {
  std::vector<std::vector<double>> all;
  for (const double one : z) all.push_back(hermite(one, degree));
  return all;
}

}  // namespace

std::size_t coefficients(Eigen::Index numbers, int degree) {
  // binomial coefficient (numbers + degree over degree)
  std::size_t count = 1;
  for (int k = 1; k <= degree; ++k)
    count = count * (static_cast<std::size_t>(numbers) + static_cast<std::size_t>(k)) /
            static_cast<std::size_t>(k);
  return count;
}

PolynomialTests::PolynomialTests(const FurtherTests& tests, const std::vector<ModelPoint>& points,
                                 int degree)
    : degree_(degree) {
  const auto n = points.front().p.size();
  const auto m = tests.measured().size();
  const auto count = static_cast<Eigen::Index>(points.size());
  powers_ = exponents(static_cast<std::size_t>(n), degree);
  const auto terms_count = static_cast<Eigen::Index>(powers_.size());

  // the scale of the variables: that of the points
  centre_ = VecX::Zero(n);
  for (const ModelPoint& point : points) centre_ += point.p / static_cast<double>(count);
  MatX covariance = MatX::Zero(n, n);
  for (const ModelPoint& point : points) {
    const VecX away = point.p - centre_;
    covariance += away * away.transpose() / static_cast<double>(count);
  }
  const VecX diagonal = covariance.diagonal();
  covariance.diagonal() += 1e-10 * diagonal;
  const MatX L = Cholesky(covariance).L();
  to_z_ = L.triangularView<Eigen::Lower>().solve(MatX::Identity(n, n));

  // a row for the value and one for each slope of each point
  MatX A(count * (1 + n), terms_count);
  MatX B(count * (1 + n), m);
  for (Eigen::Index i = 0; i < count; ++i) {
    const ModelPoint& point = points[static_cast<std::size_t>(i)];
    const VecX z = to_z_ * (point.p - centre_);
    A.row(i * (1 + n)) = terms(z).transpose();
    A.middleRows(i * (1 + n) + 1, n) = slopes_of_terms(z).transpose();
    B.row(i * (1 + n)) = point.values.transpose();
    B.middleRows(i * (1 + n) + 1, n) = (point.slope * L).transpose();
  }
  const VecX& weight = tests.weight();
  B = B * weight.asDiagonal();
  coefficients_ = PivotedQr(A).solve_columns(B);

  // |C^T h - y| = |R h - Q^T y| with [C^T y] = Q R
  measured_ = tests.measured().cwiseProduct(weight);
  if (m > terms_count + 1) {
    MatX both(m, terms_count + 1);
    both.leftCols(terms_count) = coefficients_.transpose();
    both.col(terms_count) = measured_;
    const MatX R = Qr(both).R();
    coefficients_ = R.leftCols(terms_count).transpose();
    measured_ = R.col(terms_count);
  }
  weight_ = VecX::Ones(measured_.size());
  curves_ = {measured_.size()};
}

VecX PolynomialTests::terms(const VecX& z) const {
  const auto h = hermite_of_each(z, degree_);
  VecX all(static_cast<Eigen::Index>(powers_.size()));
  for (std::size_t k = 0; k < powers_.size(); ++k) {
    double product = 1;
    for (std::size_t i = 0; i < h.size(); ++i)
      product *= h[i][static_cast<std::size_t>(powers_[k][i])];
    all[static_cast<Eigen::Index>(k)] = product;
  }
  return all;
}

MatX PolynomialTests::slopes_of_terms(const VecX& z) const {
  const auto h = hermite_of_each(z, degree_);
  MatX all = MatX::Zero(static_cast<Eigen::Index>(powers_.size()), z.size());
  for (std::size_t k = 0; k < powers_.size(); ++k)
    for (std::size_t j = 0; j < h.size(); ++j) {
      const int power = powers_[k][j];
      if (power == 0) continue;
      double product = std::sqrt(power) * h[j][static_cast<std::size_t>(power) - 1];
      for (std::size_t i = 0; i < h.size(); ++i)
        if (i != j) product *= h[i][static_cast<std::size_t>(powers_[k][i])];
      all(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(j)) = product;
    }
  return all;
}

bool PolynomialTests::model(const VecX& p, VecX& values) {
  values = coefficients_.transpose() * terms(to_z_ * (p - centre_));
  return values.allFinite();
}

bool PolynomialTests::slope(const VecX& p, MatX& J) {
  J = coefficients_.transpose() * slopes_of_terms(to_z_ * (p - centre_)) * to_z_;
  return J.allFinite();
}

}  // namespace langer
