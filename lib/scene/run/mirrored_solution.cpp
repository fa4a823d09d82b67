#include "scene/run/mirrored_solution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "mechanics/mesh/bounding_box.hpp"
#include "results/store/solution_layout.hpp"
#include "scene/model/scene_image.hpp"
#include "scene/model/solve_config_io.hpp"
#include "scene/run/body_mesh.hpp"
#include "scene/run/continued.hpp"
#include "scene/run/step_record.hpp"

namespace langer {

namespace {

struct NamedTurn {
  const char* name;
  Mat3 turn;
};

Mat3 turn_of(double xx, double xz, double zx, double zz) {
  Mat3 turn = Mat3::Identity();
  turn(0, 0) = xx;
  turn(0, 2) = xz;
  turn(2, 0) = zx;
  turn(2, 2) = zz;
  return turn;
}

std::array<NamedTurn, 8> operations() {
  return {{{"the same fibres as", Mat3::Identity()},
           {"mirror x of", turn_of(-1, 0, 0, 1)},
           {"mirror z of", turn_of(1, 0, 0, -1)},
           {"half turn about y of", turn_of(-1, 0, 0, -1)},
           {"mirror x = z of", turn_of(0, 1, 1, 0)},
           {"mirror x = -z of", turn_of(0, -1, -1, 0)},
           {"quarter turn about y of", turn_of(0, 1, -1, 0)},
           {"quarter turn about -y of", turn_of(0, -1, 1, 0)}}};
}

// Torques change their sign in a mirror, derivatives belong to named components, deviations to
// parameters.
bool knows_how_to_turn(const StepRecord& step) {
  return step.point_fields.empty() &&
         std::none_of(step.scalars.begin(), step.scalars.end(), [](const auto& scalar) {
           const std::string& name = scalar.first;
           return name.starts_with("torque_") || name.starts_with("angle_") ||
                  name.starts_with("d_") || name.ends_with("_deviation");
         });
}

// Columns of results are those of the first family.
bool first_family_stays(const MeshImage& g, const Mesh& mesh, const Scene& scene,
                        const Scene& image) {
  for (int e = 0; e < mesh.n_cells(); ++e) {
    const auto a = scene.directions.of(e);
    const auto b = image.directions.of(g.cell[e]);
    if (a.empty() ||
        !has_direction(scene.materials[mesh.body.empty() ? 0 : mesh.body[e]].fibres[0]))
      continue;
    const Vec3 turned = g.turn * a[0];
    if (std::min((turned - b[0]).norm(), (turned + b[0]).norm()) > same_place) return false;
  }
  return true;
}

std::map<std::string, std::string> without_mirror(std::map<std::string, std::string> inputs) {
  inputs.erase("mirror");
  return inputs;
}

// what keeps the files from being of scenes that differ in their fibre angles only; empty where
// nothing
std::string other_task(const MirrorTask& task, const Identity& theirs,
                       const SolveConfig& their_config) {
  const SolveConfig& own = task.config;
  if (own.symmetry == SymmetryChoice::none) return "symmetry: none";
  const EstimateBy by = own.estimate.value_or(EstimateBy::recovery);
  const bool cheap = by == EstimateBy::none || by == EstimateBy::recovery;
  if (own.accuracy || own.fidelity || own.reduce == Reduce::automatic || !cheap)
    return "cells that are chosen, or errors that are estimated, are its own";
  SolveConfig same = their_config;
  same.fibre_angles = own.fibre_angles;
  if (to_yaml(same, file_name) != to_yaml(own, file_name))
    return "the configs differ in more than fibre_angles";
  if (without_mirror(theirs.inputs) != without_mirror(task.identity.inputs))
    return "they were made from other files";
  return "";
}

}  // namespace

std::optional<MirrorOperation> operation_between(const Mesh& mesh, const Scene& scene,
                                                 const Scene& image, std::string& why_not) {
  if (!scene.surfaces.empty()) {
    why_not = "surfaces that touch each other";
    return std::nullopt;
  }
  for (const NamedTurn& op : operations()) {
    auto g = find_image(mesh, op.turn, bounding_box(mesh.X).middle());
    if (!g) continue;
    const SceneImage found = image_of(*g, mesh, scene, image);
    bool own = found.broken.empty();
    for (std::size_t c = 0; own && c < found.contact.size(); ++c)
      own = found.contact[c] == static_cast<int>(c);
    if (own && first_family_stays(*g, mesh, scene, image))
      return MirrorOperation{op.name, std::move(*g)};
    // that the fibres differ is what the other operations are for
    if (why_not.empty() || !found.broken.starts_with("the fibres")) {
      if (found.broken.empty()) {
        why_not = "indenters or families change places";
      } else {
        why_not = found.broken;
      }
    }
  }
  if (why_not.empty()) why_not = "the mesh";
  return std::nullopt;
}

// A step of the other solution as it looks in the mirror: nodes, elements and candidates change
// places, vectors and tensors are turned.
StepRecord image_of_step(const StepRecord& step, const MeshImage& g,
                         const std::vector<RigidContact>& contacts) {
  StepRecord out = step;
  for (std::size_t i = 0; i < step.u.size(); ++i) {
    const auto to = static_cast<std::size_t>(g.node[i]);
    out.u[to] = g.turn * step.u[i];
    out.reaction[to] = g.turn * step.reaction[i];
  }
  for (auto& [name, values] : out.cell_fields) {
    const std::vector<double>& from = step.cell_fields.at(name);
    const auto width = static_cast<std::size_t>(solution::components_of(name));
    for (std::size_t e = 0; e < g.cell.size(); ++e) {
      const double* of = from.data() + width * e;
      double* to = values.data() + width * static_cast<std::size_t>(g.cell[e]);
      if (width == 9)
        Eigen::Map<Mat3>{to} = g.turn * Eigen::Map<const Mat3>(of) * g.turn.transpose();
      else if (width == 3)
        Eigen::Map<Vec3>{to} = g.turn * Eigen::Map<const Vec3>(of);
      else
        *to = *of;
    }
  }
  out.u_ind = g.turn * step.u_ind;
  out.force_ind = g.turn * step.force_ind;
  const auto turn = [&](const std::string& name, const auto& turned) {
    const std::array<std::string, 3> parts{name + "_x", name + "_y", name + "_z"};
    if (!std::all_of(parts.begin(), parts.end(),
                     [&](const auto& part) { return step.scalars.count(part) > 0; }))
      return;
    const Vec3 v = turned(
        Vec3(step.scalars.at(parts[0]), step.scalars.at(parts[1]), step.scalars.at(parts[2])));
    for (int k = 0; k < 3; ++k) out.scalars[parts[static_cast<std::size_t>(k)]] = v[k];
  };
  turn("weakest", Isometry{g.turn, g.centre});
  if (const auto cell = out.scalars.find("weakest_cell");
      cell != out.scalars.end() && cell->second >= 0)
    cell->second = g.cell[static_cast<std::size_t>(cell->second)];
  for (const RigidContact& contact : contacts) {
    turn("force_" + contact.name, [&](const Vec3& v) { return Vec3(g.turn * v); });
    std::map<int, std::size_t> candidate;
    for (std::size_t i = 0; i < contact.nodes.size(); ++i) candidate[contact.nodes[i]] = i;
    const ContactRecord& from = step.contacts.at(contact.name);
    ContactRecord& to = out.contacts.at(contact.name);
    for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
      const std::size_t j = candidate.at(g.node[static_cast<std::size_t>(contact.nodes[i])]);
      to.r[j] = g.turn * from.r[i];
      to.status[j] = from.status[i];
      to.gap[j] = from.gap[i];
      if (from.beta.empty()) continue;
      to.beta[j] = from.beta[i];
      to.bonded_at[j] = g.turn * from.bonded_at[i];
      to.adhesive[j] = g.turn * from.adhesive[i];
    }
  }
  return out;
}

