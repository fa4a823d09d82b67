// langer-fit: parameters of a law from a measured curve.
//   langer-fit abdomen.yaml -o material.h5        also writes fit.csv: strain, measured stress, model, error
#include "fit/uniaxial_fit.hpp"
#include "material/ellipticity.hpp"
#include "scene/fit_config.hpp"
#include "stage.hpp"
#include "store/curves_file.hpp"
#include "store/material_file.hpp"
#include "store/seal.hpp"

namespace langer {
namespace {

FitRecord record_of(const FitConfig& config, const Curve& curve, const UniaxialFit& fit) {
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

// what a user of the parameters should know
void warn(const Job<FitConfig>& job, const FitRecord& record, const UniaxialFit& fit) {
  for (const MatrixTerm& term : fit.material.matrix)
    std::visit(
        [&](const auto& law) {
          if (const double slope = law(3.).dW; slope < 0)
            job.say("warning: {} starts with a negative slope ({:.4g} MPa): the shear modulus of this term is negative at rest",
                    law.key, slope);
        },
        term);
  for (const Fibre& fibre : fit.material.fibres)
    if (fibre.hgo.c1 < 0)
      job.say(
          "warning: c1 = {:.4g} MPa is negative: the energy is unbounded below, and solutions exist in a limited range only",
          fibre.hgo.c1);
  for (std::size_t i = 0; i < record.parameters.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(j);
      const double r = record.covariance(a, b) / std::sqrt(record.covariance(a, a) * record.covariance(b, b));
      if (std::abs(r) > 0.99)
        job.say("warning: {} and {} are correlated by {:.4f}: this curve hardly tells them apart", record.parameters[j].name,
                record.parameters[i].name, r);
    }
}

// where the fitted law becomes unstable along the test, looked for up to half as far again as the curve goes
void say_stability(const Job<FitConfig>& job, const FitRecord& record, const Material& material) {
  const std::vector<Vec3> a = fibre_directions(material);
  const double far = 1.5 * record.strain_max, step = far / 200;
  for (double strain = 0; strain <= far && far > 0; strain += step) {
    const Uniaxial u = uniaxial_incompressible(material, 1 + strain);
    if (u.converged && smallest_shear_stiffness(material, u.stretch.asDiagonal(), a).value > 0) continue;
    return job.say("warning: strong ellipticity is lost at strain {:.2g}; the curve ends at {:.2g}", strain, record.strain_max);
  }
}

std::vector<Summary> fit(const Job<FitConfig>& job) {
  const FitConfig& config = job.config;
  const std::string& file = config.data.file.path;
  const double inf = std::numeric_limits<double>::infinity();
  const Curve curve =
      between_strains(read_curve(file), config.data.strain_from.value_or(-inf), config.data.strain_to.value_or(inf));
  UniaxialFitOptions options;
  options.dilatation = config.dilatation;
  options.starts = config.starts;
  options.seed = static_cast<unsigned>(config.seed);
  UniaxialFit found;
  try {
    found = fit_uniaxial(curve, config.law, free_parameters(config), options);
  } catch (const Failure& failure) {
    std::vector<Error> errors = failure.errors();
    for (Error& e : errors) e.where.file = file;
    throw Failure(failure.code(), errors);
  }
  if (!found.best.converged)
    throw Failure(Exit::not_converged, {job.where("parameters"), "parameters",
                                        fmt::format("no optimum from {} starts: {}; KKT residual {:.2g}, cost {:.6g} MPa^2",
                                                    config.starts, found.best.why, found.best.kkt, found.best.cost),
                                        "", "more starts, other start values or narrower bounds"});
  const FitRecord record = record_of(config, curve, found);

  for (const FittedParameter& p : record.parameters) {
    const bool on_bound = p.value == p.lower || p.value == p.upper;
    job.say("{:>10} = {:12.6g} {:<5}  {}", p.name, p.value, p.unit == "-" ? "" : p.unit,
            on_bound                       ? "on its bound"
            : std::isnan(p.standard_error) ? "not determined by this curve"
                                           : fmt::format("standard error {:.2g}", p.standard_error));
  }
  job.say("mean error {:.3g} %, largest {:.3g} % of the largest stress; KKT residual {:.1e}; {} points, {} starts",
          record.mean_error_percent, record.max_error_percent, record.kkt_residual, curve.size(), config.starts);
  warn(job, record, found);
  if (!job.quiet) say_stability(job, record, found.material);

  std::vector<double> error;  // percent of the largest stress, as in fig. 5 of [A23]
  double largest = 0;
  for (double stress : curve.stress) largest = std::max(largest, std::abs(stress));
  for (std::size_t i = 0; i < curve.size(); ++i) error.push_back(100 * (record.model[i] - curve.stress[i]) / largest);
  const std::string measured = std::string(names(curve.measure)[static_cast<std::size_t>(curve.measure)]) + "_stress";
  write_text_file(job.beside("fit.csv"), csv({{"strain", "-", record.strain},
                                              {measured, "MPa", record.stress},
                                              {"model", "MPa", record.model},
                                              {"error", "percent", error}}));
  write_material(job.output, found.material, record, job.identity);
  return read_summary(job.output);
}

}  // namespace
}  // namespace langer

int main(int argc, char** argv) { return langer::run_stage<langer::FitConfig>(argc, argv, "fit", langer::fit); }
