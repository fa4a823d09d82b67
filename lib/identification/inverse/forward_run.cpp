#include "identification/inverse/forward_run.hpp"

#include <fmt/format.h>

#include "core/base/interrupt.hpp"
#include "core/config/writer.hpp"
#include "identification/inverse/sensitivity.hpp"
#include "mechanics/material/path.hpp"
#include "mechanics/mesh/reference.hpp"
#include "scene/model/config_number.hpp"
#include "scene/model/scene_parameters.hpp"
#include "scene/run/body_mesh.hpp"

namespace langer {

namespace {

// materials.fat.matrix.yeoh.a1 is short for materials.fat.material.matrix.yeoh.a1
std::string in_full(const std::string& path) {
  constexpr std::string_view begin = "materials.";
  if (!path.starts_with(begin)) return path;
  const std::size_t end = path.find('.', begin.size());
  if (end == std::string::npos) return path;
  const std::string rest = path.substr(end + 1);
  if (rest.starts_with("material.") || rest.starts_with("fibre_")) return path;
  return path.substr(0, end) + ".material." + rest;
}

// A run of a fit needs the path alone: error estimates, stability checks and reductions are
// switched off.
SolveConfig without_judgement(SolveConfig config) {
  config.accuracy.reset();
  config.fidelity.reset();
  config.estimate.reset();
  config.truncation.clear();
  config.stability = StabilityCheck::off;
  config.on_unstable = OnUnstable::warn;
  config.reduce = Reduce::none;
  config.homogeneous = Homogeneous::off;
  return config;
}

// Adds points on the straight lines between those of a history, so that increments end at the
// stops.
template <class Point, class To>
std::vector<Point> with_stops(const std::vector<Point>& points, const std::vector<double>& stops,
                              To between) {
  std::vector<Point> all;
  Point before{0.0, {}, {}};
  for (const Point& point : points) {
    for (double t : stops)
      if (t > *before.t + 1e-9 && t < *point.t - 1e-9)
        all.push_back(
            {t, between(before.to, point.to, (t - *before.t) / (*point.t - *before.t)), {}});
    all.push_back(point);
    before = point;
  }
  return all;
}

// Adds stops to the first history that moves, of contacts before loads. Paths in seconds have their
// own increments.
void add_stops(SolveConfig& config, const std::vector<double>& stops) {
  const auto point_between = [](const std::array<double, 3>& a, const std::array<double, 3>& b,
                                double part) {
    std::array<double, 3> x{};
    for (std::size_t k = 0; k < 3; ++k) x[k] = a[k] + part * (b[k] - a[k]);
    return x;
  };
  const auto add_to = [&](HistoryConfig& history) {
    if (history.points.empty()) history.points = {{1.0, history.value, {}}};
    history.points = with_stops(history.points, stops,
                                [](double a, double b, double part) { return a + part * (b - a); });
    return true;
  };
  const auto add_if = [&](std::optional<HistoryConfig>& history) {
    return history && history->moves() && add_to(*history);
  };
  for (auto& [name, contact] : config.contacts) {
    if (contact.motion.empty() && !contact.control) continue;
    if (contact.control)
      add_to(contact.control->force);
    else
      contact.motion = with_stops(contact.motion, stops, point_between);
    return;
  }
  for (LoadConfig& load : config.loads) {
    if (auto& u = load.displacement; u && (add_if(u->x) || add_if(u->y) || add_if(u->z))) return;
    if (add_if(load.pressure)) return;
  }
}

// Whether a key names a number of a scene that this one does not have.
bool is_of_another(const std::string& key, const SolveConfig& config) {
  if (key.starts_with("contacts.") && key.ends_with(".friction"))
    return std::none_of(config.contacts.begin(), config.contacts.end(), [&](const auto& contact) {
      return key == "contacts." + contact.first + ".friction";
    });
  for (const char* begin : {"contacts.", "mesh.", "materials."})
    if (key.starts_with(begin)) return !config_number(config, in_full(key));
  return false;
}

// A matrix from rows that were collected during a run.
MatX matrix_of(const std::vector<std::vector<double>>& rows, std::size_t columns) {
  MatX m(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns));
  for (std::size_t i = 0; i < rows.size(); ++i)
    m.row(static_cast<Eigen::Index>(i)) =
        Eigen::Map<const VecX>(rows[i].data(), m.cols()).transpose();
  return m;
}

}  // namespace

