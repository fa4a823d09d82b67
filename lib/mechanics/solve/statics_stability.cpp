// Stability of an equilibrium: the number of negative eigenvalues of the constrained tangent.
//
// By Sylvester's law of inertia it is the number of negative pivots of an L D L^T factorization. If
// the contact is condensed, the part without candidates is positive definite, and the eigenvalues
// of the Schur complement on the candidates decide. Contact removes directions (closed candidates)
// and subtracts the turning of its reactions, r_n times the curvature of the indenter.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/base/stopwatch.hpp"
#include "core/tensor/dense.hpp"
#include "mechanics/solve/cell_stability.hpp"
#include "mechanics/solve/statics.hpp"

namespace langer {

namespace {

// The effect of contact on one node: directions that are held, and r_n times the curvature of the
// indenter.
struct NodeContact {
  std::vector<Vec3> held;
  Mat3 turning = Mat3::Zero();
};

std::vector<NodeContact> node_contacts(const Statics& statics, const std::vector<Vec3>& X,
                                       std::size_t n_nodes) {
  std::vector<NodeContact> out(n_nodes);
  const BodyState& state = statics.accepted();
  const Bonds& bonds = statics.bonds();
  const auto defects = statics.defects();
  for (std::size_t k = 0; k < defects.size(); ++k) {
    const RigidContact& contact = statics.contacts()[k];
    const Vec3 c = indenter_displacement(contact, state.t, state.travel);
    for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
      const int node = contact.nodes[i];
      if (bonds.holds(k, i)) out[node].turning += bonds.tangent(k, i);
      if (defects[k].status[i] == ContactStatus::open) continue;
      const ShapePoint shape = shape_at(contact.shape, X[node] + state.u.segment<3>(3 * node) - c);
      const Mat3 frame = contact_frame(shape.normal);
      out[node].held.push_back(frame.col(0));
      if (defects[k].status[i] == ContactStatus::stick) {
        out[node].held.push_back(frame.col(1));
        out[node].held.push_back(frame.col(2));
      } else {
        const Mat3 along = Mat3::Identity() - shape.normal * shape.normal.transpose();
        out[node].turning +=
            std::max(0.0, state.r[k][i].dot(shape.normal)) * along * shape.curvature * along;
      }
    }
  }
  return out;
}

// Orthonormal columns: the movements of a node that its supports and contacts allow.
MatX left_of(const NodeContact& contact, const bool* is_free) {
  MatX held = MatX::Zero(3, 3 + static_cast<Eigen::Index>(contact.held.size()));
  Eigen::Index n = 0;
  for (int j = 0; j < 3; ++j)
    if (!is_free[j]) held.col(n++) = Vec3::Unit(j);
  for (const Vec3& h : contact.held) held.col(n++) = h;
  if (n == 0) return Mat3::Identity();
  const Svd of = svd(held);
  return of.U.rightCols((of.values.array() <= 1e-9).count());
}

Signature signs(const MatX& M, bool zero_energy_too) {
  constexpr int largest = 1500;  // rows of a dense eigenvalue problem that is still affordable
  if (M.rows() == 0) return {};
  if (Cholesky(M).positive_definite() && (!zero_energy_too || M.rows() > largest)) return {};
  const VecX e = symmetric_eigenvalues(M);
  const double small = 1e-8 * e.cwiseAbs().maxCoeff();
  return {static_cast<int>((e.array() < -small).count()),
          static_cast<int>((e.array().abs() <= small).count())};
}

// Adds contacts to a tangent: subtracts the turning of their reactions, and adds held directions as
// springs so stiff that they are no soft directions any more.
void add_contacts(const std::vector<NodeContact>& contacts, const Dofs& dofs,
                  const Pattern& pattern, std::vector<double>& K) {
  double stiffest = 0;
  for (int row = 0; row < dofs.n_free(); ++row) {
    stiffest = std::max(stiffest, std::abs(K[pattern.column_start[row]]));
  }
  for (int node = 0; node < dofs.n / 3; ++node) {
    Mat3 block = -contacts[node].turning;
    for (const Vec3& h : contacts[node].held) block += 1e4 * stiffest * h * h.transpose();
    if (block.isZero(0)) continue;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const int row = dofs.equation[3 * node + i];
        const int column = dofs.equation[3 * node + j];
        if (column < 0 || row < column) continue;
        for (int k = pattern.column_start[column]; k < pattern.column_start[column + 1]; ++k) {
          if (pattern.row[k] == row) K[k] += block(i, j);
        }
      }
    }
  }
}

}  // namespace

