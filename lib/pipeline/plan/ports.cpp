#include "pipeline/plan/ports.hpp"

namespace langer {

namespace {

// A stage: name, first sentence of --help, input ports, main output file.
const StageSpec mesh_stage{
    "mesh", "Makes a mesh with named sets and local fibre frames.", {}, "mesh.h5"};
// A fit reads measured curves from files that its config names. Curves of simulated scenes, for
// tests of the method, come from langer-post instead.
const StageSpec fit_stage{
    "fit",
    "Finds material parameters from a measured curve.",
    {{.name = "curves",
      .says = "measured curves of scenes, for the items of data without a file, in their order",
      .made_by = {"post"},
      .required = false,
      .several = true}},
    "material.h5"};
// Members of a sweep over {samples: n} begin with this stage: each has another set of parameters.
const StageSpec sample_stage{"sample",
                             "Draws one sample of the parameters from the covariance of a fit.",
                             {{.name = "material", .says = "the fit", .made_by = {"fit"}}},
                             "material.h5"};
// Works on the material alone: it needs no mesh and no solution.
const StageSpec sensitivity_stage{"sensitivity",
                                  "Ranks material parameters: one at a time, by Morris, by Sobol.",
                                  {{.name = "material",
                                    .says = "the material whose parameters are ranked",
                                    .made_by = {"fit"},
                                    .takes_yaml = true}},
                                  "sensitivity.h5"};
// Mesh and material may be keys of the config, so a scene can be one file. The port `mirror` is
// filled by langer-plan (siblings.hpp).
const StageSpec solve_stage{
    "solve",
    "Finds equilibrium along a load path.",
    {{.name = "mesh",
      .says = "mesh with named sets and frames, unless the config has one",
      .made_by = {"mesh"},
      .required = false,
      .or_key = true},
     {.name = "material",
      .says = "energy terms and their parameters, unless the config has them",
      .made_by = {"fit", "sample"},
      .required = false,
      .or_key = true,
      .takes_yaml = true},
     {.name = "mirror",
      .says = "a solution with other fibre angles, copied if this scene is its mirror image",
      .made_by = {"solve"},
      .required = false}},
    "solution.h5",
    true};
// Homogeneously stretched layers need no mesh: only their laws. The table has the name of that of
// gather, so that a node called `table` leaves what pipelines promise.
const StageSpec layers_stage{"layers",
                             "Waves and wrinkles of stretched layers, over the direction.",
                             {{.name = "material",
                               .says = "the law of the layers that have none in the config",
                               .made_by = {"fit", "sample"},
                               .required = false,
                               .takes_yaml = true}},
                             "table.h5"};
// A solution has all that post needs: mesh, material, config and every step.
const StageSpec post_stage{
    "post",
    "Turns a solution into fields and curves.",
    {{.name = "solution", .says = "steps of a load path", .made_by = {"solve"}}},
    "curves.h5",
    false,
    "only writes the solved scene for another program: scene.inp for CalculiX, scene.feb for "
    "FEBio 4; may be repeated, and needs --solution only"};
// Gathers files of any stage with a summary. Its port is called curves, because members are mostly
// curves.h5.
const StageSpec gather_stage{
    "gather",
    "Collects one quantity or several over a sweep.",
    {{.name = "curves",
      .says = "results of each run of the sweep, such as curves: post or curves: fit",
      .made_by = {"post", "layers", "fit", "sensitivity", "mesh", "solve"},
      .several = true,
      .members = true},
     {.name = "material",
      .says = "the fit, for a sweep over {samples: 100}",
      .made_by = {"fit"},
      .required = false}},
    "sweep.h5"};
// All ports are optional: a report shows what a run has.
const StageSpec report_stage{
    "report",
    "Writes a report on a run: one page that opens offline.",
    {{.name = "mesh", .says = "a mesh", .made_by = {"mesh"}, .required = false, .several = true},
     {.name = "material",
      .says = "a fitted material",
      .made_by = {"fit"},
      .required = false,
      .several = true},
     {.name = "sensitivity",
      .says = "a ranking of parameters",
      .made_by = {"sensitivity"},
      .required = false,
      .several = true},
     {.name = "solution",
      .says = "a solution, shown as a deformed body",
      .made_by = {"solve"},
      .required = false,
      .several = true},
     {.name = "curves",
      .says = "curves of a solution",
      .made_by = {"post", "layers"},
      .required = false,
      .several = true},
     {.name = "table",
      .says = "the table of a sweep",
      .made_by = {"gather"},
      .required = false,
      .several = true}},
    "report.html"};
// The members are solutions of one scene with different meshes, increments or solvers.
const StageSpec tune_stage{
    "tune",
    "Draws the work-precision diagram of a refinement study: which settings give the smallest "
    "error for their cost.",
    {{.name = "curves",
      .says = "one level of the study: curves of its solution",
      .made_by = {"post"},
      .several = true,
      .members = true}},
    "levels.h5"};

}  // namespace

// The order is that of the work, and of the pages that list the stages.
const std::vector<StageSpec>& stages() {
  static const std::vector<StageSpec> table{
      mesh_stage, fit_stage,    sample_stage, sensitivity_stage, solve_stage,
      post_stage, layers_stage, gather_stage, report_stage,      tune_stage};
  return table;
}

const Port* StageSpec::port(const std::string& wanted) const {
  for (const Port& p : inputs)
    if (wanted == p.name) return &p;
  return nullptr;
}

const StageSpec* find_stage(const std::string& name) {
  for (const StageSpec& s : stages())
    if (name == s.name) return &s;
  return nullptr;
}

std::vector<std::string> stage_names() {
  std::vector<std::string> names;
  for (const StageSpec& s : stages()) names.push_back(s.name);
  return names;
}

}  // namespace langer
