#include "export/export_scene.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "core/base/version.hpp"
#include "export/acting.hpp"
#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/reference.hpp"
#include "scene/model/scene.hpp"
#include "scene/model/scene_symmetry.hpp"
#include "scene/model/solve_config_io.hpp"

namespace langer {

namespace {

// no negative zeros
Vec3 plain(const Vec3& x) {
  return x.unaryExpr([](double v) { return v + 0.0; });
}

const auto nowhere = [](const std::string&) {
  return Place{};
};

[[noreturn]] void refuse(const std::string& path, const std::string& key, const std::string& found,
                         const std::string& expected) {
  throw Failure(Exit::config, Error{{path}, key, found, expected, ""});
}

using Spot = std::tuple<double, double, double>;
Spot spot(const Vec3& X) { return {X[0], X[1], X[2]}; }

// The config as it was solved, with the laws that it found: what files held stands in the solution
// itself.
SolveConfig config_of(const SolutionHeader& header, const std::string& path) {
  SolveConfig config =
      read_config<SolveConfig>(parse_yaml(header.identity.config, path + ": config")).config;
  config.fibre_angles.clear();
  config.fibre_field.reset();
  config.materials.clear();
  for (std::size_t b = 0; b < header.mesh.bodies.size(); ++b) {
    BodyConfig body;
    if (header.materials.empty()) {
      body.material = header.material;
    } else {
      body.material = header.materials[b];
    }
    config.materials[header.mesh.bodies[b]] = body;
  }
  for (std::size_t i = 0; i < config.loads.size(); ++i)
    if (config.loads[i].on_surface())
      refuse(path, fmt::format("loads[{}]", i), "a force, a traction or a pressure",
             "imposed displacements and indenters");
  for (std::size_t i = 0; i < config.loads.size(); ++i)
    if (config.loads[i].rotation)
      refuse(path, fmt::format("loads[{}].rotation", i), "a set that is turned",
             "one that is displaced");
  for (const auto& [name, contact] : config.contacts)
    if (contact.rotation)
      refuse(path, "contacts." + name + ".rotation", "an indenter that turns", "one that does not");
  for (const auto& [name, contact] : config.contacts)
    if (contact.adhesion && contact.adhesion->work > 0)
      refuse(path, "contacts." + name + ".adhesion", "an indenter that adheres",
             "one without adhesion: no deck has this law");
  for (const auto& [name, contact] : config.contacts)
    if (contact.control)
      refuse(path, "contacts." + name + ".control", "an indenter under force control",
             "one that moves as told");
  for (const auto& [name, contact] : config.contacts)
    if (!ball_of(contact.rigid))
      refuse(
          path, "contacts." + name + ".rigid", "an indenter of another shape",
          "a sphere, or no indenter: the nearest to an ellipsoid is the sphere of its curvature, to a plane a large one");
  return config;
}

// The mirrored part of a body whose cells the planes do not cut; nothing where the whole has to be
// written.
const ReducedScene* exportable(const std::optional<ReducedScene>& part) {
  if (!part || part->swaps_indenters()) return nullptr;
  const auto& share = part->cell_share();
  if (std::any_of(share.begin(), share.end(),
                  [&](double s) { return std::abs(s - share[0]) > 1e-12; }))
    return nullptr;
  const auto& tie = part->scene().dofs.tie;
  for (std::size_t i = 0; i < tie.size(); ++i)
    if (tie[i].of != static_cast<int>(i)) return nullptr;
  return &*part;
}

// cells whose acting fibres are alike: no other program needs families whose modulus is 0, and
// FEBio refuses them
std::vector<FibreGroup> groups_of(const Mesh& mesh, const Scene& scene) {
  std::map<std::pair<int, std::vector<long long>>, FibreGroup> groups;
  for (int e = 0; e < mesh.n_cells(); ++e) {
    int body = 0;
    if (!mesh.body.empty()) body = mesh.body[e];
    const Material& law = scene.materials[body];
    const std::vector<Vec3> fibres = acting(law, scene.directions.of(e));
    std::pair<int, std::vector<long long>> key{body, {}};
    for (const Vec3& a : fibres)
      for (int k = 0; k < 3; ++k) key.second.push_back(std::llround(1e9 * a[k]));
    FibreGroup& group = groups[key];
    if (group.cells.empty()) {
      group.body = body;
      group.fibres = fibres;
    }
    group.cells.push_back(e);
  }
  std::vector<FibreGroup> list;
  for (auto& [key, group] : groups) list.push_back(std::move(group));
  return list;
}

std::vector<Facet> outer_facets(const Mesh& mesh, const std::vector<int>& nodes) {
  const std::set<int> may(nodes.begin(), nodes.end());
  std::map<std::array<int, 4>, std::pair<int, Facet>> seen;
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (int f = 0; f < mesh.cell().n_facets(); ++f) {
      const auto key = facet_key(mesh, {e, f});
      if (!std::all_of(key.begin(), key.end(), [&](int n) { return may.count(n) > 0; })) continue;
      auto& [times, facet] = seen[key];
      ++times;
      facet = {e, f};
    }
  std::vector<Facet> facets;
  for (const auto& [key, found] : seen)
    if (found.first == 1) facets.push_back(found.second);
  return facets;
}

double shortest_side(const Mesh& mesh, const std::vector<Facet>& facets) {
  double least = 1e300;
  for (const Facet& facet : facets)
    for (const auto& quad : facet_quads(mesh, facet))
      for (int k = 0; k < 4; ++k)
        least = std::min(least, (mesh.X[quad[k]] - mesh.X[quad[(k + 1) % 4]]).norm());
  return least;
}

DeckContact contact_of(const Mesh& mesh, const RigidContact& law, const std::string& set,
                       const Vec3& towards, const std::string& path) {
  DeckContact contact{law, set, outer_facets(mesh, law.nodes), {}};
  if (contact.facets.empty())
    refuse(path, "contacts." + law.name + ".on", "no facet with all corners in " + set,
           "a set that covers facets");
  std::vector<Vec3> places;
  for (int n : law.nodes) {
    places.push_back(mesh.X[n]);
    for (const Waypoint& w : law.motion) places.push_back(mesh.X[n] - w.to);
  }
  contact.cap =
      rigid_cap(*ball_of(law.shape), towards, places, 0.5 * shortest_side(mesh, contact.facets));
  return contact;
}

}  // namespace

namespace {

// forces at the last step, of the whole body
std::vector<std::string> answers(const SolutionReader& solution, const SolveConfig& config) {
  std::vector<std::string> lines;
  if (solution.n_steps() == 0) return lines;
  const StepRecord last = solution.step(solution.n_steps() - 1);
  const auto answer = [&](const std::string& on, Vec3 force) {
    force = plain(force);
    lines.push_back(fmt::format(
        "Langer's answer at t = {:g}: force on {} of the whole body ({:.6g}, {:.6g}, {:.6g}) N",
        last.t, on, force[0], force[1], force[2]));
  };
  for (const auto& [name, contact] : last.contacts) {
    Vec3 force = Vec3::Zero();
    for (const Vec3& r : contact.r) force -= r;
    answer("the indenter \"" + name + "\"", force);
  }
  for (const LoadConfig& load : config.loads) {
    Vec3 force = Vec3::Zero();
    for (int n : solution.header().mesh.node_sets.at(load.on)) force += last.reaction[n];
    answer("\"" + load.on + "\"", force);
  }
  return lines;
}

}  // namespace

std::optional<TooStiff> too_stiff_for_contact(const Deck& deck) {
  constexpr double borne =
      1000;  // measured: 500 to 1000 in FEBio 4.11, 370 in CalculiX 2.20, which stalls at 3700
  TooStiff worst;
  for (const Material& m : deck.materials) {
    const double mu = shear_modulus(m);
    const double ratio = bulk_modulus(m) / mu;
    if (mu > 0 && ratio > worst.ratio) worst = {ratio, 2 / (borne * mu)};
  }
  if (deck.contacts.empty() || worst.ratio <= borne * (1 + 1e-9)) return std::nullopt;
  return worst;
}

namespace {

// A deck on its way: the scene as it was solved, of which the part that decides the rest is
// written.
class DeckComposer {
 public:
  DeckComposer(const SolutionReader& solution, const SolveConfig& config, const std::string& path)
      : solution_(solution),
        header_(solution.header()),
        path_(path),
        config_(config),
        whole_(scene_of(config_, header_)),
        found_(ReducedScene::find(config_.symmetry, header_.mesh, whole_, nowhere)),
        part_(exportable(found_)) {}