void Statics::update_factor_of_accepted(double within) {
  const double moved = (now_.u - before_.u).lpNorm<Eigen::Infinity>();
  if (factor_.kind() != TangentFactor::Kind::none &&
      (now_.u - factored_at_).lpNorm<Eigen::Infinity>() <= within * moved)
    return;
  const TangentFactor::Counts needed = factor_.counts();
  update_tangent();
  factorize();
  factor_.uncount(needed);  // the counts show what the solution itself needed
}

// Contact in the tangent itself: it is positive definite, or its negative pivots are counted.
Signature Statics::signature_with_contact() {
  const double moved = (now_.u - before_.u).lpNorm<Eigen::Infinity>();
  std::vector<std::vector<ContactStatus>> status;
  for (ContactDefect& defect : defects()) status.push_back(std::move(defect.status));
  ContactInTangent& contact = *factor_.in_tangent();
  const bool recent = factor_.kind() != TangentFactor::Kind::none &&
                      factored_at_.size() == now_.u.size() &&
                      (now_.u - factored_at_).lpNorm<Eigen::Infinity>() <= 0.02 * moved;
  if (recent && factor_.kind() == TangentFactor::Kind::whole && contact.factored(status)) return {};
  update_tangent();
  const std::vector<Vec3> c = indenters(now_.t, now_.travel);
  const std::vector<Vec3> c_start = indenters(before_.t, before_.travel);
  const std::vector<double> values = contact.constrained(
      {contacts_, equilibrium_.mesh().X, u_, u_start_, c, c_start, r_}, equilibrium_.K(), status);
  const TangentFactor::Counts needed = factor_.counts();
  {
    const Stopwatch watch(cost_.factor);
    factored_at_ = u_;
    factor_serves_ = false;
    factor_.factorize_with_contact(values);
  }
  factor_.uncount(needed);
  if (factor_.kind() == TangentFactor::Kind::whole) return Signature{};
  return Signature{factor_.linear().negative_pivots(values), 0};
}

Signature Statics::signature() {
  if (contact_in_tangent()) return signature_with_contact();
  if (options_.signs_from_cells && contacts_.empty() && every_cell_resists(equilibrium_, now_.u))
    return {};
  const Dofs& dofs = equilibrium_.dofs();
  using Kind = TangentFactor::Kind;
  update_factor_of_accepted(0.02);
  if (factor_.kind() == Kind::whole && contacts_.empty()) return {};
  const auto contacts = contacts_.empty() ? std::vector<NodeContact>(equilibrium_.mesh().n_nodes())
                                          : node_contacts(*this, equilibrium_.mesh().X,
                                                          equilibrium_.mesh().n_nodes());
  const bool turning = std::any_of(contacts.begin(), contacts.end(),
                                   [](const auto& c) { return !c.turning.isZero(0); });
  if (factor_.kind() == Kind::whole && !turning) return {};
  if (factor_.kind() != Kind::indefinite)
    if (auto S = factor_.linear().schur()) {
      if (factor_.kind() == Kind::supported) S->diagonal().array() -= factor_.gamma();
      MatX Z = MatX::Zero(S->rows(), S->rows());
      Eigen::Index columns = 0;
      for (int node = 0; node < equilibrium_.mesh().n_nodes(); ++node) {
        int row[3];
        bool is_free[3], candidate = false;
        for (int j = 0; j < 3; ++j) {
          row[j] = factor_.last_of(3 * node + j);
          is_free[j] = row[j] >= 0;
          candidate = candidate || is_free[j];
        }
        if (!candidate) continue;
        const MatX basis = left_of(contacts[node], is_free);
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            if (is_free[i] && is_free[j]) (*S)(row[i], row[j]) -= contacts[node].turning(i, j);
        for (Eigen::Index c = 0; c < basis.cols(); ++c, ++columns)
          for (int j = 0; j < 3; ++j)
            if (is_free[j]) Z(row[j], columns) = basis(j, c);
      }
      const auto used = Z.leftCols(columns);
      return signs(used.transpose() * (*S * used), factor_.kind() == Kind::supported);
    }
  update_tangent();
  std::vector<double> K = equilibrium_.K();
  add_contacts(contacts, dofs, equilibrium_.pattern(), K);
  return {held_by_volumes(factor_.linear().negative_pivots(K)), 0};
}

