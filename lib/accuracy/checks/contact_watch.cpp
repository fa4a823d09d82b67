#include "accuracy/checks/contact_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/model/scene_adhesion.hpp"
#include "scene/run/step_record.hpp"

namespace langer {

namespace {

constexpr double tiny = 1e-9;  // [mm] what positions are known to

// Depths between nodes as a share of the travel: from `share_meaningless` on the force says nothing
// of the body, from `share_warned` on a warning says so. A node outside the set may be inside the
// indenter by `node_refused` of the travel before the run stops.
constexpr double share_meaningless = 0.5;
constexpr double share_warned = 0.1;
constexpr double node_refused = 0.01;

std::string text(const Vec3& X) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", X[0], X[1], X[2]);
}

}  // namespace

// An indenter must start outside of the body. All three ways to start inside are refused: the whole
// indenter inside, a node inside the indenter, a facet inside it between its nodes.
ContactWatch::ContactWatch(const Mesh& mesh, const Scene& scene, Where where)
    : mesh_(mesh),
      scene_(scene),
      where_(std::move(where)),
      check_(mesh),
      found_(scene.contacts.size()) {
  const std::vector<Vec3> rest(mesh.X.size(), Vec3::Zero());
  for (const RigidContact& contact : scene.contacts) {
    const SurfaceLook look = check_.look(contact, rest, Vec3::Zero());
    const std::string key = "contacts." + contact.name + ".rigid";
    const std::string outside = "a start outside the body or touching it";
    const std::string hint = "the indenter moves in from there by `motion`";
    if (look.swallowed) refuse(key, "starts wholly inside the body", outside, hint);
    if (look.node.depth > tiny)
      refuse(
          key,
          fmt::format("starts {:.3g} mm inside the body at {}", look.node.depth, text(look.node.X)),
          outside, hint);
    if (look.unresolved_ratio > 1)
      refuse(key,
             fmt::format("starts {:.3g} mm inside the body near {}, between its nodes",
                         look.unresolved.depth, text(look.unresolved.X)),
             outside, hint);
  }
  for (Found& f : found_) f.distance = std::numeric_limits<double>::infinity();
}

void ContactWatch::refuse(const std::string& key, std::string found, std::string expected,
                          std::string hint) const {
  throw Failure(Exit::config,
                Error{where_(key), key, std::move(found), std::move(expected), std::move(hint)});
}

// How deep the body is inside the indenter between nodes, as a share of the depth to which the
// indenter is pressed.
double ContactWatch::Found::share() const {
  const double depth = at_force.facet.depth;
  if (depth > tiny) return depth / std::max(at_force.pressed, depth);
  return 0;
}

// States in which the force is not that of the scene: the surface does not stop the indenter, or
// the mesh cannot show its shape.
void ContactWatch::refuse_mid_path(const RigidContact& contact, const SurfaceLook& look,
                                   double t) const {
  const std::string key = "contacts." + contact.name;
  const std::string when = fmt::format("at t = {:.4g} the indenter is ", t);
  if (look.swallowed)
    refuse(key + ".rigid", when + "wholly inside the body and touches no node",
           "an indenter that the body's surface stops",
           "shorter cells where it goes in, and shorter increments");
  const double width = half_width(contact.shape);
  if ((look.touching > 0 || look.facet.depth > tiny) && width < look.spacing)
    refuse(
        key + ".rigid",
        when +
            fmt::format(
                "smaller than the cells: half its width is {:.3g} mm, nodes that it meets are {:.3g} mm apart (at {})",
                width, 2 * look.spacing, text(look.nearest)),
        fmt::format("nodes at most {:.3g} mm apart there", 2 * width),
        "shorter cells where it goes in");
  if (look.node.depth > tiny && look.node.depth > node_refused * look.pressed)
    refuse(key + ".on",
           when + fmt::format("{:.3g} mm inside the body at {}, a node that is not in its set",
                              look.node.depth, text(look.node.X)),
           "a set with every node that the indenter reaches",
           "leave out the key `on`, or name a larger set: the force is wrong from here on");
  if (look.unresolved_ratio > 1)
    refuse(key + ".rigid",
           when + fmt::format("{:.3g} mm inside the body near {}, between its nodes",
                              look.unresolved.depth, text(look.unresolved.X)),
           fmt::format("at most {:.3g} mm, half the distance of the nodes there",
                       look.unresolved.depth / look.unresolved_ratio),
           "shorter cells there");
}

