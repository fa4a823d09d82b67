#include "identification/fit/prior.hpp"

#include <cmath>

#include "core/base/error.hpp"

namespace langer {

namespace {

// The values of `tests`, and behind them one for each prior.
class TestsWithPriors : public FurtherTests {
 public:
  TestsWithPriors(std::vector<Prior> priors, std::shared_ptr<FurtherTests> tests)
      : priors_(std::move(priors)), tests_(std::move(tests)) {
    const auto k = static_cast<Eigen::Index>(priors_.size());
    if (tests_) {
      of_tests_ = tests_->measured().size();
      curves_ = tests_->curves();
    }
    measured_.resize(of_tests_ + k);
    weight_.resize(of_tests_ + k);
    if (tests_) {
      measured_.head(of_tests_) = tests_->measured();
      weight_.head(of_tests_) = tests_->weight();
    }
    for (Eigen::Index i = 0; i < k; ++i) {
      const Prior& prior = priors_[static_cast<std::size_t>(i)];
      measured_[of_tests_ + i] = prior.centre;
      weight_[of_tests_ + i] = 1 / prior.deviation;
      curves_.push_back(1);
    }
  }

  const VecX& measured() const override { return measured_; }
  const VecX& weight() const override { return weight_; }
  const std::vector<Eigen::Index>& curves() const override { return curves_; }

  bool model(const VecX& p, VecX& values) override {
    VecX first;
    if (tests_ && !tests_->model(p, first)) return false;
    values.resize(measured_.size());
    values.head(of_tests_) = first;
    for (std::size_t i = 0; i < priors_.size(); ++i) {
      const auto at = of_tests_ + static_cast<Eigen::Index>(i);
      if (!priors_[i].value(p[priors_[i].number], values[at])) return false;
    }
    return true;
  }

  bool slope(const VecX& p, MatX& J) override {
    MatX first;
    if (tests_ && !tests_->slope(p, first)) return false;
    J = MatX::Zero(measured_.size(), p.size());
    if (tests_) J.topRows(of_tests_) = first;
    for (std::size_t i = 0; i < priors_.size(); ++i) {
      const auto at = of_tests_ + static_cast<Eigen::Index>(i);
      J(at, priors_[i].number) = priors_[i].slope(p[priors_[i].number]);
    }
    return true;
  }

 private:
  std::vector<Prior> priors_;
  std::shared_ptr<FurtherTests> tests_;
  Eigen::Index of_tests_ = 0;
  VecX measured_, weight_;
  std::vector<Eigen::Index> curves_;
};

}  // namespace

bool Prior::value(double p, double& x) const {
  x = p;
  if (!logarithm) return true;
  if (!(p > 0)) return false;
  x = std::log(p);
  return true;
}

double Prior::slope(double p) const {
  if (logarithm) return 1 / p;
  return 1;
}

std::shared_ptr<FurtherTests> with_priors(std::vector<Prior> priors,
                                          std::shared_ptr<FurtherTests> tests) {
  if (priors.empty()) return tests;
  return std::make_shared<TestsWithPriors>(std::move(priors), std::move(tests));
}

void weigh_by_noise(FitProblem& problem, const FitOptions& options) {
  FitProblem plain = problem;
  plain.noise = NoiseKind::white;
  plain.further.reset();
  const FitResult found = fit(plain, options);
  if (!std::isfinite(found.best.cost)) return;
  const auto freedom =
      std::max(1., static_cast<double>(found.residual.size() - found.best.p.size()));
  const double noise = found.residual.norm() / std::sqrt(freedom);
  // data that the law follows exactly outweigh any prior
  double largest = 0;
  for (const Test& test : problem.tests)
    largest = std::max(largest, test.weight * largest_stress(test));
  for (Test& test : problem.tests) test.weight /= std::max(noise, 1e-9 * largest);
}

}  // namespace langer
