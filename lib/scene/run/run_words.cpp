#include "scene/run/run_words.hpp"

#include <fmt/format.h>

#include "mechanics/assembly/zero_energy_modes.hpp"

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

}  // namespace

double report_scene(const Voice& voice, const Run& run) {
  for (const Material& m : run.scene.materials)
    if (at_rest(m) == AtRest::unstable) voice.warn("a law is " + at_rest_in_words(m));
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
