#include "mechanics/solve/touching_bodies.hpp"

#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <algorithm>
#include <set>

#include "core/tensor/dense.hpp"
#include "mechanics/contact/supported_problem.hpp"
#include "mechanics/mortar/penetration.hpp"

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

// Rows of the law, of indenters first, and the degrees of freedom that take part.
struct Rows {
  struct Rigid {
    std::size_t contact, candidate;
    LinearisedContact law;
    Vec3 r;
  };
  std::vector<Rigid> rigid;
  std::vector<MortarLaw> mortar;  // by surface
  std::vector<int> column_of;     // (3 n)
  std::vector<int> dofs;          // by column
  int n_rows() const {
    std::size_t n = rigid.size();
    for (const MortarLaw& law : mortar) n += law.nodes.size();
    return static_cast<int>(n);
  }
};

using Sparse = Eigen::SparseMatrix<double>;
using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

class Step {
 public:
  Step(const ContactState& state, TouchingBodies& bodies, const VecX& u_begin,
       const VecX& prescribed, const TangentFactor& factor, const VecX& move)
      : state_(state),
        bodies_(bodies),
        factor_(factor),
        x_(positions(state.X, state.u)),
        x0_(positions(state.X, u_begin)),
        moves_(prescribed) {
    for (Eigen::Index dof = 0; dof < moves_.size(); ++dof)
      if (const int row = factor.last_of(static_cast<int>(dof)); row >= 0) moves_[dof] = move[row];
  }

  // Of candidates that bear something.
  SurfaceSystem system() {
    bearing_only_ = true;
    find_mortar_rows();
    number_columns();
    assemble();
    SurfaceSystem out{{}, rows_.dofs, m_.L, m_.G, m_.C, F_, q_, present_, mu_};
    for (std::size_t s = 0; s < rows_.mortar.size(); ++s) {
      const MortarLaw& law = rows_.mortar[s];
      for (std::size_t p = 0; p < law.nodes.size(); ++p)
        out.rows.push_back({s, static_cast<std::size_t>(law.nodes[p].candidate), law.frames[p]});
    }
    return out;
  }

  std::optional<ContactChange> solved() {
    find_rigid_rows();
    find_mortar_rows();
    ContactChange change{VecX::Zero(static_cast<Eigen::Index>(factor_.last().size())), state_.r};
    if (rows_.n_rows() == 0 && !factor_.with_springs()) return change;
    number_columns();
    assemble();
    VecX d, r;
    if (!solve(d, r, change.sweeps)) return std::nullopt;
    // forces on the rows that the factor has eliminated last
    const VecX s = m_.G * (r - present_) + m_.C * d;
    for (std::size_t column = 0; column < rows_.dofs.size(); ++column)
      if (const int row = factor_.last_of(rows_.dofs[column]); row >= 0)
        change.force[row] = s[static_cast<Eigen::Index>(column)];
    give_reactions(r, change.r);
    if (!change.force.allFinite()) return std::nullopt;
    return change;
  }

 private:
  Vec3 move_of(int node) const { return moves_.segment<3>(3 * static_cast<Eigen::Index>(node)); }

  bool holds(std::size_t contact, std::size_t candidate) const {
    return state_.bonds && state_.bonds->holds(contact, candidate);
  }

