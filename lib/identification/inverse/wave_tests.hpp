// Wave tests of a fit (kind: wave): speeds of surface waves over the direction.
//
//   file     angle_deg, speed_m_s, and frequency_Hz where the skin has a thickness or is viscous
//   model    guided_wave() of one layer: the law, stretched by `prestretch`, as a half-space or with
//            a thickness on a fixed base; the mode that a vertical tap excites
//   slope    central differences of the model
// Refused, with file, line and column: speeds and frequencies <= 0, missing frequencies.
#pragma once

#include <functional>

#include "identification/setup/fit_config.hpp"
#include "layers/guided_wave.hpp"
#include "results/store/material_file.hpp"

namespace langer {

class WaveTests : public FurtherTests {
 public:
  using Where = std::function<Place(const std::string&)>;
  // problem: its law, free numbers and ties. Throws Failure(config, input).
  WaveTests(const FitConfig& config, const Where& where, const FitProblem& problem);

  const VecX& measured() const override { return measured_; }
  const VecX& weight() const override { return weight_; }
  const std::vector<Eigen::Index>& curves() const override { return curves_; }
  bool model(const VecX& p, VecX& values) override;
  bool slope(const VecX& p, MatX& J) override;

  // measured and computed speeds of all tests; fit: whose quality is told
  std::vector<FittedCurve> fitted(const FitResult& fit, std::size_t homogeneous_tests) const;

 private:
  struct WaveTest {
    std::string name;
    std::size_t data = 0;                         // item of `data`
    std::vector<double> angle, speed, frequency;  // [deg], [m/s], [Hz]; may be empty
    double deviation = 1;                         // [m/s]
  };
  WaveTest read(std::size_t item, const Where& where) const;
  LayerStack stack_at(const WaveTest& test, const VecX& p) const;

  FitConfig config_;
  FitProblem law_;  // without further tests
  std::vector<WaveTest> tests_;
  VecX measured_, weight_;
  std::vector<Eigen::Index> curves_;
};

}  // namespace langer
