#include "scene/fit_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "material/ellipticity.hpp"
#include "store/curves_file.hpp"

namespace langer {

FitRecord fit_record(const FitConfig& config, const Curve& curve, const UniaxialFit& fit) {
  FitRecord record;
  Material material = fit.material;
  const std::vector<MaterialParameter> all = parameters(material);
  for (std::size_t i = 0; i < config.parameters.size(); ++i) {
    const FitParameter& p = config.parameters[i];
    const auto k = static_cast<Eigen::Index>(i);
    const auto known = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.key == p.key; });
    record.parameters.push_back({known->name, known->unit, fit.best.p[k], p.lower, p.upper, std::sqrt(fit.covariance(k, k))});
  }
  record.covariance = fit.covariance;
  record.cost = fit.best.cost;
  record.kkt_residual = fit.best.kkt;
  record.mean_error_percent = fit.mean_error_percent, record.max_error_percent = fit.max_error_percent;
  record.starts = fit.starts;
  const auto [low, high] = std::minmax_element(curve.strain.begin(), curve.strain.end());
  record.strain_min = *low, record.strain_max = *high;
  record.strain = curve.strain, record.stress = curve.stress, record.model = fit.model;
  return record;
}

std::string fit_csv(const Curve& curve, const std::vector<double>& model) {
  std::vector<double> error;
  double largest = 0;
  for (double stress : curve.stress) largest = std::max(largest, std::abs(stress));
  for (std::size_t i = 0; i < curve.size(); ++i) error.push_back(100 * (model[i] - curve.stress[i]) / largest);
  const std::string measured = std::string(names(curve.measure)[static_cast<std::size_t>(curve.measure)]) + "_stress";
  return csv(
      {{"strain", "-", curve.strain}, {measured, "MPa", curve.stress}, {"model", "MPa", model}, {"error", "percent", error}});
}

std::vector<std::string> fit_results(const FitRecord& record) {
  std::vector<std::string> lines;
  for (const FittedParameter& p : record.parameters) {
    const bool on_bound = p.value == p.lower || p.value == p.upper;
    const std::string known = on_bound                       ? "on its bound"
                              : std::isnan(p.standard_error) ? "not determined by this curve"
                                                             : fmt::format("standard error {:.2g}", p.standard_error);
    lines.push_back(fmt::format("{:>10} = {:12.6g} {:<5}  {}", p.name, p.value, p.unit == "-" ? "" : p.unit, known));
  }
  lines.push_back(fmt::format(
      "mean error {:.3g} %, largest {:.3g} % of the largest stress; KKT residual {:.1e}; {} points, {} starts",
      record.mean_error_percent, record.max_error_percent, record.kkt_residual, record.strain.size(), record.starts.rows()));
  return lines;
}

std::vector<std::string> fit_warnings(const FitRecord& record, const Material& material) {
  std::vector<std::string> lines;
  for (const MatrixTerm& term : material.matrix)
    if (const double mu = shear_modulus(term); mu < 0)
      lines.push_back(fmt::format("{} starts with a negative slope: the shear modulus of this term is {:.4g} MPa at rest",
                                  std::visit([](const auto& law) { return law.key; }, term), mu));
  for (const Fibre& fibre : material.fibres)
    if (fibre.hgo.c1 < 0)
      lines.push_back(
          fmt::format("c1 = {:.4g} MPa is negative: the energy is unbounded below, and solutions exist in a limited range only",
                      fibre.hgo.c1));
  for (std::size_t i = 0; i < record.parameters.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(j);
      const double r = record.covariance(a, b) / std::sqrt(record.covariance(a, a) * record.covariance(b, b));
      if (std::abs(r) > 0.99)
        lines.push_back(fmt::format("{} and {} are correlated by {:.4f}: this curve hardly tells them apart",
                                    record.parameters[j].name, record.parameters[i].name, r));
    }
  const std::vector<Vec3> a = fibre_directions(material);
  const double far = 1.5 * record.strain_max;
  for (int i = 0; i <= 200 && far > 0; ++i) {
    const Uniaxial u = uniaxial_incompressible(material, 1 + i * far / 200);
    if (u.converged && smallest_shear_stiffness(material, u.stretch.asDiagonal(), a).value > 0) continue;
    lines.push_back(
        fmt::format("strong ellipticity is lost at strain {:.2g}; the curve ends at {:.2g}", i * far / 200, record.strain_max));
    break;
  }
  return lines;
}

}  // namespace langer
