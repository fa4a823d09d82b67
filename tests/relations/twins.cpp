#include "relations/twins.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace langer::relations {

namespace {

// Exact numbers: a matrix from cos and sin would not permute axes.
Mat3 quarter_turn() {
  Mat3 Q = Mat3::Zero();
  Q(2, 0) = 1;
  Q(0, 2) = -1;
  Q(1, 1) = 1;
  return Q;
}

Mat3 mirror(int axis) {
  Mat3 Q = Mat3::Identity();
  Q(axis, axis) = -1;
  return Q;
}

Mat3 any_rotation(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
  return q.normalized().toRotationMatrix();
}

bool holds_everything(const Support& support) {
  return support.hold == std::array{true, true, true};
}

// All components at the same times, or none of its axes.
bool turns_freely(const Load& load) {
  if (load.kind == LoadKind::pressure || load.kind == LoadKind::rotation) {
    return true;
  }
  return load.along[0] && load.along[1] && load.along[2];
}

bool turns_freely(const Contact& contact) {
  const bool about_y = contact.shape == ShapeKind::sphere && contact.rotation;
  return contact.shape != ShapeKind::ellipsoid && !about_y;
}

bool turns_freely(const Scene& scene) {
  const Body& body = scene.body;
  const bool written = body.kind == BodyKind::block && body.cells != "hex27" && !body.cut;
  const bool anisotropic = std::any_of(body.layers.begin(), body.layers.end(),
                                       [](const Layer& l) { return !l.law.fibres.empty(); });
  // fibres are in the plane of x and z unless the frames of hexahedra turn with the mesh
  return written && (body.along_edges || !anisotropic) &&
         std::all_of(scene.supports.begin(), scene.supports.end(), holds_everything) &&
         std::all_of(scene.loads.begin(), scene.loads.end(),
                     [](const Load& load) { return turns_freely(load); }) &&
         std::all_of(scene.contacts.begin(), scene.contacts.end(),
                     [](const Contact& contact) { return turns_freely(contact); });
}

bool on_surface(const Load& load) {
  return load.kind == LoadKind::force || load.kind == LoadKind::traction ||
         load.kind == LoadKind::pressure;
}

Load half(Load load) {
  for (auto& component : load.along) {
    if (!component) {
      continue;
    }
    for (HistoryPoint& point : *component) {
      point.value *= 0.5;
    }
  }
  for (HistoryPoint& point : load.history) {
    point.value *= 0.5;
  }
  return load;
}

Scene with_loads_split(Scene scene) {
  std::vector<Load> parts;
  for (const Load& load : scene.loads) {
    if (on_surface(load)) {
      parts.push_back(half(load));
      parts.push_back(half(load));
    } else {
      parts.push_back(load);
    }
  }
  scene.loads = parts;
  return scene;
}

// A quantity of both answers at one step, the scene's mapped to the twin's frame and units.
class Compared {
 public:
  explicit Compared(std::string name) : name_(std::move(name)) {}

  void add(const Vec3& expected, const Vec3& found, double t) {
    largest_ = std::max(largest_, expected.norm());
    const double difference = (expected - found).norm();
    if (!(difference <= difference_)) {
      difference_ = difference;
      t_ = t;
    }
  }
  void add(double expected, double found, double t) {
    add(Vec3(expected, 0, 0), Vec3(found, 0, 0), t);
  }
  const std::string& name() const { return name_; }
  double largest() const { return largest_; }
  // The value with which differences are compared even if all values are smaller.
  void compare_with_at_least(double value) { largest_ = std::max(largest_, value); }

  void report(double tolerance, std::vector<std::string>& lines) const {
    // NaN is a difference
    if (difference_ <= tolerance * largest_) {
      return;
    }
    lines.push_back(
        fmt::format("{}: difference {:.3g} of the largest {:.6g}, {:.2g} of it, at t = {:g}", name_,
                    difference_, largest_, difference_ / largest_, t_));
  }

 private:
  std::string name_;
  double largest_ = 0;
  double difference_ = 0;
  double t_ = 0;
};

// for each node of the scene that of the twin; empty where one has none
std::vector<int> matching_nodes(const Mesh& scene, const Mesh& twin, const Change& change) {
  std::vector<int> match;
  const double near = 1e-7 * change.length;
  for (std::size_t i = 0; i < scene.X.size(); ++i) {
    const Vec3 image = change.length * (change.Q * scene.X[i]);
    int found = -1;
    if (i < twin.X.size() && (twin.X[i] - image).norm() < near) {
      found = static_cast<int>(i);
    }
    for (std::size_t j = 0; j < twin.X.size() && found < 0; ++j) {
      if ((twin.X[j] - image).norm() < near) {
        found = static_cast<int>(j);
      }
    }
    if (found < 0) {
      return {};
    }
    match.push_back(found);
  }
  return match;
}

// Histories that are compared, with the powers of length and stress in their units. Torques turn
// around in mirrors and are compared by size.
struct Quantity {
  const char* name;
  int length;
  int stress;
};
constexpr std::array quantities{
    // the energy comes first
    Quantity{"energy", 3, 1},          Quantity{"viscous_work", 3, 1},
    Quantity{"adhesion_stored", 3, 1}, Quantity{"adhesion_dissipated", 3, 1},
    Quantity{"bonded_area", 2, 0},     Quantity{"torque_sphere", 3, 1},
    Quantity{"torque_tool", 3, 1},     Quantity{"torque_disc", 3, 1},
    Quantity{"torque_high", 3, 1}};

}  // namespace

