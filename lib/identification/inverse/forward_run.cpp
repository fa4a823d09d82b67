#include "identification/inverse/forward_run.hpp"

#include <fmt/format.h>

#include "core/base/interrupt.hpp"
#include "identification/inverse/sensitivity.hpp"
#include "mechanics/material/path.hpp"
#include "mechanics/mesh/reference.hpp"
#include "scene/run/body_mesh.hpp"

namespace langer {

namespace {

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

// Whether a key names the friction of a contact that this scene does not have.
bool is_friction_of_another(const std::string& key, const SolveConfig& config) {
  return key.starts_with("contacts.") &&
         std::none_of(config.contacts.begin(), config.contacts.end(), [&](const auto& contact) {
           return key == "contacts." + contact.first + ".friction";
         });
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
  config.material = turned(input.law, fibre_angle_);
  if (!config.path.seconds) add_stops(config, stops_);
  for (const auto& [name, mu] : input.friction)
    if (const auto contact = config.contacts.find(name); contact != config.contacts.end())
      contact->second.friction = mu;
  return config;
}

ForwardPath ForwardRun::solve(const ForwardInput& input) const {
  // Ask for the sensitivity by each number that this scene has. The others stay zero.
  SolveConfig config = config_at(input);
  std::vector<std::size_t> asked;  // those that this scene has
  for (std::size_t k = 0; k < input.slopes.size(); ++k)
    if (!is_friction_of_another(input.slopes[k], config)) {
      asked.push_back(k);
      config.sensitivity.push_back(input.slopes[k]);
    }
  Run run(*mesh_, config, config.material, where_);
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
