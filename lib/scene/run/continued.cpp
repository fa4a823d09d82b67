#include "scene/run/continued.hpp"

#include <map>
#include <memory>

#include "core/base/say.hpp"
#include "scene/model/solve_config_io.hpp"

namespace langer {

namespace {
double relative(const SolveConfig& config) {
  return std::visit([](const auto& solver) { return solver.relative; }, config.solver);
}
}  // namespace

Identity with_steps_hash(Identity identity, const SolveConfig& config) {
  SolveConfig steps = config;
  const SolveConfig usual;
  steps.threads = usual.threads;
  steps.blas_threads = usual.blas_threads;
  steps.solver = usual.solver;
  steps.path.smallest = usual.path.smallest;
  steps.path.longest_attempt = usual.path.longest_attempt;
  steps.on_unstable = usual.on_unstable;
  steps.estimate = usual.estimate;
  steps.truncation = usual.truncation;
  steps.modes = usual.modes;  // vibrations are computed after the path
  steps.harmonic = usual.harmonic;
  identity.steps_hash = fnv1a(to_yaml(steps, file_name));
  return identity;
}

SolutionWriter::StillGood within_tolerance(const SolveConfig& config) {
  const double now = relative(config);
  const auto then = std::make_shared<std::map<std::string, double>>();  // by config
  return [now, then](const StepRecord& step, const EarlierRun& run) {
    if (!then->count(run.config))
      (*then)[run.config] =
          relative(read_config<SolveConfig>(parse_yaml(run.config, "provenance")).config);
    if (now >= then->at(run.config) || step.residual <= now) return true;
    say_line(
        "solve: the step at t = {:.6g} was kept with a residual of {:.2g}, and solver asks for {:.2g} now; it is made anew",
        step.t, step.residual, now);
    return false;
  };
}

}  // namespace langer