std::vector<Twin> twins(const Scene& scene, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Twin> all;
  const auto transformed = [&](const std::string& relation, const Change& change) {
    all.push_back({relation, changed(scene, change), change});
  };
  if (scene.body.kind == BodyKind::block) {
    transformed("quarter turn", {quarter_turn(), 1, 1});
    transformed("mirrored", {mirror(random() % 2 == 0 ? 0 : 2), 1, 1});
  }
  if (turns_freely(scene)) {
    transformed("turned", {any_rotation(random), 1, 1});
  }
  transformed("longer", {Mat3::Identity(), 2.7, 1});
  transformed("stiffer", {Mat3::Identity(), 1, 3.3});

  Twin whole{"unreduced", scene};
  whole.scene.whole = true;
  all.push_back(whole);

  if (std::any_of(scene.loads.begin(), scene.loads.end(), on_surface)) {
    all.push_back({"loads split", with_loads_split(scene)});
  }
  Twin killed{"killed and resumed", scene};
  killed.killed = true;
  all.push_back(killed);

  if (!scene.viscous() && scene.frictionless() && !scene.adheres()) {
    Twin few{"other increments", scene};
    few.scene.increments = random() % 2 == 0 ? 1 : 2 * scene.increments + 1;
    few.last_only = true;
    // one increment for the whole path may be too long
    few.may_fail = few.scene.increments == 1;
    all.push_back(few);
  }
  if (!scene.adheres()) {
    Twin kinsol{"by KINSOL", scene};
    kinsol.scene.solver = "kinsol";
    kinsol.may_fail = true;
    all.push_back(kinsol);
  }
  return all;
}

std::vector<std::string> differences(const Answer& scene, const Answer& twin, const Twin& how,
                                     double tolerance) {
  if (!how.last_only && scene.steps.size() != twin.steps.size()) {
    return {fmt::format("{} steps, and {} of the twin", scene.steps.size(), twin.steps.size())};
  }
  const std::vector<int> match = matching_nodes(scene.mesh, twin.mesh, how.change);
  if (match.size() != twin.mesh.X.size()) {
    return {"the nodes of the meshes are not the images of each other"};
  }
  const double L = how.change.length;
  const double F = how.change.stress * L * L;
  const Mat3& Q = how.change.Q;
  Compared u("displacement");
  Compared reaction("reaction");
  Compared place("displacement of the indenter");
  Compared force("force on the indenter");
  std::vector<Compared> histories;
  for (const Quantity& quantity : quantities) {
    histories.emplace_back(quantity.name);
  }
  std::vector<std::string> lines;
  const std::size_t n = scene.steps.size();
  for (std::size_t i = how.last_only ? n - 1 : 0; i < n; ++i) {
    const StepRecord& a = scene.steps[i];
    const StepRecord& b = how.last_only ? twin.steps.back() : twin.steps[i];
    if (std::abs(a.t - b.t) > 1e-12) {
      return {fmt::format("step {} ends at t = {}, that of the twin at {}", i, a.t, b.t)};
    }
    for (std::size_t node = 0; node < a.u.size(); ++node) {
      const auto other = static_cast<std::size_t>(match[node]);
      u.add(L * (Q * a.u[node]), b.u[other], a.t);
      reaction.add(F * (Q * a.reaction[node]), b.reaction[other], a.t);
    }
    place.add(L * (Q * a.u_ind), b.u_ind, a.t);
    force.add(F * (Q * a.force_ind), b.force_ind, a.t);
    for (std::size_t k = 0; k < quantities.size(); ++k) {
      const Quantity& quantity = quantities[k];
      const auto in_scene = a.scalars.find(quantity.name);
      const auto in_twin = b.scalars.find(quantity.name);
      if ((in_scene == a.scalars.end()) != (in_twin == b.scalars.end())) {
        lines.push_back(fmt::format("{}: only one of the two has it", quantity.name));
      } else if (in_scene != a.scalars.end()) {
        const double unit =
            std::pow(L, quantity.length) * std::pow(how.change.stress, quantity.stress);
        histories[k].add(unit * std::abs(in_scene->second), std::abs(in_twin->second), a.t);
      }
    }
  }
  u.report(tolerance, lines);
  reaction.report(tolerance, lines);
  place.report(tolerance, lines);
  force.report(tolerance, lines);
  // A torque that is zero without friction consists of rounding alone: it is then compared with a
  // small share of the energy, which has the same unit.
  constexpr double share = 1e-3;
  const double energy = histories.front().largest();
  for (Compared& history : histories) {
    if (history.name().starts_with("torque")) {
      history.compare_with_at_least(share * energy);
    }
    history.report(tolerance, lines);
  }
  return lines;
}

}  // namespace langer::relations
