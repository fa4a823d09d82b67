#include "mechanics/solve/tangent_signs.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/stopwatch.hpp"
#include "core/tensor/dense.hpp"
#include "mechanics/solve/cell_stability.hpp"

namespace langer {

namespace {

// By node.
std::vector<NodeContact> node_contacts(const IncrementState& increment) {
  const std::vector<Vec3>& X = increment.body.mesh().X;
  std::vector<NodeContact> out(X.size());
  if (increment.contacts.empty()) return out;
  const BodyState& state = increment.now;
  const Bonds& bonds = increment.bonds;
  const auto defects = increment.defects();
  for (std::size_t k = 0; k < defects.size(); ++k) {
    const RigidContact& contact = increment.contacts[k];
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

// The rows of another tangent in the order in which the body's own factor eliminates the nodes: the
// meshes are the same, and finding an order takes as long as some factors.
std::vector<int> order_of(const Dofs& own, const std::vector<int>& own_order, const Dofs& other) {
  std::vector<int> order;
  order.reserve(other.free.size());
  std::vector<bool> listed(static_cast<std::size_t>(other.n / 3), false);
  const auto list = [&](int node) {
    if (listed[static_cast<std::size_t>(node)]) return;
    listed[static_cast<std::size_t>(node)] = true;
    for (int dof = 3 * node; dof < 3 * node + 3; ++dof)
      if (other.equation[dof] >= 0) order.push_back(other.equation[dof]);
  };
  for (const int row : own_order) list(own.free[row] / 3);
  for (int node = 0; node < other.n / 3; ++node) list(node);
  return order;
}

}  // namespace

// Contact in the tangent itself: it is positive definite, or its negative pivots are counted.
Signature TangentSigns::signature_with_contact(double within) {
  const double moved = (now_.u - before_.u).lpNorm<Eigen::Infinity>();
  std::vector<std::vector<ContactStatus>> status;
  for (ContactDefect& defect : state_.defects()) status.push_back(std::move(defect.status));
  ContactInTangent& contact = *factors_.factor.in_tangent();
  const bool recent = factors_.factor.kind() != TangentFactor::Kind::none &&
                      factors_.factored_at.size() == now_.u.size() &&
                      (now_.u - factors_.factored_at).lpNorm<Eigen::Infinity>() <= within * moved;
  if (recent && factors_.factor.kind() == TangentFactor::Kind::whole && contact.factored(status))
    return {};
  factors_.update_tangent();
  const std::vector<Vec3> c = state_.indenters(now_.t, now_.travel);
  const std::vector<Vec3> c_start = state_.indenters(before_.t, before_.travel);
  const std::vector<double> values =
      contact.constrained(state_.contact_state(c, c_start), body_.K(), status);
  const TangentFactor::Counts needed = factors_.factor.counts();
  {
    const Stopwatch watch(state_.cost.factor);
    factors_.factored_at = trial_.u;
    factors_.serves = false;
    factors_.factor.factorize_with_contact(values);
  }
  factors_.factor.uncount(needed);
  if (factors_.factor.kind() == TangentFactor::Kind::whole) return Signature{};
  return Signature{factors_.factor.linear().negative_pivots(values), 0};
}

// The eigenvalues on the candidates decide, where the rest of the body is positive definite.
Signature TangentSigns::signs_on_candidates(MatX S,
                                            const std::vector<NodeContact>& contacts) const {
  const bool supported = factors_.factor.kind() == TangentFactor::Kind::supported;
  if (supported) S.diagonal().array() -= factors_.factor.gamma();
  MatX Z = MatX::Zero(S.rows(), S.rows());
  Eigen::Index columns = 0;
  for (int node = 0; node < body_.mesh().n_nodes(); ++node) {
    int row[3];
    bool is_free[3], candidate = false;
    for (int j = 0; j < 3; ++j) {
      row[j] = factors_.factor.last_of(3 * node + j);
      is_free[j] = row[j] >= 0;
      candidate = candidate || is_free[j];
    }
    if (!candidate) continue;
    const NodeContact& contact = contacts[static_cast<std::size_t>(node)];
    const MatX basis = left_of(contact, is_free);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (is_free[i] && is_free[j]) S(row[i], row[j]) -= contact.turning(i, j);
    for (Eigen::Index c = 0; c < basis.cols(); ++c, ++columns)
      for (int j = 0; j < 3; ++j)
        if (is_free[j]) Z(row[j], columns) = basis(j, c);
  }
  const auto used = Z.leftCols(columns);
  return signs(used.transpose() * (S * used), supported);
}

Signature TangentSigns::signature(double within) {
  if (factors_.contact_in_tangent()) return signature_with_contact(within);
  const bool touched = !state_.contacts.empty();
  if (state_.options.signs_from_cells && !touched && every_cell_resists(body_, now_.u)) return {};
  using Kind = TangentFactor::Kind;
  if (factors_.factor.kind() != Kind::whole) within = std::min(within, nearly_there);
  factors_.update_of_accepted(within);
  const Kind kind = factors_.factor.kind();
  if (kind == Kind::whole && !touched) return {};
  const std::vector<NodeContact> contacts = node_contacts(state_);
  const bool turning = std::any_of(contacts.begin(), contacts.end(),
                                   [](const NodeContact& c) { return !c.turning.isZero(0); });
  if (kind == Kind::whole && !turning) return {};
  if (kind != Kind::indefinite) {
    if (auto S = factors_.factor.linear().schur())
      return signs_on_candidates(std::move(*S), contacts);
  }
  factors_.update_tangent();
  std::vector<double> K = body_.K();
  add_contacts(contacts, body_.dofs(), body_.pattern(), K);
  return {held_by_volumes(factors_.factor.linear().negative_pivots(K)), 0};
}

// A given volume holds one direction: with C = F^T K^-1 F of the forces F of unit pressure, the
// tangent on the movements that keep the volumes has as many negative eigenvalues as K, less those
// of C.
int TangentSigns::held_by_volumes(int negative) {
  if (negative <= 0 || trial_.pressures.size() == 0) return negative;
  const TangentFactor::Counts needed = factors_.factor.counts();
  const bool solvable = factors_.factorize();
  factors_.factor.uncount(needed);
  factors_.serves = false;
  if (!solvable) return negative;
  const std::vector<VecX> F = border_.volume_gradients();
  const auto m = static_cast<Eigen::Index>(F.size());
  MatX C(m, m);
  for (Eigen::Index j = 0; j < m; ++j) {
    const VecX move = factors_.factor.linear().solve(F[static_cast<std::size_t>(j)]);
    for (Eigen::Index i = 0; i < m; ++i) C(i, j) = F[static_cast<std::size_t>(i)].dot(move);
  }
  const VecX e = symmetric_eigenvalues(0.5 * (C + C.transpose()));
  return negative - static_cast<int>((e.array() < 0).count());
}

std::vector<double> TangentSigns::constrained_tangent() {
  body_.pressures_from(now_.u);
  const VecX direction = border_.imposed_direction(now_.u);
  body_.assemble(now_.u, true, &direction);
  factors_.K_is_current = true;
  std::vector<double> K = body_.K();
  if (state_.contacts.empty()) return K;
  add_contacts(node_contacts(state_), body_.dofs(), body_.pattern(), K);
  return K;
}

std::vector<double> TangentSigns::constrained_tangent(OtherTangent& other) {
  body_.pressures_from(now_.u);
  body_.assemble_under(now_.u, std::span(&other, 1));
  if (state_.contacts.empty()) return other.K;
  add_contacts(node_contacts(state_), other.dofs, other.pattern, other.K);
  return other.K;
}

std::vector<bool> TangentSigns::factorize_under(
    std::span<OtherTangent> others, std::vector<std::unique_ptr<LinearSolver>>& solvers) {
  const std::vector<NodeContact> contacts = node_contacts(state_);
  {
    const Stopwatch watch(state_.cost.assembly);
    // accepted states have no cell that is turned inside out
    body_.assemble_under(now_.u, others);
  }
  const Stopwatch watch(state_.cost.factor);
  std::vector<bool> positive;
  for (std::size_t i = 0; i < others.size(); ++i) {
    OtherTangent& other = others[i];
    if (other.pattern.n == 0) {
      positive.push_back(true);
      continue;
    }
    add_contacts(contacts, other.dofs, other.pattern, other.K);
    if (!solvers[i]) {
      LinearSolver::Order order(
          order_of(body_.dofs(), factors_.factor.linear().order(), other.dofs));
      solvers[i] =
          std::make_unique<LinearSolver>(other.pattern, std::move(order), state_.options.threads);
    }
    positive.push_back(solvers[i]->factorize(other.K));
  }
  return positive;
}

bool TangentSigns::all_positive_under(std::span<OtherTangent> others,
                                      std::vector<std::unique_ptr<LinearSolver>>& solvers) {
  const std::vector<bool> positive = factorize_under(others, solvers);
  return std::find(positive.begin(), positive.end(), false) == positive.end();
}

Signature TangentSigns::signature_under(std::span<OtherTangent> others,
                                        std::vector<std::unique_ptr<LinearSolver>>& solvers) {
  const std::vector<bool> positive = factorize_under(others, solvers);
  const Stopwatch watch(state_.cost.factor);
  Signature sum;
  bool singular = false;
  for (std::size_t i = 0; i < others.size(); ++i) {
    if (positive[i]) continue;
    const int negative = solvers[i]->negative_pivots(others[i].K);
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
