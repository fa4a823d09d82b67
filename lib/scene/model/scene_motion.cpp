#include "scene/model/scene_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "core/base/text.hpp"
#include "core/config/member.hpp"
#include "mechanics/assembly/separate_bodies.hpp"
#include "mechanics/mesh/bounding_box.hpp"

namespace langer {

namespace {

// A body all of whose nodes may touch others would have no mass left.
void refuse_without_mass(const Scene& scene, const Mesh& mesh, const Place& place,
                         std::vector<Error>& errors) {
  std::vector<char> touches(mesh.X.size(), 0);
  for (const RigidContact& contact : scene.contacts) {
    for (int node : contact.nodes) touches[static_cast<std::size_t>(node)] = 1;
  }
  for (const SurfaceContact& surface : scene.surfaces) {
    for (int node : surface.all_nodes) touches[static_cast<std::size_t>(node)] = 1;
  }
  std::vector<char> in_a_cell(mesh.X.size(), 0);
  for (int node : mesh.connectivity) in_a_cell[static_cast<std::size_t>(node)] = 1;
  std::vector<std::vector<int>> bodies{{}};
  if (scene.surfaces.empty()) {
    for (int node = 0; node < mesh.n_nodes(); ++node) bodies.front().push_back(node);
  } else {
    bodies = separate_bodies(mesh);
  }
  for (const std::vector<int>& nodes : bodies) {
    const auto inside = [&](int node) {
      return in_a_cell[static_cast<std::size_t>(node)] != 0;
    };
    const auto keeps = [&](int node) {
      return inside(node) && !touches[static_cast<std::size_t>(node)];
    };
    if (std::none_of(nodes.begin(), nodes.end(), inside)) continue;
    if (std::any_of(nodes.begin(), nodes.end(), keeps)) continue;
    std::string who = "an indenter";
    if (!scene.surfaces.empty()) {
      const Vec3& X = mesh.X[static_cast<std::size_t>(nodes.front())];
      who = fmt::format("another body, of the one at ({:g}, {:g}, {:g}),", X[0], X[1], X[2]);
    }
    errors.push_back({place, "dynamics.contact_mass",
                      "every node may touch " + who + ", and would lose its mass",
                      "kept, or more cells",
                      "`on` and `against` of a contact name the nodes that may touch"});
    return;
  }
}

// The body of the config that each layer of the mesh belongs to. Both have the same order, and the
// name of a layer is that of its body, or begins with it and _.
std::vector<std::string> bodies_of_layers(const SolveConfig& config, const Mesh& mesh) {
  std::vector<std::string> owners;
  auto body = config.bodies.begin();
  for (const std::string& layer : mesh.bodies) {
    const auto next = std::next(body);
    if (next != config.bodies.end() &&
        (layer == next->first || layer.starts_with(next->first + "_"))) {
      body = next;
    }
    owners.push_back(body->first);
  }
  return owners;
}

// Several bodies and their velocities at the beginning.
std::vector<MovingBody> moving_bodies(const SolveConfig& config, const Mesh& mesh,
                                      const InertiaOptions& motion) {
  std::vector<MovingBody> moving;
  if (config.bodies.empty()) return moving;
  const std::vector<std::string> owners = bodies_of_layers(config, mesh);
  for (const auto& [name, body] : config.bodies) {
    MovingBody& one = moving.emplace_back();
    one.name = name;
    one.velocity = motion.velocity;
    one.spin = motion.spin;
    one.spin_centre = motion.spin_centre;
    std::set<int> nodes;
    for (int e = 0; e < mesh.n_cells(); ++e) {
      const auto layer = static_cast<std::size_t>(mesh.body[static_cast<std::size_t>(e)]);
      if (owners[layer] != name) continue;
      for (int node : mesh.cell(e)) nodes.insert(node);
    }
    one.nodes.assign(nodes.begin(), nodes.end());
    if (body.velocity || body.spin) one.spin.setZero();
    if (body.velocity) one.velocity = vec(*body.velocity);
    if (!body.spin) continue;
    one.spin = vec(*body.spin);
    std::vector<Vec3> places;
    for (int node : one.nodes) places.push_back(mesh.X[static_cast<std::size_t>(node)]);
    one.spin_centre = bounding_box(places).middle();
  }
  return moving;
}

// Motions that leave the plane of a section or turn it.
void refuse_out_of_section(const DynamicsConfig& dynamics, const Mesh& mesh,
                           const std::function<Place(const std::string&)>& where,
                           std::vector<Error>& errors) {
  if (!mesh.section) return;
  const bool is_round = mesh.section->of == SectionOf::axisymmetric;
  const auto refuse = [&](const char* name, bool wrong) {
    if (!wrong) return;
    const std::string key = std::string("dynamics.") + name;
    errors.push_back({where(key), key, "leaves the plane of the section",
                      is_round ? "a direction along y" : "a direction in the plane of x and y",
                      "a block is needed for others"});
  };
  const auto leaves = [&](const std::array<double, 3>& v) {
    return v[2] != 0 || (is_round && v[0] != 0);
  };
  refuse("gravity", leaves(dynamics.gravity));
  refuse("velocity", leaves(dynamics.velocity));
  const auto& spin = dynamics.spin;
  refuse("spin", spin[0] != 0 || spin[1] != 0 || (is_round && spin[2] != 0));
}

}  // namespace

std::vector<double> densities(const DynamicsConfig& dynamics, const Mesh& mesh,
                              const std::function<Place(const std::string&)>& where,
                              std::vector<Error>& errors) {
  std::vector<double> all(std::max<std::size_t>(1, mesh.bodies.size()),
                          dynamics.density_kg_m3 * tonne_per_mm3);
  for (const auto& [name, density] : dynamics.densities_kg_m3) {
    const auto found = std::ranges::find(mesh.bodies, name);
    if (found == mesh.bodies.end()) {
      const std::string key = "dynamics.densities_kg_m3." + name;
      errors.push_back({where(key), key, fmt::format("found \"{}\"", name),
                        "a body of the mesh: " + list_words(mesh.bodies),
                        did_you_mean(nearest(name, mesh.bodies))});
      continue;
    }
    all[static_cast<std::size_t>(found - mesh.bodies.begin())] = density * tonne_per_mm3;
  }
  return all;
}

void add_motion(Scene& scene, const SolveConfig& config, const Mesh& mesh,
                const std::function<Place(const std::string&)>& where, std::vector<Error>& errors) {
  const DynamicsConfig& dynamics = *config.dynamics;
  InertiaOptions motion;
  motion.density = densities(dynamics, mesh, where, errors);
  motion.mass = dynamics.mass;
  if (motion.mass == MassKind::lumped && mesh.cell().second_order()) {
    errors.push_back(
        {where("dynamics.mass"), "dynamics.mass",
         fmt::format("lumped, of cells {}", names(mesh.type)[static_cast<int>(mesh.type)]),
         "consistent", "sums of rows are for hex8"});
  }
  motion.scheme = dynamics.scheme;
  const bool touches = !scene.contacts.empty() || !scene.surfaces.empty();
  motion.rho_inf = dynamics.rho_inf.value_or(touches ? 1 : 0.8);
  motion.theta = dynamics.theta;
  motion.xi = dynamics.xi;
  if (dynamics.damping) {
    motion.damping_mass = dynamics.damping->mass_per_s;
    motion.damping_stiffness = dynamics.damping->stiffness_s;
  }
  motion.gravity = vec(dynamics.gravity);
  motion.velocity = vec(dynamics.velocity);
  motion.spin = vec(dynamics.spin);
  motion.spin_centre = bounding_box(mesh.X).middle();
  motion.bodies = moving_bodies(config, mesh, motion);
  motion.seconds = config.path.seconds.value_or(1);
  for (const RigidContact& contact : scene.contacts) {
    if (!contact.control || !contact.control->free()) continue;
    motion.travel_mass = contact.control->mass;
    motion.travel_velocity = contact.control->velocity;
    motion.travel_weight = contact.control->mass * motion.gravity.dot(contact.control->along);
  }
  if (dynamics.contact_mass == ContactMass::moved_inwards && touches) {
    motion.massless.assign(mesh.X.size(), 0);  // those of the part are set where it is known
    refuse_without_mass(scene, mesh, where("dynamics"), errors);
  }
  refuse_out_of_section(dynamics, mesh, where, errors);
  if (dynamics.scheme == Scheme::energy_momentum) {
    for (const Material& material : scene.materials) {
      if (!is_viscous(material)) continue;
      errors.push_back({where("dynamics.scheme"), "dynamics.scheme",
                        "energy_momentum, and a material is viscous", "generalised_alpha",
                        "viscous branches know the end of a step, not its middle"});
      break;
    }
  }
  constexpr double most_increments = 1e7;
  if (dynamics.step && motion.seconds / *dynamics.step > most_increments) {
    errors.push_back({where("dynamics.step"), "dynamics.step",
                      fmt::format("{:g} s, of which the path of {:g} s has {:.2g}", *dynamics.step,
                                  motion.seconds, motion.seconds / *dynamics.step),
                      fmt::format("at most {:.0g} increments", most_increments),
                      "a wave crosses an element of length h in h sqrt(rho / (K + 4/3 G))"});
  }
  scene.motion = std::move(motion);
  scene.motion_step = dynamics.step;
  if (dynamics.error) scene.motion_error = 0.01 * percent_of(*dynamics.error).value_or(0.1);
}

// A spin is an axial vector: a mirror keeps what is along its normal.
bool keeps_motion(const Vec3& signs, const InertiaOptions& motion) {
  const auto same = [&](const Vec3& v) {
    return signs.cwiseProduct(v) == v;
  };
  const double det = signs.prod();
  return same(motion.gravity) && same(motion.velocity) &&
         det * signs.cwiseProduct(motion.spin) == motion.spin;
}

MotionState recorded_motion(
    const StepRecord& record,
    const std::function<VecX(const std::vector<Vec3>& field, bool shared)>& of_nodes) {
  MotionState motion;
  motion.v = of_nodes(record.point_fields.at(velocity_field), false);
  motion.a = of_nodes(record.point_fields.at(acceleration_field), false);
  motion.b = of_nodes(record.point_fields.at(carried_field), false);
  motion.reactions = of_nodes(record.reaction, true);
  const auto number = [&](const char* name) {
    return value_or(record.scalars, name, 0);
  };
  motion.travel_v = number(indenter_velocity);
  motion.travel_a = number(indenter_acceleration);
  motion.travel_b = number(indenter_carried);
  motion.kinetic = number("kinetic_energy");
  motion.stored = number("energy");
  motion.total = number("mechanical_energy");
  motion.damped = number("damped_energy");
  motion.balance = number("energy_balance");
  return motion;
}

}  // namespace langer