// An indenter that is away from the body before and after an increment may have passed through it.
void ContactWatch::refuse_jump(const RigidContact& contact, const std::vector<Vec3>& u,
                               const Vec3& from, const Vec3& to, double t) const {
  const double width = half_width(contact.shape);
  const int parts = static_cast<int>(std::min(1000.0, std::ceil((to - from).norm() / width)));
  for (int k = 1; k < parts; ++k) {
    const SurfaceLook look =
        check_.look(contact, u, from + (static_cast<double>(k) / parts) * (to - from));
    const SurfaceLook::Spot* deepest = &look.facet;
    if (look.node.depth > look.facet.depth) deepest = &look.node;
    if (!look.swallowed && deepest->depth <= tiny) continue;
    Vec3 place = deepest->X;
    if (look.swallowed) place = look.nearest;
    refuse(
        "contacts." + contact.name + ".motion",
        fmt::format(
            "in the increment to t = {:.4g} the indenter passes through the body near {} and touches no node",
            t, text(place)),
        fmt::format("increments in which it moves by at most half its width, {:.3g} mm", width),
        "smaller path.first and path.largest");
  }
}

// Keeps the worst of all steps, the nearest approach, and the state with the largest force, of
// which the warnings at the end speak.
void ContactWatch::keep(std::size_t contact, const SurfaceLook& look, double t, double force) {
  Found& f = found_[contact];
  if (look.node.depth > std::max(f.node.depth, tiny)) f.node = look.node;
  if (look.facet.depth > std::max(f.facet.depth, tiny)) f.facet = look.facet;
  if (look.distance < f.distance) {
    f.distance = look.distance;
    f.nearest = look.nearest;
    f.t_nearest = t;
  }
  f.touched = f.touched || look.touching > 0;
  if (force >= f.force) {
    f.force = force;
    f.at_force = look;
  }
}

// Looks at each indenter of an accepted step, and adds the force of each one where there are
// several, and the depth between nodes.
void ContactWatch::look(StepRecord& record) {
  double entry = 0;
  for (std::size_t k = 0; k < scene_.contacts.size(); ++k) {
    const RigidContact& contact = scene_.contacts[k];
    const std::vector<Vec3>& r = record.contacts.at(contact.name).r;
    const Vec3 c = indenter_at(contact, record);
    const SurfaceLook look = check_.look(contact, record.u, c, r);
    refuse_mid_path(contact, look, record.t);
    Found& before = found_[k];
    const bool away = look.touching == 0;
    if (away && before.away) refuse_jump(contact, record.u, before.c, c, record.t);
    before.c = c;
    before.away = away;
    Vec3 force = record.force_ind;  // on the indenter
    if (scene_.contacts.size() > 1) {
      for (int j = 0; j < 3; ++j)
        force[j] = record.scalars.at("force_" + contact.name + "_" + "xyz"[j]);
      if (adds_) {
        if (c.norm() > 0) {
          record.scalars["force_" + contact.name] = -force.dot(c) / c.norm();
        } else {
          record.scalars["force_" + contact.name] = force.norm();
        }
      }
    }
    keep(k, look, record.t, force.norm());
    const std::vector<double>& beta =
        record.contacts.at(contact.name).beta;  // what is bonded has touched
    if (std::any_of(beta.begin(), beta.end(), [](double b) { return b >= 0; }))
      found_[k].touched = true;
    entry = std::max(entry, look.facet.depth);
  }
  if (adds_) record.scalars["penetration_between_nodes"] = entry;
}

