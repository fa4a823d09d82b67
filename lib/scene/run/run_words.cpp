#include "scene/run/run_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "mechanics/assembly/zero_energy_modes.hpp"
#include "mechanics/mesh/facets.hpp"

namespace langer {

namespace {

// One indenter that pushes a body which nothing else holds or loads only moves it away. One of
// triangles may hold it from several sides.
bool is_pushed_away(const Run& run, const RigidMotions& free) {
  if (free.along < 3 || run.scene.contacts.size() != 1) return false;
  const RigidContact& contact = run.scene.contacts.front();
  return run.scene.surfaces.empty() && run.scene.loads.empty() && !contact.adhesion &&
         !surface_file(contact.shape);
}

double distance_from(const Line& axis, const Vec3& x) {
  return (x - axis.point).cross(axis.along).norm();
}

// How far from the axis of a hole a load presses on facets that may touch the plate around it [mm];
// 0 if its facets end where the plate begins to be flat.
double reach_under_plate(const Mesh& mesh, const RigidContact& contact, const RoundHole& hole,
                         const SurfaceLoad& load) {
  const std::set<int> candidates(contact.nodes.begin(), contact.nodes.end());
  const double flat_from = (1 + 1e-6) * (hole.radius + hole.edge);
  const auto is_beyond = [&](int node) {
    return distance_from(hole.axis, mesh.X[static_cast<std::size_t>(node)]) > flat_from;
  };
  // Of a section only the nodes in front are candidates.
  const auto may_touch = [&](int node) {
    return candidates.count(node) > 0;
  };
  double reach = 0;
  for (const Facet& facet : load.facets)
    for (const auto& quad : facet_quads(mesh, facet)) {
      if (!std::ranges::all_of(quad, is_beyond) || !std::ranges::any_of(quad, may_touch)) continue;
      for (int node : quad)
        reach = std::max(reach, distance_from(hole.axis, mesh.X[static_cast<std::size_t>(node)]));
    }
  return reach;
}

// A pressure acts on its whole set, also where a plate with a hole covers it.
void warn_of_pressure_under_plates(const Voice& voice, const Run& run) {
  for (const RigidContact& contact : run.scene.contacts) {
    const std::optional<RoundHole> hole = hole_of(contact.shape);
    if (!hole) continue;
    for (const SurfaceLoad& load : run.scene.loads) {
      if (load.pressure == 0 && !load.volume) continue;
      const double reach = reach_under_plate(run.mesh, contact, *hole, load);
      if (reach == 0) continue;
      voice.warn(fmt::format(
          "contacts.{}: a pressure also acts under the plate: its set reaches {:.4g} mm from the "
          "axis of the hole, and the plate is flat from {:.4g} mm on",
          contact.name, reach, hole->radius + hole->edge));
    }
  }
}

}  // namespace

double report_scene(const Voice& voice, const Run& run) {
  for (const Material& m : run.scene.materials)
    if (at_rest(m) == AtRest::unstable) voice.warn("a law is " + at_rest_in_words(m));
  warn_of_pressure_under_plates(voice, run);
  FibreJump jump = FibreJump{};
  if (run.scene.families() > 0) jump = largest_jump(run.mesh, run.scene.directions);
  if (jump.degrees > 1e-3)
    voice.detail(
        "fibres turn by up to {:.3g} degrees between neighbours: cells {} and {}, at ({:.4g}, {:.4g}, {:.4g}) mm",
        jump.degrees, jump.cell, jump.neighbour, jump.place[0], jump.place[1], jump.place[2]);
  if (const std::string words = run.reduction.words(); !words.empty()) voice.detail("{}", words);
  return jump.degrees;
}

std::string held_by_contact(const Voice& voice, const Run& run, const Run::Where& where) {
  if (run.inertia) return "";  // inertia resists every motion
  const RigidMotions free =
      rigid_motions(run.mesh, run.mesh.section ? run.reduction.scene().dofs : run.scene.dofs);
  const bool no_contact = run.scene.contacts.empty();
  if (!free.words.empty() && (no_contact || is_pushed_away(run, free)))
    throw Failure(Exit::config,
                  Error{where("supports"), "supports", free.words,
                        no_contact ? "a body that is held, or contacts"
                                   : "a body that is held: one indenter only pushes it away",
                        ""});
  if (free.about > 1)
    voice.warn(free.words +
               ": only contact keeps it from tipping over; is a support missing, or does its set "
               "have too few nodes?");
  return free.words;
}

std::vector<Summary> summary_of(const Run& run, const RunEnd& end, int n_steps) {
  const Increment::Cost cost = run.increment.cost();
  std::vector<Summary> summary{
      {"steps", static_cast<double>(n_steps), "-"},
      {"iterations", static_cast<double>(end.path.iterations), "-"},
      {"cuts", static_cast<double>(end.path.cut_backs), "-"},
      {"indefinite", static_cast<double>(run.increment.n_indefinite()), "-"},
      {"cpu_assembly", cost.assembly, "s"},
      {"cpu_factor", cost.factor, "s"},
      {"cpu_solve", cost.solve, "s"},
      {"cpu_contact", cost.contact, "s"}};
  if (!run.scene.contacts.empty()) summary.push_back({"force", end.last.force_ind.norm(), "N"});
  for (const RigidContact& contact : run.scene.contacts)
    if (const auto found = end.last.scalars.find("force_" + contact.name);
        found != end.last.scalars.end())
      summary.push_back({"force_" + contact.name, found->second, "N"});
  const double cells = run.mesh.n_cells();
  if (run.reduction.kind() == Reduction::Kind::symmetry)
    summary.push_back({"symmetry", cells / run.body.mesh().n_cells(), "-"});
  if (run.reduction.kind() == Reduction::Kind::homogeneous)
    summary.push_back({"homogeneous", cells, "-"});
  return summary;
}

std::vector<Summary> joined(const std::vector<std::vector<Summary>>& parts) {
  std::vector<Summary> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace langer
