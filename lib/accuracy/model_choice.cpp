#include "accuracy/model_choice.hpp"

#include "run/run_words.hpp"

namespace langer {

namespace {

SolveConfig of_scene(SolveConfig config, bool has_file) {
  if (has_file) config.mesh.reset();
  return config;
}

}  // namespace

ModelChoice::ModelChoice(const Voice& voice, const SolveConfig& config, bool has_file, const std::optional<Material>& material,
                         Where where, bool dry)
    : voice_(voice),
      asked_(config),
      material_(material),
      where_(std::move(where)),
      dry_(dry),
      section_(voice, of_scene(config, has_file), material, where_, dry),
      accuracy_(of_model()),
      at_a_point_(config.homogeneous == Homogeneous::automatic) {}

Accuracy ModelChoice::of_model() const {
  return Accuracy(voice_, section_.taken() ? section_.config() : asked_, material_, where_, dry_);
}

bool ModelChoice::another(const std::vector<ErrorEstimate>& errors) {
  if (section_.accurate(errors)) return accuracy_.refine(errors);
  accuracy_ = of_model();
  return true;
}

void ModelChoice::leave_point() {
  voice_.say("homogeneous: the mesh no longer balances, and is solved from there on");
  at_a_point_ = false;
}

std::vector<Summary> ModelChoice::summary(const std::vector<ErrorEstimate>& errors) const {
  return joined({section_.summary(errors), accuracy_.summary(errors)});
}

}  // namespace langer
