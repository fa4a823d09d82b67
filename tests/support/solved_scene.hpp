// Scenes solved in memory, whole or on the part that symmetry or a section leaves of them.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "scene/model/make_mesh.hpp"
#include "scene/model/solve_config_io.hpp"
#include "scene/run/run.hpp"

namespace langer::test {

inline const auto nowhere = [](const std::string&) {
  return Place{};
};

inline SolveConfig config_of(const std::string& text) {
  return read_config<SolveConfig>(parse_yaml(text, "scene.yaml")).config;
}
inline Mesh mesh_in(const SolveConfig& config) { return make_mesh(*config.mesh, nowhere).mesh; }

// what make_scene says of a config on this mesh; "accepted"
inline std::string said_of_scene(const std::string& text, const Mesh& mesh) {
  const SolveConfig config = config_of(text);
  try {
    make_scene(config, mesh, config.material, nowhere);
  } catch (const Failure& failure) {
    CHECK(failure.code() == Exit::config);
    return failure.what();
  }
  return "accepted";
}

struct Solved {
  std::vector<StepRecord> steps;  // of the whole body
  int free = 0;                   // unknowns
  const StepRecord& last() const { return steps.back(); }
};

struct HowToSolve {
  LoadPathOptions path;
  std::variant<NewtonOptions, KinsolOptions> solver;
  const StepRecord* from = nullptr;    // continued after this step
  const StepRecord* before = nullptr;  // and the one before it; none: the body at rest
};

inline Solved solved(const Mesh& mesh, const Scene& scene, const std::optional<ReducedScene>& part,
                     const HowToSolve& how) {
  Run run(mesh, scene, part, how.path, how.solver);
  if (how.from) run.resume(*how.from, how.before ? std::optional(*how.before) : std::nullopt);
  Solved out;
  out.free = run.body.dofs().n_free();
  RunListener each;
  each.of_whole = [&](const StepRecord& step, const SolveReport&) {
    out.steps.push_back(step);
  };
  const RunEnd end = run.follow(each);
  CAPTURE(end.path.why);
  REQUIRE(end.path.complete);
  return out;
}

// of two fields of the same nodes
inline double largest_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  REQUIRE(a.size() == b.size());
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).norm());
  return most;
}

}  // namespace langer::test