ForwardRun::ForwardRun(SolveConfig config, Where where, double fibre_angle)
    : config_(without_judgement(std::move(config))),
      where_(std::move(where)),
      fibre_angle_(fibre_angle),
      mesh_(std::make_shared<const Mesh>(body_mesh(config_, "", where_))) {}

void ForwardRun::observe(std::vector<Observation> observations, std::vector<double> stops) {
  observations_ = std::move(observations);
  stops_ = std::move(stops);
}

SolveConfig ForwardRun::config_at(const ForwardInput& input) const {
  SolveConfig config = config_;
  // before increments are added: paths mean the histories of the config
  for (const auto& [path, value] : input.numbers)
    if (!names_thickness(path, config)) config = with_config_number(config, in_full(path), value);
  const double angle = fibre_angle_ + input.fibre_angle;
  config.material = turned(input.law, angle);
  // families keep their angles to the first, whose angle the formula gives
  if (config.fibre_field && angle != 0)
    if (auto* formula = std::get_if<FormulaField>(&*config.fibre_field))
      formula->alpha = fmt::format("({}) + ({})", formula->alpha, number_text(angle));
  if (!config.path.seconds) add_stops(config, stops_);
  for (const auto& [name, mu] : input.friction)
    if (const auto contact = config.contacts.find(name); contact != config.contacts.end())
      contact->second.friction = mu;
  return config;
}

// The mesh of the config where layers have other thicknesses. Other numbers of its geometry mesh it
// anew, with as many cells.
Mesh ForwardRun::mesh_at(const ForwardInput& input, const SolveConfig& config) const {
  // A mesh that is made anew has to have the same cells: observations and fields of the scene are
  // those of its nodes, and a fit needs answers that change smoothly.
  Mesh mesh = *mesh_;
  for (const auto& [path, value] : input.numbers) {
    if (names_thickness(path, config)) continue;
    if (path.starts_with("mesh.") || path.starts_with("bodies"))
      mesh = body_mesh(config, "", where_);
  }
  if (mesh.connectivity != mesh_->connectivity)
    throw Failure(Exit::config, Error{{},
                                      "mesh",
                                      "a mesh of other cells at these numbers",
                                      "numbers that only move its nodes",
                                      ""});
  for (const auto& [path, value] : input.numbers) {
    if (!names_thickness(path, config)) continue;
    std::string why;
    const auto layer = layer_thickness(path, config, mesh, why);
    if (!(value > 0) || !layer)
      throw Failure(Exit::config, Error{{}, path, "found " + number_text(value), "above 0", why});
    mesh = layer->with(std::move(mesh), value);
  }
  return mesh;
}

// A thickness is measured at the mesh, whose layers may have been given by other numbers.
std::optional<double> ForwardRun::number(const std::string& path) const {
  if (!names_thickness(path, config_)) return config_number(config_, in_full(path));
  std::string why;
  const auto layer = layer_thickness(path, config_, *mesh_, why);
  if (!layer) return std::nullopt;
  return layer->value();
}

// Every number can be another one but those that decide how many cells there are: observations are
// made at nodes, so these have to stay.
std::string ForwardRun::reason_fixed(const std::string& path) const {
  if (names_thickness(path, config_)) {
    std::string why;
    if (layer_thickness(path, config_, *mesh_, why)) return "";
    return why;
  }
  if (!config_number(config_, in_full(path))) return "the scene has no such number";
  if (!path.starts_with("mesh.") && !path.starts_with("bodies")) return "";
  // a mesh that `accuracy` chose has cells that its numbers do not say
  const double value = *config_number(config_, path);
  const Mesh again = body_mesh(with_config_number(config_, path, value), "", where_);
  if (again.connectivity == mesh_->connectivity) return "";
  return "the cells of the mesh follow from other numbers as well";
}

// Numbers that a laboratory measures or assumes, and that change every force: how rough the
// indenter is, how large, and how thick the layers are.
std::vector<std::string> ForwardRun::uncertain_numbers() const {
  std::vector<std::string> paths;
  for (const auto& [name, contact] : config_.contacts) {
    if (contact.deformable()) continue;
    paths.push_back("contacts." + name + ".friction");
    for (const char* shape : {"sphere", "cylinder"})
      paths.push_back("contacts." + name + ".rigid." + shape + ".radius");
  }
  if (config_.mesh) {
    for (std::size_t i = 0; i < config_.mesh->bodies.size(); ++i)
      paths.push_back(fmt::format("mesh.bodies[{}].thickness", i));
    for (const char* kind : {"block", "graded_block", "indented_block", "section", "indented_disc"})
      paths.push_back(fmt::format("mesh.geometry.{}.size[1]", kind));
  }
  // what this scene does not have: another shape, or a body with layers
  std::erase_if(paths, [&](const std::string& path) {
    return !config_number(config_, path) || !number(path);
  });
  return paths;
}