  Deck deck() {
    if (part_) {
      deck_.mesh = part_->mesh();
    } else {
      deck_.mesh = header_.mesh;
    }
    deck_.mesh.node_sets.clear();
    deck_.mesh.facet_sets.clear();
    for (int n = 0; n < deck_.mesh.n_nodes(); ++n) number_[spot(deck_.mesh.X[n])] = n;
    for (const Material& m : scene().materials) deck_.materials.push_back(acting(m));
    deck_.groups = groups_of(deck_.mesh, scene());
    deck_.share = static_cast<double>(header_.mesh.n_cells()) / deck_.mesh.n_cells();
    deck_.words.push_back(fmt::format("a scene of langer-solve, {}{} ({}); mm, N, MPa", written_by,
                                      version, revision));
    hold_and_move();
    hold_mirror_planes();
    for (std::size_t c = 0; c < scene().contacts.size(); ++c) add_contact(c);
    take_increments();
    say_the_rest();
    return std::move(deck_);
  }

 private:
  static Scene scene_of(const SolveConfig& config, const SolutionHeader& header) {
    Scene scene = make_scene(config, header.mesh, {}, nowhere);
    scene.directions = header.directions;
    return scene;
  }
  const Scene& scene() const {
    if (part_) return part_->scene();
    return whole_;
  }

