#include "scene/model/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "core/base/text.hpp"
#include "mechanics/contact/surface_check.hpp"
#include "mechanics/contact/touch.hpp"
#include "mechanics/mesh/bounding_box.hpp"
#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/hanging.hpp"
#include "mechanics/mesh/reference.hpp"
#include "mechanics/mesh/section.hpp"
#include "meshing/read_surface.hpp"
#include "scene/model/hanging_constraints.hpp"
#include "scene/model/scene_adhesion.hpp"
#include "scene/model/scene_bodies.hpp"
#include "scene/model/scene_loads.hpp"
#include "scene/model/scene_motion.hpp"
#include "scene/model/scene_section.hpp"

namespace langer {

namespace {

using Find = std::function<Place(const std::string&)>;

// Collects the prescribed displacements of a scene by node and direction, and the errors in them:
// sets that the mesh does not have, and directions with two different values.
class ConstraintBuilder {
 public:
  ConstraintBuilder(const Mesh& mesh, const Find& where)
      : mesh_(mesh),
        where_(where),
        named_by_(3 * static_cast<std::size_t>(mesh.n_nodes())),
        to_(named_by_.size()) {}
  Place place_of(const std::string& key) const { return where_(key); }

  const std::vector<int>& of_set(const std::string& set, const std::string& key) {
    static const std::vector<int> none;
    const auto found = mesh_.node_sets.find(set);
    if (found != mesh_.node_sets.end() && !found->second.empty()) return found->second;
    std::vector<std::string> known;
    std::string list;
    for (const auto& [name, members] : mesh_.node_sets) {
      known.push_back(name);
      append(list, ", ", name);
    }
    const std::string near = nearest(set, known);
    errors.push_back({where_(key), key, fmt::format("found \"{}\"", set),
                      "a node set of the mesh: " + list, did_you_mean(near)});
    return none;
  }

  // false, and an error, where the key prescribes another movement in the same direction
  bool prescribe(int node, int axis, const History& to, const std::string& key,
                 const std::optional<Turn>& turn = {}) {
    const std::size_t dof = 3 * static_cast<std::size_t>(node) + static_cast<std::size_t>(axis);
    const Prescribed wanted{static_cast<int>(dof), to.value, to.factor, turn};
    if (!named_by_[dof].empty() && !to_[dof].moves_as(wanted)) {
      const bool other_way = to_[dof].value == to.value;
      errors.push_back(
          {where_(key), key,
           fmt::format("asks for {} at a node that {} sets to {}{}: at ({:.4g}, {:.4g}, "
                       "{:.4g}) mm",
                       words(wanted), named_by_[dof], words(to_[dof], false),
                       other_way && !turn && !to_[dof].turn ? " by another history" : "",
                       mesh_.X[static_cast<std::size_t>(node)][0],
                       mesh_.X[static_cast<std::size_t>(node)][1],
                       mesh_.X[static_cast<std::size_t>(node)][2]),
           "one value for each direction of a node",
           "the two sets share it: leave the direction out of one of the keys, or the node out of "
           "one of the sets"});
      return false;
    }
    named_by_[dof] = key;
    to_[dof] = wanted;
    prescribed.push_back(wanted);
    return true;
  }

  std::vector<Prescribed> prescribed;  // in the order of the config
  std::vector<Error> errors;

