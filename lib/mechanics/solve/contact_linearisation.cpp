#include "mechanics/solve/contact_linearisation.hpp"

#include <Eigen/Dense>
#include <limits>

#include "core/tensor/dense.hpp"
#include "mechanics/contact/supported_problem.hpp"
#include "mechanics/solve/condensed_contact.hpp"

namespace langer {

namespace {

// Far candidates cannot close in this linear step: their gap exceeds what the whole movement could
// take away. Those with springs are all needed, to take the springs out. travel: of the indenter
// under force control, which may take as much of the gap as well
struct NearCandidates {
  std::vector<Near> of;
  int level = 0;  // the lowest that holds them
};

NearCandidates near_candidates(const ContactState& state, const TangentFactor& factor,
                               const MoveOfNode& move, double travel) {
  NearCandidates near;
  for (std::size_t k = 0; k < state.contacts.size(); ++k) {
    const RigidContact& contact = state.contacts[k];
    const Vec3 c = state.c[k];
    const Vec3 c0 = state.c_start[k];
    double further = 0;
    if (static_cast<int>(k) == state.controlled) further = travel;
    for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
      const int node = contact.nodes[i];
      const Vec3 x = state.X[node] + state.u.segment<3>(3 * node);
      const Vec3 x0 = state.X[node] + state.u_start[k].segment<3>(3 * node);
      const Vec3 d = move(node);
      const double reach = (c - c0).norm() + 2 * d.norm() + 0.05 + further;
      const bool bonded = state.bonds && state.bonds->holds(k, i);
      if (!factor.with_springs() && !bonded && state.r[k][i].isZero(0) &&
          shape_at(contact.shape, x - c).gap > reach)
        continue;
      Near n{k, i, linearise(contact, x, x0, c, c0, state.r[k][i]), {}, {}};
      if (bonded) n.law.D += n.law.frame.transpose() * state.bonds->tangent(k, i) * n.law.frame;
      n.r = n.law.frame.transpose() * state.r[k][i];
      n.move = n.law.frame.transpose() * d;
      near.of.push_back(n);
      near.level = std::max(near.level, factor.levels().of(k, i));
    }
  }
  return near;
}

}  // namespace

Condensed condensed(const ContactState& state, const TangentFactor& factor,
                    const std::vector<Near>& near) {
  const auto m = static_cast<Eigen::Index>(near.size());
  const auto n_last = static_cast<Eigen::Index>(factor.last().size());
  Condensed out{MatX::Zero(n_last, 3 * m),
                {},
                VecX(3 * m),
                VecX(3 * m),
                VecX(3 * m),
                VecX(m),
                {},
                {},
                false,
                {},
                {},
                {}};
  const auto node_of = [&](const Near& n) {
    return state.contacts[n.contact].nodes[n.candidate];
  };
  std::vector<int> sharing(factor.last().size(),
                           0);  // candidates of several contacts share a node's springs
  for (Eigen::Index p = 0; p < m; ++p)
    for (int j = 0; j < 3; ++j)
      if (const int row = factor.last_of(3 * node_of(near[p]) + j); row >= 0)
        out.B.row(row).segment<3>(3 * p) = near[p].law.frame.row(j), ++sharing[row];
  for (Eigen::Index p = 0; p < m; ++p) {
    const Near& n = near[p];
    out.move.segment<3>(3 * p) = n.move, out.present.segment<3>(3 * p) = n.r,
                            out.q.segment<3>(3 * p) = n.law.q;
    out.mu[p] = state.contacts[n.contact].mu;
    Mat3 E = n.law.D;
    if (factor.with_springs()) {
      Mat3 springs = Mat3::Zero();
      for (int j = 0; j < 3; ++j)
        if (const int row = factor.last_of(3 * node_of(n) + j); row >= 0)
          springs(j, j) = factor.gamma() / sharing[row];
      const Mat3 turned = n.law.frame.transpose() * springs * n.law.frame;
      E += turned;
      if (state.controlled >= 0) out.springs.push_back(turned);
    }
    out.T.push_back(n.law.T);
    out.E.push_back(E);
    out.follows = out.follows || !E.isZero(0);
  }
  out.W = factor.linear().compliance(out.B);
  if (state.controlled < 0) return out;
  out.along = VecX::Zero(3 * m);
  if (!state.start_moves.empty()) out.start_moves = VecX::Zero(3 * m);
  for (Eigen::Index p = 0; p < m; ++p) {
    const Near& n = near[p];
    if (static_cast<int>(n.contact) != state.controlled) continue;
    out.along.segment<3>(3 * p) =
        n.law.frame.transpose() * state.contacts[n.contact].control->along;
    if (state.start_moves.empty()) continue;
    out.start_moves.segment<3>(3 * p) = n.law.frame.transpose() * state.start_moves[n.candidate];
    out.start_moves[3 * p] = 0;  // the gap knows no start
  }
  return out;
}