// Copies the solution of a mirrored scene instead of solving it again. This is allowed only where
// both configs differ in nothing but their fibre angles, and a mirror turns one scene into the
// other.
Mirrored mirrored(const MirrorTask& task) {
  const auto no = [&](std::string why) {
    return Mirrored{"", std::move(why)};
  };
  const SolutionReader other(task.of);
  const Identity& theirs = other.header().identity;
  std::optional<SolveConfig> their_config;
  try {
    their_config = read_config<SolveConfig>(parse_yaml(theirs.config, task.of)).config;
  } catch (const Failure&) {
    return no("its config is not one of this version");
  }
  if (std::string why = other_task(task, theirs, *their_config); !why.empty())
    return no(std::move(why));
  const Mesh mesh = body_mesh(task.config, task.mesh_file, task.where);
  if (mesh.section) return no("a section is cheaper than its image");
  if (other.n_steps() == 0 || !knows_how_to_turn(other.step(other.n_steps() - 1)))
    return no("torques, derivatives or errors are its own");
  const Scene scene = make_scene(task.config, mesh, task.material, task.where);
  SolveConfig turned = task.config;
  turned.fibre_angles = their_config->fibre_angles;
  std::string why;
  const auto op =
      operation_between(mesh, make_scene(turned, mesh, task.material, task.where), scene, why);
  if (!op) return no(std::move(why));
  Mirrored out{fmt::format("{} {}", op->name, task.of), ""};
  // steps that a stopped run of this task kept would be as good; the copy is made at once
  SolutionWriter file(
      task.output,
      header_of(mesh, scene.formulation, scene, with_steps_hash(task.identity, task.config)),
      [](const StepRecord&, const EarlierRun&) { return false; });
  file.write_image_of(fmt::format("{} {} ({})", op->name, other.content_id(), task.of));
  StepRecord last;
  for (int i = 0; i < other.n_steps(); ++i)
    file.append(last = image_of_step(other.step(i), op->symmetry, scene.contacts));
  file.finish({}, other.summary());
  out.summary = {{"steps", static_cast<double>(other.n_steps()), "-"}};
  if (!scene.contacts.empty()) out.summary.push_back({"force", last.force_ind.norm(), "N"});
  for (const RigidContact& contact : scene.contacts)
    if (const auto found = last.scalars.find("force_" + contact.name); found != last.scalars.end())
      out.summary.push_back({"force_" + contact.name, found->second, "N"});
  return out;
}

std::optional<std::vector<Summary>> copy_mirrored_solution(const Voice& voice,
                                                           const MirrorTask& task) {
  const Mirrored image = mirrored(task);
  if (image.words.empty()) {
    voice.say("not the image of {}, which differs in: {}", task.of, image.why_not);
    return {};
  }
  voice.say("{}: not solved again", image.words);
  return image.summary;
}

}  // namespace langer
