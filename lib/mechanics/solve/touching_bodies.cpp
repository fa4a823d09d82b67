#include "mechanics/solve/touching_bodies.hpp"

#include <Eigen/Dense>
#include <set>

#include "core/tensor/dense.hpp"
#include "mechanics/contact/supported_problem.hpp"
#include "mechanics/mortar/penetration.hpp"
#include "mechanics/solve/surface_laws.hpp"

namespace langer {

std::vector<int> TouchingBodies::nodes() const {
  std::set<int> all;
  for (const SurfaceContact& s : surfaces_) all.insert(s.all_nodes.begin(), s.all_nodes.end());
  return {all.begin(), all.end()};
}

const std::vector<std::vector<MortarNode>>& TouchingBodies::at(const std::vector<Vec3>& X,
                                                               const VecX& u) {
  if (at_.size() == u.size() && at_ == u) return averages_;
  const VecX x = positions(X, u);
  averages_.clear();
  for (const SurfaceContact& surface : surfaces_) averages_.push_back(mortar_nodes(surface, x));
  at_ = u;
  return averages_;
}

void TouchingBodies::add_forces(const std::vector<Vec3>& X, const VecX& u, const Reactions& r,
                                std::size_t first, VecX& f) {
  const VecX x = positions(X, u);
  const auto& averages = at(X, u);
  for (std::size_t s = 0; s < surfaces_.size(); ++s)
    add_mortar_forces(averages[s], x, r[first + s], f);
}

std::vector<ContactDefect> TouchingBodies::defects(const std::vector<Vec3>& X, const VecX& u,
                                                   const VecX& u0, const Reactions& r,
                                                   std::size_t first, double motion) {
  // Bodies that only inertia moves stick to each other while both of them go far.
  if (motion == 0) motion = (u - u0).lpNorm<Eigen::Infinity>();
  const VecX x = positions(X, u);
  const VecX x0 = positions(X, u0);
  const auto& averages = at(X, u);
  std::vector<ContactDefect> out;
  for (std::size_t s = 0; s < surfaces_.size(); ++s)
    out.push_back(mortar_defect(surfaces_[s], averages[s], x, x0, r[first + s], motion));
  return out;
}

double TouchingBodies::work_of_friction(const std::vector<Vec3>& X, const VecX& u, const VecX& du,
                                        const Reactions& r, std::size_t first) {
  double work = 0;
  const auto& averages = at(X, u);
  for (std::size_t s = 0; s < surfaces_.size(); ++s) {
    if (surfaces_[s].mu == 0) continue;
    for (const MortarNode& node : averages[s]) {
      const Vec3& force = r[first + s][static_cast<std::size_t>(node.candidate)];
      if (force.isZero(0)) continue;
      work += force.dot(node.slip(du));
    }
  }
  return work;
}

std::vector<double> TouchingBodies::penetrations(const std::vector<Vec3>& X, const VecX& u) const {
  const VecX x = positions(X, u);
  std::vector<double> out;
  for (const SurfaceContact& surface : surfaces_) out.push_back(penetration(surface, x));
  return out;
}

void TouchingBodies::turn(const std::vector<Vec3>& X, const VecX& u, const VecX& du, Reactions& r,
                          std::size_t first) {
  const VecX x = positions(X, u);
  std::vector<std::vector<Vec3>> old_normals;
  for (const SurfaceContact& surface : surfaces_) old_normals.push_back(mortar_normals(surface, x));
  const auto& averages = at(X, u + du);
  for (std::size_t s = 0; s < surfaces_.size(); ++s) {
    std::vector<Vec3> turned(r[first + s].size(), Vec3::Zero());
    for (const MortarNode& node : averages[s]) {
      const auto i = static_cast<std::size_t>(node.candidate);
      if (!r[first + s][i].isZero(0))
        turned[i] = turn_with_normal(r[first + s][i], old_normals[s][i], node.normal);
    }
    r[first + s] = std::move(turned);
  }
}

namespace {

using Sparse = Eigen::SparseMatrix<double>;
using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

// Movements (3 n) without any change of reaction: of rows that the factor has eliminated last, and
// of prescribed degrees of freedom.
VecX movements(VecX prescribed, const TangentFactor& factor, const VecX& move) {
  for (Eigen::Index dof = 0; dof < prescribed.size(); ++dof)
    if (const int row = factor.last_of(static_cast<int>(dof)); row >= 0)
      prescribed[dof] = move[row];
  return prescribed;
}

// (columns, columns) of these laws, where prescribed degrees of freedom do not move.
MatX compliance(const SurfaceLaws& laws, const TangentFactor& factor) {
  const auto columns = static_cast<Eigen::Index>(laws.dofs.size());
  const auto n_last = static_cast<Eigen::Index>(factor.last().size());
  std::vector<Eigen::Index> free;
  for (Eigen::Index c = 0; c < columns; ++c)
    if (factor.last_of(laws.dofs[static_cast<std::size_t>(c)]) >= 0) free.push_back(c);
  MatX B = MatX::Zero(n_last, static_cast<Eigen::Index>(free.size()));
  for (std::size_t c = 0; c < free.size(); ++c)
    B(factor.last_of(laws.dofs[static_cast<std::size_t>(free[c])]), static_cast<Eigen::Index>(c)) =
        1;
  const MatX F_free = factor.linear().compliance(B);
  MatX F = MatX::Zero(columns, columns);
  for (std::size_t i = 0; i < free.size(); ++i)
    for (std::size_t j = 0; j < free.size(); ++j)
      F(free[i], free[j]) = F_free(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  return F;
}

// Springs that support the tangent are taken out in the change of forces C.
Sparse without_springs(const SurfaceLaws& laws, const TangentFactor& factor) {
  if (!factor.with_springs()) return laws.C;
  Sparse springs(laws.C.rows(), laws.C.cols());
  for (Eigen::Index c = 0; c < springs.cols(); ++c)
    if (factor.last_of(laws.dofs[static_cast<std::size_t>(c)]) >= 0)
      springs.insert(c, c) = factor.gamma();
  return laws.C + springs;
}

class Step {
 public:
  Step(const ContactState& state, TouchingBodies& bodies, const VecX& u_begin,
       const VecX& prescribed, const TangentFactor& factor, const VecX& move)
      : state_(state), factor_(factor) {
    const VecX moves = movements(prescribed, factor, move);
    laws_ = surface_laws(
        state, bodies, u_begin, moves, SurfaceLaws::Of::near,
        factor.with_springs() ? SurfaceLaws::Nodes::all : SurfaceLaws::Nodes::involved);
    move_.resize(static_cast<Eigen::Index>(laws_.dofs.size()));
    for (std::size_t c = 0; c < laws_.dofs.size(); ++c)
      move_[static_cast<Eigen::Index>(c)] = moves[laws_.dofs[c]];
  }

  std::optional<ContactChange> solved() {
    ContactChange change{VecX::Zero(static_cast<Eigen::Index>(factor_.last().size())), state_.r};
    if (laws_.n_rows() == 0 && !factor_.with_springs()) return change;
    C_ = without_springs(laws_, factor_);
    F_ = compliance(laws_, factor_);
    VecX d, r;
    if (!solve(d, r, change.sweeps)) return std::nullopt;
    // forces on the rows that the factor has eliminated last
    const VecX s = laws_.G * VecX(r - laws_.r) + C_ * d;
    for (std::size_t column = 0; column < laws_.dofs.size(); ++column)
      if (const int row = factor_.last_of(laws_.dofs[column]); row >= 0)
        change.force[row] = s[static_cast<Eigen::Index>(column)];
    laws_.give_reactions(r, change.r);
    if (!change.force.allFinite()) return std::nullopt;
    return change;
  }

 private:
  // The movement d and the reactions r.
  bool solve(VecX& d, VecX& r, int& sweeps) {
    // A candidate moves few nodes, so that G, L and C are almost empty: products with them cost n^2
    // times a few, where those of dense matrices cost n^3.
    const SparseRows L = laws_.L;
    const MatX FG = F_ * laws_.G;
    MatX rest = F_ * C_;
    rest *= -1;
    rest.diagonal().array() += 1;
    r = laws_.r;
    if (r.size() == 0) {
      d = Lu(rest).solve(move_);
      return d.allFinite();
    }
    if (!factor_.with_springs()) {
      const Lu lu(rest);
      if (lu.rcond() > 1e-10) {
        const VecX free = lu.solve(move_);
        const MatX by_reactions = lu.solve_columns(FG);
        const MatX W = L * by_reactions;
        const LocalReport report =
            solve_local({W, VecX(laws_.q + L * free - W * laws_.r), laws_.mu}, r);
        sweeps += report.sweeps;
        if (report.converged && r.allFinite()) {
          d = free + by_reactions * (r - laws_.r);
          return true;
        }
      }
    }
    return solve_with_springs_of_law(L, rest, FG, d, r, sweeps);
  }

  // s = r + kappa L d in place of r
  bool solve_with_springs_of_law(const SparseRows& L, const MatX& rest, const MatX& FG, VecX& d,
                                 VecX& r, int& sweeps) {
    const MatX W_alone = L * FG;
    VecX kappa(W_alone.rows());
    for (Eigen::Index i = 0; i < kappa.size(); i += 3)
      kappa.segment<3>(i).setConstant(1 / std::max(W_alone.block<3, 3>(i, i).norm(), 1e-300));
    const SparseRows springs = kappa.asDiagonal() * L;
    const Lu lu(rest + FG * springs);
    const VecX free = lu.solve(move_);
    const MatX by_reactions = lu.solve_columns(FG);
    if (!free.allFinite() || !by_reactions.allFinite()) return false;
    const MatX W = L * by_reactions;
    const MatX A = MatX::Identity(W.rows(), W.cols()) - kappa.asDiagonal() * W;
    const VecX b = laws_.r - kappa.asDiagonal() * VecX(L * free);
    const SupportedProblem problem{W, A, VecX(laws_.q + L * free), b, laws_.mu};
    // from the present reactions; where that leads nowhere, from none
    VecX s = laws_.r;
    LocalReport report = solve_supported(problem, s);
    sweeps += report.newton_steps;
    if (!report.converged) {
      VecX other = VecX::Zero(b.size());
      const LocalReport again = solve_supported(problem, other);
      sweeps += again.newton_steps;
      if (again.residual < report.residual) {
        s = other;
        report = again;
      }
    }
    r = b + A * s;
    for (std::size_t p = 0; p < report.status.size(); ++p)
      if (report.status[p] == ContactStatus::open)
        r.segment<3>(3 * static_cast<Eigen::Index>(p)).setZero();
    d = free + by_reactions * s;
    return r.allFinite() && d.allFinite();
  }

  const ContactState& state_;
  const TangentFactor& factor_;
  SurfaceLaws laws_;
  Sparse C_;
  MatX F_;
  VecX move_;
};

}  // namespace

std::optional<ContactChange> linearised_bodies(const ContactState& state, TouchingBodies& bodies,
                                               const VecX& u_begin, const VecX& prescribed,
                                               const TangentFactor& factor, const VecX& move) {
  return Step(state, bodies, u_begin, prescribed, factor, move).solved();
}

SurfaceSystem surface_system(const ContactState& state, TouchingBodies& bodies, const VecX& u_begin,
                             const TangentFactor& factor) {
  const VecX at_rest = VecX::Zero(state.u.size());
  SurfaceSystem out{
      surface_laws(state, bodies, u_begin, at_rest, SurfaceLaws::Of::bearing,
                   factor.with_springs() ? SurfaceLaws::Nodes::all : SurfaceLaws::Nodes::involved),
      {},
      {}};
  out.laws.C = without_springs(out.laws, factor);
  out.F = compliance(out.laws, factor);
  for (std::size_t s = 0; s < out.laws.mortar.size(); ++s) {
    const MortarLaw& law = out.laws.mortar[s];
    for (std::size_t p = 0; p < law.nodes.size(); ++p)
      out.rows.push_back({s, static_cast<std::size_t>(law.nodes[p].candidate), law.frames[p]});
  }
  return out;
}

}  // namespace langer