namespace {

struct Answer {
  VecX s, r;  // local
  int sweeps = 0;
  bool solved = false;
};

void take(const LocalReport& local, Answer& answer) {
  answer.sweeps += local.sweeps;
  answer.solved = local.converged && answer.r.allFinite();
}

// The law on the near candidates, for any travel of the indenter under force control.
class Law {
 public:
  explicit Law(const Condensed& c) : c_(c) {
    if (!c.follows) {
      W_r_ = c.W;
      direct_ = true;
    } else {
      A_ = MatX::Identity(c.move.size(), c.move.size());  // r = b + A s
      for (std::size_t p = 0; p < c.E.size(); ++p)
        if (const auto row = 3 * static_cast<Eigen::Index>(p); !c.E[p].isZero(0))
          A_.middleRows<3>(row) -= c.E[p] * c.W.middleRows<3>(row);
      lu_.compute(A_);
      direct_ = lu_.rcond() > 1e-9;  // s = A^-1 (r - b)
      if (direct_) W_r_ = lu_.solve_transposed(c.W.transpose()).transpose();
    }
    if (direct_) slipping_ = c.slipping(W_r_);
  }

  // r: to start from
  Answer at(double travel, const VecX& r) const {
    // of the nodes past the indenter
    VecX move = c_.move;
    if (c_.along.size() > 0) move = VecX(c_.move - travel * c_.along);
    const VecX b = without_change(travel, move);
    VecX q = c_.q;
    if (c_.start_moves.size() > 0) q = VecX(c_.q - travel * c_.start_moves);
    Answer direct{VecX(c_.move.size()), r};
    if (direct_) {
      // W_r may be indefinite, and the law have several solutions: the one next to the present
      // reactions continues the path.
      LocalOptions options;
      options.next_to_start = c_.follows;
      take(solve_local({slipping_, q + c_.slipping(move - W_r_ * b), c_.mu}, direct.r, options),
           direct);
      if (!c_.follows) direct.s = direct.r - c_.present;
      if (direct.solved && c_.follows) direct.s = lu_.solve(direct.r - b);
      if (!c_.follows || (direct.solved && near_present(direct))) return direct;
    }
    // A solution far from the present reactions, or none, as for a body that is stable only through
    // its contacts.
    const Answer next = from_present(q + c_.slipping(move), b);
    if (direct.solved && !(next.solved && 2 * next.s.norm() < direct.s.norm())) return direct;
    return next;
  }

  // What the indenter under force control then bears along its direction [N].
  double force(const Answer& answer) const {
    double sum = c_.along.dot(c_.present + answer.s);
    if (c_.springs.empty()) return sum;
    const VecX moved = c_.move + c_.W * answer.s;
    for (std::size_t p = 0; p < c_.springs.size(); ++p) {
      const auto row = 3 * static_cast<Eigen::Index>(p);
      sum -= c_.along.segment<3>(row).dot(c_.springs[p] * moved.segment<3>(row));
    }
    return sum;
  }

  // Where it just touches, if its candidates bear nothing: the largest travel without a force.
  double touch(const Answer& free) const {
    const VecX moved = c_.q + c_.slipping(c_.move + c_.W * free.s);
    double least = std::numeric_limits<double>::infinity();
    for (Eigen::Index p = 0; p < c_.mu.size(); ++p)
      if (c_.along[3 * p] > 1e-9) least = std::min(least, moved[3 * p] / c_.along[3 * p]);
    return least;
  }

