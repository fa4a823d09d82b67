// langer-sensitivity: which parameters of a material decide its uniaxial stress, and at which strains.
//   langer-sensitivity abdomen.yaml --material material.h5 -o sensitivity.h5     also sensitivity.csv, sensitivity_zones.csv
#include "scene/ranking.hpp"
#include "scene/step_record.hpp"
#include "stage.hpp"
#include "store/seal.hpp"

namespace langer {
namespace {

std::optional<FitRecord> fit_of(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension();
  if (extension == ".yaml" || extension == ".yml") return std::nullopt;
  return read_material(path).fit;
}

std::vector<Summary> sensitivity(const Job<SensitivityConfig>& job) {
  const SensitivityConfig& config = job.config;
  Material material = material_from(job.input("material"));
  const Ranking chosen = ranking(config, material, fit_of(job.input("material")), job.where);
  SensitivityRecord record;
  record.parameters = chosen.numbers;
  for (int i = 0; i < config.strain.points; ++i)
    record.strain.push_back(config.strain.from + i * (config.strain.to - config.strain.from) / (config.strain.points - 1));
  record.strain.back() = config.strain.to;
  for (const auto& [from, to] : config.zones) record.zones.push_back({from, to});

  const auto k = static_cast<Eigen::Index>(chosen.numbers.size());
  VecX value(k), lower(k), upper(k);
  for (Eigen::Index j = 0; j < k; ++j) {
    const RankedNumber& n = record.parameters[static_cast<std::size_t>(j)];
    value[j] = n.value, lower[j] = n.lower, upper[j] = n.upper;
  }
  const auto stress = [&](const VecX& p, VecX& y) {
    for (Eigen::Index j = 0; j < k; ++j) *chosen.values[static_cast<std::size_t>(j)] = p[j];
    const auto sigma = uniaxial_curve(material, record.strain, config.stress, config.dilatation);
    if (sigma) y = Eigen::Map<const VecX>(sigma->data(), static_cast<Eigen::Index>(sigma->size()));
    return sigma.has_value();
  };
  VecX curve;
  if (stress(value, curve)) {
    record.curve.assign(curve.data(), curve.data() + curve.size());
    record.effects = one_at_a_time(stress, value, lower, upper, config.steps);
  } else
    record.effects.missing = value;
  if (!record.effects.complete) {
    std::string at;
    for (Eigen::Index j = 0; j < k; ++j)
      at += fmt::format("{}{} = {:.6g}", j ? ", " : "", record.parameters[static_cast<std::size_t>(j)].name,
                        record.effects.missing[j]);
    throw Failure(Exit::not_converged, {job.where("parameters"), "parameters", "no uniaxial state exists at " + at, "",
                                        "narrower bounds or a smaller strain.to"});
  }
  write_text_file(job.beside("sensitivity.csv"), effects_csv(record));
  write_text_file(job.beside("sensitivity_zones.csv"), zones_csv(record));
  write_sensitivity(job.output, record, job.identity);
  job.say("one at a time, {} steps for each of {} parameters, {} strains; interactions are not seen", config.steps, k,
          config.strain.points);
  return summary_of(record);
}

}  // namespace
}  // namespace langer

int main(int argc, char** argv) {
  return langer::run_stage<langer::SensitivityConfig>(argc, argv, "sensitivity", langer::sensitivity);
}
