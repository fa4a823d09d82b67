// langer-fit: parameters of a law from a measured curve.
//   langer-fit abdomen.yaml -o material.h5        also writes fit.csv: strain, measured stress, model, error
#include "scene/fit_report.hpp"
#include "stage.hpp"
#include "store/seal.hpp"

namespace langer {
namespace {

UniaxialFit best_fit(const FitConfig& config, const Curve& curve) {
  UniaxialFitOptions options;
  options.dilatation = config.dilatation;
  options.starts = config.starts;
  options.seed = static_cast<unsigned>(config.seed);
  try {
    return fit_uniaxial(curve, config.law, free_parameters(config), options);
  } catch (const Failure& failure) {
    std::vector<Error> errors = failure.errors();
    for (Error& e : errors) e.where.file = config.data.file.path;
    throw Failure(failure.code(), errors);
  }
}

std::vector<Summary> fit(const Job<FitConfig>& job) {
  const FitConfig& config = job.config;
  constexpr double inf = std::numeric_limits<double>::infinity();
  const Curve curve = between_strains(read_curve(config.data.file.path), config.data.strain_from.value_or(-inf),
                                      config.data.strain_to.value_or(inf));
  const UniaxialFit found = best_fit(config, curve);
  if (!found.best.converged)
    throw Failure(Exit::not_converged, {job.where("parameters"), "parameters",
                                        fmt::format("no optimum from {} starts: {}; KKT residual {:.2g}, cost {:.6g} MPa^2",
                                                    config.starts, found.best.why, found.best.kkt, found.best.cost),
                                        "", "more starts, other start values or narrower bounds"});
  const FitRecord record = fit_record(config, curve, found);
  for (const std::string& line : fit_results(record)) job.say("{}", line);
  for (const std::string& line : fit_warnings(record, found.material)) job.say("warning: {}", line);
  write_text_file(job.beside("fit.csv"), fit_csv(curve, record.model));
  write_material(job.output, found.material, record, job.identity);
  return read_summary(job.output);
}

}  // namespace
}  // namespace langer

int main(int argc, char** argv) { return langer::run_stage<langer::FitConfig>(argc, argv, "fit", langer::fit); }