  // Candidates whose gap the movement may close. Those that are far off would only cost time.
  void find_rigid_rows() {
    for (std::size_t k = 0; k < state_.contacts.size(); ++k) {
      const RigidContact& contact = state_.contacts[k];
      const Vec3 c = state_.c[k];
      const Vec3 c0 = state_.c_start[k];
      for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
        const auto node = static_cast<std::size_t>(contact.nodes[i]);
        const Vec3 x = x_.segment<3>(3 * static_cast<Eigen::Index>(node));
        const Vec3 x0 =
            state_.X[node] + state_.u_start[k].segment<3>(3 * static_cast<Eigen::Index>(node));
        const double reach = (c - c0).norm() + 2 * move_of(contact.nodes[i]).norm() + 0.05;
        const Vec3& r = state_.r[k][i];
        const bool bonded = holds(k, i);
        if (!bonded && r.isZero(0) && shape_at(contact.shape, x - c).gap > reach) continue;
        LinearisedContact law = linearise(contact, x, x0, c, c0, r);
        if (bonded) law.D += law.frame.transpose() * state_.bonds->tangent(k, i) * law.frame;
        rows_.rigid.push_back({k, i, law, law.frame.transpose() * r});
      }
    }
  }

  void find_mortar_rows() {
    const auto& averages = bodies_.at(state_.X, state_.u);
    for (std::size_t s = 0; s < bodies_.surfaces().size(); ++s) {
      const SurfaceContact& surface = bodies_.surfaces()[s];
      const std::size_t k = state_.contacts.size() + s;
      const std::vector<Vec3>& r = state_.r[k];
      std::vector<char> wanted(surface.nodes.size(), 0);
      for (const MortarNode& node : averages[s]) {
        const auto i = static_cast<std::size_t>(node.candidate);
        const double reach = 2 * node.average(moves_).norm() + std::sqrt(node.area);
        wanted[i] = !r[i].isZero(0) || holds(k, i) || (!bearing_only_ && node.gap() <= reach);
      }
      const bool adheres = state_.bonds && state_.bonds->of(k);
      rows_.mortar.push_back(mortar_law(averages[s], wanted, x_, x0_, r,
                                        adheres ? state_.bonds->forces(k) : std::vector<Vec3>{}));
    }
  }

  // Springs support all rows that are eliminated last: then all of them take part.
  void number_columns() {
    rows_.column_of.assign(static_cast<std::size_t>(x_.size()), -1);
    std::set<int> nodes;
    if (factor_.with_springs()) {
      for (int node : bodies_.nodes()) nodes.insert(node);
      for (const RigidContact& contact : state_.contacts)
        nodes.insert(contact.nodes.begin(), contact.nodes.end());
    }
    for (const Rows::Rigid& row : rows_.rigid)
      nodes.insert(state_.contacts[row.contact].nodes[row.candidate]);
    for (std::size_t s = 0; s < rows_.mortar.size(); ++s) {
      const SurfaceContact& surface = bodies_.surfaces()[s];
      std::set<int> own;
      for (const MortarNode& node : rows_.mortar[s].nodes) {
        own.insert(surface.nodes[static_cast<std::size_t>(node.candidate)]);
        for (const Weight& w : node.other) nodes.insert(w.node);
      }
      for (const QuadNodes& facet : surface.own)
        if (std::any_of(facet.begin(), facet.end(), [&](int n) { return own.count(n) > 0; }))
          nodes.insert(facet.begin(), facet.end());
    }
    for (int node : nodes)
      for (int dof = 3 * node; dof < 3 * node + 3; ++dof) {
        rows_.column_of[static_cast<std::size_t>(dof)] = static_cast<int>(rows_.dofs.size());
        rows_.dofs.push_back(dof);
      }
  }

  void assemble() {
    const Eigen::Index rows = 3 * static_cast<Eigen::Index>(rows_.n_rows());
    const auto columns = static_cast<Eigen::Index>(rows_.dofs.size());
    m_ = {MatX::Zero(rows, columns), MatX::Zero(columns, rows), MatX::Zero(columns, columns)};
    q_.resize(rows);
    present_.resize(rows);
    mu_.resize(rows / 3);
    Eigen::Index row = 0;
    for (const Rows::Rigid& rigid : rows_.rigid) {
      const RigidContact& contact = state_.contacts[rigid.contact];
      const Eigen::Index column =
          rows_.column_of[3 * static_cast<std::size_t>(contact.nodes[rigid.candidate])];
      const LinearisedContact& law = rigid.law;
      m_.L.block<3, 3>(row, column) = law.T * law.frame.transpose();
      m_.G.block<3, 3>(column, row) = law.frame;
      m_.C.block<3, 3>(column, column) += law.frame * law.D * law.frame.transpose();
      q_.segment<3>(row) = law.q;
      present_.segment<3>(row) = rigid.r;
      mu_[row / 3] = contact.mu;
      row += 3;
    }
    for (std::size_t s = 0; s < rows_.mortar.size(); ++s) {
      const MortarLaw& law = rows_.mortar[s];
      if (law.nodes.empty()) continue;
      add_mortar_matrices(bodies_.surfaces()[s], law, x_, x0_, rows_.column_of,
                          static_cast<int>(row), m_);
      add_bonds(s);
      for (std::size_t p = 0; p < law.nodes.size(); ++p) {
        q_.segment<3>(row) = law.q[p];
        present_.segment<3>(row) = law.r[p];
        mu_[row / 3] = bodies_.surfaces()[s].mu;
        row += 3;
      }
    }
    // compliance of these degrees of freedom, and their movement
    const auto n_last = static_cast<Eigen::Index>(factor_.last().size());
    std::vector<Eigen::Index> free;
    for (Eigen::Index c = 0; c < columns; ++c)
      if (factor_.last_of(rows_.dofs[static_cast<std::size_t>(c)]) >= 0) free.push_back(c);
    MatX B = MatX::Zero(n_last, static_cast<Eigen::Index>(free.size()));
    for (std::size_t c = 0; c < free.size(); ++c)
      B(factor_.last_of(rows_.dofs[static_cast<std::size_t>(free[c])]),
        static_cast<Eigen::Index>(c)) = 1;
    const MatX F = factor_.linear().compliance(B);
    F_ = MatX::Zero(columns, columns);
    for (std::size_t i = 0; i < free.size(); ++i)
      for (std::size_t j = 0; j < free.size(); ++j)
        F_(free[i], free[j]) = F(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    move_.resize(columns);
    for (Eigen::Index c = 0; c < columns; ++c)
      move_[c] = moves_[rows_.dofs[static_cast<std::size_t>(c)]];
    if (factor_.with_springs())
      for (Eigen::Index c : free) m_.C(c, c) += factor_.gamma();
  }

  // The forces of bonds follow the movements of their nodes. How weights and normals change the
  // opening is left out: of the order of the opening over a facet.
  void add_bonds(std::size_t s) {
    const std::size_t k = state_.contacts.size() + s;
    for (const MortarNode& node : rows_.mortar[s].nodes) {
      const auto candidate = static_cast<std::size_t>(node.candidate);
      if (!holds(k, candidate)) continue;
      const Mat3& tangent = state_.bonds->tangent(k, candidate);
      for (const NodalForce& force : force_operator(node, x_)) {
        const Mat3 by_opening = force.per_reaction * tangent;
        for (const auto* side : {&node.own, &node.other})
          for (const Weight& w : *side) add_block(force.node, w.node, w.of * by_opening);
      }
    }
  }

  void add_block(int to, int by, const Mat3& block) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const int row =
            rows_.column_of[3 * static_cast<std::size_t>(to) + static_cast<std::size_t>(i)];
        const int column =
            rows_.column_of[3 * static_cast<std::size_t>(by) + static_cast<std::size_t>(j)];
        if (row >= 0 && column >= 0) m_.C(row, column) += block(i, j);
      }
  }

  // The movement d and the reactions r.
  bool solve(VecX& d, VecX& r, int& sweeps) {
    // A candidate moves few nodes, so that G, L and C are almost empty: products with them cost n^2
    // times a few, where those of dense matrices cost n^3.
    const Sparse G = m_.G.sparseView();
    const SparseRows L = m_.L.sparseView();
    const Sparse C = m_.C.sparseView();
    const MatX FG = F_ * G;
    MatX rest = F_ * C;
    rest *= -1;
    rest.diagonal().array() += 1;
    r = present_;
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
        const LocalReport report = solve_local({W, VecX(q_ + L * free - W * present_), mu_}, r);
        sweeps += report.sweeps;
        if (report.converged && r.allFinite()) {
          d = free + by_reactions * (r - present_);
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
    const VecX b = present_ - kappa.asDiagonal() * VecX(L * free);
    const SupportedProblem problem{W, A, VecX(q_ + L * free), b, mu_};
    // from the present reactions; where that leads nowhere, from none
    VecX s = present_;
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

  void give_reactions(const VecX& r, Reactions& out) const {
    Eigen::Index row = 0;
    for (const Rows::Rigid& rigid : rows_.rigid) {
      out[rigid.contact][rigid.candidate] = rigid.law.frame * r.segment<3>(row);
      row += 3;
    }
    for (std::size_t s = 0; s < rows_.mortar.size(); ++s) {
      const MortarLaw& law = rows_.mortar[s];
      for (std::size_t p = 0; p < law.nodes.size(); ++p) {
        out[state_.contacts.size() + s][static_cast<std::size_t>(law.nodes[p].candidate)] =
            law.frames[p] * r.segment<3>(row);
        row += 3;
      }
    }
  }

  const ContactState& state_;
  TouchingBodies& bodies_;
  const TangentFactor& factor_;
  VecX x_, x0_;
  VecX moves_;  // (3 n), of contact nodes, without any change of reaction
  Rows rows_;
  MortarMatrices m_;
  MatX F_;
  VecX q_, present_, mu_, move_;
  bool bearing_only_ = false;
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
  const VecX none = VecX::Zero(static_cast<Eigen::Index>(factor.last().size()));
  return Step(state, bodies, u_begin, at_rest, factor, none).system();
}

}  // namespace langer
