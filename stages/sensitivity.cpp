// langer-sensitivity: which parameters of a material decide its stress in a test, and at which
// strains.
//   langer-sensitivity abdomen.yaml --material material.h5 -o sensitivity.h5
// CSV tables and figures are written next to the output.
#include <memory>

#include "core/base/text.hpp"
#include "core/hdf5/seal.hpp"
#include "identification/sensitivity/long_work.hpp"
#include "identification/sensitivity/ranking.hpp"
#include "identification/sensitivity/sensitivity_tables.hpp"
#include "identification/statistics/study_files.hpp"
#include "scene/run/step_record.hpp"
#include "stage.hpp"

namespace langer {
namespace {

// The fit of a material file; a YAML file has none.
std::optional<FitRecord> fit_of(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension();
  if (extension == ".yaml" || extension == ".yml") return std::nullopt;
  return read_material(path).fit;
}

// The ties of a fit that apply here. A tie of a ranked parameter is dropped, because the parameter
// varies on its own. If the sheet is turned by an angle, both angles a and b of a tie b = factor a
// + offset are turned, which adds turn (1 - factor) to the offset.
std::vector<Tie> ties_in(const FitRecord& fit, Material& material,
                         const std::vector<std::string>& keys, double turn) {
  std::vector<Tie> ties;
  for (Tie tie : fit.ties) {
    if (std::find(keys.begin(), keys.end(), tie.key) != keys.end()) continue;
    for (const MaterialParameter& p : parameters(material))
      if (p.key == tie.key && p.unit == std::string(unit::deg))
        tie.offset += turn * (1 - tie.factor);
    ties.push_back(tie);
  }
  return ties;
}

// The stress at the strains as a function of the ranked parameters. Each copy of the function has
// its own material, so that threads do not share one.
CurveMaker stress_of(const SensitivityConfig& config, const Material& material,
                     const std::vector<std::string>& keys, const std::vector<Tie>& ties,
                     const std::vector<double>& strain) {
  return [=, &strain]() -> ParametricCurve {
    const auto own = std::make_shared<Material>(material);
    const auto tied = std::make_shared<TiedNumbers>(*own, ties);
    std::vector<double*> numbers;
    for (const std::string& key : keys)
      for (const MaterialParameter& p : parameters(*own))
        if (p.key == key) numbers.push_back(p.value);
    return [=, &strain](const VecX& p, VecX& y) {
      for (std::size_t j = 0; j < numbers.size(); ++j)
        *numbers[j] = p[static_cast<Eigen::Index>(j)];
      tied->follow();
      std::optional<std::vector<double>> sigma;
      if (config.dilatation == Dilatation::compressible)
        sigma = uniaxial_curve(*own, strain, config.stress, config.dilatation);
      else
        sigma = path_curve(*own, config.test, strain, config.stress);
      if (sigma)
        y = Eigen::Map<const VecX>(sigma->data(), static_cast<Eigen::Index>(sigma->size()));
      return sigma.has_value();
    };
  };
}

// Samples without a state of the material are left out. A few of them change little; if there are
// many, the results are those of other bounds, so too few remaining samples are refused.
void check_samples(const Job<SensitivityConfig>& job, const std::string& method, long used,
                   long without, long least) {
  if (used < least)
    throw Failure(Exit::not_converged,
                  {job.where(method), method,
                   fmt::format("no state exists in {} of {} samples", without, used + without), "",
                   "narrower bounds or a smaller strain.to"});
  if (without > 0)
    job.warn("{}: {} of {} samples have no state at some strain and are left out", method, without,
             used + without);
}

// Effects of one parameter at a time. The material must have a state at all these points.
void add_one_at_a_time(const Job<SensitivityConfig>& job, const CurveMaker& stress,
                       const VecX& value, const VecX& lower, const VecX& upper,
                       SensitivityRecord& record) {
  VecX curve;
  if (stress()(value, curve)) {
    record.curve.assign(curve.data(), curve.data() + curve.size());
    record.effects = one_at_a_time(stress(), value, lower, upper, job.config.steps);
  } else {
    record.effects.missing = value;
  }
  if (record.effects.complete) return;
  std::string point;
  for (Eigen::Index j = 0; j < value.size(); ++j)
    append(point, ", ",
           fmt::format("{} = {:.6g}", record.parameters[static_cast<std::size_t>(j)].name,
                       record.effects.missing[j]));
  throw Failure(Exit::not_converged,
                {job.where("parameters"), "parameters", "no state exists at " + point, "",
                 "narrower bounds or a smaller strain.to"});
}

// One parameter at a time is always computed; Morris and Sobol' if the config asks for them.
std::vector<Summary> sensitivity(const Job<SensitivityConfig>& job) {
  const SensitivityConfig& config = job.config;
  Material material = turned(material_from(job.input("material")), config.turn);
  const std::optional<FitRecord> fit = fit_of(job.input("material"));
  const Ranking chosen = ranking(config, material, fit, job.where);
  SensitivityRecord record;
  record.parameters = chosen.numbers;
  // Strains are evenly spaced; the last one is set exactly, without rounding.
  for (int i = 0; i < config.strain.points; ++i)
    record.strain.push_back(config.strain.from + i * (config.strain.to - config.strain.from) /
                                                     (config.strain.points - 1));
  record.strain.back() = config.strain.to;
  for (const auto& [from, to] : config.zones) record.zones.push_back({from, to});

  const auto k = static_cast<Eigen::Index>(chosen.numbers.size());
  VecX value(k);
  VecX lower(k);
  VecX upper(k);
  for (Eigen::Index j = 0; j < k; ++j) {
    const RankedNumber& n = record.parameters[static_cast<std::size_t>(j)];
    value[j] = n.value;
    lower[j] = n.lower;
    upper[j] = n.upper;
  }
  std::vector<Tie> ties;
  if (fit) ties = ties_in(*fit, material, chosen.keys, config.turn);
  const CurveMaker stress = stress_of(config, material, chosen.keys, ties, record.strain);
  add_one_at_a_time(job, stress, value, lower, upper, record);
  job.say(
      "one at a time, {} steps for each of {} parameters, {} strains; interactions are not seen",
      config.steps, k, config.strain.points);
  // Methods that see interactions. Zones average the effects over ranges of strain.
  SamplingOptions options;
  options.seed = static_cast<std::uint64_t>(config.seed);
  options.threads = config.threads;
  options.resamples = config.resamples;
  options.groups = points_in(record.strain, record.zones);
  if (config.morris) {
    options.progress = progress_of("sensitivity", "Morris", job.quiet);
    record.morris =
        morris(stress, lower, upper, config.morris->trajectories, config.morris->levels, options);
    check_samples(job, "morris", record.morris->trajectories, record.morris->without_curve, 2);
  }
  if (config.sobol) {
    options.progress = progress_of("sensitivity", "Sobol", job.quiet);
    options.sequence = config.sobol->sequence;
    record.sobol = sobol(stress, lower, upper, config.sobol->samples, options);
    check_samples(job, "sobol", record.sobol->rows, record.sobol->without_curve, 64);
  }
  for (const std::string& line : sensitivity_lines(record)) job.say("{}", line);
  write_text_file(job.side_file("sensitivity.csv"), effects_csv(record));
  write_text_file(job.side_file("sensitivity_zones.csv"), zones_csv(record));
  if (record.morris) write_text_file(job.side_file("sensitivity_morris.csv"), morris_csv(record));
  if (record.sobol) write_text_file(job.side_file("sensitivity_sobol.csv"), sobol_csv(record));
  if (config.figures)
    for (const std::string& line : draw_sensitivity(record, config.figure_style, job.side_file("")))
      job.say("{}", line);
  write_sensitivity(job.output, record, job.identity);
  return summary_of(record);
}

std::vector<std::string> side_files(const SensitivityConfig& config) {
  std::vector<std::string> names{"sensitivity.csv", "sensitivity_zones.csv"};
  if (config.morris) names.push_back("sensitivity_morris.csv");
  if (config.sobol) names.push_back("sensitivity_sobol.csv");
  return names;
}

}  // namespace
}  // namespace langer

int main(int argc, char** argv) {
  return langer::run_stage<langer::SensitivityConfig>(argc, argv, "sensitivity",
                                                      langer::sensitivity, langer::side_files);
}