  // Nodes of a set of the whole body in what is written; false where none of them is.
  bool name_set(const std::string& set) {
    std::vector<int>& nodes = deck_.mesh.node_sets[set];
    if (!nodes.empty()) return true;
    for (int n : header_.mesh.node_sets.at(set))
      if (const auto at = number_.find(spot(header_.mesh.X[n])); at != number_.end())
        nodes.push_back(at->second);
    std::sort(nodes.begin(), nodes.end());
    if (nodes.empty()) deck_.mesh.node_sets.erase(set);
    return deck_.mesh.node_sets.count(set) > 0;
  }

  // a name that no set of the whole body has
  std::string free_name(std::string name) const {
    while (header_.mesh.node_sets.count(name)) name += "_";
    return name;
  }

  void hold_and_move() {
    for (const SupportConfig& support : config_.supports)
      for (Axis axis : support.hold)
        if (name_set(support.on)) deck_.held.push_back({support.on, static_cast<int>(axis), {}});
    for (const LoadConfig& load : config_.loads)
      for (int k = 0; k < 3; ++k)
        if (const auto to = load.imposed(k); to && name_set(load.on))
          deck_.held.push_back({load.on, k, history_of(*to, config_.path.seconds)});
  }

  void hold_mirror_planes() {
    for (int k = 0; part_ && k < 3; ++k) {
      std::vector<int> plane;
      for (int n = 0; n < deck_.mesh.n_nodes(); ++n)
        if (scene().dofs.tie[n].T(k, k) == 0) plane.push_back(n);
      if (plane.empty()) continue;
      const std::string name = free_name(fmt::format("mirror_{}", "xyz"[k]));
      deck_.mesh.node_sets[name] = plane;
      deck_.held.push_back({name, k, {}});
    }
  }