bool ForwardRun::differentiates_itself(const Material& law) const {
  for (const auto& [name, contact] : config_.contacts)
    if (contact.adhesion) return false;
  if (!config_.dynamics) return true;
  for (const auto& [name, body] : config_.materials)
    if (body.material && is_viscous(*body.material)) return false;
  return !is_viscous(law);
}

// Asks the scene itself, which refuses what it cannot be differentiated by: a shape from a file,
// loads on the sides of a layer.
bool ForwardRun::differentiates(const std::string& path, const Material& law) const {
  if (!number(path)) return true;  // it has no part in this scene
  if (!differentiates_itself(law)) return false;
  SolveConfig config = config_;
  config.material = law;
  config.sensitivity = {path};
  if (!config.bodies.empty() || config.dynamics) return false;
  try {
    const Scene scene = make_scene(config, *mesh_, config.material, where_);
    if (!scene.surfaces.empty()) return false;
    const SceneParameters parameters(config, *mesh_, scene, where_);
    return true;
  } catch (const Failure&) {
    return false;
  }
}

ForwardPath ForwardRun::solve(const ForwardInput& input) const {
  // Ask for the sensitivity by each number that this scene has. The others stay zero.
  SolveConfig config = config_at(input);
  std::vector<std::size_t> asked;  // those that this scene has
  for (std::size_t k = 0; k < input.slopes.size(); ++k)
    if (!is_of_another(input.slopes[k], config)) {
      asked.push_back(k);
      config.sensitivity.push_back(input.slopes[k]);
    }
  Run run(mesh_at(input, config), config, config.material, where_);
  std::optional<Sensitivity> sensitivity;
  if (!asked.empty()) sensitivity.emplace(run, config, where_);
  std::vector<std::vector<double>> rows;
  std::vector<std::vector<std::vector<double>>> slopes(input.slopes.size());
  ForwardPath found;
  // Record observations and their derivatives at each accepted increment.
  RunListener listener;
  listener.of_whole = [&](StepRecord& whole, const SolveReport&) {
    found.t.push_back(whole.t);
    rows.emplace_back();
    for (const Observation& one : observations_)
      rows.back().push_back(one.value(whole, run.scene.contacts));
    for (auto& of_number : slopes) of_number.emplace_back(observations_.size(), 0.0);
    for (std::size_t k = 0; k < asked.size(); ++k)
      for (std::size_t i = 0; i < observations_.size(); ++i)
        slopes[asked[k]].back()[i] =
            observations_[i].slope(whole, sensitivity->now()[k], run.scene.contacts);
  };
  if (sensitivity) listener = sensitivity->along(std::move(listener));
  const RunEnd end = run.follow(std::move(listener));
  if (end.at == RunEnd::At::signal)
    throw Failure(exit_code_of(interrupted()),
                  Error{{}, "", fmt::format("stopped by {}", signal_name(interrupted())), "", ""});
  found.complete = end.path.complete;
  if (!found.complete)
    found.why =
        fmt::format("no equilibrium behind t = {:.4g} of its path ({})", end.path.t, end.path.why);
  found.values = matrix_of(rows, observations_.size());
  for (const auto& of_number : slopes)
    found.slopes.push_back(matrix_of(of_number, observations_.size()));
  return found;
}

std::optional<SolveConfig> ForwardRun::on_longer_cells(double factor) const {
  if (!config_.mesh || !has_numbers_of_cells(config_.mesh->geometry)) return std::nullopt;
  SolveConfig longer = config_;
  Geometry& geometry = longer.mesh->geometry;
  const bool scaled =
      has_edge_in_contact_radii(geometry) && reference(config_.mesh->cells).second_order();
  if (scaled) {
    scale_cells(geometry, factor);
  } else {
    lengthen_cells(geometry, factor);
  }
  if (numbers_of_cells(geometry) == numbers_of_cells(config_.mesh->geometry)) return std::nullopt;
  if (longer.symmetry != SymmetryChoice::none) longer.symmetry = SymmetryChoice::automatic;
  return longer;
}

}  // namespace langer
