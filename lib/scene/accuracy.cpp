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
  // make trade; rungs q80-4steps, q50-4steps, q25-5steps and q17 of <scene>/trade.csv, the worst force_error of the three
  static const std::vector<AccuracyRung> rungs{{0.8, 0.25, 2.3}, {0.5, 0.25, 1.5}, {0.25, 0.2, 0.9}, {0.1768, 0.1, 0.45}};
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
  chosen.words = fmt::format("{:g} % wanted: hex27 of {:g} contact radii, increments of {:g}; on the ladder's three scenes the force "
                             "was within {:g} %{}",
                             chosen.wanted, chosen.rung.edge, chosen.rung.step, chosen.rung.error,
                             chosen.met ? "" : ", the finest rung measured");
  return chosen;
}

}  // namespace langer
