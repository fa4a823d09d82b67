#include "serve/scene_view.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "accuracy/checks/run_watch.hpp"
#include "accuracy/estimate/report_errors.hpp"
#include "accuracy/refinement/model_choice.hpp"
#include "core/base/stopwatch.hpp"
#include "core/base/text.hpp"
#include "mechanics/contact/outline.hpp"
#include "mechanics/mesh/raise.hpp"
#include "mechanics/mesh/reference.hpp"
#include "pipeline/plan/expand.hpp"
#include "pipeline/plan/stage_config.hpp"
#include "report/json.hpp"
#include "report/packed.hpp"
#include "results/post/render.hpp"
#include "scene/model/solve_config_io.hpp"
#include "scene/run/dry_run.hpp"
#include "scene/run/post_files.hpp"
#include "scene/run/run_words.hpp"
#include "scene/run/step_record.hpp"

namespace langer {

namespace {

using pipeline::Step;
using pipeline::StepInput;
using report::Json;
using report::list;
using report::number;
using report::numbers;
using report::object;
using report::packed;
using report::words;

constexpr std::size_t most_fibres = 1500;  // drawn; more would hide each other
constexpr std::size_t most_points = 400;   // drawn of a set

// A step that solves, and what its inputs are before anything has run.
struct SolveInputs {
  Tree config;                // with the keys mesh and material where they come from other nodes
  std::string mesh_file;      // a file given at the port
  std::string material_file;  // a file given at the port, or what a fit has made
  std::string law;            // where the material comes from
};

// The step that makes an input; nullptr for a file that is there.
const Step* maker_of(const std::vector<Step>& steps, const StepInput& input) {
  for (const Step& step : steps)
    if (input.made && step.output() == input.path) return &step;
  return nullptr;
}

// Mesh and material of other nodes become keys of the config, so that nothing has to be made.
SolveInputs inputs_of(const Step& solve, const std::vector<Step>& steps,
                      const std::string& run_folder) {
  SolveInputs inputs;
  inputs.config = solve.config;
  inputs.law = "of the config";
  for (const StepInput& input : solve.inputs) {
    const Step* maker = maker_of(steps, input);
    const std::string made = run_folder + "/" + input.path;
    if (input.port == "mesh") {
      if (maker)
        set_value(inputs.config, "mesh", maker->config);
      else
        inputs.mesh_file = input.path;
    }
    if (input.port != "material") continue;
    if (!maker) {
      inputs.material_file = input.path;
      inputs.law = "of " + input.path;
    } else if (std::filesystem::exists(made)) {
      inputs.material_file = made;
      inputs.law = "as fitted by the last run";
    } else if (const Tree* law = maker->config.find("law")) {
      set_value(inputs.config, "material", *law);
      inputs.law = "start values of " + maker->node + ", which has not run";
    }
  }
  return inputs;
}

// The facets of the surface, and the cell that each belongs to.
struct Skin {
  std::vector<std::array<int, 4>> facets;
  std::vector<int> cell;
};

// A cell of second order has several facets on the surface, each with corners of its own.
Skin skin_of(const Mesh& mesh) {
  const Mesh simple = between_nodes(mesh);
  const int parts = simple.n_cells() / mesh.n_cells();
  Skin skin;
  skin.facets =
      outer_surface(simple, std::vector<bool>(static_cast<std::size_t>(simple.n_cells()), true));
  std::map<std::array<int, 4>, int> cells;
  for (int e = 0; e < simple.n_cells(); ++e)
    for (const auto& local : Hex8::facet) {
      std::array<int, 4> nodes{};
      for (int k = 0; k < 4; ++k) nodes[k] = simple.cell(e)[local[k]];
      std::ranges::sort(nodes);
      cells[nodes] = e / parts;
    }
  for (std::array<int, 4> nodes : skin.facets) {
    std::ranges::sort(nodes);
    skin.cell.push_back(value_or(cells, nodes, 0));
  }
  return skin;
}

Vec3 middle_of(const Mesh& mesh, const std::array<int, 4>& facet) {
  return 0.25 * (mesh.X[facet[0]] + mesh.X[facet[1]] + mesh.X[facet[2]] + mesh.X[facet[3]]);
}

void add(std::vector<float>& to, const Vec3& x) {
  for (double c : x) to.push_back(static_cast<float>(c));
}

// Whether a facet belongs to a set of nodes. The sets of a section have the nodes of its plane z =
// 0, those behind follow them.
bool covers(const Mesh& mesh, const std::vector<bool>& in, const std::array<int, 4>& corners) {
  bool behind = false;
  for (const int n : corners) {
    if (mesh.section && std::abs(mesh.X[n][2]) > 1e-12)
      behind = true;
    else if (!in[static_cast<std::size_t>(n)])
      return false;
  }
  return behind || !mesh.section;
}

// A set is drawn by its facets; one without facets, such as a point, by its nodes.
Json sets_view(const Mesh& mesh, const Skin& skin) {
  std::vector<Json> sets;
  for (const auto& [name, nodes] : mesh.node_sets) {
    std::vector<bool> in(mesh.X.size(), false);
    for (int node : nodes) in[static_cast<std::size_t>(node)] = true;
    std::vector<std::int32_t> facets;
    for (std::size_t f = 0; f < skin.facets.size(); ++f) {
      if (covers(mesh, in, skin.facets[f])) facets.push_back(static_cast<std::int32_t>(f));
    }
    std::vector<float> points;
    const std::size_t every = std::max<std::size_t>(1, nodes.size() / most_points);
    for (std::size_t i = 0; facets.empty() && i < nodes.size(); i += every)
      add(points, mesh.X[nodes[i]]);
    sets.push_back(object({{"name", words(name)},
                           {"nodes", number(static_cast<double>(nodes.size()))},
                           {"facets", packed(facets)},
                           {"points", packed(points)}}));
  }
  return list(sets);
}

// Each indenter as triangles at its start, and its way. Under force control the way is not known.
Json indenters_view(const Scene& scene, const Mesh& mesh) {
  Shown region = shown_of(mesh);
  region.parts = 24;
  return list(scene.contacts, [&](const RigidContact& contact) {
    const Outline outline = langer::outline(contact.shape, region);
    std::vector<float> points;
    for (const Vec3& x : outline.points) add(points, x);
    std::vector<std::int32_t> triangles;
    for (const auto& face : outline.faces)
      for (std::size_t k = 2; k < face.size(); ++k)
        triangles.insert(triangles.end(), {face[0], face[k - 1], face[k]});
    const Json motion = list(contact.motion, [](const Waypoint& point) {
      return numbers({point.t, point.to[0], point.to[1], point.to[2]});
    });
    return object({{"name", words(contact.name)},
                   {"points", packed(points)},
                   {"triangles", packed(triangles)},
                   {"motion", motion}});
  });
}

// Directions in the middle of facets; those normal to the surface would be points.
Json fibres_view(const Scene& scene, const Mesh& mesh, const Skin& skin) {
  std::vector<Json> families;
  const std::size_t every = std::max<std::size_t>(1, skin.facets.size() / most_fibres);
  for (int k = 0; k < scene.directions.n_families(); ++k) {
    std::vector<float> at, along;
    for (std::size_t f = 0; f < skin.facets.size(); f += every) {
      const auto directions = scene.directions.of(skin.cell[f]);
      if (k >= static_cast<int>(directions.size())) continue;
      const Vec3& a = directions[static_cast<std::size_t>(k)];
      const auto& c = skin.facets[f];
      const Vec3 normal =
          (mesh.X[c[2]] - mesh.X[c[0]]).cross(mesh.X[c[3]] - mesh.X[c[1]]).normalized();
      if (!a.allFinite() || std::abs(a.dot(normal)) > 0.7) continue;
      add(at, middle_of(mesh, c) + 1e-3 * normal);
      add(along, a);
    }
    families.push_back(object({{"at", packed(at)}, {"along", packed(along)}}));
  }
  return list(families);
}

Json supports_view(const SolveConfig& config) {
  return list(config.supports, [](const SupportConfig& support) {
    std::string held;
    for (const Axis axis : support.hold)
      append(held, ", ", names(Axis{})[static_cast<std::size_t>(axis)]);
    return object({{"on", words(support.on)}, {"hold", words(held)}});
  });
}

Json loads_view(const SolveConfig& config) {
  return list(config.loads, [](const LoadConfig& load) {
    std::string kind = "force";
    if (load.displacement) kind = "displacement";
    if (load.rotation) kind = "rotation";
    if (load.traction) kind = "traction";
    if (load.pressure) kind = "pressure";
    return object({{"on", words(load.on)}, {"kind", words(kind)}});
  });
}

// What langer-solve --dry-run says, as numbers.
std::vector<Summary> forecast(const SolveInputs& inputs, ModelChoice& model, Mesh mesh,
                              const std::optional<Material>& material, const Where& where) {
  const Voice voice{"solve", false, false};
  const double begun = cpu_seconds();
  SolveConfig config = model.config();
  Run run(std::move(mesh), config, material, where, model.at_a_point());
  held_by_contact(voice, run, where);
  report_scene(voice, run);
  config.estimate = estimate_of(voice, config, material, where, run);
  StudyRecord study;
  if (!inputs.material_file.empty()) study = study_from(inputs.material_file);
  RunWatch watch(run, config, where, study);
  return report_forecast(voice, config, material, where, run, watch, cpu_seconds() - begun);
}

}  // namespace

// The scene is made as langer-solve makes it, up to the first step. What fails after the body is
// there, such as a motion that nothing restrains, is reported in addition to the picture.
std::string scene_view(const std::string& pipeline_file, const std::string& run_folder) {
  const auto read = [](const std::string& path) {
    return load_yaml(path);
  };
  const std::vector<Step> steps =
      pipeline::expand(pipeline::read_pipeline(load_yaml(pipeline_file)), read);
  const auto solves = [](const Step& step) {
    return std::string(step.stage->name) == "solve";
  };
  const auto solve = std::ranges::find_if(steps, solves);
  if (solve == steps.end()) return object({{"node", Json{}}}).text;
  const auto members = std::ranges::count_if(
      steps, [&](const Step& step) { return solves(step) && step.node == solve->node; });

  const SolveInputs inputs = inputs_of(*solve, steps, run_folder);
  SolveConfig config;
  const ReadConfig read_of = read_stage_config(inputs.config, config);
  const Where& where = read_of.where;
  std::optional<Material> material = config.material;
  if (!inputs.material_file.empty()) material = material_of_body(inputs.material_file);

  ModelChoice model({"solve", false, false}, config, inputs.mesh_file, material, where, true);
  Mesh mesh = model.mesh();
  const Scene scene = make_scene(model.config(), mesh, material, where);
  const Skin skin = skin_of(mesh);
  std::vector<float> X;
  for (const Vec3& x : mesh.X) add(X, x);
  std::vector<std::int32_t> facets;
  for (const auto& facet : skin.facets) facets.insert(facets.end(), facet.begin(), facet.end());

  std::vector<std::pair<const char*, Json>> parts = {
      {"node", words(solve->node)},
      {"members", number(static_cast<double>(members))},
      {"law", words(inputs.law)},
      {"section", Json{mesh.section ? "true" : "false"}},
      {"cells", number(mesh.n_cells())},
      {"nodes", number(mesh.n_nodes())},
      {"X", packed(X)},
      {"facets", packed(facets)},
      {"sets", sets_view(mesh, skin)},
      {"indenters", indenters_view(scene, mesh)},
      {"fibres", fibres_view(scene, mesh, skin)},
      {"supports", supports_view(config)},
      {"loads", loads_view(config)}};
  Json numbers_of{};
  std::string problem;
  try {
    const std::vector<Summary> found = forecast(inputs, model, std::move(mesh), material, where);
    std::string text;
    for (const Summary& s : found)
      append(text, ",",
             words(s.name).text + ":[" + number(s.value).text + "," + words(s.unit).text + "]");
    numbers_of.text = "{" + text + "}";
  } catch (const Failure& failure) {
    problem = failure.what();
  }
  parts.emplace_back("forecast", numbers_of);
  parts.emplace_back("problem", words(problem));
  return object(parts).text;
}

}  // namespace langer
