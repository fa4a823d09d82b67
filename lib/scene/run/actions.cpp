// What holds, moves and loads a body, as arrows of its pictures.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "scene/model/scene_loads.hpp"
#include "scene/run/post_files.hpp"
#include "scene/run/recorded_config.hpp"

namespace langer {

namespace {

// The direction of a movement or a load: along an axis, or against it for a negative value.
Vec3 signed_direction(double value, const Vec3& axis) {
  if (value < 0) return -axis;
  return axis;
}

std::string when(const History& history) {
  if (history.factor) return " at the end";
  return "";
}

class Actions {
 public:
  Actions(const Mesh& mesh, const std::vector<Vec3>& u, std::optional<double> seconds)
      : mesh_(mesh), u_(u), seconds_(seconds) {
    for (const Vec3& X : mesh.X) middle_ += X / static_cast<double>(mesh.X.size());
  }

  void hold(const std::string& set, int axis) {
    const double way = middle_[axis] - centre(set)[axis];
    add(set, signed_direction(way, Vec3::Unit(axis)), false, fmt::format("u_{} = 0", "xyz"[axis]));
  }
  void move(const std::string& set, int axis, const History& to) {
    if (to.value == 0) return hold(set, axis);
    add(set, signed_direction(to.value, Vec3::Unit(axis)), true,
        fmt::format("u_{} = {:g} mm{}", "xyz"[axis], to.at(1), when(to)));
  }
  void turn(const LoadConfig& load) {
    const History angle = history_of(load.rotation->angle, seconds_);
    add(load.on, signed_direction(angle.value, direction(load.rotation->axis)), true,
        fmt::format("turned by {:g} degrees{}", angle.at(1), when(angle)));
  }
  void load(const LoadConfig& load) {
    for (int axis = 0; axis < 3; ++axis)
      if (const auto force = load.dead(axis); force && force->moves()) {
        const History f = history_of(*force, seconds_);
        std::string text = fmt::format("t_{} = {:g} MPa", "xyz"[axis], f.at(1));
        if (load.force) text = fmt::format("F_{} = {:g} N", "xyz"[axis], f.at(1));
        add(load.on, signed_direction(f.value, Vec3::Unit(axis)), true, text + when(f));
      }
    if (!load.pressure) return;
    const History p = history_of(*load.pressure, seconds_);
    Vec3 inwards = Vec3::Zero();
    if (const auto facets = mesh_.facet_sets.find(load.on); facets != mesh_.facet_sets.end())
      for (const Facet& facet : facets->second)
        inwards += follower_pressure(mesh_.cell(), facet.local, element_nodes(mesh_, facet.cell))
                       .colwise()
                       .sum()
                       .transpose();
    if (!inwards.isZero(0))
      add(load.on, signed_direction(p.value, inwards.normalized()), true,
          fmt::format("p = {:g} MPa{}", p.at(1), when(p)));
  }

  std::vector<Action> all;

 private:
  const std::vector<int>& nodes(const std::string& set) const {
    static const std::vector<int> none;
    const auto found = mesh_.node_sets.find(set);
    if (found == mesh_.node_sets.end()) return none;
    return found->second;
  }
  Vec3 centre(const std::string& set) const {
    Vec3 sum = Vec3::Zero();
    for (int node : nodes(set)) sum += mesh_.X[node] / static_cast<double>(nodes(set).size());
    return sum;
  }
  void add(const std::string& set, const Vec3& along, bool moves, std::string says) {
    constexpr std::size_t most = 9;
    const std::vector<int>& on = nodes(set);
    if (on.empty()) return;
    Action action;
    const std::size_t n = std::min(most, on.size());
    for (std::size_t i = 0; i < n; ++i) {
      std::size_t at = 0;
      if (n > 1) at = i * (on.size() - 1) / (n - 1);
      const int node = on[at];
      action.at.push_back(mesh_.X[node] + u_[node]);
    }
    action.along = along;
    action.moves = moves;
    action.says = std::move(says);
    all.push_back(std::move(action));
  }

  const Mesh& mesh_;
  const std::vector<Vec3>& u_;
  std::optional<double> seconds_;  // of the path
  Vec3 middle_ = Vec3::Zero();
};

}  // namespace

std::vector<Action> actions_of(const SolutionHeader& header, const std::vector<Vec3>& u) {
  const auto solve = recorded_config(header);
  if (!solve) return {};
  Actions actions(header.mesh, u, solve->path.seconds);
  for (const SupportConfig& support : solve->supports)
    for (Axis axis : support.hold) actions.hold(support.on, static_cast<int>(axis));
  for (const LoadConfig& load : solve->loads) {
    for (int axis = 0; axis < 3; ++axis)
      if (const auto to = load.imposed(axis))
        actions.move(load.on, axis, history_of(*to, solve->path.seconds));
    if (load.rotation) actions.turn(load);
    actions.load(load);
  }
  return actions.all;
}

}  // namespace langer
