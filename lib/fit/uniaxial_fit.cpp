#include "fit/uniaxial_fit.hpp"

#include <cmath>

namespace langer {

CurveError curve_error(const std::vector<double>& model, const std::vector<double>& stress) {
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

UniaxialFit fit_uniaxial(const Curve& curve, const Material& law, const std::vector<FreeParameter>& free,
                         const UniaxialFitOptions& options) {
  const FitResult all =
      fit({law, free, {test_of(curve, "curve")}, options.dilatation}, {options.starts, options.seed, options.least_squares});
  return {all.material,
          all.best,
          all.covariance,
          all.starts,
          {all.model.begin(), all.model.end()},
          all.quality.mean_error_percent,
          all.quality.max_error_percent};
}

}  // namespace langer
