#include "scene/run/shared_run.hpp"

#include <fmt/format.h>

#include "core/base/interrupt.hpp"
#include "mechanics/linear/petsc/petsc_load.hpp"
#include "mechanics/solve/tangent_factor.hpp"

namespace langer {

std::string single_rank_reason(const SolveConfig& config, bool may_be_an_image) {
  const auto* newton = std::get_if<NewtonOptions>(&config.solver);
  if (!newton) return "solver: kinsol has a factor";
  if (newton->linear == LinearBy::direct)
    return "solver.newton.linear: direct is a factor, which one process makes";
  if (config.in_motion()) return "a body in motion is solved by a factor";
  if (config.accuracy || config.fidelity || config.reduce == Reduce::automatic)
    return "other models may be solved together with this one";
  if (config.estimate && *config.estimate != EstimateBy::none &&
      *config.estimate != EstimateBy::recovery)
    return "the estimate of its errors solves other scenes, or by a factor";
  if (!config.sensitivity.empty() || config.uncertainty) return "derivatives are those of a factor";
  if (config.modes || config.harmonic) return "vibrations are those of a factor";
  if (may_be_an_image) return "it may be the image of another solution";
  return "";
}

namespace {

// Why this reduced scene is solved by one rank, after all reasons that its config gives.
std::string serial_reason(const Reduction& reduction, const SolveConfig& config) {
  if (std::string why = single_rank_reason(config, false); !why.empty()) return why;
  if (reduction.point()) return "one hexahedron stands for the body";
  const Scene& scene = reduction.scene();
  if (ViscousPoints::needed(scene.materials)) return "its material is viscous";
  const bool follows = Loads(reduction.mesh(), scene.loads).follow();
  std::string why = why_by_factor(reduction.mesh(), scene.dofs, scene.formulation, scene.contacts,
                                  follows, std::get<NewtonOptions>(config.solver).linear);
  if (why.empty()) petsc(why);
  return why;
}

}  // namespace

// METIS divides the mesh by its connectivity: each rank gets cells with few neighbours elsewhere.
std::optional<Division> divided(const Reduction& reduction, const SolveConfig& config,
                                std::string& why) {
  if (!ranks()) return std::nullopt;
  why = serial_reason(reduction, config);
  const Mesh& mesh = reduction.mesh();
  if (why.empty() && mesh.n_cells() < ranks()->n()) why = "it has fewer cells than there are ranks";
  if (!why.empty()) return std::nullopt;
  std::vector<int> nodes;
  const MovingNodes moving(mesh);
  for (int e = 0; e < mesh.n_cells(); ++e)
    nodes.insert(nodes.end(), moving.of(e).begin(), moving.of(e).end());
  return Division{ranks(), ranks()->divide(nodes, mesh.cell().n_nodes, mesh.n_nodes())};
}

// All ranks have to end after the same increment: the largest signal of any rank is that of all.
int signal_of(const Ranks* ranks) {
  if (!ranks) return interrupted();
  const int signal = static_cast<int>(ranks->largest(interrupted()));
  note_signal(signal);
  return signal;
}

// Sends the state from which rank 0 continues to all ranks: sizes are those of `shape`.
bool share(const Ranks& ranks, std::optional<Resumed>& resumed, const BodyState& shape) {
  int some = resumed.has_value();
  ranks.broadcast_from_root(&some, sizeof some);
  if (!some) return false;
  if (!ranks.first()) resumed = Resumed{shape, shape, 0};
  const auto tell = [&](double& x) {
    ranks.broadcast_from_root(&x, sizeof x);
  };
  for (BodyState* state : {&resumed->now, &resumed->before}) {
    tell(state->t);
    tell(state->travel);
    ranks.broadcast_from_root(state->u.data(),
                              static_cast<std::size_t>(state->u.size()) * sizeof(double));
    for (std::vector<Vec3>& reactions : state->r)
      ranks.broadcast_from_root(reactions.data(), reactions.size() * sizeof(Vec3));
  }
  tell(resumed->increment);
  return true;
}

}  // namespace langer