 private:
  static std::string words(const Prescribed& wanted, bool with_name = true) {
    std::string name;
    if (with_name) name = fmt::format("{} = ", "xyz"[wanted.dof % 3]);
    if (wanted.turn) return fmt::format("{}{} mm and a rotation", name, wanted.value);
    return fmt::format("{}{} mm", name, wanted.value);
  }
  const Mesh& mesh_;
  const Find& where_;
  std::vector<std::string> named_by_;  // by dof: the key; empty where none
  std::vector<Prescribed> to_;         // by dof
};

History radians(const HistoryConfig& degrees, std::optional<double> seconds) {
  History history = history_of(degrees, seconds);
  history.value *= std::numbers::pi / 180;
  return history;
}

void set_angles(Material& material, const std::vector<double>& angles, const std::string& key,
                const Find& where, std::vector<Error>& errors) {
  if (angles.size() != material.fibres.size())
    return errors.push_back(
        {where(key), key, fmt::format("found {} angles", angles.size()),
         fmt::format("{}, one for each fibre family of the material", material.fibres.size()), ""});
  for (std::size_t k = 0; k < angles.size(); ++k) material.fibres[k].alpha_deg = angles[k];
}

// A field gives the direction of the first family: angles beside it tell those of further ones, and
// of a single one nothing.
void refuse_angles_without_effect(const std::vector<double>& angles,
                                  const std::optional<FibreField>& field, const Material& material,
                                  const std::string& key, const Find& where,
                                  std::vector<Error>& errors) {
  if (!field || angles.empty() || material.fibres.size() != 1) return;
  for (const Error& e : errors)
    if (e.key == key) return;
  errors.push_back(
      {where(key), key,
       "found together with fibre_field, which gives the direction of the only family",
       "one of the two",
       "`fibre_field: null` takes an included field away, `fibre_angles: []` included angles"});
}

// The material, fibre angles and fibre field of each body. Keys of a body replace those at the top
// of the config; a key at the top that no body uses is an error.
void add_materials(Scene& scene, const SolveConfig& config, const Mesh& mesh,
                   const std::optional<Material>& general, const Find& where,
                   std::vector<Error>& errors) {
  std::string list;
  for (const std::string& name : mesh.bodies) append(list, ", ", name);
  for (const auto& [name, body] : config.materials)
    if (std::find(mesh.bodies.begin(), mesh.bodies.end(), name) == mesh.bodies.end()) {
      const std::string near = nearest(name, mesh.bodies);
      const std::string key = "materials." + name;
      errors.push_back({where(key), key, fmt::format("found \"{}\"", name),
                        "a body of the mesh: " + list, did_you_mean(near)});
    }
  if (!errors.empty()) return;
  std::vector<FirstFamily> fields(mesh.bodies.size());
  // do any bodies take the keys at the top?
  bool angles_follow = false;
  bool field_follows = false;
  for (std::size_t b = 0; b < mesh.bodies.size(); ++b) {
    const auto named = config.materials.find(mesh.bodies[b]);
    BodyConfig own;
    if (named != config.materials.end()) own = named->second;
    const std::string key = "materials." + mesh.bodies[b] + ".";
    if (!own.material && !general) {
      errors.push_back({where("materials"), "materials",
                        fmt::format("nothing for the body \"{}\"", mesh.bodies[b]),
                        "a material for every body: " + list,
                        "the key `material` or --material stands for those not named"});
      continue;
    }
    std::optional<Material> chosen = general;
    if (own.material) chosen = own.material;
    Material& material = *chosen;
    if (!own.fibre_angles.empty())
      set_angles(material, own.fibre_angles, key + "fibre_angles", where, errors);
    else if (!config.fibre_angles.empty() && !own.material)
      set_angles(material, config.fibre_angles, "fibre_angles", where, errors);
    const bool follows = !own.material && own.fibre_angles.empty();
    // A body without a material of its own follows the keys at the top of the config.
    std::optional<FibreField> field = own.fibre_field;
    std::string field_key = key + "fibre_field";
    std::string angles_key = key + "fibre_angles";
    std::vector<double> angles = own.fibre_angles;
    if (!own.fibre_field) {
      if (follows) field = config.fibre_field;
      field_key = "fibre_field";
      angles_key = "fibre_angles";
      angles = config.fibre_angles;
    }
    if (own.fibre_field && material.fibres.empty())
      errors.push_back({where(field_key), field_key, "the material has no fibres",
                        "a material with fibres", ""});
    refuse_angles_without_effect(angles, field, material, angles_key, where, errors);
    angles_follow = angles_follow || !own.material;
    field_follows = field_follows || (follows && !own.fibre_field);
    if (is_viscous(material) && !config.path.seconds)
      errors.push_back(
          {where("path.seconds"), "path.seconds",
           fmt::format("nothing, and the material of the body \"{}\" is viscous", mesh.bodies[b]),
           "the duration of the path in s", "path: {seconds: 100}"});
    if (is_viscous(material) && config.estimate == EstimateBy::recovery)
      errors.push_back(
          {where("estimate"), "estimate",
           fmt::format("recovery, and the material of the body \"{}\" is viscous", mesh.bodies[b]),
           "refinement", "recovery compares elastic stresses"});
    scene.materials.push_back(material);
    if (!field || material.fibres.empty() || !errors.empty()) continue;
    std::vector<int> cells;
    for (int e = 0; e < mesh.n_cells(); ++e)
      if (mesh.body[e] == static_cast<int>(b)) cells.push_back(e);
    fields[b] = first_family(*field, mesh, cells, field_key, where);
  }
  for (const auto& [given, taken, key] :
       {std::tuple{!config.fibre_angles.empty(), angles_follow, "fibre_angles"},
        std::tuple{config.fibre_field.has_value(), field_follows, "fibre_field"}})
    if (given && !taken)
      errors.push_back(
          {where(key), key,
           "no body takes it: all of them have a material, angles or a field of their own",
           fmt::format("{} of a body, as materials.{}.{}", key, mesh.bodies[0], key), ""});
  if (scene.materials.size() == mesh.bodies.size())
    scene.directions = make_directions(mesh, fibre_angles(scene.materials), fields);
}

// The candidates of an indenter for which the config names no set: boundary nodes that it can reach
// and that no support holds against it.
std::vector<int> nodes_in_reach(const RigidContact& contact, const Mesh& mesh,
                                const std::vector<Prescribed>& prescribed) {
  double moves = 0;
  std::vector<Vec3> held(mesh.X.size(), Vec3::Zero());
  for (const Prescribed& p : prescribed) {
    held[p.dof / 3][p.dof % 3] = 1;
    double way = std::abs(p.value);
    if (p.turn) way += 2 * p.turn->radius();
    moves = std::max(moves, way);
  }
  std::vector<int> nodes = SurfaceCheck(mesh).reached(contact, moves);
  std::erase_if(nodes, [&](int n) {
    const Vec3 normal = shape_at(contact.shape, mesh.X[n]).normal;
    return held[n].cwiseProduct(normal).squaredNorm() > 0.5;
  });
  return nodes;
}

// The path stops at every point of a history, but not twice within what it tells apart
// (nonlinear/load_path.cpp).
template <class Point>
void take_stops(const std::vector<Point>& points, std::optional<double> seconds,
                const std::string& key, std::vector<double>& stops, ConstraintBuilder& nodes) {
  constexpr double shortest = 1e-9;
  double before = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double here = place(points[i], seconds);
    stops.push_back(here);
    const std::string at = fmt::format("{}[{}]", key, i);
    if (here - before < shortest)
      nodes.errors.push_back(
          {nodes.place_of(at), at,
           fmt::format("{:.3g} of the path behind the point before, or its beginning",
                       here - before),
           fmt::format("at least {:g}", shortest), "a longer ramp, or a shorter path"});
    before = here;
  }
}

void hold_and_move(ConstraintBuilder& nodes, const SolveConfig& config,
                   std::vector<double>& stops) {
  for (std::size_t i = 0; i < config.supports.size(); ++i) {
    const std::string key = fmt::format("supports[{}]", i);
    for (int node : nodes.of_set(config.supports[i].on, key + ".on"))
      for (Axis axis : config.supports[i].hold)
        nodes.prescribe(node, static_cast<int>(axis), {}, key);
  }
  for (std::size_t i = 0; i < config.loads.size(); ++i) {
    const std::string key = fmt::format("loads[{}]", i);
    const LoadConfig& load = config.loads[i];
    std::array<std::optional<History>, 3> to;
    for (int axis = 0; axis < 3; ++axis)
      if (const auto along = load.imposed(axis)) to[axis] = history_of(*along, config.path.seconds);
    for (const auto& [at, history] : load.histories_by_key())
      take_stops(history.points, config.path.seconds, key + "." + at, stops, nodes);
    bool agrees = true;
    const auto& on = nodes.of_set(load.on, key + ".on");
    for (int node : on)
      for (int axis = 0; axis < 3 && agrees && !load.rotation; ++axis)
        if (to[axis]) agrees = nodes.prescribe(node, axis, *to[axis], key + ".displacement");
  }
}

// All three directions of each node: what is rigid is turned or moved, and does nothing else.
void turn(ConstraintBuilder& nodes, const TurnedSet& set, const Mesh& mesh,
          const std::string& key) {
  for (int node : set.nodes) {
    const AboutLine at = about(set.axis, mesh.X[node]);
    const Vec3 across = at.rho * at.outward;
    const Vec3 along = cross(set.axis.along, across);
    for (int k = 0; k < 3; ++k)
      if (!nodes.prescribe(node, k, set.to[k], key, Turn{set.angle, along[k], across[k]})) return;
  }
}

void add_turned(Scene& scene, ConstraintBuilder& nodes, const SolveConfig& config,
                const Mesh& mesh) {
  scene.turned = turned_sets(config, mesh);
  auto set = scene.turned.begin();
  for (std::size_t i = 0; i < config.loads.size() && set != scene.turned.end(); ++i) {
    const LoadConfig& load = config.loads[i];
    if (!load.rotation || load.on != set->name) continue;
    const std::string key = fmt::format("loads[{}].rotation", i);
    if (config.contacts.count(set->name))
      nodes.errors.push_back(
          {nodes.place_of(key), key,
           fmt::format("turns the set \"{}\", and an indenter has the same name", set->name),
           "names of their own", fmt::format("torque_{} would be that of both", set->name)});
    turn(nodes, *set++, mesh, key);
  }
}

void read_triangles(RigidContact& rigid) {
  if (const auto file = surface_file(rigid.shape))
    set_file_triangles(rigid.shape, read_surface(*file));
}

void refuse_start_inside(const RigidContact& rigid, const Mesh& mesh, const std::string& key,
                         const Find& where, std::vector<Error>& errors) {
  for (int node : rigid.nodes)
    if (const double g = shape_at(rigid.shape, mesh.X[node]).gap; g < -1e-9) {
      const Vec3& X = mesh.X[node];
      errors.push_back({where(key), key,
                        fmt::format("starts {:.3g} mm inside the body at ({:g}, {:g}, {:g})", -g,
                                    X[0], X[1], X[2]),
                        "a start outside the body or touching it",
                        "the indenter moves in from there by `motion`"});
      return;
    }
}

// One indenter's travel may be unknown.
void check_only_one(const Scene& scene, const std::string& key, const Find& where,
                    std::vector<Error>& errors) {
  for (const RigidContact& other : scene.contacts)
    if (other.control)
      errors.push_back(
          {where(key), key,
           fmt::format("found, and the travel of \"{}\" is unknown as well", other.name),
           "one indenter under force control or with a mass", "others may follow `motion`"});
}

// How far a force pushes is not known before: candidates are named, and what is across its
// direction moves as prescribed.
void check_control(const Scene& scene, const ContactConfig& contact, const std::string& key,
                   const Find& where, std::vector<Error>& errors) {
  if (contact.on.empty())
    errors.push_back({where(key), key + ".on", "missing, with control given",
                      "a node set that may touch the indenter",
                      "how far a force pushes the indenter is not known before"});
  for (const RigidContact& other : scene.contacts)
    if (other.control)
      errors.push_back({where(key + ".control"), key + ".control",
                        fmt::format("found together with that of \"{}\"", other.name),
                        "one indenter under force control", "others may follow `motion`"});
}

// A force that pushes out of the body against its far side from within would have to bring the
// indenter through the body first.
void refuse_far_side(const RigidContact& rigid, const std::string& on, const Mesh& mesh,
                     const std::string& key, const Find& where, std::vector<Error>& errors) {
  if (!rigid.control || rigid.nodes.empty()) return;
  bool covers = false;
  for (const Facet& facet : surface_of(mesh, on))
    for (const auto& quad : facet_quads(mesh, facet)) {
      const auto X = [&](int k) {
        return mesh.X[static_cast<std::size_t>(quad[static_cast<std::size_t>(k)])];
      };
      const Vec3 outward = cross(X(2) - X(0), X(3) - X(1));
      if (rigid.control->along.dot(outward) < 1e-9 * outward.norm()) return;
      covers = true;
    }
  if (covers)
    errors.push_back(
        {where(key + ".on"), key + ".on",
         fmt::format("the surface of \"{}\" faces away: the force pushes out of the body there",
                     on),
         "a set whose surface faces the indenter", "look at `on` and at `control.along`"});
}

// ConstraintBuilder that supports hold in all directions cannot give way: an indenter whose path
// leads through them has no equilibrium there.
void refuse_path_through_supports(const RigidContact& rigid, const ConstraintBuilder& nodes,
                                  const Mesh& mesh, const std::string& key, const Find& where,
                                  std::vector<Error>& errors) {
  if (rigid.control || rigid.motion.empty()) return;
  const BoundingBox box = bounding_box(mesh.X);
  // a start inside the body is refused as that
  if (const auto inside = point_inside(rigid.shape)) {
    const bool in_box =
        (inside->array() >= box.low.array()).all() && (inside->array() <= box.high.array()).all();
    if (in_box) return;
  }
  std::vector<char> held(mesh.X.size(), 0);
  for (const Prescribed& p : nodes.prescribed)
    if (p.value == 0 && !p.turn) ++held[static_cast<std::size_t>(p.dof / 3)];
  // Held nodes that the indenter meets first are the edge of the pressed surface, such as the top
  // edge of a block that is held at a side. They are no candidates, and the others can give way.
  std::vector<double> gap;
  for (const Vec3& X : mesh.X) gap.push_back(shape_at(rigid.shape, X).gap);
  const double met_first = *std::ranges::min_element(gap) + 1e-6 * (box.high - box.low).norm();
  double begin = 0;
  for (std::size_t i = 0; i < rigid.motion.size(); ++i) {
    const double end = rigid.motion[i].t;
    const Vec3 way = indenter_displacement(rigid, end) - indenter_displacement(rigid, begin);
    const double width = std::max(half_width(rigid.shape), 1e-3 * way.norm());
    const int parts = std::max(1, static_cast<int>(std::ceil(2 * way.norm() / width)));
    for (int k = 1; k <= parts; ++k) {
      const double t = begin + (end - begin) * k / parts;
      const Vec3 c = indenter_displacement(rigid, t);
      for (std::size_t n = 0; n < mesh.X.size(); ++n) {
        if (held[n] < 3 || gap[n] <= met_first) continue;
        const double depth = -shape_at(rigid.shape, mesh.X[n] - c).gap;
        if (depth <= 0.01 * c.norm()) continue;
        const std::string at = fmt::format("{}.motion[{}].to", key, i);
        errors.push_back({where(at), at,
                          fmt::format("at t = {:.3g} the indenter is {:.3g} mm inside nodes that "
                                      "supports hold, at ({:.4g}, {:.4g}, {:.4g})",
                                      t, depth, mesh.X[n][0], mesh.X[n][1], mesh.X[n][2]),
                          "a path that ends before what is held",
                          "a shorter way, or look at its place and at its direction"});
        return;
      }
    }
    begin = end;
  }
}

// A hole that no candidate lies beyond has nothing to press on.
void refuse_wide_hole(const RigidContact& rigid, const Mesh& mesh, const std::string& key,
                      const Find& where, std::vector<Error>& errors) {
  const auto hole = hole_of(rigid.shape);
  if (!hole || rigid.nodes.empty()) return;
  double widest = 0;
  for (int node : rigid.nodes) widest = std::max(widest, about(hole->axis, mesh.X[node]).rho);
  if (widest > hole->radius) return;
  errors.push_back(
      {where(key), key + ".radius",
       fmt::format(
           "a hole of {:g} mm, and all that may touch the plate is within {:.4g} mm of its axis",
           hole->radius, widest),
       "a hole that the body reaches beyond", "look at the place of the hole and at `on`"});
}

void add_contacts(Scene& scene, ConstraintBuilder& nodes, const SolveConfig& config,
                  const Mesh& mesh, const Find& where) {
  for (const auto& [name, contact] : config.contacts) {
    const std::string key = fmt::format("contacts.{}", name);
    RigidContact rigid = indenter_of(name, contact, config.path);
    read_triangles(rigid);
    take_stops(contact.motion, config.path.seconds, key + ".motion", scene.stops, nodes);
    if (contact.control)
      take_stops(contact.control->force.points, config.path.seconds, key + ".control.force",
                 scene.stops, nodes);
    if (contact.rotation)
      take_stops(contact.rotation->points, config.path.seconds, key + ".rotation", scene.stops,
                 nodes);
    if (contact.free && contact.on.empty())
      nodes.errors.push_back({where(key), key + ".on", "missing, with free given",
                              "a node set that may touch the indenter",
                              "where its inertia takes the indenter is not known before"});
    if (contact.free && contact.on.empty()) continue;
    if (contact.free) check_only_one(scene, key + ".free", where, nodes.errors);
    if (contact.control) check_control(scene, contact, key, where, nodes.errors);
    if (contact.on.empty() && contact.control) continue;
    if (contact.on.empty()) {
      rigid.nodes = nodes_in_reach(rigid, mesh, nodes.prescribed);
    } else {
      rigid.nodes = nodes.of_set(contact.on, key + ".on");
    }
    std::erase_if(rigid.nodes, [&](int node) {
      return hanging_at(mesh.hanging, node) != nullptr;
    });  // what they hang on touches
    if (rigid.nodes.empty() && contact.on.empty())
      nodes.errors.push_back({where(key + ".motion"), key + ".motion",
                              "the indenter reaches no node of the body",
                              "a way that brings it to a node that may move",
                              "look at its place and at how far it goes"});
    refuse_start_inside(rigid, mesh, key + ".rigid", where, nodes.errors);
    refuse_path_through_supports(rigid, nodes, mesh, key, where, nodes.errors);
    refuse_wide_hole(rigid, mesh, key + ".rigid.aperture", where, nodes.errors);
    refuse_far_side(rigid, contact.on, mesh, key, where, nodes.errors);
    if (contact.adhesion) take_adhesion(rigid, contact, mesh, key, where, nodes.errors);
    const auto at_rest = [&](int node) {
      return mesh.X[static_cast<std::size_t>(node)];
    };
    if (rigid.control && !rigid.nodes.empty() && !travel_to_touch(rigid, 0, 0, at_rest))
      nodes.errors.push_back({where(key + ".control"), key + ".control.along",
                              "the indenter passes all of its nodes by",
                              "a direction in which it meets the body",
                              "look at its place, at `on` and at `along`"});
    scene.contacts.push_back(std::move(rigid));
  }
}

}  // namespace

