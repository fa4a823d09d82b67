#include "accuracy/estimate/refinements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "accuracy/estimate/truncation.hpp"
#include "mechanics/mesh/reference.hpp"

namespace langer {

namespace {

// distances of nodes in contact radii
struct Lengths {
  double fine_enough;  // up to which errors follow the law (pipelines/estimates.yaml)
  double finest;       // of the meshes for coarser ones
};
constexpr Lengths of_block{0.18, 0.125};
constexpr double resolves_edge =
    0.14;  // with friction; on longer cells what is fitted was a third of the error
constexpr Lengths of_disc{0.07, 0.0442};  // a line of nodes in contact: nothing averages
constexpr std::array longer{1.25, 1.5}, hex27_longer{std::numbers::sqrt2, 2.0};
constexpr std::array cheap{1.4, 1.75};   // for estimate: auto, together about a fifth of the solve
constexpr std::array fewer_parts{3, 2};  // of a family, whose solved mesh has four
constexpr std::array longer_impact{1.4, 2.0};  // in space and in time
constexpr double close_enough =
    1e-5;  // residual, relative to the reactions: errors are asked to two digits
constexpr double few = 0.125;  // increments that are longer do not follow their law
constexpr double apart = 1.08,
                 longest = 3;  // lengths of two meshes' cells, at least; the coarsest, at most
using Find = std::function<Place(const std::string&)>;

// the mean of those axes that have more than one
double cells_along(const Geometry& geometry) {
  double sum = 0;
  int axes = 0;
  for (int n : numbers_of_cells(geometry))
    if (n > 1) {
      sum += std::log(n);
      ++axes;
    }
  return std::exp(sum / std::max(axes, 1));
}

Failure too_few_cells(const std::string& which, const Find& where) {
  return Failure(
      Exit::not_converged,
      Error{where("estimate"), "estimate",
            "too few cells" + which + " to make coarser meshes from them", "shorter cells", ""});
}

// numbers that a factor below two divides without a change of the cells' shape
void need_some_cells(const Geometry& geometry, const Find& where) {
  if (has_edge_in_contact_radii(geometry)) return;
  const std::vector<int> n = numbers_of_cells(geometry);
  for (std::size_t i = 0; i < n.size(); ++i)
    if (n[i] == 2 || n[i] == 3)
      throw too_few_cells(fmt::format(" along {} ({}; 1, or 4 and more)", "xyz"[i], n[i]), where);
}

void need_numbers_of_cells(const SolveConfig& config, const Find& where) {
  if (!config.mesh || !has_numbers_of_cells(config.mesh->geometry))
    throw Failure(Exit::config,
                  Error{where("estimate"), "estimate",
                        "a mesh whose cells follow from no numbers of this config",
                        "geometry: {block: ...}, section, indented_block or indented_disc", ""});
  need_some_cells(config.mesh->geometry, where);
}

// a mesh with an odd number of cells has less of it than one that names it
void any_symmetry(SolveConfig& config) {
  if (config.symmetry != SymmetryChoice::none) config.symmetry = SymmetryChoice::automatic;
}

// coarser ones with `other`'s cells, all longer by one factor
void add_longer_hex8(Refinements& refined, SolveConfig other, const std::array<double, 2>& factors,
                     const Find& where) {
  Geometry& geometry = other.mesh->geometry;
  refined.length = {1};
  const double cells = cells_along(geometry);
  for (double factor : factors) {
    do lengthen_cells(geometry, factor);  // a few layers may be divided by two factors alike
    while (cells / cells_along(geometry) < apart * refined.length.back() &&
           (factor *= 1.1) < longest);
    if (factor >= longest) throw too_few_cells("", where);
    refined.length.push_back(cells / cells_along(geometry));
    refined.hex8.push_back(other);
  }
}

// The same bodies with 3/4 and half of the cells along each axis, which SolveConfig has made sure
// of: one family, also of cells that face each other.
void add_coarser_bodies(Refinements& refined, const SolveConfig& config) {
  refined.own = true;
  refined.length = {1};
  for (int parts : fewer_parts) {
    SolveConfig& other = refined.hex8.emplace_back(config);
    refined.length.push_back(4.0 / parts);
    for (auto& [name, body] : other.bodies) {
      Block& block = std::get<Block>(body.mesh.geometry);
      if (block.family) {
        block.family->parts = parts;
        continue;
      }
      std::array<int, 3> n = block.numbers();
      for (int& along : n)
        if (along > 1) along = along * parts / 4;
      block.instead = n;
    }
  }
}

// The same scene on cells longer by about a factor; returns their length in those of before.
double lengthen(SolveConfig& config, double factor) {
  Geometry& geometry = config.mesh->geometry;
  if (has_edge_in_contact_radii(geometry)) {
    scale_cells(geometry, factor);
    return factor;
  }
  const double cells = cells_along(geometry);
  lengthen_cells(geometry, factor);
  any_symmetry(config);
  return cells / cells_along(geometry);
}

// The same on a coarser mesh of a family, whose solved mesh has four parts.
double coarsen_family(SolveConfig& config, int parts) {
  family_of(config.mesh->geometry)->parts = parts;
  any_symmetry(config);
  return 4.0 / parts;
}

void add_longer_hex27(Refinements& refined, const SolveConfig& config) {
  refined.hex27_length = {1};
  for (double factor : hex27_longer) {
    SolveConfig& other = refined.hex27.emplace_back(config);
    refined.hex27_length.push_back(lengthen(other, factor));
  }
}

// Coarser meshes of the family that the solved one belongs to, with the same cells.
void add_family(Refinements& refined, const SolveConfig& config) {
  const bool quadratic = reference(config.mesh->cells).second_order();
  std::vector<SolveConfig>& scenes = quadratic ? refined.hex27 : refined.hex8;
  std::vector<double>& length = quadratic ? refined.hex27_length : refined.length;
  length = {1};
  for (int parts : fewer_parts) {
    SolveConfig& other = scenes.emplace_back(config);
    length.push_back(coarsen_family(other, parts));
  }
  refined.own = !quadratic;
}

}  // namespace

std::vector<LongerScene> longer_in_space_and_time(const SolveConfig& config, const Find& where) {
  need_numbers_of_cells(config, where);
  constexpr double usual_error = 0.1;  // in percent: dynamics.error without a key
  std::vector<LongerScene> out;
  for (std::size_t i = 0; i < longer_impact.size(); ++i) {
    LongerScene& longer = out.emplace_back();
    longer.config = config;
    if (family_of(longer.config.mesh->geometry)) {
      longer.length = coarsen_family(longer.config, fewer_parts[i]);
    } else {
      longer.length = lengthen(longer.config, longer_impact[i]);
    }
    const double before = i == 0 ? 1 : out[i - 1].length;
    if (longer.length < apart * before) throw too_few_cells("", where);
    DynamicsConfig& dynamics = *longer.config.dynamics;
    if (dynamics.step) {
      *dynamics.step *= longer.length;
    } else if (config.path.steps) {
      longer.config.path.use_increment(longer.length * config.path.largest_increment());
    } else {
      double error = usual_error;
      if (dynamics.error) error = percent_of(*dynamics.error).value_or(usual_error);
      // the error per time grows with the square of the increment
      dynamics.error = fmt::format("{:.17g}%", error * longer.length * longer.length);
    }
  }
  return out;
}

namespace {

// The same on other increments, where the path matters. On cells so long that nodes stick by chance
// their increments do, too.
void add_other_increments(Refinements& refined, const SolveConfig& config,
                          const SolveConfig& coarsest) {
  bool rough = has_friction(config);
  bool first_order = false;  // a node that touches slips from the beginning of its increment
  for (const auto& [name, contact] : config.touching)
    if (contact.friction > 0) rough = first_order = true;
  if (!rough && !config.path.seconds) return;
  const double increment = config.path.largest_increment();
  const bool shorter = increment >= 0.1;
  double another = 2 * increment;
  if (shorter) another = std::min(0.5 * increment, few);
  const double ratio = increment / another;
  refined.per_change = 1;
  if (shorter) refined.per_change = -ratio * ratio / (ratio * ratio - 1);
  if (shorter && first_order) refined.per_change = -ratio / (ratio - 1);
  refined.other_increments = coarsest;
  if (refined.edge_unresolved) refined.other_increments = refined.hex8.front();
  refined.other_increments.path.use_increment(another);
  refined.other_increments.path.time_error /=
      ratio * ratio * ratio;  // it grows with the third power of an increment
}

}  // namespace

Refinements refinements(const SolveConfig& given, const Find& where) {
  SolveConfig config = given;
  if (auto* newton = std::get_if<NewtonOptions>(&config.solver))
    newton->relative = std::max(newton->relative, close_enough);
  Refinements refined;
  if (!config.bodies.empty()) {
    add_coarser_bodies(refined, config);
    add_other_increments(refined, config, refined.hex8.back());
    return refined;
  }
  need_numbers_of_cells(config, where);
  SolveConfig other = config;
  Geometry& geometry = other.mesh->geometry;
  const bool quadratic = reference(config.mesh->cells).second_order();
  const bool locks =
      config.formulation == Formulation::displacement;  // and with it its limit on such cells
  refined.own = !quadratic && !locks;
  const auto& factors = config.estimate == EstimateBy::automatic ? cheap : longer;
  const bool family = family_of(geometry) != nullptr;
  if (family) {
    add_family(refined, config);
  } else if (const double* edge = edge_in_contact_radii(geometry)) {
    const Lengths lengths = is_section(geometry) ? of_disc : of_block;
    refined.own = refined.own && *edge * factors.back() <= lengths.fine_enough * longer.back();
    refined.edge_unresolved =
        refined.own && !is_section(geometry) && has_friction(config) && *edge > resolves_edge;
    // A hex27 element of twice the length has as many nodes.
    double same_nodes = *edge;
    if (quadratic) same_nodes *= 0.5;
    if (!refined.own) {
      *edge_in_contact_radii(geometry) = std::min(same_nodes, lengths.finest);
    }
  } else {
    if (quadratic) scale_cells(geometry, 0.5);  // as many nodes
    any_symmetry(other);
  }
  if (!refined.own && !family) {
    other.mesh->cells = CellType::hex8;
    other.formulation.reset();
  }
  if (!family && (!quadratic || !config.contacts.empty())) {
    if (!refined.own) refined.hex8.push_back(other);
    add_longer_hex8(refined, other, factors, where);
  }
  if (quadratic && !family) add_longer_hex27(refined, config);
  const SolveConfig& coarsest = refined.hex8.empty() ? refined.hex27.back() : refined.hex8.back();
  for (Truncation truncation : config.truncation)
    refined.wider[truncation] = wider(coarsest, truncation);
  add_other_increments(refined, config, coarsest);
  return refined;
}

}  // namespace langer
