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
#include "mechanics/mesh/section.hpp"
#include "scene/model/scene.hpp"
#include "scene/model/scene_bodies.hpp"
#include "scene/model/scene_symmetry.hpp"
#include "scene/model/solve_config_io.hpp"

namespace langer {

namespace {

// The vector without negative zeros.
Vec3 plain(const Vec3& x) { return (x.array() + 0.0).matrix(); }

const auto nowhere = [](const std::string&) {
  return Place{};
};

[[noreturn]] void refuse(const std::string& path, const std::string& key, const std::string& found,
                         const std::string& expected) {
  throw Failure(Exit::config, Error{{path}, key, found, expected, ""});
}

// A position as the key of a map.
using Spot = std::tuple<double, double, double>;
Spot spot(const Vec3& X) { return {X[0], X[1], X[2]}; }

// Refuses loads that decks cannot express.
void check_loads(const SolveConfig& config, const std::string& path) {
  if (config.in_motion()) refuse(path, "dynamics", "a body in motion", "an equilibrium");
  for (std::size_t i = 0; i < config.loads.size(); ++i)
    if (config.loads[i].on_surface())
      refuse(path, fmt::format("loads[{}]", i), "a force, a traction or a pressure",
             "imposed displacements and indenters");
  for (std::size_t i = 0; i < config.loads.size(); ++i)
    if (config.loads[i].rotation)
      refuse(path, fmt::format("loads[{}].rotation", i), "a set that is turned",
             "one that is displaced");
}

// Refuses indenters that decks cannot express.
void check_contacts(const SolveConfig& config, const std::string& path) {
  for (const auto& [name, contact] : config.contacts)
    if (contact.rotation)
      refuse(path, "contacts." + name + ".rotation", "an indenter that turns", "one that does not");
  for (const auto* contacts : {&config.contacts, &config.touching})
    for (const auto& [name, contact] : *contacts)
      if (contact.adhesion && contact.adhesion->work > 0)
        refuse(path, "contacts." + name + ".adhesion", "a contact that adheres",
               "one without adhesion: decks cannot express it");
  for (const auto& [name, contact] : config.contacts)
    if (contact.control)
      refuse(path, "contacts." + name + ".control", "a force-controlled indenter",
             "one with a prescribed motion");
  for (const auto& [name, contact] : config.contacts)
    if (!std::holds_alternative<Sphere>(contact.rigid.value()))
      refuse(
          path, "contacts." + name + ".rigid", "an indenter of another shape",
          "a sphere, or no indenter: closest to an ellipsoid is the sphere of its curvature, to a "
          "plane a large sphere");
  for (const auto& [name, contact] : config.touching)
    if (contact.on == *contact.against)
      refuse(path, "contacts." + name + ".against", "a surface that touches itself",
             "two surfaces");
}

// The config of the solution with its materials, which the solution stores itself. Refuses
// everything that no deck can express.
SolveConfig config_of(const SolutionHeader& header, const std::string& path) {
  Tree tree = parse_yaml(header.identity.config, path + ": config");
  SolveConfig config = read_config<SolveConfig>(tree).config;
  expand_bodies(config, tree);
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
  check_loads(config, path);
  check_contacts(config, path);
  return config;
}

// The symmetric part of a body, if mirror planes cut it between elements. Otherwise nullptr: the
// whole body is written.
const ReducedScene* exportable(const std::optional<ReducedScene>& part) {
  if (!part || part->swaps_indenters()) return nullptr;
  const auto& share = part->cell_share();
  const auto same_share = [&](double s) {
    return !(std::abs(s - share[0]) > 1e-12);
  };
  if (!std::ranges::all_of(share, same_share)) return nullptr;
  // Half turns tie nodes to each other instead of to a plane. No deck can express that.
  const auto& tie = part->scene().dofs.tie;
  for (std::size_t i = 0; i < tie.size(); ++i)
    if (tie[i].of != static_cast<int>(i)) return nullptr;
  return &*part;
}

// Groups of elements whose fibre families with stiffness have the same directions. Families
// without stiffness are left out, because other programs do not need them and FEBio refuses them.
std::vector<FibreGroup> groups_of(const Mesh& mesh, const Scene& scene) {
  std::map<std::pair<int, std::vector<long long>>, FibreGroup> groups;
  for (int e = 0; e < mesh.n_cells(); ++e) {
    int body = 0;
    if (!mesh.body.empty()) body = mesh.body[e];
    const Material& law = scene.materials[body];
    const std::vector<Vec3> fibres = acting(law, scene.directions.of(e));
    // Directions that agree to nine digits are the same.
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

// The facets of the surface all of whose corners are in a list of nodes.
std::vector<Facet> outer_facets(const Mesh& mesh, const std::vector<int>& nodes) {
  const std::set<int> candidates(nodes.begin(), nodes.end());
  const auto is_candidate = [&](int node) {
    return candidates.count(node) > 0;
  };
  std::map<std::array<int, 4>, std::pair<int, Facet>> seen;
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (int f = 0; f < mesh.cell().n_facets(); ++f) {
      const auto key = facet_key(mesh, {e, f});
      if (!std::ranges::all_of(key, is_candidate)) continue;
      auto& [times, facet] = seen[key];
      ++times;
      facet = {e, f};
    }
  std::vector<Facet> facets;
  for (const auto& [key, found] : seen)
    if (found.first == 1) facets.push_back(found.second);
  return facets;
}

// The shortest edge of the facets, to which the facets of the sphere are adapted.
double shortest_side(const Mesh& mesh, const std::vector<Facet>& facets) {
  double least = 1e300;
  for (const Facet& facet : facets)
    for (const auto& quad : facet_quads(mesh, facet))
      for (int k = 0; k < 4; ++k)
        least = std::min(least, (mesh.X[quad[k]] - mesh.X[quad[(k + 1) % 4]]).norm());
  return least;
}

// The contact of a deck. Its cap covers all positions of the candidates relative to the sphere,
// with facets of half the shortest side of the body's facets.
DeckContact contact_of(const Mesh& mesh, const RigidContact& law, const std::string& set,
                       const Vec3& towards, const std::string& path) {
  DeckContact contact{law, set, outer_facets(mesh, law.nodes), {}};
  if (contact.facets.empty())
    refuse(path, "contacts." + law.name + ".on", "no facet with all corners in " + set,
           "a set that covers facets");
  // Where each candidate is relative to the sphere at the waypoints of its path.
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

// Comment lines with Langer's forces at the last step, of the whole body.
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
    const auto pair = config.touching.find(name);
    if (pair == config.touching.end()) {
      answer("the indenter \"" + name + "\"", force);
    } else {
      answer("\"" + *pair->second.against + "\" by \"" + pair->second.on + "\"", force);
    }
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
  // Measured: converged up to ratios of 500 to 1000 in FEBio 4.11 and 370 in CalculiX 2.20, which
  // stalls at 3700.
  constexpr double largest_ratio = 1000;
  TooStiff worst;
  for (const Material& m : deck.materials) {
    const double mu = shear_modulus(m);
    const double ratio = bulk_modulus(m) / mu;
    if (mu > 0 && ratio > worst.ratio) worst = {ratio, 2 / (largest_ratio * mu)};
  }
  if (!deck.touches() || worst.ratio <= largest_ratio * (1 + 1e-9)) return std::nullopt;
  return worst;
}

namespace {

// Composes a deck from the scene that was solved. If symmetry determines the rest, a part of the
// body is written.
class DeckComposer {
 public:
  DeckComposer(const SolutionReader& solution, const SolveConfig& config, const std::string& path)
      : solution_(solution),
        header_(solution.header()),
        path_(path),
        config_(config),
        whole_(scene_of(config_, header_)),
        // decks of other programs move what the config moves
        found_(ReducedScene::find(config_.symmetry, header_.mesh, whole_, nowhere, nullptr,
                                  ReducedScene::Seen::from_rest)),
        part_(exportable(found_)) {}

  // Composes the whole deck; may be called once.
  Deck deck() {
    if (part_) {
      deck_.mesh = part_->mesh();
    } else {
      deck_.mesh = header_.mesh;
    }
    deck_.mesh.node_sets.clear();
    deck_.mesh.facet_sets.clear();
    for (int n = 0; part_ && n < deck_.mesh.n_nodes(); ++n) number_[spot(deck_.mesh.X[n])] = n;
    for (const Material& m : scene().materials) deck_.materials.push_back(acting(m));
    deck_.groups = groups_of(deck_.mesh, scene());
    deck_.share = static_cast<double>(header_.mesh.n_cells()) / deck_.mesh.n_cells();
    deck_.words.push_back(fmt::format("a scene of langer-solve, {}{} ({}); mm, N, MPa", written_by,
                                      version, revision));
    add_supports_and_loads();
    add_mirror_planes();
    for (std::size_t c = 0; c < scene().contacts.size(); ++c) add_contact(c);
    for (const auto& [name, contact] : config_.touching) add_pair(name, contact);
    set_increments();
    add_remarks();
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

  // Of a node of the whole body, where it is in the written part. Nodes of two bodies may be at one
  // place: only a part is searched by position.
  std::optional<int> number_in_deck(int node) const {
    if (!part_) return node;
    const auto at = number_.find(spot(header_.mesh.X[node]));
    if (at == number_.end()) return std::nullopt;
    return at->second;
  }

  // Adds the nodes of a set that are in the written part. Returns false if there are none.
  bool add_set(const std::string& set) {
    std::vector<int>& nodes = deck_.mesh.node_sets[set];
    if (!nodes.empty()) return true;
    for (int n : header_.mesh.node_sets.at(set))
      if (const auto at = number_in_deck(n)) nodes.push_back(*at);
    std::sort(nodes.begin(), nodes.end());
    if (nodes.empty()) deck_.mesh.node_sets.erase(set);
    return deck_.mesh.node_sets.count(set) > 0;
  }

  // A name that no set of the whole body has.
  std::string free_name(std::string name) const {
    while (header_.mesh.node_sets.count(name)) name += "_";
    return name;
  }

  // Components with an imposed displacement, of supports and of moved sets that are in the
  // written part.
  void add_supports_and_loads() {
    for (const SupportConfig& support : config_.supports)
      for (Axis axis : support.hold)
        if (add_set(support.on)) deck_.held.push_back({support.on, static_cast<int>(axis), {}});
    for (const LoadConfig& load : config_.loads)
      for (int k = 0; k < 3; ++k) {
        const auto to = load.imposed(k);
        if (to && add_set(load.on))
          deck_.held.push_back({load.on, k, history_of(*to, config_.path.seconds)});
      }
  }

  // Nodes on a mirror plane do not move across it. The dofs of the reduced scene show which they
  // are.
  void add_mirror_planes() {
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

  // A sphere and the surface that it may touch. Its direction to the body is that to the mean of
  // the candidates.
  void add_contact(std::size_t c) {
    const RigidContact& law = scene().contacts[c];
    const Ball sphere = *ball_of(law.shape);
    const Vec3 to = plain(indenter_displacement(law, 1));
    deck_.words.push_back(
        fmt::format("sphere \"{}\": radius {:g}, centre ({:g}, {:g}, {:g}), ends moved by ({:g}, "
                    "{:g}, {:g}), friction {:g}",
                    law.name, sphere.radius, sphere.centre[0], sphere.centre[1], sphere.centre[2],
                    to[0], to[1], to[2], law.mu));
    // The mean of the candidates of the whole body, because a part may have those on one side
    // only.
    Vec3 middle = Vec3::Zero();  // of the whole body's candidates
    for (int n : whole_.contacts[c].nodes)
      middle += header_.mesh.X[n] / static_cast<double>(whole_.contacts[c].nodes.size());
    std::string set = config_.contacts.at(law.name).on;
    if (set.empty()) {
      // The candidates are the nodes that the indenter can reach.
      set = free_name("contact_" + law.name);
      deck_.mesh.node_sets[set] = law.nodes;
    } else {
      add_set(set);
    }
    deck_.contacts.push_back(
        contact_of(deck_.mesh, law, set, (middle - sphere.centre).normalized(), path_));
  }

  // Two surfaces, which no symmetry has cut.
  void add_pair(const std::string& name, const ContactConfig& contact) {
    const Mesh& mesh = header_.mesh;
    deck_.words.push_back(fmt::format("surfaces \"{}\": \"{}\" against \"{}\", friction {:g}", name,
                                      contact.on, *contact.against, contact.friction));
    deck_.pairs.push_back(
        {name, contact.friction, surface_of(mesh, contact.on), surface_of(mesh, *contact.against)});
  }

  // The increments of the config; every kink of the path is a stop.
  void set_increments() {
    const LoadPathOptions& increments = config_.path;
    deck_.first = increments.first_increment();
    deck_.largest = increments.largest_increment();
    deck_.smallest = increments.smallest;
    std::set<double> stops(scene().stops.begin(), scene().stops.end());
    stops.insert(1.0);
    deck_.stops.assign(stops.begin(), stops.end());
  }

  // Comment lines on the mesh, the symmetry and the results.
  void add_remarks() {
    deck_.words.push_back(fmt::format("{} elements {}, {} nodes", deck_.mesh.n_cells(),
                                      names(deck_.mesh.type)[static_cast<int>(deck_.mesh.type)],
                                      deck_.mesh.n_nodes()));
    if (header_.formulation == "displacement")
      deck_.words.push_back(
          "solved with formulation: displacement, which locks near incompressibility: the elements "
          "here do not");
    if (part_)
      deck_.words.push_back(
          fmt::format("{}: forces here are 1/{:g} of the body's", part_->words(), deck_.share));
    if (found_ && !part_)
      deck_.words.push_back("solved by symmetry (" + found_->words() +
                            "), which mirror planes between elements with one indenter on them "
                            "cannot express: the whole body");
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
  std::map<Spot, int> number_;  // of the nodes of the written part, by position
};

}  // namespace

// Refuses scenes that no program can express before it composes the deck.
Deck deck_of(const SolutionReader& solution, const std::string& path) {
  const SolutionHeader& header = solution.header();
  if (header.mesh.section)
    refuse(path, "", "a section",
           "the same scene on a body in three dimensions; with symmetry: auto a quarter of it is "
           "enough");
  if (!header.mesh.hanging.empty())
    refuse(path, "", "locally refined elements with hanging nodes",
           "the same scene on a mesh without `cuts`: the decks have no ties");
  for (const Material& law : header.laws())
    if (is_viscous(law))
      refuse(path, "", "a viscous material, whose scene depends on time",
             "the same scene without viscous and spectrum: the material after complete relaxation");
  const SolveConfig config = config_of(header, path);
  if (!header.mesh.cell().names.febio)
    refuse(path, "",
           fmt::format("elements {}",
                       names(header.mesh.type)[static_cast<std::size_t>(header.mesh.type)]),
           "the same body with hex8: CalculiX has no such element, that of FEBio was not tested");
  return DeckComposer(solution, config, path).deck();
}

}  // namespace langer
