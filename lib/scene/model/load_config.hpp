// Loads as the solve stage's YAML may name them: imposed displacements and rotations of sets,
// forces, tractions and pressures on facets.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/fields.hpp"
#include "core/base/history.hpp"

namespace langer {

// x, y or z of a load whose components have histories of their own.
const std::optional<HistoryConfig>& component(const auto& load, int axis) {
  if (axis == 0) return load.x;
  if (axis == 1) return load.y;
  return load.z;
}

struct Displacement {
  std::optional<HistoryConfig> x, y, z;
  const std::optional<HistoryConfig>& along(int axis) const { return component(*this, axis); }
  static void fields(auto& v) {
    constexpr const char* says =
        "displacement at the end of the path, in proportion to t; or [{t: 0.5, to: 2}, {t: 1, to: 2}]";
    v(&Displacement::x, "x", unit::mm, says);
    v(&Displacement::y, "y", unit::mm, says);
    v(&Displacement::z, "z", unit::mm, says);
  }
};

struct DeadForce {
  std::optional<HistoryConfig> x, y, z;
  const std::optional<HistoryConfig>& along(int axis) const { return component(*this, axis); }
  static void fields(auto& v) {
    constexpr const char* says =
        "at the end of the path, in proportion to t; or a history, as a displacement";
    v(&DeadForce::x, "x", unit::N, says);
    v(&DeadForce::y, "y", unit::N, says);
    v(&DeadForce::z, "z", unit::N, says);
  }
};

struct DeadTraction {
  std::optional<HistoryConfig> x, y, z;
  const std::optional<HistoryConfig>& along(int axis) const { return component(*this, axis); }
  static void fields(auto& v) {
    constexpr const char* says =
        "at the end of the path, in proportion to t; or a history, as a displacement";
    v(&DeadTraction::x, "x", unit::MPa, says);
    v(&DeadTraction::y, "y", unit::MPa, says);
    v(&DeadTraction::z, "z", unit::MPa, says);
  }
};

struct RotationConfig {
  HistoryConfig angle;
  std::array<double, 3> axis{0, 1, 0};
  std::optional<std::array<double, 3>> through = {};
  static void fields(auto& v) {
    v(&RotationConfig::angle, "angle", unit::deg,
      "by the right hand about the axis, at the end of the path, in proportion to t; or a history",
      required);
    v(&RotationConfig::axis, "axis", unit::none, "direction of the axis; any length");
    v(&RotationConfig::through, "through", unit::mm,
      "a point of the axis; none: the middle of the box that holds the set");
  }
  std::vector<Complaint> complaints() const {
    if (axis == std::array<double, 3>{}) return {{"axis", "found [0, 0, 0]", "a direction", ""}};
    return {};
  }
};

struct LoadConfig {
  std::string on;
  std::optional<Displacement> displacement;
  std::optional<RotationConfig> rotation = {};
  std::optional<DeadForce> force;
  std::optional<DeadTraction> traction;
  std::optional<HistoryConfig> pressure;
  std::optional<HistoryConfig> volume = {};
  static void fields(auto& v) {
    v(&LoadConfig::on, "on", unit::none,
      "node set of the mesh; of a force, a traction or a pressure one that covers facets",
      required);
    v(&LoadConfig::displacement, "displacement", unit::none, "imposed displacement");
    v(&LoadConfig::rotation, "rotation", unit::none,
      "the set is turned as a rigid body, as what is glued to it; displacement with it moves that as a whole");
    v(&LoadConfig::force, "force", unit::none,
      "dead force on the whole set, spread evenly over its area at rest");
    v(&LoadConfig::traction, "traction", unit::none, "dead traction, per area at rest");
    v(&LoadConfig::pressure, "pressure", unit::MPa,
      "pressure that follows the surface, positive into the body; at the end of the path, in proportion to t; or a history");
    v(&LoadConfig::volume, "volume", "mm^3",
      "instead of a pressure: the volume that is pumped in behind the surface, swept by it from where it is at rest and positive into "
      "the body; negative sucks. The pressure is a result, load_pressure. At the end of the path, in proportion to t; or a history");
  }
  bool on_surface() const { return !displacement && !rotation; }
  // components along an axis; none where there is none
  std::optional<HistoryConfig> imposed(int axis) const {
    if (displacement) return displacement->along(axis);
    return std::nullopt;
  }
  // whether it moves its set, which zeros do not
  bool imposes_motion() const {
    if (rotation) return true;
    for (int axis = 0; axis < 3; ++axis)
      if (const auto one = imposed(axis); one && one->moves()) return true;
    return false;
  }
  bool tells(int axis) const {
    return rotation || imposed(axis);
  }  // where the set's nodes go along it
  std::optional<HistoryConfig> dead(int axis) const {
    if (force) return force->along(axis);
    if (traction) return traction->along(axis);
    return std::nullopt;
  }
  std::map<std::string, HistoryConfig> histories_by_key() const {
    std::map<std::string, HistoryConfig> all;
    for (int axis = 0; axis < 3; ++axis)
      for (const auto& [kind, one] : {std::pair("displacement.", imposed(axis)),
                                      std::pair(force ? "force." : "traction.", dead(axis))})
        if (one) all[std::string(kind) + "xyz"[axis]] = *one;
    if (rotation) all["rotation.angle"] = rotation->angle;
    if (pressure) all["pressure"] = *pressure;
    if (volume) all["volume"] = *volume;
    return all;
  }
  std::vector<HistoryConfig> histories() const {
    std::vector<HistoryConfig> all;
    for (const auto& [key, history] : histories_by_key()) all.push_back(history);
    return all;
  }
  std::vector<Complaint> complaints() const {
    constexpr const char* kinds =
        "exactly one of displacement (with or without rotation), force, traction, pressure, volume";
    const int n = !on_surface() + force.has_value() + traction.has_value() + pressure.has_value() +
                  volume.has_value();
    if (n == 0) return {{"", "found no load", kinds, ""}};
    if (n > 1) return {{"", "found several kinds of load", kinds, ""}};
    if (volume && !volume->moves())
      return {{"volume", "found no volume", "one other than 0 mm^3 somewhere on the path", ""}};
    if (!histories().empty()) return {};
    std::string key = "traction";
    if (displacement) key = "displacement";
    if (force) key = "force";
    return {{key, "found no component", "x, y or z", ""}};
  }
};

}  // namespace langer