  void add_contact(std::size_t c) {
    const RigidContact& law = scene().contacts[c];
    const Ball sphere = *ball_of(law.shape);
    const Vec3 to = plain(indenter_displacement(law, 1));
    deck_.words.push_back(fmt::format(
        "sphere \"{}\": radius {:g}, centre ({:g}, {:g}, {:g}), ends moved by ({:g}, {:g}, {:g}), friction {:g}",
        law.name, sphere.radius, sphere.centre[0], sphere.centre[1], sphere.centre[2], to[0], to[1],
        to[2], law.mu));
    Vec3 middle = Vec3::Zero();  // of the whole body's candidates
    for (int n : whole_.contacts[c].nodes)
      middle += header_.mesh.X[n] / static_cast<double>(whole_.contacts[c].nodes.size());
    std::string set = config_.contacts.at(law.name).on;
    if (set.empty()) {  // what the indenter can reach
      set = free_name("contact_" + law.name);
      deck_.mesh.node_sets[set] = law.nodes;
    } else {
      name_set(set);
    }
    deck_.contacts.push_back(
        contact_of(deck_.mesh, law, set, (middle - sphere.centre).normalized(), path_));
  }

  void take_increments() {
    const LoadPathOptions& increments = config_.path;
    deck_.first = increments.first_increment();
    deck_.largest = increments.largest_increment();
    deck_.smallest = increments.smallest;
    std::set<double> stops(scene().stops.begin(), scene().stops.end());
    stops.insert(1.0);
    deck_.stops.assign(stops.begin(), stops.end());
  }

  void say_the_rest() {
    deck_.words.push_back(fmt::format("{} cells {}, {} nodes", deck_.mesh.n_cells(),
                                      names(deck_.mesh.type)[static_cast<int>(deck_.mesh.type)],
                                      deck_.mesh.n_nodes()));
    if (header_.formulation == "displacement")
      deck_.words.push_back(
          "solved with formulation: displacement, which locks near incompressibility: cells here do not");
    if (part_)
      deck_.words.push_back(
          fmt::format("{}: forces here are 1/{:g} of the body's", part_->words(), deck_.share));
    if (found_ && !part_)
      deck_.words.push_back(
          "solved by symmetry (" + found_->words() +
          "), which mirror planes between cells with one indenter on them cannot express: the whole body");
    for (const std::string& line : answers(solution_, config_)) deck_.words.push_back(line);
  }

  const SolutionReader& solution_;
  const SolutionHeader& header_;
  const std::string& path_;
  const SolveConfig& config_;
  const Scene whole_;
  const std::optional<ReducedScene> found_;
  const ReducedScene* part_;  // nullptr: the whole body is written
  Deck deck_;
  std::map<Spot, int> number_;  // of the places in what is written
};

}  // namespace

Deck deck_of(const SolutionReader& solution, const std::string& path) {
  const SolutionHeader& header = solution.header();
  if (header.mesh.section)
    refuse(
        path, "", "a section",
        "the same scene on a body in three dimensions: of its quarter, where symmetry: auto finds mirror planes");
  if (!header.mesh.hanging.empty())
    refuse(path, "", "cells that are cut beside larger ones",
           "the same scene on a mesh without `cuts`: the decks have no ties");
  for (const Material& law : header.laws())
    if (is_viscous(law))
      refuse(
          path, "", "a viscous material, whose scene goes through time",
          "the same scene without viscous and spectrum: the law that is left after all has relaxed");
  const SolveConfig config = config_of(header, path);
  if (!header.mesh.cell().names.febio)
    refuse(path, "",
           fmt::format("cells {}",
                       names(header.mesh.type)[static_cast<std::size_t>(header.mesh.type)]),
           "the same body with hex8: CalculiX has no such cell, FEBio's was not tried");
  return DeckComposer(solution, config, path).deck();
}

}  // namespace langer