 private:
  // Reactions rarely grow beyond three times the present ones in one correction.
  bool near_present(const Answer& answer) const { return answer.s.norm() <= 3 * c_.present.norm(); }

  // Newton's method for the forces on the supported body, from no change on.
  Answer from_present(const VecX& q, const VecX& b) const {
    Answer answer{VecX::Zero(c_.move.size()), {}};
    const LocalReport local = solve_supported({c_.slipping(c_.W), A_, q, b, c_.mu}, answer.s);
    answer.r = b + A_ * answer.s;
    // what rounding leaves at an open candidate would be a reaction across a gap
    for (std::size_t p = 0; p < c_.E.size(); ++p)
      if (local.status[p] == ContactStatus::open)
        answer.r.segment<3>(3 * static_cast<Eigen::Index>(p)).setZero();
    take(local, answer);
    return answer;
  }

  // reactions without a force change on the body
  VecX without_change(double travel, const VecX& move) const {
    VecX b = c_.present;
    for (std::size_t p = 0; p < c_.E.size() && c_.follows; ++p)
      if (const auto row = 3 * static_cast<Eigen::Index>(p); !c_.E[p].isZero(0))
        b.segment<3>(row) -= c_.E[p] * move.segment<3>(row);
    for (std::size_t p = 0; p < c_.springs.size();
         ++p) {  // springs stand still when the indenter moves
      const auto row = 3 * static_cast<Eigen::Index>(p);
      b.segment<3>(row) -= travel * (c_.springs[p] * c_.along.segment<3>(row));
    }
    return b;
  }

  const Condensed& c_;
  MatX A_, W_r_, slipping_;
  Lu lu_;
  bool direct_ = false;
};

struct Pushed {
  Answer answer;
  double travel = 0;
};

// the candidates of the indenter bear nothing
Answer without_indenter(const Law& law, const Condensed& c) {
  VecX none = c.present;
  for (Eigen::Index i = 0; i < none.size(); i += 3)
    if (!c.along.segment<3>(i).isZero(0)) none.segment<3>(i).setZero();
  return law.at(-1e3 * (1 + c.q.lpNorm<Eigen::Infinity>() + c.move.lpNorm<Eigen::Infinity>()),
                none);
}

// The travel at which the indenter bears the given force: the root of a function that does not
// fall, and is linear while no contact changes. Secants within the bounds known so far; the cone
// law holds exactly at each.
Pushed pushed_by(const Law& law, const Condensed& c, double force) {
  constexpr double exact = 1e-12, enough = 1e-9, infinite = std::numeric_limits<double>::infinity();
  double low = -infinite;
  double high = infinite;
  struct Point {
    double travel, miss;
  };
  std::optional<Point> last;
  Pushed best{{{}, c.present}, 0};
  double least = infinite;
  double next = 0;
  int sweeps = 0;
  if (force == 0 || c.along.dot(c.present) == 0) {  // from the touch on
    best.answer = without_indenter(law, c);
    low = best.travel = law.touch(best.answer);
    if (force == 0 || !best.answer.solved || !std::isfinite(low)) return best;
    sweeps = best.answer.sweeps;
    last = {low, -force};
    next = low + 1e-3;
  }
  for (int i = 0; i < 100 && least > exact * force; ++i) {
    Answer answer = law.at(next, best.answer.r);
    sweeps += answer.sweeps;
    if (!answer.solved) {  // too far
      if (next > 0) {
        high = next;
      } else {
        low = next;
      }
      next *= 0.5;
      continue;
    }
    const Point here{next, law.force(answer) - force};
    if (std::abs(here.miss) < least) {
      least = std::abs(here.miss);
      best = {std::move(answer), next};
    }
    (here.miss < 0 ? low : high) = next;
    double slope = 0;
    if (last) slope = (here.miss - last->miss) / (here.travel - last->travel);
    double furthest = 0;
    if (last) {
      furthest = 100 * std::abs(here.travel - last->travel);
    } else {
      furthest = 1e-3;
    }
    double step = furthest;
    if (slope > 0) step = std::abs(here.miss) / slope;
    if (here.miss < 0) {
      next += std::min(step, furthest);
    } else {
      next += -std::min(step, furthest);
    }
    if (std::isfinite(low) && std::isfinite(high) && (!(next > low && next < high) || i % 8 == 7))
      next = 0.5 * (low + high);
    if (std::isfinite(low) && high - low <= 1e-16 * (1 + std::abs(low))) break;
    last = here;
  }
  best.answer.sweeps = sweeps;
  best.answer.solved = least <= enough * force;
  return best;
}

// The travel at which the contact bears what the inertia of the indenter gives: force - falls *
// travel. The difference of the two grows with the travel, so there is one root, in contact or not.
Pushed carried_by_inertia(const Law& law, const Condensed& c, double force, double falls) {
  constexpr double exact = 1e-13, infinite = std::numeric_limits<double>::infinity();
  Pushed best{{{}, c.present}, 0};
  double least = infinite;
  double low = -infinite;
  double high = infinite;
  double next = 0;
  double last_travel = 0;
  double last_excess = 0;
  int sweeps = 0;
  bool has_last = false;
  for (int i = 0; i < 200; ++i) {
    Answer answer = law.at(next, best.answer.r);
    sweeps += answer.sweeps;
    if (!answer.solved) {
      if (next == 0) break;
      (next > 0 ? high : low) = next;
      next *= 0.5;
      continue;
    }
    const double borne = law.force(answer);
    const double excess = borne - force + falls * next;
    const double scale = std::abs(borne) + std::abs(force) + falls * std::abs(next);
    if (std::abs(excess) < least) {
      least = std::abs(excess);
      best = {std::move(answer), next};
    }
    if (std::abs(excess) <= exact * scale) break;
    (excess < 0 ? low : high) = next;
    // Without a second point the slope is that of the inertia alone: contact only adds to it.
    double slope = falls;
    if (has_last && next != last_travel) {
      slope = std::max(falls, (excess - last_excess) / (next - last_travel));
    }
    last_travel = next;
    last_excess = excess;
    has_last = true;
    next -= excess / slope;
    const bool bracketed = std::isfinite(low) && std::isfinite(high);
    if (bracketed && (!(next > low && next < high) || i % 6 == 5)) next = 0.5 * (low + high);
    if (bracketed && high - low <= 1e-16 * (1 + std::abs(low))) break;
  }
  best.answer.sweeps = sweeps;
  best.answer.solved = std::isfinite(least);
  return best;
}

}  // namespace