RigidContact indenter_of(const std::string& name, const ContactConfig& contact,
                         const LoadPathOptions& path) {
  const std::optional<double> seconds = path.seconds;
  RigidContact rigid{name, contact.rigid.value(), contact.friction, {}, {}};
  rigid.in_proportion = path.arc_length.has_value();
  for (const WaypointConfig& w : contact.motion)
    rigid.motion.push_back({place(w, seconds), Vec3(w.to[0], w.to[1], w.to[2])});
  if (contact.control)
    rigid.control = ForceControl{vec(contact.control->along).normalized(),
                                 history_of(contact.control->force, seconds)};
  if (contact.free)
    rigid.control = ForceControl{vec(contact.free->along).normalized(), History{},
                                 contact.free->mass_g * tonne_per_gram, contact.free->speed()};
  if (contact.rotation)
    rigid.rotation = Rotation{axis_of(rigid.shape).value(), radians(*contact.rotation, seconds)};
  return rigid;
}

std::vector<TurnedSet> turned_sets(const SolveConfig& config, const Mesh& mesh) {
  std::vector<TurnedSet> turned;
  for (const LoadConfig& load : config.loads) {
    const auto set = mesh.node_sets.find(load.on);
    if (!load.rotation || set == mesh.node_sets.end() || set->second.empty()) continue;
    std::vector<Vec3> places;
    for (int node : set->second) places.push_back(mesh.X[node]);
    const RotationConfig& turn = *load.rotation;
    TurnedSet& out = turned.emplace_back();
    out.name = load.on;
    out.nodes = set->second;
    out.angle = radians(turn.angle, config.path.seconds);
    out.axis = {turn.through ? vec(*turn.through) : bounding_box(places).middle(),
                direction(turn.axis)};
    for (int k = 0; k < 3; ++k)
      if (const auto to = load.imposed(k))
        out.to[static_cast<std::size_t>(k)] = history_of(*to, config.path.seconds);
  }
  return turned;
}

