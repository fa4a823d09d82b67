#include "accuracy/checks/branch.hpp"

#include <fmt/format.h>

#include "mechanics/mesh/bounding_box.hpp"
#include "mechanics/mesh/quality.hpp"

namespace langer {

namespace {

// The config of the perfect body, unreduced, up to its first critical point.
SolveConfig perfect(SolveConfig config) {
  config.branch.reset();
  config.imperfection.reset();
  if (!config.mesh || !is_section(config.mesh->geometry)) config.symmetry = SymmetryChoice::none;
  config.homogeneous = Homogeneous::off;
  config.on_unstable = OnUnstable::warn;
  return config;
}

// A key that contradicts what the computation found, with its place in the scene.
[[noreturn]] void refuse_key(const Run::Where& where, const std::string& key, std::string found,
                             std::string expected, std::string hint) {
  throw Failure(Exit::config,
                Error{where(key), key, std::move(found), std::move(expected), std::move(hint)});
}

// Follows the path of the perfect body up to its first critical point and leaves the run there, so
// that modes can be computed. A path without a critical point is refused.
CriticalPoint found_on_path(const Voice& voice, Run& run, const std::string& key,
                            const Run::Where& where) {
  auto point = first_critical_point(run);
  if (!point)
    refuse_key(where, key, "the perfect body has no critical point on this path",
               "a path on which the equilibrium becomes unstable",
               "larger loads, shorter increments (path.largest), or no " + key);
  voice.say("perfect body: {}", point->words());
  run.put_at(point->t_state, point->state, point->earlier);
  return *point;
}

}  // namespace

// The start of a secondary path: at a bifurcation the state is moved along the critical mode, in
// either direction. Without an amplitude it is a hundredth of the largest side of the body. At a
// limit point there is no other path to change to, which is refused.
Branch branch_of(const Voice& voice, const Mesh& mesh, const SolveConfig& config,
                 const std::optional<Material>& material, const Run::Where& where) {
  Run run(mesh, perfect(config), material, where);
  CriticalPoint point = found_on_path(voice, run, "branch", where);
  if (point.kind != "bifurcation")
    refuse_key(where, "branch", "the first critical point is no bifurcation: " + point.words(),
               "a bifurcation",
               "path.arc_length continues past a limit point, where no other path begins");
  const std::vector<VecX> modes = modes_of(run, 1);
  if (modes.empty())
    refuse_key(where, "branch", "the tangent is singular to the last digit", "a mode",
               "other increments (path.largest)");
  const BranchConfig& branch = *config.branch;
  Run::Switch out;
  out.t = point.t_state;
  out.mode = modes.front();
  out.amplitude = branch.amplitude.value_or(0.01 * bounding_box(mesh.X).size().maxCoeff());
  if (branch.sign == BranchSign::negative) {
    out.mode = -out.mode;
    out.sign = -1;
  }
  return {out, std::move(point)};
}

// A mesh whose nodes are moved by a multiple of a buckling mode of the perfect body. The
// bifurcation becomes a smooth path. The amplitude must not fold a cell.
Mesh imperfect_mesh(const Voice& voice, Mesh mesh, const SolveConfig& config,
                    const std::optional<Material>& material, const Run::Where& where) {
  const ImperfectionConfig& imperfection = *config.imperfection;
  Run run(mesh, perfect(config), material, where);
  found_on_path(voice, run, "imperfection", where);
  const std::vector<VecX> modes = modes_of(run, imperfection.mode);
  if (static_cast<int>(modes.size()) < imperfection.mode)
    refuse_key(where, "imperfection.mode", fmt::format("found {} modes", modes.size()),
               "one of them", "");
  const VecX& mode = modes.back();
  for (int i = 0; i < mesh.n_nodes(); ++i)
    mesh.X[static_cast<std::size_t>(i)] +=
        imperfection.amplitude * displacement(run.body.dofs(), mode, i);
  if (const Quality q = quality(mesh); !(q.least_jacobian > 0))
    refuse_key(where, "imperfection.amplitude",
               fmt::format("cell {} of the imperfect mesh is folded", q.at_cell),
               "a smaller amplitude", "");
  return mesh;
}

}  // namespace langer
