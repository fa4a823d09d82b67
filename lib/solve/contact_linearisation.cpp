#include "solve/contact_linearisation.hpp"

#include <Eigen/Dense>

#include "base/traps.hpp"
#include "contact/supported_problem.hpp"

namespace langer {

namespace {

struct Near {
  std::size_t contact, candidate;
  LinearisedContact law;
  Vec3 r, move;  // local: present reaction, movement without any change of reaction
};

// Far candidates cannot close in this linear step: their gap exceeds what the whole movement could take away. Those with springs
// are all needed, to take the springs out.
std::vector<Near> near_candidates(const ContactState& state, const TangentFactor& factor, const VecX& move) {
  std::vector<Near> near;
  for (std::size_t k = 0; k < state.contacts.size(); ++k) {
    const RigidContact& contact = state.contacts[k];
    const Vec3 c = indenter_displacement(contact, state.t), c0 = indenter_displacement(contact, state.t_start);
    for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
      const int node = contact.nodes[i];
      const Vec3 x = state.X[node] + state.u.segment<3>(3 * node), x0 = state.X[node] + state.u_start[k].segment<3>(3 * node);
      Vec3 d = Vec3::Zero();
      for (int j = 0; j < 3; ++j) {
        const int row = factor.last_of(3 * node + j);
        d[j] = row >= 0 ? move[row] : 0;
      }
      const double reach = (c - c0).norm() + 2 * d.norm() + 0.05;
      if (!factor.with_springs() && state.r[k][i].isZero(0) && shape_at(contact.shape, x - c).gap > reach) continue;
      Near n{k, i, linearise(contact, x, x0, c, c0, state.r[k][i]), {}, {}};
      n.r = n.law.frame.transpose() * state.r[k][i];
      n.move = n.law.frame.transpose() * d;
      near.push_back(n);
    }
  }
  return near;
}

// A force change s on the body moves the near candidates by  d = move + W s  and leaves the reactions  r = present + s - E d.
struct Condensed {
  MatX B, W;                     // of forces on the rows of last(); compliance
  VecX move, present, q, mu;     // q: positions without movement
  std::vector<Mat3> T, E;        // the law feels q + T d; force that follows the movement: turning frame, and springs
  bool follows = false;          // some E is not 0
  MatX slipping(MatX M) const {  // T times the rows of each contact
    for (std::size_t p = 0; p < T.size(); ++p) {
      const auto row = 3 * static_cast<Eigen::Index>(p);
      M.middleRows<3>(row) = (T[p] * M.middleRows<3>(row)).eval();
    }
    return M;
  }
};

Condensed condensed(const ContactState& state, const TangentFactor& factor, const std::vector<Near>& near) {
  const auto m = static_cast<Eigen::Index>(near.size()), n_last = static_cast<Eigen::Index>(factor.last().size());
  Condensed out{MatX::Zero(n_last, 3 * m), {}, VecX(3 * m), VecX(3 * m), VecX(3 * m), VecX(m), {}, {}};
  const auto node_of = [&](const Near& n) { return state.contacts[n.contact].nodes[n.candidate]; };
  std::vector<int> sharing(factor.last().size(), 0);  // candidates of several contacts share a node's springs
  for (Eigen::Index p = 0; p < m; ++p)
    for (int j = 0; j < 3; ++j)
      if (const int row = factor.last_of(3 * node_of(near[p]) + j); row >= 0)
        out.B.row(row).segment<3>(3 * p) = near[p].law.frame.row(j), ++sharing[row];
  for (Eigen::Index p = 0; p < m; ++p) {
    const Near& n = near[p];
    out.move.segment<3>(3 * p) = n.move, out.present.segment<3>(3 * p) = n.r, out.q.segment<3>(3 * p) = n.law.q;
    out.mu[p] = state.contacts[n.contact].mu;
    Mat3 E = n.law.D;
    if (factor.with_springs()) {
      Mat3 springs = Mat3::Zero();
      for (int j = 0; j < 3; ++j)
        if (const int row = factor.last_of(3 * node_of(n) + j); row >= 0) springs(j, j) = factor.gamma() / sharing[row];
      E += n.law.frame.transpose() * springs * n.law.frame;
    }
    out.T.push_back(n.law.T), out.E.push_back(E);
    out.follows = out.follows || !E.isZero(0);
  }
  out.W = factor.linear().compliance(out.B);
  return out;
}

struct Answer {
  VecX s, r;  // local
  int sweeps = 0;
  bool solved = false;
};

void take(const LocalReport& local, Answer& answer) {
  answer.sweeps += local.sweeps;
  answer.solved = local.converged && answer.r.allFinite();
}

Answer solve_fixed(const Condensed& c) {
  Answer answer{{}, c.present};
  take(solve_local({c.slipping(c.W), c.q + c.slipping(c.move - c.W * c.present), c.mu}, answer.r), answer);
  answer.s = answer.r - c.present;
  return answer;
}

Answer solve_following(const Condensed& c) {
  const auto n = c.move.size();
  MatX A = MatX::Identity(n, n);  // r = b + A s
  VecX b = c.present;
  for (std::size_t p = 0; p < c.E.size(); ++p)
    if (const auto row = 3 * static_cast<Eigen::Index>(p); !c.E[p].isZero(0)) {
      A.middleRows<3>(row) -= c.E[p] * c.W.middleRows<3>(row);
      b.segment<3>(row) -= c.E[p] * c.move.segment<3>(row);
    }
  Answer answer{VecX(n), c.present};
  const Eigen::PartialPivLU<MatX> lu(A);
  if (rcond(lu) > 1e-9) {  // s = A^-1 (r - b)
    const MatX W_t = c.W.transpose(), W_r_t = lu.transpose().solve(W_t), W_r = W_r_t.transpose();
    take(solve_local({c.slipping(W_r), c.q + c.slipping(c.move - W_r * b), c.mu}, answer.r), answer);
    if (answer.solved) answer.s = lu.solve(answer.r - b);
  }
  if (answer.solved) return answer;
  answer.s = VecX::Zero(n);  // W_r indefinite, or none: stable only through its contacts
  const LocalReport local = solve_supported({c.slipping(c.W), A, c.q + c.slipping(c.move), b, c.mu}, answer.s);
  answer.r = b + A * answer.s;
  for (std::size_t p = 0; p < c.E.size(); ++p)  // what rounding leaves at an open candidate would be a reaction across a gap
    if (local.status[p] == ContactStatus::open) answer.r.segment<3>(3 * static_cast<Eigen::Index>(p)).setZero();
  take(local, answer);
  return answer;
}

}  // namespace

std::optional<ContactChange> linearised_contact(const ContactState& state, const TangentFactor& factor, const VecX& move) {
  ContactChange change{VecX::Zero(static_cast<Eigen::Index>(factor.last().size())), state.r};
  const std::vector<Near> near = near_candidates(state, factor, move);
  if (near.empty()) return change;
  const Condensed c = condensed(state, factor, near);
  const Answer answer = c.follows ? solve_following(c) : solve_fixed(c);
  if (!answer.s.allFinite() || !answer.r.allFinite()) return std::nullopt;
  change.force = c.B * answer.s;
  change.sweeps = answer.sweeps;
  for (std::size_t p = 0; p < near.size(); ++p)
    change.r[near[p].contact][near[p].candidate] = near[p].law.frame * answer.r.segment<3>(3 * static_cast<Eigen::Index>(p));
  return change;
}

}  // namespace langer