// A given volume holds one direction: with C = F^T K^-1 F of the forces F of unit pressure, the
// tangent on the movements that keep the volumes has as many negative eigenvalues as K, less those
// of C.
int Statics::held_by_volumes(int negative) {
  if (negative <= 0 || p_.size() == 0) return negative;
  const TangentFactor::Counts needed = factor_.counts();
  const bool solvable = factorize();
  factor_.uncount(needed);
  factor_serves_ = false;
  if (!solvable) return negative;
  const std::vector<VecX> F = volume_gradients();
  const auto m = static_cast<Eigen::Index>(F.size());
  MatX C(m, m);
  for (Eigen::Index j = 0; j < m; ++j) {
    const VecX move = factor_.linear().solve(F[static_cast<std::size_t>(j)]);
    for (Eigen::Index i = 0; i < m; ++i) C(i, j) = F[static_cast<std::size_t>(i)].dot(move);
  }
  const VecX e = symmetric_eigenvalues(0.5 * (C + C.transpose()));
  return negative - static_cast<int>((e.array() < 0).count());
}

std::vector<double> Statics::constrained_tangent() {
  equilibrium_.pressures_from(now_.u);
  const VecX direction = imposed_direction(now_.u);
  equilibrium_.assemble(now_.u, true, &direction);
  K_current_ = true;
  std::vector<double> K = equilibrium_.K();
  if (contacts_.empty()) return K;
  const auto n_nodes = static_cast<std::size_t>(equilibrium_.mesh().n_nodes());
  add_contacts(node_contacts(*this, equilibrium_.mesh().X, n_nodes), equilibrium_.dofs(),
               equilibrium_.pattern(), K);
  return K;
}

std::vector<double> Statics::constrained_tangent(OtherTangent& other) {
  equilibrium_.pressures_from(now_.u);
  equilibrium_.assemble_under(now_.u, std::span(&other, 1));
  if (contacts_.empty()) return other.K;
  const auto n_nodes = static_cast<std::size_t>(equilibrium_.mesh().n_nodes());
  add_contacts(node_contacts(*this, equilibrium_.mesh().X, n_nodes), other.dofs, other.pattern,
               other.K);
  return other.K;
}

Signature Statics::signature_under(std::span<OtherTangent> others,
                                   std::vector<std::unique_ptr<LinearSolver>>& solvers) {
  const int n_nodes = equilibrium_.mesh().n_nodes();
  std::vector<NodeContact> contacts(static_cast<std::size_t>(n_nodes));
  if (!contacts_.empty()) {
    contacts = node_contacts(*this, equilibrium_.mesh().X, static_cast<std::size_t>(n_nodes));
  }
  {
    const Stopwatch watch(cost_.assembly);
    // accepted states have no cell that is turned inside out
    equilibrium_.assemble_under(now_.u, others);
  }
  const Stopwatch watch(cost_.factor);
  Signature sum;
  bool singular = false;
  for (std::size_t i = 0; i < others.size(); ++i) {
    OtherTangent& other = others[i];
    if (other.pattern.n == 0) continue;
    add_contacts(contacts, other.dofs, other.pattern, other.K);
    if (!solvers[i]) {
      solvers[i] =
          std::make_unique<LinearSolver>(other.pattern, std::vector<int>{}, options_.threads);
    }
    if (solvers[i]->factorize(other.K)) continue;
    const int negative = solvers[i]->negative_pivots(other.K);
    if (negative < 0) {
      singular = true;
    } else {
      sum.negative += negative;
    }
  }
  if (singular && sum.negative == 0) sum.negative = -1;
  return sum;
}

}  // namespace langer
