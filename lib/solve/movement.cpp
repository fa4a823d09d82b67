// The body's answer to a small disturbance of an accepted state, in which every contact keeps its status: one solve with a factor of that
// state and a dense one of the closed contacts.
#include <Eigen/Dense>

#include "base/traps.hpp"
#include "solve/statics.hpp"

namespace langer {

namespace {

// What the law says of a node that is disturbed, d its movement and psi the change of its reaction:  D d + P psi = given
struct NodeLaw {
  int node = 0;
  int contact = -1, candidate = -1;  // -1: a node with springs alone
  Mat3 D = Mat3::Zero(), P = Mat3::Identity();
  Vec3 given = Vec3::Zero();
};

// One row for each direction: fixed, held by the contact, or free to glide.
void close(NodeLaw& law, const RigidContact& contact, const Vec3& x, const Vec3& r, bool sticks, const Vec3& moved,
           const std::array<bool, 3>& is_free) {
  const ShapePoint shape = shape_at(contact.shape, x);
  const Vec3 n = shape.normal;
  const double r_n = r.dot(n);
  const Vec3 r_t = r - r_n * n;
  const Mat3 frame = contact_frame(n);
  Mat3 known = Mat3::Zero();  // orthonormal directions that have their row already
  int rows = 0;
  law.D.setZero(), law.P.setZero(), law.given.setZero();
  const auto beside_known = [&](const Vec3& v) { return Vec3(v - known.leftCols(rows) * (known.leftCols(rows).transpose() * v)); };
  for (int j = 0; j < 3; ++j)
    if (!is_free[static_cast<std::size_t>(j)]) law.P.row(rows) = Vec3::Unit(j).transpose(), known.col(rows++) = Vec3::Unit(j);
  constexpr double none = 1e-6;
  for (int j = 0; j < (sticks ? 3 : 1) && rows < 3; ++j) {
    const Vec3 left = beside_known(frame.col(j));
    if (left.norm() < none) continue;
    law.D.row(rows) = frame.col(j).transpose(), law.given[rows] = frame.col(j).dot(moved);
    known.col(rows++) = left.normalized();
  }
  for (int j = 0; j < 3 && rows < 3; ++j) {  // a reaction turns with the normal, and friction follows the pressure
    const Vec3 left = beside_known(frame.col(j));
    if (left.norm() < none) continue;
    const Vec3 q = left.normalized();
    law.P.row(rows) = (q - (contact.mu > 0 && r_n > 0 ? q.dot(r_t) / r_n : 0) * n).transpose();
    law.D.row(rows) = -r_n * q.transpose() * shape.curvature;
    law.given[rows] = law.D.row(rows).dot(moved);
    known.col(rows++) = q;
  }
}

// Of the closed candidates, or where springs hold them of all; nothing where a node is closed in two contacts.
std::optional<std::vector<NodeLaw>> laws_of(const Statics& statics, const Equilibrium& body, const std::vector<Vec3>& indenters,
                                            bool springs) {
  std::vector<NodeLaw> laws;
  std::vector<int> law_of(static_cast<std::size_t>(body.mesh().n_nodes()), -1);
  const BodyState& state = statics.accepted();
  const auto defects = statics.defects();
  for (std::size_t k = 0; k < defects.size(); ++k) {
    const RigidContact& contact = statics.contacts()[k];
    const Vec3 c = indenter_displacement(contact, state.t, state.travel);
    for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
      const int node = contact.nodes[i];
      const bool closed = defects[k].status[i] != ContactStatus::open;
      if (!closed && (!springs || law_of[node] >= 0)) continue;
      std::array<bool, 3> is_free{};
      for (int j = 0; j < 3; ++j) is_free[static_cast<std::size_t>(j)] = body.dofs().equation[3 * node + j] >= 0;
      if (is_free == std::array<bool, 3>{}) continue;
      if (law_of[node] < 0) law_of[node] = static_cast<int>(laws.size()), laws.push_back({node});
      NodeLaw& law = laws[static_cast<std::size_t>(law_of[node])];
      if (!closed) continue;
      if (law.contact >= 0) return std::nullopt;
      law.contact = static_cast<int>(k), law.candidate = static_cast<int>(i);
      close(law, contact, body.mesh().X[node] + state.u.segment<3>(3 * node) - c, state.r[k][i],
            defects[k].status[i] == ContactStatus::stick, indenters.empty() ? Vec3(Vec3::Zero()) : indenters[k], is_free);
    }
  }
  return laws;
}

// Forces on the body on the rows of last(), those that take springs out among them, and the change of reactions; nothing where the laws
// do not decide them. moved: of the rows of last() without any; prescribed: of the other dofs
std::optional<VecX> contact_forces(const std::vector<NodeLaw>& laws, const TangentFactor& factor, const VecX& moved,
                                   const VecX& prescribed, Reactions& r) {
  const auto m = static_cast<Eigen::Index>(laws.size());
  const double gamma = factor.with_springs() ? factor.gamma() : 0;
  MatX B = MatX::Zero(moved.size(), 3 * m);
  VecX d0(3 * m);
  for (Eigen::Index p = 0; p < m; ++p)
    for (int j = 0; j < 3; ++j) {
      const int dof = 3 * laws[static_cast<std::size_t>(p)].node + j, row = factor.last_of(dof);
      if (row >= 0) B(row, 3 * p + j) = 1;
      d0[3 * p + j] = row >= 0 ? moved[row] : prescribed[dof];
    }
  if (m == 0) return VecX(VecX::Zero(moved.size()));
  const MatX W = factor.linear().compliance(B);
  MatX A(3 * m, 3 * m);
  VecX b(3 * m);
  for (Eigen::Index p = 0; p < m; ++p) {
    const NodeLaw& law = laws[static_cast<std::size_t>(p)];
    const Mat3 on_d = law.D - gamma * law.P;  // forces on the body are psi + gamma d
    A.middleRows<3>(3 * p) = on_d * W.middleRows<3>(3 * p);
    A.block<3, 3>(3 * p, 3 * p) += law.P;
    b.segment<3>(3 * p) = law.given - on_d * d0.segment<3>(3 * p);
  }
  const Eigen::PartialPivLU<MatX> lu(A);
  if (!(rcond(lu) > 1e-15)) return std::nullopt;
  const VecX forces = lu.solve(b), d = d0 + W * forces;
  for (Eigen::Index p = 0; p < m; ++p)
    if (const NodeLaw& law = laws[static_cast<std::size_t>(p)]; law.contact >= 0)
      r[static_cast<std::size_t>(law.contact)][static_cast<std::size_t>(law.candidate)] =
          forces.segment<3>(3 * p) - gamma * d.segment<3>(3 * p);
  return VecX(B * forces);
}

}  // namespace

