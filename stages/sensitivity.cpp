// langer-sensitivity: which parameters of a material decide its uniaxial stress, and at which strains.
//   langer-sensitivity abdomen.yaml --material material.h5 -o sensitivity.h5     also sensitivity.csv, sensitivity_zones.csv
#include "material/parameters.hpp"
#include "scene/sensitivity_config.hpp"
#include "scene/sensitivity_file.hpp"
#include "scene/step_record.hpp"
#include "stage.hpp"
#include "store/material_file.hpp"
#include "store/seal.hpp"

namespace langer {
namespace {

std::optional<FitRecord> fit_of(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension();
  if (extension == ".yaml" || extension == ".yml") return std::nullopt;
  return read_material(path).fit;
}

// The parameters asked for with their bounds; `chosen` points into the material.
std::vector<RankedNumber> ranked(const Job<SensitivityConfig>& job, Material& material,
                                 std::vector<MaterialParameter>& chosen) {
  const std::vector<MaterialParameter> known = parameters(material);
  const std::optional<FitRecord> fit = fit_of(job.input("material"));
  std::vector<RankedParameter> asked = job.config.parameters;
  if (asked.empty() && fit)
    for (const FittedParameter& p : fit->parameters)
      for (const MaterialParameter& k : known)
        if (k.name == p.name) asked.push_back({k.key, {}, {}, {}});
  std::vector<Error> errors;
  const auto say = [&](const std::string& key, std::string found, std::string expected, std::string hint = "") {
    errors.push_back({job.where(key), key, std::move(found), std::move(expected), std::move(hint)});
  };
  if (asked.empty()) say("parameters", "none, and the material comes from no fit", "numbers to rank, with bounds");

  std::vector<RankedNumber> numbers;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const RankedParameter& p = asked[i];
    const std::string at = fmt::format("parameters[{}]", i);
    const auto one = std::find_if(known.begin(), known.end(), [&](const auto& k) { return k.key == p.key; });
    if (one == known.end()) {
      std::vector<std::string> keys;
      for (const MaterialParameter& k : known) keys.push_back(k.key);
      const std::string near = nearest(p.key, keys);
      say(at + ".key", "the material has no number \"" + p.key + "\"", "one of " + list_words(keys),
          near.empty() ? "" : "did you mean \"" + near + "\"?");
      continue;
    }
    RankedNumber n{one->name, one->unit, *one->value, 0, 0};
    const auto fitted = [&]() -> const FittedParameter* {
      if (fit)
        for (const FittedParameter& f : fit->parameters)
          if (f.name == n.name) return &f;
      return nullptr;
    }();
    if (p.lower)
      n.lower = *p.lower, n.upper = *p.upper;
    else if (p.around)
      n.lower = n.value - *p.around * std::abs(n.value), n.upper = n.value + *p.around * std::abs(n.value);
    else if (fitted)
      n.lower = fitted->lower, n.upper = fitted->upper;
    else
      say(at, p.key + " has no bounds, and the material comes from no fit of it", "lower and upper, or around");
    if ((p.lower || p.around || fitted) && !(n.lower < n.upper))
      say(at, fmt::format("{} = {} leaves no room between the bounds", p.key, n.value), "lower < upper");
    if (n.lower < one->range.low || n.upper > one->range.high)
      say(at, fmt::format("bounds {} and {}", n.lower, n.upper),
          fmt::format("within {} and {}, as the law asks", one->range.low, one->range.high));
    numbers.push_back(n);
    chosen.push_back(*one);
  }
  if (!errors.empty()) throw Failure(Exit::config, std::move(errors));
  return numbers;
}

std::vector<Summary> sensitivity(const Job<SensitivityConfig>& job) {
  const SensitivityConfig& config = job.config;
  Material material = material_from(job.input("material"));
  std::vector<MaterialParameter> chosen;
  SensitivityRecord record;
  record.parameters = ranked(job, material, chosen);
  for (int i = 0; i < config.strain.points; ++i)
    record.strain.push_back(config.strain.from + i * (config.strain.to - config.strain.from) / (config.strain.points - 1));
  record.strain.back() = config.strain.to;
  for (const auto& [from, to] : config.zones) record.zones.push_back({from, to});

  const auto k = static_cast<Eigen::Index>(chosen.size());
  VecX value(k), lower(k), upper(k);
  for (Eigen::Index j = 0; j < k; ++j) {
    const RankedNumber& n = record.parameters[static_cast<std::size_t>(j)];
    value[j] = n.value, lower[j] = n.lower, upper[j] = n.upper;
  }
  const auto stress = [&](const VecX& p, VecX& y) {
    for (Eigen::Index j = 0; j < k; ++j) *chosen[static_cast<std::size_t>(j)].value = p[j];
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
