#include "mechanics/solve/surface_tangent.hpp"

#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <algorithm>
#include <limits>

#include "mechanics/solve/staged_solution.hpp"

namespace langer {

namespace {

// FG: compliance times the forces of reactions.
double mean_compliance(const Eigen::SparseMatrix<double>& L, const MatX& FG) {
  double sum = 0;
  for (int column = 0; column < L.outerSize(); ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator entry(L, column); entry; ++entry)
      sum += entry.value() * FG(column, entry.row());
  const double mean = sum / static_cast<double>(std::max<Eigen::Index>(L.rows(), 1));
  return std::max(mean, std::numeric_limits<double>::min());
}

}  // namespace

SurfaceTangent::SurfaceTangent(const IncrementState& state, const TangentFactor& factor)
    : state_(state), factor_(factor), first_(state.contacts.size()) {
  const std::vector<Vec3>& X = state.body.mesh().X;
  const BodyState& now = state.now;
  x_ = positions(X, now.u);
  const std::vector<Vec3> none;
  const ContactState contact{state.contacts, X, now.u, state.u_start, none, none, now.r};
  system_ = surface_system(contact, state.surfaces, state.before.u, factor);
  const SurfaceLaws& laws = system_.laws;
  const MatX FG = system_.F * laws.G;
  typical_ = mean_compliance(laws.L, FG);
  const std::vector<ContactDefect> defects = state.surface_defects();
  const Eigen::Index n = static_cast<Eigen::Index>(laws.dofs.size());
  const Eigen::Index m = laws.q.size();
  if (n == 0) return;
  const Eigen::SparseMatrix<double, Eigen::RowMajor> L = laws.L;
  MatX M = MatX::Zero(n + m, n + m);
  M.topLeftCorner(n, n) = MatX::Identity(n, n) - system_.F * laws.C;
  M.topRightCorner(n, m) = -FG / typical_;
  for (std::size_t p = 0; p < system_.rows.size(); ++p) {
    const SurfaceSystem::Row& row = system_.rows[p];
    const auto at = 3 * static_cast<Eigen::Index>(p);
    CandidateState& one = candidates_.emplace_back();
    one.status = defects[row.surface].status[row.candidate];
    one.mu = laws.mu[static_cast<Eigen::Index>(p)];
    one.r = laws.r.segment<3>(at);
    one.slip = laws.q.segment<2>(at + 1).norm();
    const LawRows& law = rows_.emplace_back(law_rows(one, typical_));
    M.block(n + at, 0, 3, n) = law.x * MatX(L.middleRows(at, 3));
    M.block<3, 3>(n + at, n + at) = law.r / typical_;
  }
  lu_.compute(M);
  singular_ = !(lu_.rcond() > 1e-14);
  if (singular_) least_.compute(M);
}

SurfaceTangent::Loads SurfaceTangent::loads(const ParameterChange& change,
                                            const VecX& before) const {
  Loads loads{VecX::Zero(system_.laws.q.size()),
              VecX::Zero(static_cast<Eigen::Index>(system_.laws.dofs.size()))};
  if (change.prescribed.size() > 0)
    for (std::size_t c = 0; c < system_.laws.dofs.size(); ++c)
      loads.prescribed[static_cast<Eigen::Index>(c)] = change.prescribed[system_.laws.dofs[c]];
  const auto& averages = state_.surfaces.at(state_.body.mesh().X, state_.now.u);
  for (std::size_t p = 0; p < system_.rows.size(); ++p) {
    const SurfaceSystem::Row& row = system_.rows[p];
    const CandidateState& one = candidates_[p];
    const auto at = 3 * static_cast<Eigen::Index>(p);
    if (one.mu == 0) continue;
    const auto& nodes = averages[row.surface];
    const auto node =
        std::ranges::find(nodes, static_cast<int>(row.candidate), &MortarNode::candidate);
    Vec3 slipped = -(row.frame.transpose() * node->average(before));
    slipped[0] = 0;
    loads.h.segment<3>(at) -= rows_[p].x * slipped;
    if (change.mu.empty() || one.status != ContactStatus::slip) continue;
    const Eigen::Vector2d s = -one.r.tail<2>().normalized();
    loads.h.segment<2>(at + 1) -= rows_[p].r(1, 1) * change.mu[first_ + row.surface] * one.r[0] * s;
  }
  return loads;
}

std::optional<SurfaceTangent::Change> SurfaceTangent::solve(const VecX& rhs,
                                                            const Loads& loads) const {
  const Eigen::Index n = static_cast<Eigen::Index>(system_.laws.dofs.size());
  const Eigen::Index m = system_.laws.q.size();
  Change out{{}, VecX::Zero(m)};
  if (n == 0) {
    out.move = factor_.linear().solve(rhs);
    if (out.move.allFinite()) return out;
    return std::nullopt;
  }
  const StagedSolution staged(factor_, rhs);
  VecX b = VecX::Zero(n + m);
  if (loads.prescribed.size() > 0) b.head(n) = loads.prescribed;
  if (loads.h.size() > 0) b.tail(m) = loads.h;
  for (Eigen::Index c = 0; c < n; ++c)
    if (const int row = factor_.last_of(system_.laws.dofs[static_cast<std::size_t>(c)]); row >= 0)
      b[c] += staged.last()[row];
  const VecX answer = singular_ ? least_.solve(b) : lu_.solve(b);
  if (!answer.allFinite()) return std::nullopt;
  out.r = answer.tail(m) / typical_;
  // forces on the rows that the factor has eliminated last
  const VecX s = system_.laws.G * out.r + system_.laws.C * answer.head(n);
  VecX force = VecX::Zero(staged.last().size());
  for (Eigen::Index c = 0; c < n; ++c)
    if (const int row = factor_.last_of(system_.laws.dofs[static_cast<std::size_t>(c)]); row >= 0)
      force[row] = s[c];
  out.move = staged.with(force);
  if (out.move.allFinite()) return out;
  return std::nullopt;
}

void SurfaceTangent::add_reactions(const Change& change, Reactions& r) const {
  for (std::size_t p = 0; p < system_.rows.size(); ++p) {
    const SurfaceSystem::Row& row = system_.rows[p];
    r[first_ + row.surface][row.candidate] +=
        row.frame * change.r.segment<3>(3 * static_cast<Eigen::Index>(p));
  }
}

// Positions move by 1e-5 of the least distance of two contact nodes, or reactions by as much of
// the largest of them.
double SurfaceTangent::step(const VecX& du, const Reactions& r) const {
  constexpr double share = 1e-5;
  double length = 1;
  for (const SurfaceContact& surface : state_.surfaces.surfaces())
    length = std::min(length, surface.reach);
  double moved = 0;
  for (const int dof : system_.laws.dofs) moved = std::max(moved, std::abs(du[dof]));
  double changed = 0;
  double largest = 0;
  for (std::size_t s = first_; s < r.size(); ++s)
    for (std::size_t i = 0; i < r[s].size(); ++i) {
      changed = std::max(changed, r[s][i].norm());
      largest = std::max(largest, state_.now.r[s][i].norm());
    }
  double most = std::numeric_limits<double>::infinity();
  if (moved > 0) most = share * length / moved;
  if (changed > 0 && largest > 0) most = std::min(most, share * largest / changed);
  return std::isfinite(most) ? most : 1;
}

SurfaceTangent::Moved SurfaceTangent::moved(const VecX& du, const Reactions& r, double step) const {
  Moved out{x_ + step * du, state_.now.r};
  const auto& surfaces = state_.surfaces.surfaces();
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    const std::vector<Vec3> old = mortar_normals(surfaces[s], x_);
    const std::vector<Vec3> now = mortar_normals(surfaces[s], out.x);
    std::vector<Vec3>& reactions = out.r[first_ + s];
    for (std::size_t i = 0; i < reactions.size(); ++i) {
      if (reactions[i].isZero(0)) continue;
      reactions[i] = turn_with_normal(reactions[i] + step * r[first_ + s][i], old[i], now[i]);
    }
  }
  return out;
}

VecX SurfaceTangent::forces(const VecX& du, const Reactions& r) const {
  const double h = step(du, r);
  VecX out = VecX::Zero(x_.size());
  for (const double sign : {1.0, -1.0}) {
    const Moved at = moved(du, r, sign * h);
    VecX f = VecX::Zero(x_.size());
    const auto& surfaces = state_.surfaces.surfaces();
    for (std::size_t s = 0; s < surfaces.size(); ++s)
      add_mortar_forces(mortar_nodes(surfaces[s], at.x), at.x, at.r[first_ + s], f);
    out += sign / (2 * h) * f;
  }
  return out;
}

void SurfaceTangent::turn_reactions(const VecX& du, Reactions& r) const {
  const double h = step(du, r);
  const Moved more = moved(du, r, h);
  const Moved less = moved(du, r, -h);
  for (std::size_t s = first_; s < r.size(); ++s)
    for (std::size_t i = 0; i < r[s].size(); ++i) r[s][i] = (more.r[s][i] - less.r[s][i]) / (2 * h);
}

}  // namespace langer