void ContactWatch::kept(const StepRecord& step) {
  StepRecord again = step;
  adds_ = false;
  for (Found& f : found_) f.away = false;  // the way to here was looked at by the run that made it
  look(again);
  adds_ = step.scalars.count("penetration_between_nodes") > 0;
}

// A force of 0 N because the indenter passed between nodes is no result.
void ContactWatch::finish() const {
  for (std::size_t k = 0; k < found_.size(); ++k) {
    const Found& f = found_[k];
    const std::string key = "contacts." + scene_.contacts[k].name + ".rigid";
    const std::string apart = fmt::format("{:.3g}", 2 * f.at_force.spacing);
    if (!f.touched && f.facet.depth > 1e-6 * f.at_force.spacing)
      refuse(
          key,
          fmt::format(
              "no node touches the indenter, which is up to {:.3g} mm inside the body near {}, between nodes {} mm apart",
              f.facet.depth, text(f.facet.X), apart),
          "an indenter that meets nodes", "shorter cells there: its force is not 0 N");
  }
}

std::vector<std::string> ContactWatch::warnings() const {
  std::vector<std::string> lines;
  const auto warn_of_bonds = [&](const auto& contact) {
    if (!contact.adhesion) return;
    const BondZone zone = bond_zone(*contact.adhesion, contact.nodes, mesh_, scene_.materials);
    if (zone.resolved()) return;
    lines.push_back(
        "contacts." + contact.name + ": " +
        fmt::format(
            "bonds come loose over about {:.2g} mm (4 shear moduli over adhesion.stiffness), and the "
            "shortest cells that touch are {:.2g} mm long: the pull depends on the cells; shorten "
            "them to {:.2g} mm, or lower the stiffness",
            zone.length, zone.cell, zone.longest_cell()));
  };
  for (const SurfaceContact& surface : scene_.surfaces) warn_of_bonds(surface);
  for (std::size_t k = 0; k < found_.size(); ++k) {
    const Found& f = found_[k];
    const std::string name = "contacts." + scene_.contacts[k].name + ": ";
    warn_of_bonds(scene_.contacts[k]);
    if (!f.touched)
      lines.push_back(
          name +
          fmt::format(
              "the indenter never touches the body: nearest at t = {:.4g}, {:.3g} mm from {}; look at its place "
              "and its motion",
              f.t_nearest, f.distance, text(f.nearest)));
    if (f.node.depth > 0)
      lines.push_back(
          name +
          fmt::format(
              "the indenter is up to {:.3g} mm inside the body at {}, a node that is not in its set; a larger "
              "set is needed",
              f.node.depth, text(f.node.X)));
    std::string meaning = "the force depends on the length of the cells";
    if (f.share() > share_meaningless)
      meaning = "the force is that of the cells and not of the body";
    if (f.share() > share_warned)
      lines.push_back(
          name +
          fmt::format(
              "between nodes the body is {:.3g} mm inside the indenter near {}, {:.0f} % of its travel: "
              "{}; shorten them there",
              f.at_force.facet.depth, text(f.at_force.facet.X), 100 * f.share(), meaning));
    const bool hangs =
        scene_.contacts[k].adhesion && f.at_force.touching == 0;  // by its bonds alone
    if (f.force > 0 && !f.at_force.whole_facet && !hangs)
      lines.push_back(
          name +
          fmt::format(
              "at the largest force {} node{}, and no facet as a whole: the force depends on the length "
              "of the cells, whose nodes are {:.3g} mm apart there; shorten them",
              f.at_force.touching, f.at_force.touching == 1 ? " touches" : "s touch",
              2 * f.at_force.spacing));
  }
  return lines;
}

std::vector<Summary> ContactWatch::summary() const {
  double share = 0, deepest = 0;
  for (const Found& f : found_) {
    share = std::max(share, f.share());
    deepest = std::max(deepest, f.facet.depth);
  }
  return {{"contact_warnings", static_cast<double>(warnings().size()), "-"},
          {"penetration_between_nodes", deepest, "mm"},
          {"penetration_share", share, "-"}};
}

}  // namespace langer
