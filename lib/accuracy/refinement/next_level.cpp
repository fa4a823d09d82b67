// From a level of an accuracy to the next.
#include <algorithm>
#include <cmath>

#include "accuracy/refinement/accuracy.hpp"
#include "accuracy/refinement/constants.hpp"
#include "core/base/text.hpp"

namespace langer {

using namespace refinement;

namespace {

// Other numbers of cells may not fit the lengths of graded ones: then somewhat shorter ones do.
Geometry with_cells(const Geometry& written, double factor) {
  for (int i = 0;; ++i, factor *= 0.97) {
    Geometry geometry = written;
    scale_cells(geometry, factor);
    if (i == 10 ||
        std::visit([](const auto& g) { return contradictions(g, {}).empty(); }, geometry))
      return geometry;
  }
}

// as it would be on cells longer by the factor `edge`, in increments longer by `step` [%]
double percent_with(ErrorEstimate e, double edge, double step, double order) {
  e.cells *= std::pow(edge, order);
  e.increments *= step * step;
  const bool decided_by_single_nodes = e.scatter <= e.by_single_nodes;
  e.by_single_nodes *= std::pow(edge, 3);
  e.scatter *= edge * edge;
  if (decided_by_single_nodes) e.scatter = e.by_single_nodes;
  return e.percent();
}

void put_length(const ChosenLevel& chosen, double length, Geometry& geometry) {
  if (double* edge = edge_in_contact_radii(geometry)) {
    *edge = length;
  } else if (length == 1) {
    geometry = chosen.written;
  } else {
    geometry = with_cells(chosen.written, length);
  }
}

// Cells longer by a factor: 1, or a multiple of 4, which has coarser meshes.
Block with_length(Block block, double length) {
  for (int& along : block.divisions)
    if (along > 1)
      along = 4 * std::max(1, static_cast<int>(std::ceil(along / (4 * length) - 1e-9)));
  return block;
}

double cells_with_length(const ChosenLevel& chosen, double length) {
  if (chosen.bodies.empty()) {
    Geometry geometry = chosen.written;
    put_length(chosen, length, geometry);
    return n_cells(geometry);
  }
  double cells = 0;
  for (const auto& [name, written] : chosen.bodies) {
    const std::array<int, 3> n = with_length(written, length).numbers();
    cells += 1.0 * n[0] * n[1] * n[2];
  }
  return cells;
}

// the shortest cells of a next level, in those of this one
double shortest_at_once(const ChosenLevel& chosen) {
  const auto cells_with = [&](double factor) {
    return cells_with_length(chosen, factor * chosen.level.edge);
  };
  const double most = most_cells_more * cells_with(1);
  const double least = chosen.finest / chosen.level.edge;
  double factor = 1;
  while (factor > least && cells_with(0.97 * factor) <= most) factor *= 0.97;
  return factor;
}

// Factors of the mesh size and of the increments for a next level.
struct Factors {
  double edge = 1, step = 1;
};

// The increments that errors by increments alone ask for. The estimate from few increments scatters
// by more than its value, and a fifth more increments cost less than smaller elements.
double step_by_increments(const ChosenLevel& chosen, const std::vector<ErrorEstimate>& forces) {
  double step = 1;
  for (const ErrorEstimate& e : forces) {
    const double increments = e.in_percent(std::abs(e.increments));
    if (increments > 0.35 * chosen.wanted) {
      step = std::min(step, std::sqrt(0.3 * chosen.wanted / increments));
    } else if (increments > 0.05 * chosen.wanted) {
      step = std::min(step, 0.8);
    }
  }
  return std::max(step, 1 / most_increments_more);
}

// The mesh size that is small enough with these increments, or the smallest that is tried at once.
double edge_with(double step, const ChosenLevel& chosen, const std::vector<ErrorEstimate>& forces,
                 double at_once, const OrdersSeen& seen) {
  double edge = 1;
  for (const ErrorEstimate& e : forces) {
    const double order = value_or(seen, e.of.name, e.order);
    while (percent_with(e, edge, step, order) > target * chosen.wanted && edge > at_once)
      edge *= 0.97;
  }
  return edge;
}

// Of the levels that are accurate enough the cheapest: half as long increments may save a mesh of
// twice the elements. If none is accurate enough, the increments are as their own error asks.
Factors cheapest_factors(const ChosenLevel& chosen, const std::vector<ErrorEstimate>& forces,
                         double at_once, const OrdersSeen& seen) {
  Factors best;
  best.step = step_by_increments(chosen, forces);
  best.edge = edge_with(best.step, chosen, forces, at_once, seen);
  const auto cost = [](const Factors& f) {
    return std::pow(f.edge, -cost_of_length) / f.step;
  };
  for (double step = best.step; step > 1 / most_increments_more; step *= 0.9) {
    const Factors other{edge_with(step, chosen, forces, at_once, seen), step};
    if (other.edge > at_once && cost(other) < cost(best)) best = other;
  }
  return best;
}

}  // namespace

double n_cells(const Geometry& geometry) {
  double cells = 1;
  for (int n : numbers_of_cells(geometry)) cells *= n;
  return cells;
}

double n_cells(const ChosenLevel& chosen, const AccuracyLevel& level) {
  return cells_with_length(chosen, level.edge);
}

void put(const ChosenLevel& chosen, SolveConfig& config) {
  const AccuracyLevel& level = chosen.level;
  for (const auto& [name, written] : chosen.bodies)
    config.bodies.at(name).mesh.geometry = with_length(written, level.edge);
  if (chosen.bodies.empty()) {
    put_length(chosen, level.edge, config.mesh->geometry);
    config.mesh->cells = level.cells;
  }
  const double first = config.path.first_increment();
  if (level.step != config.path.largest_increment()) config.path.use_increment(level.step);
  if (config.path.seconds)
    config.path.first =
        std::min(first, level.step);  // its error decides: longer ones are begun again
}

AccuracyLevel finest_at_once(const ChosenLevel& chosen) {
  AccuracyLevel level = chosen.level;
  level.edge *= shortest_at_once(chosen);
  return level;
}

std::optional<AccuracyLevel> finer_level(const ChosenLevel& chosen,
                                         const std::vector<ErrorEstimate>& estimates,
                                         const OrdersSeen& seen) {
  AccuracyLevel finer = chosen.level;
  const std::vector<ErrorEstimate> forces = forces_judged(estimates);
  const double at_once = shortest_at_once(chosen);
  const auto [edge, step] = cheapest_factors(chosen, forces, at_once, seen);
  const double least = chosen.finest / chosen.level.edge;
  for (const ErrorEstimate& e : forces) {
    const bool is_rough = e.percent() > rough;
    double most = doubtful * chosen.wanted;
    double hoped = e.order;
    if (is_rough) {
      most = too_large * chosen.wanted;
      hoped = std::max(hoped, 1.0);  // what a few nodes in contact show is no order
    }
    if (percent_with(e, least, step, hoped) > most) return std::nullopt;
  }
  finer.edge *= edge;
  finer.step *= step;
  // The numbers of elements of a family are multiples: reduce the size until they change.
  if (edge < 1) {
    const double now = cells_with_length(chosen, chosen.level.edge);
    while (finer.edge > chosen.finest && cells_with_length(chosen, finer.edge) <= now)
      finer.edge *= 0.97;
  }
  finer.step = std::max(finer.step, std::min(shortest_step, chosen.level.step));
  finer.edge = std::max(finer.edge, chosen.finest);
  if (finer.edge > 0.99 * chosen.level.edge && finer.step > 0.99 * chosen.level.step)
    return std::nullopt;
  return finer;
}

double percent_at(const ChosenLevel& chosen, const std::vector<ErrorEstimate>& estimates,
                  const AccuracyLevel& level) {
  double most = 0;
  for (const ErrorEstimate& e : forces_judged(estimates)) {
    const double edge = level.edge / chosen.level.edge;
    const double step = level.step / chosen.level.step;
    most = std::max(most, percent_with(e, edge, step, e.order));
  }
  return most;
}

AccuracyLevel finest_level(const ChosenLevel& chosen) {
  AccuracyLevel level = chosen.level;
  level.edge = chosen.finest;
  return level;
}

std::optional<AccuracyLevel> with_shorter_cells(const ChosenLevel& chosen) {
  AccuracyLevel shorter = chosen.level;
  shorter.edge *= 0.7;
  if (shorter.edge < chosen.finest) return std::nullopt;
  return std::optional(shorter);
}

}  // namespace langer
