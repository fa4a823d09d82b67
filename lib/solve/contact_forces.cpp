// The linearised contact law on the compliance of the body: the reactions after the next movement.
#include <Eigen/Dense>

#include "base/stopwatch.hpp"
#include "contact/supported_problem.hpp"
#include "solve/statics.hpp"

namespace langer {

// Change of the contact forces on the rows of last_ that makes the linearised law hold; r_next_ gets the reactions.
std::optional<VecX> Statics::contact_forces(const VecX& last_move) {
  const Stopwatch watch(cost_.contact);
  const std::vector<Vec3>& X = equilibrium_.mesh().X;
  struct Near {
    std::size_t contact, candidate;
    LinearisedContact law;
    Vec3 r, move;  // local: present reaction, movement without any change of reaction
  };
  std::vector<Near> near;
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const RigidContact& contact = contacts_[k];
    const Vec3 c = indenter_displacement(contact, t_), c0 = indenter_displacement(contact, now_.t);
    for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
      const int node = contact.nodes[i];
      const Vec3 x = X[node] + u_.segment<3>(3 * node), x0 = X[node] + u_start_.segment<3>(3 * node);
      Vec3 d = Vec3::Zero();
      for (int j = 0; j < 3; ++j) {
        const int row = last_of_[3 * node + j];
        d[j] = row >= 0 ? last_move[row] : 0;
      }
      // far candidates cannot close in this linear step: their gap exceeds what the whole movement could take away;
      // those with springs are all needed, to take the springs out
      const double reach = (c - c0).norm() + 2 * d.norm() + 0.05;
      if (!supported_ && r_[k][i].isZero(0) && shape_at(contact.shape, x - c).gap > reach) continue;
      Near n{k, i, linearise(contact, x, x0, c, c0, r_[k][i]), {}, {}};
      n.r = n.law.frame.transpose() * r_[k][i];
      n.move = n.law.frame.transpose() * d;
      near.push_back(n);
    }
  }
  VecX force = VecX::Zero(last_.size());
  r_next_ = r_;
  if (near.empty()) return force;
  const int m = static_cast<int>(near.size());
  MatX B = MatX::Zero(last_.size(), 3 * m);
  VecX move(3 * m), present(3 * m), q(3 * m), mu(m);
  std::vector<Mat3> E(m);  // force that follows the movement: turning frame, and springs
  bool follows = false;
  std::vector<int> sharing(last_.size(), 0);  // candidates of several contacts share a node's springs
  for (int p = 0; p < m; ++p) {
    const int node = contacts_[near[p].contact].nodes[near[p].candidate];
    for (int j = 0; j < 3; ++j)
      if (const int row = last_of_[3 * node + j]; row >= 0) B.row(row).segment<3>(3 * p) = near[p].law.frame.row(j), ++sharing[row];
  }
  for (int p = 0; p < m; ++p) {
    const Near& n = near[p];
    const int node = contacts_[n.contact].nodes[n.candidate];
    move.segment<3>(3 * p) = n.move, present.segment<3>(3 * p) = n.r, q.segment<3>(3 * p) = n.law.q;
    mu[p] = contacts_[n.contact].mu;
    E[p] = n.law.D;
    if (supported_) {
      Mat3 springs = Mat3::Zero();
      for (int j = 0; j < 3; ++j)
        if (const int row = last_of_[3 * node + j]; row >= 0) springs(j, j) = gamma_ / sharing[row];
      E[p] += n.law.frame.transpose() * springs * n.law.frame;
    }
    follows = follows || !E[p].isZero(0);
  }
  // force change s on the body, movement d:  d = move + W s,  reaction r = present + s - E d = b + A s
  MatX W = linear_->compliance(B);
  VecX b = present, s(3 * m);
  MatX A;
  bool solved = false;
  if (follows) {
    A = MatX::Identity(3 * m, 3 * m);
    for (int p = 0; p < m; ++p)
      if (!E[p].isZero(0)) {
        A.middleRows<3>(3 * p) -= E[p] * W.middleRows<3>(3 * p);
        b.segment<3>(3 * p) -= E[p] * move.segment<3>(3 * p);
      }
  }
  VecX r = present;
  const auto slipping = [&](MatX M) {  // rows of each contact times its T: the law feels x = q + T d
    for (int p = 0; p < m; ++p) M.middleRows<3>(3 * p) = (near[p].law.T * M.middleRows<3>(3 * p)).eval();
    return M;
  };
  const auto take = [&](const LocalReport& local) {
    cost_.sweeps += local.sweeps;
    solved = local.converged && r.allFinite();
  };
  if (!follows) {
    take(solve_local({slipping(W), q + slipping(move - W * present), mu}, r));
    s = r - present;
  } else {
    const Eigen::PartialPivLU<MatX> lu(A);
    if (lu.rcond() > 1e-9) {  // s = A^-1 (r - b)
      const MatX W_t = W.transpose(), W_r_t = lu.transpose().solve(W_t), W_r = W_r_t.transpose();
      take(solve_local({slipping(W_r), q + slipping(move - W_r * b), mu}, r));
      if (solved) s = lu.solve(r - b);
    }
  }
  if (!solved && follows) {  // W_r indefinite, or none: stable only through its contacts
    s = VecX::Zero(3 * m);
    const LocalReport local = solve_supported({slipping(W), A, q + slipping(move), b, mu}, s);
    r = b + A * s;
    for (int p = 0; p < m; ++p)  // what rounding leaves at an open candidate would be a reaction across a gap
      if (local.status[p] == ContactStatus::open) r.segment<3>(3 * p).setZero();
    take(local);
  }
  if (!s.allFinite() || !r.allFinite()) return std::nullopt;
  force = B * s;
  for (int p = 0; p < m; ++p)  // in the frame at u; turned in moved()
    r_next_[near[p].contact][near[p].candidate] = near[p].law.frame * r.segment<3>(3 * p);
  return force;
}

}  // namespace langer
