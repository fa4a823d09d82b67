#include "accuracy/refinement/adaptive_cells.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "accuracy/refinement/constants.hpp"
#include "mechanics/element/geometry.hpp"
#include "mechanics/mesh/bounding_box.hpp"
#include "scene/model/hanging_constraints.hpp"
#include "scene/run/footprint.hpp"

namespace langer {

namespace {

constexpr double equal = 1e-4;  // relative: errors that symmetry makes equal
// The largest element under an indenter, in half widths of the contact.
constexpr double across = 0.5;
constexpr int most_at_first = 20'000;

// The extent of a cell in x and z, as seen by an indenter from above [mm].
double longest_edge_in_plan(const Mesh& mesh, int e) {
  const ElementNodes X = element_nodes(mesh, e);
  const Eigen::RowVector3d size = X.colwise().maxCoeff() - X.colwise().minCoeff();
  return std::max(size[0], size[2]);
}

}  // namespace

// Marks the cells with the largest parts of the error, until a sum is reached. A cut divides the
// error of a cell by 2^order: if a share s of the error is marked, 1 - s (1 - 2^-order) of it
// remains. This is solved for s with the wanted remainder. Limits keep s useful: too few cells need
// too many levels, too many are no longer a choice. Parts that are equal by symmetry are marked
// together, so that the cut mesh remains symmetric.
std::vector<char> largest_parts(const std::vector<double>& parts, double wanted, double order) {
  std::vector<std::size_t> by_size(parts.size());
  std::iota(by_size.begin(), by_size.end(), 0);
  std::ranges::stable_sort(by_size,
                           [&](std::size_t a, std::size_t b) { return parts[a] > parts[b]; });
  const double sum = std::accumulate(parts.begin(), parts.end(), 0.0);
  const double enough =
      sum * std::clamp((1 - wanted) / (1 - std::pow(2, -order)), refinement::least_marked_error,
                       refinement::most_marked_error);
  std::vector<char> marked(parts.size(), 0);
  double so_far = 0, last = 0;
  std::size_t n = 0;
  for (std::size_t e : by_size) {
    const bool are_enough =
        so_far >= enough && static_cast<double>(n) >=
                                refinement::least_marked_cells * static_cast<double>(parts.size());
    if (parts[e] == 0 || (are_enough && parts[e] < (1 - equal) * last)) break;
    marked[e] = 1;
    ++n;
    so_far += parts[e];
    last = parts[e];
  }
  return marked;
}

// Why cells of a scene cannot be cut one by one; an empty text where they can.
std::string reason_not_refinable(const SolveConfig& config) {
  const bool dual = config.estimate == EstimateBy::dual;
  if (!dual && config.estimate != EstimateBy::recovery)
    return "cells are cut by the parts of a dual solution or of recovery";
  if (!dual && config.mesh && has_edge_in_contact_radii(config.mesh->geometry))
    return "recovery judges graded lines as they are";
  if (dual && has_friction(config)) return "a dual solution knows no friction";
  if (config.path.seconds) return "errors by cells are those of an elastic body";
  const std::vector<Complaint> never = not_on_cut_cells(config);
  if (never.empty()) return "";
  return never.front().found;
}

// The same for a mesh that was read or made.
std::string reason_not_refinable(const Mesh& mesh) {
  if (mesh.section) return "sections have no cuts";
  if (mesh.type != CellType::hex8) return "hex8 alone are cut";
  if (!mesh.hanging.empty()) return "the mesh has cuts of its own";
  return "";
}

// Cuts cells below the indenters until each is at most half as long as the contact is half wide.
// The region reaches as deep as the contact is half wide, where stresses are largest. It ends early
// where the mesh would exceed its first limit. Returns the number of rounds; each adds seven cells
// for each one that is cut.
int shorten_under(const SolveConfig& config, CutMesh& cells) {
  const BoundingBox body = bounding_box(cells.mesh().X);
  const Vec3 size = body.size();
  const Box box{{body.low[0], body.low[1], body.low[2]}, {size[0], size[1], size[2]}};
  const double top = body.high[1];
  const std::vector<Footprint> prints = footprints(config, box);
  for (int times = 0;; ++times) {
    const Mesh& mesh = cells.mesh();
    std::vector<char> marked(static_cast<std::size_t>(mesh.n_cells()), 0);
    for (const Footprint& print : prints) {
      const double half = std::max(print.half(0), print.half(1));
      const CutRegion region{{print.low[0], top - half, print.low[1]},
                             {print.high[0], top, print.high[1]}};
      for (int e = 0; e < mesh.n_cells(); ++e)
        if (longest_edge_in_plan(mesh, e) > across * half && has_part_of(region, mesh, e))
          marked[static_cast<std::size_t>(e)] = 1;
    }
    const auto n = std::ranges::count(marked, 1);
    if (n == 0 || mesh.n_cells() + 7 * n > most_at_first) return times;
    cells.cut(std::move(marked));
  }
}

}  // namespace langer
