#include "scene/accuracy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace langer {

std::optional<double> percent_of(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  std::string rest(end, text.data() + text.size());
  std::erase(rest, ' ');
  if (error != std::errc{} || rest != "%" || !std::isfinite(value) || !(value > 0)) return std::nullopt;
  return value;
}

const std::vector<AccuracyRung>& accuracy_rungs() {
  // make run PIPELINE=pipelines/trade.yaml JOBS=1;  <scene>/trade.csv, force_error
  static const std::vector<AccuracyRung> rungs{
      {0.35, 0.25, 8}, {0.25, 0.25, 4}, {0.175, 0.2, 1.5}, {0.125, 0.1, 0.5}, {0.088, 0.1, 0.15}, {0.0625, 0.1, 0.05}};
  return rungs;
}

std::optional<ChosenRung> choose_accuracy(SolveConfig& config) {
  if (!config.accuracy && !config.fidelity) return std::nullopt;
  constexpr double by_name[]{5, 1, 0.2};
  ChosenRung chosen;
  chosen.wanted = config.accuracy ? *percent_of(*config.accuracy) : by_name[static_cast<int>(*config.fidelity)];
  const auto& rungs = accuracy_rungs();
  auto rung = std::find_if(rungs.begin(), rungs.end(), [&](const AccuracyRung& r) { return r.error <= chosen.wanted; });
  chosen.met = rung != rungs.end();
  chosen.rung = chosen.met ? *rung : rungs.back();

  std::get<IndentedBlock>(config.mesh->geometry).edge = chosen.rung.edge;
  config.path.first = std::min(chosen.rung.step, 1.0);
  config.path.largest = chosen.rung.step;
  config.mesh->cells = CellType::hex27;
  if (!config.estimate) config.estimate = EstimateBy::second_rung;
  if (config.symmetry == SymmetryChoice::none) config.symmetry = SymmetryChoice::automatic;
  chosen.words = fmt::format("{:g} % wanted: cells of {:g} contact radii, increments of {:g}; on the ladder's three scenes the force "
                             "was within {:g} %{}",
                             chosen.wanted, chosen.rung.edge, chosen.rung.step, chosen.rung.error,
                             chosen.met ? "" : ", the finest rung measured");
  return chosen;
}

}  // namespace langer
