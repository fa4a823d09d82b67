// Scenes solved in memory, whole or on the part that symmetry or a section leaves of them.
#pragma once

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "config/reader.hpp"
#include "run/equilibrium_by.hpp"
#include "run/step_record.hpp"
#include "scene/make_mesh.hpp"
#include "scene/symmetry.hpp"
#include "solve/load_path.hpp"

namespace langer::test {

inline const auto nowhere = [](const std::string&) { return Place{}; };

inline SolveConfig config_of(const std::string& text) { return read_config<SolveConfig>(parse_yaml(text, "scene.yaml")).config; }
inline Mesh mesh_in(const SolveConfig& config) { return make_mesh(*config.mesh, nowhere).mesh; }

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

inline Solved solved(const Mesh& mesh, const Scene& scene, const std::optional<ReducedScene>& part, const HowToSolve& how) {
  const Scene& own = part ? part->scene() : scene;
  Equilibrium body = equilibrium_of(mesh, scene, part);
  Statics statics(body, own.contacts, {});
  std::optional<double> increment;
  if (how.from) {
    const auto state = [&](const StepRecord& record) { return part ? part->reduced(record) : state_of(record, scene); };
    const BodyState before = how.before ? state(*how.before) : statics.accepted();
    statics.restore(state(*how.from), &before);
    increment = how.from->scalars.at("next_increment");
  }
  Solved out;
  out.free = body.dofs().n_free();
  const PathReport report = load_path(
      how.path, statics.accepted().t, increment, own.stops,
      [&](double t) {
        statics.begin(t);
        return equilibrium_by(how.solver, statics);
      },
      [&](double, double taken, double next, const SolveReport& step) {
        statics.accept();
        StepRecord record = step_record(statics, body, taken, next, step);
        out.steps.push_back(part ? part->whole(record) : record);
        return true;
      });
  CAPTURE(report.why);
  REQUIRE(report.complete);
  return out;
}

}  // namespace langer::test