std::optional<ContactChange> linearised_contact(const ContactState& state,
                                                const TangentFactor& factor,
                                                const MoveOfNode& move) {
  ContactChange change{VecX::Zero(static_cast<Eigen::Index>(factor.last().size())), state.r};
  for (double travel = 0.1;; travel = 2 * change.travel) {
    const NearCandidates found_near = near_candidates(state, factor, move, travel);
    if (found_near.level > factor.level()) {
      change.level = found_near.level;
      return change;
    }
    const std::vector<Near>& near = found_near.of;
    if (near.empty() && state.controlled < 0) return change;
    if (near.empty() && state.force_falls > 0) {
      change.travel = state.force / state.force_falls;
      if (std::abs(change.travel) > travel) continue;
      return change;
    }
    if (near.empty()) return std::nullopt;
    const Condensed c = condensed(state, factor, near);
    const Law law(c);
    Pushed found;
    if (state.controlled < 0) {
      found = {law.at(0, c.present), 0};
    } else if (state.force_falls > 0) {
      found = carried_by_inertia(law, c, state.force, state.force_falls);
    } else {
      found = pushed_by(law, c, state.force);
    }
    const Answer& answer = found.answer;
    if (!answer.s.allFinite() || !answer.r.allFinite()) return std::nullopt;
    if (state.controlled >= 0 && !answer.solved) return std::nullopt;
    change.travel = found.travel;
    if (change.travel > travel) continue;  // more candidates may close
    change.force = c.B * answer.s;
    change.sweeps += answer.sweeps;
    for (std::size_t p = 0; p < near.size(); ++p)
      change.r[near[p].contact][near[p].candidate] =
          near[p].law.frame * answer.r.segment<3>(3 * static_cast<Eigen::Index>(p));
    return change;
  }
}

}  // namespace langer
