#include "scene/model/torque.hpp"

#include <cmath>
#include <numbers>

namespace langer {

namespace {

constexpr double degrees = 180 / std::numbers::pi;

std::string torque_name(const std::string& name) { return "torque_" + name; }

// About the axis of a turned set at time t. force: (n) at all nodes, reactions or their
// derivatives.
double torque(const TurnedSet& set, double t, const auto& position,
              const std::vector<Vec3>& force) {
  const Vec3 p = set.axis_at(t);
  double sum = 0;
  for (int node : set.nodes)
    sum += set.axis.along.dot(cross(position(node) - p, force[static_cast<std::size_t>(node)]));
  return sum;
}

}  // namespace

// The torque about the axis of each rotating indenter and turned set,
//   T = a . sum (x - p) x f,   a: unit vector of the axis, p: a point on it,
// of contact reactions or reactions at the set, in the deformed configuration.
void add_torques(StepRecord& whole, const Mesh& mesh, const Scene& scene) {
  const auto position = [&](int node) {
    return Vec3(mesh.X[node] + whole.u[static_cast<std::size_t>(node)]);
  };
  for (const RigidContact& contact : scene.contacts) {
    if (!contact.rotation) continue;
    const auto travel = whole.scalars.find("travel_" + contact.name);
    const Vec3 c =
        indenter_displacement(contact, whole.t, travel == whole.scalars.end() ? 0 : travel->second);
    whole.scalars["angle_" + contact.name] = degrees * contact.rotation->angle.at(whole.t);
    whole.scalars[torque_name(contact.name)] =
        torque(contact, position, c, whole.contacts.at(contact.name).r);
  }
  for (const TurnedSet& set : scene.turned) {
    whole.scalars["angle_" + set.name] = degrees * set.angle.at(whole.t);
    whole.scalars[torque_name(set.name)] = torque(set, whole.t, position, whole.reaction);
  }
}

namespace {

// How a point p of a turned set's axis moves. The set is rigid: where a parameter moves its nodes,
// it moves the axis with them and turns them about it,
//   d_x = d_p + d_angle a x (x - p)
Vec3 axis_derivative(const TurnedSet& set, double t, const auto& position, const auto& d_x) {
  Vec3 mean = Vec3::Zero();
  Vec3 d_mean = Vec3::Zero();
  for (int node : set.nodes) {
    mean += position(node) / static_cast<double>(set.nodes.size());
    d_mean += d_x(node) / static_cast<double>(set.nodes.size());
  }
  double turned = 0;
  double size = 0;
  for (int node : set.nodes) {
    const Vec3 by_angle = cross(set.axis.along, position(node) - mean);
    turned += by_angle.dot(d_x(node) - d_mean);
    size += by_angle.squaredNorm();
  }
  if (!(size > 0)) return d_mean;  // all nodes lie on the axis
  return d_mean - turned / size * cross(set.axis.along, mean - set.axis_at(t));
}

}  // namespace

// Derivatives of the torques with respect to a parameter, by the product rule: of the forces and of
// the lever arms.
std::map<std::string, double> torque_derivatives(const StepRecord& whole,
                                                 const StepRecord& derivative, const Mesh& mesh,
                                                 const Scene& scene) {
  std::map<std::string, double> out;
  const auto x = [&](int node) {
    return Vec3(mesh.X[node] + whole.u[static_cast<std::size_t>(node)]);
  };
  const auto d_x = [&](int node) {
    return derivative.u[static_cast<std::size_t>(node)];
  };
  for (const RigidContact& contact : scene.contacts) {
    if (!contact.rotation) continue;
    const Line& axis = contact.rotation->axis;
    const std::string travel = "travel_" + contact.name;
    const bool pushed = contact.control.has_value();
    const Vec3 c = indenter_displacement(contact, whole.t, pushed ? whole.scalars.at(travel) : 0);
    Vec3 d_c = Vec3::Zero();
    if (pushed) d_c = derivative.scalars.at(travel) * contact.control->along;
    const std::vector<Vec3>& r = whole.contacts.at(contact.name).r;
    const std::vector<Vec3>& d_r = derivative.contacts.at(contact.name).r;
    double sum = 0;
    for (std::size_t i = 0; i < r.size(); ++i) {
      const int node = contact.nodes[i];
      sum += axis.along.dot(cross(x(node) - c - axis.point, d_r[i]) + cross(d_x(node) - d_c, r[i]));
    }
    out[torque_name(contact.name)] = sum;
  }
  for (const TurnedSet& set : scene.turned) {
    const Vec3 d_p = axis_derivative(set, whole.t, x, d_x);
    double by_arms = 0;
    for (int node : set.nodes)
      by_arms += set.axis.along.dot(
          cross(d_x(node) - d_p, whole.reaction[static_cast<std::size_t>(node)]));
    out[torque_name(set.name)] = torque(set, whole.t, x, derivative.reaction) + by_arms;
  }
  return out;
}

// Magnitudes of the torques by name, of which errors are estimated.
std::map<std::string, double> torques_of(const StepRecord& whole, const Scene& scene) {
  std::map<std::string, double> torques;
  const auto take = [&](const std::string& name) {
    torques[torque_name(name)] = std::abs(whole.scalars.at(torque_name(name)));
  };
  for (const RigidContact& contact : scene.contacts)
    if (contact.rotation) take(contact.name);
  for (const TurnedSet& set : scene.turned) take(set.name);
  return torques;
}

}  // namespace langer
