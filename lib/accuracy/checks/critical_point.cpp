#include "accuracy/checks/critical_point.hpp"

#include <fmt/format.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "accuracy/checks/place_text.hpp"
#include "core/base/text.hpp"
#include "mechanics/mesh/bounding_box.hpp"
#include "mechanics/solve/critical_modes.hpp"
#include "mechanics/solve/symmetry_breaking.hpp"
#include "results/store/curves_file.hpp"

namespace langer {

namespace {

constexpr double located = 1e-4;  // of the path, and of its part up to the point
constexpr double along = 0.7;     // cosine of mode and path from which on it is a limit point

// Negative eigenvalues of the accepted state, movements that break the symmetry included; -1 of a
// singular tangent counts as one.
int negative_eigenvalues(Run& run, SymmetryBreaking* breaking) {
  int negative = std::abs(run.increment.signature().negative);
  if (breaking) negative += std::abs(breaking->signature(run.increment).negative);
  return negative;
}

std::optional<SymmetryBreaking> breaking_of(const Run& run) {
  std::vector<Dofs> kinds = run.reduction.symmetry_breaking_dofs();
  if (kinds.empty()) return std::nullopt;
  return std::optional<SymmetryBreaking>(std::in_place, run.body, std::move(kinds));
}

VecX on_all_dofs(const Dofs& dofs, const VecX& rows) {
  VecX all = VecX::Zero(dofs.n);
  for (Eigen::Index row = 0; row < rows.size(); ++row)
    all[dofs.free[static_cast<std::size_t>(row)]] = rows[row];
  return all;
}

// The mode with the eigenvalue closest to 0, of the model or of one kind of movement that breaks
// its symmetry (kind > 0).
struct Softest {
  double eigenvalue = INFINITY;
  int kind = 0;
  Dofs dofs;
  VecX u;  // (3 n) on dofs
};

Softest softest_of(Run& run) {
  Softest softest;
  const Dofs& own = run.body.dofs();
  const std::vector<SoftMode> modes =
      softest_modes(run.body.pattern(), run.increment.constrained_tangent(), 1,
                    run.increment.volume_gradients(), 1);
  if (!modes.empty()) softest = {modes[0].eigenvalue, 0, own, on_all_dofs(own, modes[0].shape)};
  int kind = 0;
  for (Dofs& dofs : run.reduction.symmetry_breaking_dofs()) {
    ++kind;
    OtherTangent other = run.body.tangent_under(std::move(dofs));
    if (other.pattern.n == 0) continue;
    const std::vector<SoftMode> found =
        softest_modes(other.pattern, run.increment.constrained_tangent(other), 1, {}, 1);
    if (found.empty() || std::abs(found[0].eigenvalue) >= std::abs(softest.eigenvalue)) continue;
    softest = {found[0].eigenvalue, kind, other.dofs, on_all_dofs(other.dofs, found[0].shape)};
  }
  return softest;
}

void scale_to_one(std::vector<Vec3>& mode) {
  double largest = 0;
  for (const Vec3& u : mode) largest = std::max(largest, u.norm());
  if (largest == 0) return;
  // of the two directions the one in which the node that moves most goes along +y, or +x, or +z
  double sign = 1;
  for (const Vec3& u : mode) {
    if (u.norm() < (1 - 1e-9) * largest) continue;
    double leading = u[1];
    if (std::abs(u[1]) < 1e-6 * largest) leading = std::abs(u[0]) > std::abs(u[2]) ? u[0] : u[2];
    sign = leading < 0 ? -1 : 1;
    break;
  }
  for (Vec3& u : mode) u *= sign / largest;
}

using Grid = std::map<std::array<long long, 3>, int>;

std::array<long long, 3> key_of(const Vec3& X, double cell) {
  return {std::llround(X[0] / cell), std::llround(X[1] / cell), std::llround(X[2] / cell)};
}

Grid grid_of(const std::vector<Vec3>& X, const Vec3& middle, double cell) {
  Grid grid;
  for (std::size_t i = 0; i < X.size(); ++i)
    grid[key_of(X[i] - middle, cell)] = static_cast<int>(i);
  return grid;
}

// The node at a place, or -1; places may lie on the border of two cells of the grid.
int node_at(const Grid& grid, const std::vector<Vec3>& X, const Vec3& middle, const Vec3& place,
            double cell) {
  const auto key = key_of(place - middle, cell);
  for (long long i = -1; i <= 1; ++i) {
    for (long long j = -1; j <= 1; ++j) {
      for (long long k = -1; k <= 1; ++k) {
        const auto found = grid.find({key[0] + i, key[1] + j, key[2] + k});
        if (found == grid.end()) continue;
        if ((X[static_cast<std::size_t>(found->second)] - place).norm() < cell)
          return found->second;
      }
    }
  }
  return -1;
}

// A movement of the part on the whole body.
std::vector<Vec3> on_whole_body(const Run& run, const Softest& softest) {
  VecX u = VecX::Zero(3 * static_cast<Eigen::Index>(run.body.mesh().n_nodes()));
  StepRecord record;
  for (int i = 0; i < run.body.mesh().n_nodes(); ++i) {
    const Vec3 moved = displacement(softest.dofs, softest.u, i);
    u.segment<3>(3 * static_cast<Eigen::Index>(i)) = moved;
    record.u.push_back(moved);
  }
  if (const ReducedScene* part = run.reduction.part())
    return part->whole_movement(run.mesh, u, softest.kind);
  if (!run.reduction.point()) return record.u;
  record.reaction.assign(record.u.size(), Vec3::Zero());
  if (const auto whole = run.reduction.whole(record)) return whole->u;
  return std::vector<Vec3>(run.mesh.X.size(), Vec3::Zero());
}

// How the mode behaves under mirrors in the middle planes of the body.
std::string symmetry_of(const Mesh& mesh, const std::vector<Vec3>& mode) {
  if (mesh.section && mesh.section->of == SectionOf::axisymmetric) return "axisymmetric";
  const BoundingBox box = bounding_box(mesh.X);
  const Vec3 middle = box.middle();
  const double cell = 1e-6 * box.size().norm();
  const Grid grid = grid_of(mesh.X, middle, cell);
  double size = 0;
  for (const Vec3& u : mode) size += u.squaredNorm();
  std::string words;
  const int axes = mesh.section ? 2 : 3;
  for (int k = 0; k < axes; ++k) {
    Vec3 signs = Vec3::Ones();
    signs[k] = -1;
    double overlap = 0;
    bool mirrored = true;
    for (std::size_t i = 0; i < mesh.X.size() && mirrored; ++i) {
      const Vec3 place = middle + signs.cwiseProduct(mesh.X[i] - middle);
      const int image = node_at(grid, mesh.X, middle, place, cell);
      mirrored = image >= 0;
      if (mirrored)
        overlap += mode[i].dot(signs.cwiseProduct(mode[static_cast<std::size_t>(image)]));
    }
    if (!mirrored || size == 0) continue;
    overlap /= size;
    const char axis = "xyz"[k];
    if (overlap > 0.9) append(words, ", ", fmt::format("symmetric in {}", axis));
    if (overlap < -0.9) append(words, ", ", fmt::format("antisymmetric in {}", axis));
  }
  return words;
}

// The direction in which the top face of the body is waved: the greatest eigenvector of the sum of
// g g^T over the edges of its facets, g the slope of the movement along y in the plane x, z.
std::optional<double> wave_direction(const Mesh& mesh, const std::vector<Vec3>& mode) {
  const auto top = mesh.facet_sets.find("top");
  if (mesh.section || top == mesh.facet_sets.end()) return std::nullopt;
  double xx = 0;
  double zz = 0;
  double xz = 0;
  for (const Facet& facet : top->second) {
    const auto nodes = mesh.cell(facet.cell);
    const auto& corners = mesh.cell().facet[static_cast<std::size_t>(facet.local)];
    // slopes by least squares over the nodes of the facet
    Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
    Eigen::Vector2d b = Eigen::Vector2d::Zero();
    Vec3 centre = Vec3::Zero();
    double height = 0;
    for (int a : corners) {
      centre += mesh.X[static_cast<std::size_t>(nodes[a])] / double(corners.size());
      height += mode[static_cast<std::size_t>(nodes[a])][1] / double(corners.size());
    }
    for (int a : corners) {
      const auto node = static_cast<std::size_t>(nodes[a]);
      const Eigen::Vector2d d(mesh.X[node][0] - centre[0], mesh.X[node][2] - centre[2]);
      A += d * d.transpose();
      b += (mode[node][1] - height) * d;
    }
    const double determinant = A.determinant();
    if (!(std::abs(determinant) > 0)) continue;
    const Eigen::Vector2d slope((A(1, 1) * b[0] - A(0, 1) * b[1]) / determinant,
                                (-A(1, 0) * b[0] + A(0, 0) * b[1]) / determinant);
    const double area = std::sqrt(std::abs(determinant));
    xx += area * slope[0] * slope[0];
    zz += area * slope[1] * slope[1];
    xz += area * slope[0] * slope[1];
  }
  if (!(xx + zz > 0)) return std::nullopt;
  if (std::abs(xz) < 1e-9 * (xx + zz)) xz = 0;
  return 90 / std::numbers::pi * std::atan2(2 * xz, xx - zz);
}

bool driven_by_travel(const Run& run) {
  const bool forces = !run.scene.loads.empty();
  const bool pushed = run.increment.controlled() != nullptr;
  return !forces && !pushed;
}

void describe(Run& run, const VecX& last_move, CriticalPoint& point) {
  const Softest softest = softest_of(run);
  if (!std::isfinite(softest.eigenvalue)) return;
  point.mode = on_whole_body(run, softest);
  scale_to_one(point.mode);
  point.symmetry = symmetry_of(run.mesh, point.mode);
  point.angle = wave_direction(run.mesh, point.mode);
  point.kind = "bifurcation";
  if (softest.kind > 0) return;
  double largest = 0;
  for (int i = 0; i < run.body.mesh().n_nodes(); ++i)
    largest = std::max(largest, softest.u.segment<3>(3 * i).norm());
  point.of_model = softest.u / largest;
  // imposed displacements do not belong to the mode
  VecX free = last_move;
  for (const Prescribed& p : run.body.dofs().prescribed) free[p.dof] = 0;
  const double cosine = std::abs(softest.u.dot(free)) / (softest.u.norm() * free.norm());
  if (!(cosine > along)) return;
  point.kind = driven_by_travel(run) ? "limit point of travel" : "limit point of load";
}

}  // namespace

std::string CriticalPoint::words() const {
  std::string text = fmt::format("{} at t = {:.5g}", kind, t);
  if (load_factor != t) text += fmt::format(", load factor {:.5g}", load_factor);
  if (place) text += " near " + place_text(*place);
  if (!symmetry.empty()) text += fmt::format("; its mode is {}", symmetry);
  return text;
}

CriticalPoint point_between(const std::string& kind, double t_before, const StepRecord& record,
                            const std::optional<Vec3>& place) {
  CriticalPoint point;
  point.kind = kind;
  point.t = record.t;
  point.within = record.t - t_before;
  const auto factor = record.scalars.find("load_factor");
  point.load_factor = factor == record.scalars.end() ? record.t : factor->second;
  point.place = place;
  return point;
}

std::string table_of(const CriticalPoint& point) {
  std::string angle;
  if (point.angle) angle = fmt::format("{:.6g}", *point.angle);
  return fmt::format(
      "critical_t,critical_load_factor,critical_kind,critical_symmetry,critical_wave_angle_deg\n"
      "{:.10g},{:.10g},{},{},{}\n",
      point.t, point.load_factor, csv_cell(point.kind), csv_cell(point.symmetry), angle);
}

std::optional<CriticalPoint> locate_critical_point(Run& run, const StateOnPath& before,
                                                   const StateOnPath& first,
                                                   const StateOnPath& last, bool with_breaking) {
  std::optional<SymmetryBreaking> breaking;
  if (with_breaking) breaking = breaking_of(run);
  const double t_now = run.t();
  const BodyState now = run.increment.accepted();
  StateOnPath low = first;
  StateOnPath earlier = before;
  StateOnPath high = last;
  while (high.t - low.t > 2 * located * std::min(1.0, high.t)) {
    const double t = 0.5 * (low.t + high.t);
    run.put_at(low.t, low.state, earlier.state);
    if (!run.solve_at(t).converged()) break;
    run.increment.accept();
    StateOnPath middle{t, run.increment.accepted(), 0};
    middle.negative = negative_eigenvalues(run, breaking ? &*breaking : nullptr);
    if (middle.negative > first.negative) {
      high = std::move(middle);
    } else {
      earlier = std::move(low);
      low = std::move(middle);
    }
  }
  // Along one path a small part of the increment brings a small part of its movement.
  const double part = (high.t - low.t) / (last.t - first.t);
  const double moved = (high.state.u - low.state.u).norm() / (last.state.u - first.state.u).norm();
  CriticalPoint point;
  point.t = 0.5 * (low.t + high.t);
  point.within = 0.5 * (high.t - low.t);
  point.load_factor = 0.5 * (low.state.t + high.state.t);
  point.before = first.negative;
  point.after = high.negative;
  point.state = low.state;
  point.earlier = earlier.state;
  point.t_state = low.t;
  run.put_at(high.t, high.state, low.state);
  describe(run, high.state.u - low.state.u, point);
  if (moved > 0.3 && moved > 10 * part) {
    point.kind = "jump to another path";  // no place with a mode
    point.mode.clear();
    point.symmetry.clear();
    point.angle.reset();
  }
  run.put_at(t_now, now, now);
  run.body.pressures_from(now.u);
  if (point.kind.empty()) return std::nullopt;
  return point;
}

std::optional<CriticalPoint> critical_point_at_end(Run& run, const StateOnPath& before,
                                                   const StateOnPath& last, double left) {
  CriticalPoint point;
  point.t = last.t;
  point.within = left;
  point.load_factor = last.state.t;
  point.before = point.after = last.negative;
  point.state = last.state;
  point.earlier = before.state;
  point.t_state = last.t;
  run.put_at(last.t, last.state, before.state);
  describe(run, last.state.u - before.state.u, point);
  if (point.kind.empty()) return std::nullopt;
  return point;
}

std::optional<CriticalPoint> locate_jump(Run& run, const StateOnPath& before,
                                         const StateOnPath& first, const StateOnPath& last) {
  constexpr double gap = 0.3;   // share of the movement that is left where the path has no jump
  constexpr double faster = 5;  // than before: near a limit point a movement grows by less
  const double t_now = run.t();
  const BodyState now = run.increment.accepted();
  const auto distance = [](const StateOnPath& a, const StateOnPath& b) {
    return (a.state.u - b.state.u).norm();
  };
  const double jump = distance(first, last);
  StateOnPath earlier = before;
  StateOnPath low = first;
  StateOnPath high = last;
  bool jumps = true;
  while (jumps && high.t - low.t > 2 * located * std::min(1.0, high.t)) {
    const double t = 0.5 * (low.t + high.t);
    run.put_at(low.t, low.state, earlier.state);
    if (!run.solve_at(t).converged()) {
      high.t = t;  // beyond the last equilibrium on this side
      continue;
    }
    run.increment.accept();
    StateOnPath middle{t, run.increment.accepted(), low.negative};
    // After the jump the body moves on, so a state right after it may be closer to `low`.
    const double moved = distance(middle, low);
    const double foreseen =
        low.t > earlier.t ? distance(low, earlier) * (t - low.t) / (low.t - earlier.t) : moved;
    const bool jumped = moved > gap * jump && moved > faster * foreseen;
    if (jumped || moved > distance(middle, high)) {
      high = std::move(middle);
    } else {
      earlier = std::move(low);
      low = std::move(middle);
    }
    jumps = distance(low, high) > gap * jump;
  }
  std::optional<CriticalPoint> point;
  if (jumps) point = critical_point_at_end(run, earlier, low, 0.5 * (high.t - low.t));
  if (point) point->t = 0.5 * (low.t + high.t);
  if (point) point->load_factor = low.state.t + 0.5 * (high.t - low.t);
  run.put_at(t_now, now, now);
  run.body.pressures_from(now.u);
  return point;
}

std::vector<VecX> modes_of(Run& run, int n) {
  const Dofs& dofs = run.body.dofs();
  std::vector<VecX> shapes;
  for (const SoftMode& mode : softest_modes(run.body.pattern(), run.increment.constrained_tangent(),
                                            n, run.increment.volume_gradients(), 1)) {
    VecX u = on_all_dofs(dofs, mode.shape);
    double largest = 0;
    Vec3 leading = Vec3::Zero();
    for (int i = 0; i < dofs.n / 3; ++i) {
      const Vec3 at = u.segment<3>(3 * i);
      if (at.norm() <= (1 + 1e-9) * largest) continue;
      largest = at.norm();
      leading = at;
    }
    double sign = leading[1];
    if (std::abs(sign) < 1e-6 * largest)
      sign = std::abs(leading[0]) > std::abs(leading[2]) ? leading[0] : leading[2];
    shapes.push_back((sign < 0 ? -1 : 1) / largest * u);
  }
  return shapes;
}

std::optional<CriticalPoint> first_critical_point(Run& run) {
  std::optional<SymmetryBreaking> breaking = breaking_of(run);
  StateOnPath before{0, run.increment.accepted(), 0};
  StateOnPath now = before;
  std::optional<StateOnPath> unstable;
  RunListener listener;
  listener.of_part = [&](StepRecord& record) {
    StateOnPath next{record.t, run.increment.accepted(), 0};
    next.negative = negative_eigenvalues(run, breaking ? &*breaking : nullptr);
    if (next.negative > now.negative) {
      unstable = std::move(next);
      return false;
    }
    before = std::move(now);
    now = std::move(next);
    return true;
  };
  const RunEnd end = run.follow(listener);
  if (unstable) return locate_critical_point(run, before, now, *unstable, breaking.has_value());
  if (end.at != RunEnd::At::no_equilibrium || run.increment.n_unstable() == 0) return std::nullopt;
  return critical_point_at_end(run, before, now, run.path.smallest);
}

}  // namespace langer
