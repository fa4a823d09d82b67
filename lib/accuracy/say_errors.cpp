#include "accuracy/say_errors.hpp"

#include <fmt/format.h>

#include "base/interrupt.hpp"
#include "run/progress.hpp"

namespace langer {

std::vector<ErrorEstimate> say_errors(const Voice& voice, const SolveConfig& config, const std::optional<Material>& material,
                                      const Run::Where& where, const Run& run, const StepRecord& last, const Recording& recording) {
  if (config.estimate.value_or(EstimateBy::none) == EstimateBy::none) return {};
  std::vector<ErrorEstimate> errors;
  try {
    errors = estimated(config, material, where, run, last,
                       [&](const Run& other, int n, int of) { return estimate_progress(voice, other, n, of); });
  } catch (const Failure& failure) {
    if (interrupted()) recording.stopped_in_estimate();
    if (failure.code() != Exit::not_converged) throw;
    voice.warn(fmt::format("errors are not estimated: {}", failure.what()));
  }
  for (const ErrorEstimate& e : errors) voice.say("{}", in_words(e));
  return errors;
}

}  // namespace langer