std::optional<Movement> Statics::movement(const Disturbance& by) {
  if (!bonds_.none()) return std::nullopt;  // their tangent is not in the factor
  const Dofs& dofs = equilibrium_.dofs();
  std::optional<TangentFactor> own;  // where contact stands in the tangent, which has no compliance of the candidates
  if (contact_in_tangent()) {
    own.emplace(equilibrium_, contacts_, options_.threads, ContactBy::compliance);
    need_tangent();
    if (!own->factorize(equilibrium_)) return std::nullopt;
  } else {
    need_factor_of_accepted(1e-9);  // with the factor of another state the volume of cells would change, against kappa
  }
  TangentFactor& factor = own ? *own : factor_;
  VecX f = by.force.size() > 0 ? on_free_rows(by.force) : VecX(VecX::Zero(dofs.n_free()));
  Movement out{VecX::Zero(dofs.n), {}};
  for (const RigidContact& contact : contacts_) out.r.emplace_back(contact.nodes.size(), Vec3::Zero());
  if (by.prescribed.size() > 0) {
    equilibrium_.assemble(u_, true, &by.prescribed);
    f -= on_free_rows(equilibrium_.K_du()), out.u = by.prescribed;
  }
  LinearSolver& linear = factor.linear();
  VecX move;
  if (contacts_.empty()) {
    move = linear.solve(f);
  } else {
    const LinearSolver::Half half = linear.start(f);
    const auto laws = laws_of(*this, equilibrium_, by.indenters, factor.with_springs());
    const auto forces = laws ? contact_forces(*laws, factor, half.last, out.u, out.r) : std::nullopt;
    if (!forces) return std::nullopt;
    for (std::size_t i = 0; i < factor.last().size(); ++i) f[factor.last()[i]] += (*forces)[static_cast<Eigen::Index>(i)];
    move = factor.kind() == TangentFactor::Kind::whole ? linear.finish(half, *forces) : linear.solve(f);
  }
  if (!move.allFinite()) return std::nullopt;
  for (int row = 0; row < dofs.n_free(); ++row) out.u[dofs.free[row]] = move[row];
  return out;
}

}  // namespace langer