int Scene::families() const {
  std::ptrdiff_t most = 0;
  for (const Material& m : materials)
    most = std::max(most, std::count_if(m.fibres.begin(), m.fibres.end(), acts));
  return static_cast<int>(most);
}

Scene make_scene(const SolveConfig& config, const Mesh& mesh,
                 const std::optional<Material>& material, const Find& where) {
  Scene scene;
  ConstraintBuilder nodes(mesh, where);
  scene.formulation = config.formulation.value_or(usual_formulation(mesh.type));
  if (scene.formulation == Formulation::linear_dilatation && !mesh.cell().second_order())
    nodes.errors.push_back({where("formulation"), "formulation",
                            "found linear_dilatation with cells hex8: they would lock",
                            "mean_dilatation", "cells: hex27 in the mesh's config"});
  hold_and_move(nodes, config, scene.stops);
  add_turned(scene, nodes, config, mesh);
  scene.loads = surface_loads(config, mesh, where, nodes.errors);
  add_contacts(scene, nodes, config, mesh, where);
  if (!config.bodies.empty() || !config.touching.empty())
    add_surfaces(scene, config, mesh, nodes.prescribed, where, nodes.errors);
  add_materials(scene, config, mesh, material, where, nodes.errors);
  if (config.in_motion()) add_motion(scene, config, mesh, where, nodes.errors);
  if (mesh.section)
    for (Error& error : section_errors(config, mesh, scene, where))
      nodes.errors.push_back(std::move(error));
  for (Error& error : hanging_errors(config, mesh, nodes.prescribed, where))
    nodes.errors.push_back(std::move(error));
  if (!nodes.errors.empty()) throw Failure(Exit::config, nodes.errors);
  scene.dofs = number_dofs(mesh.n_nodes(), std::move(nodes.prescribed), {}, mesh.hanging).dofs;
  return scene;
}

}  // namespace langer
