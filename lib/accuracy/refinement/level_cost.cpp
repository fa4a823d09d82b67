#include "accuracy/refinement/level_cost.hpp"

#include <fmt/format.h>

#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <limits>

#include "accuracy/estimate/error_estimate.hpp"
#include "core/base/memory.hpp"
#include "core/base/stopwatch.hpp"
#include "scene/run/body_mesh.hpp"
#include "scene/run/dry_run.hpp"

namespace langer {

LevelCost level_cost(const SolveConfig& config, const std::optional<Material>& material,
                     const Run::Where& where) {
  return level_cost(config, body_mesh(config, "", where), material, where);
}

LevelCost level_cost(const SolveConfig& config, const Mesh& mesh,
                     const std::optional<Material>& material, const Run::Where& where) {
  Run run(mesh, config, material, where);
  const Forecast f = forecast_of(config, run.body, run.increment, run.scene);
  double estimate = 0;
  if (config.estimate == EstimateBy::refinement) {
    estimate = estimate_seconds(config, material, where);
  }
  return {f.seconds() + estimate, f.bytes,
          resident_bytes() + std::min(free_memory(), free_address())};
}

std::string in_words(const LevelCost& cost) {
  return fmt::format("about {} of CPU and {}", duration_in_words(cost.seconds),
                     memory_in_words(cost.bytes));
}

double seconds_left() {
  double left = std::numeric_limits<double>::infinity();
  rlimit limit{};
  if (getrlimit(RLIMIT_CPU, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    left = static_cast<double>(limit.rlim_cur) - cpu_seconds();
  if (const char* end = std::getenv("SLURM_JOB_END_TIME"))  // since 1970
    if (const double at = std::strtod(end, nullptr); at > 0)
      left = std::min(left, at - static_cast<double>(std::time(nullptr)));
  return left;
}

std::string limit_exceeded(const LevelCost& cost, double left) {
  if (cost.bytes > cost.free)
    return fmt::format("would take {} of memory, and {} are there", memory_in_words(cost.bytes),
                       memory_in_words(cost.free));
  if (cost.seconds > left)
    return fmt::format("would take about {}, and {} are left (ulimit -t, or the cluster's job)",
                       duration_in_words(cost.seconds), duration_in_words(std::max(left, 0.0)));
  return "";
}

}  // namespace langer
