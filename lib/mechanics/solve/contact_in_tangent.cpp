#include "mechanics/solve/contact_in_tangent.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <set>

#include "core/tensor/dense.hpp"
#include "mechanics/linear/krylov.hpp"

namespace langer {

namespace {

constexpr int left_to_gmres = 4;  // candidates that do something else than in the factor
// Answers in a row of which none lets fewer candidates change than those before. A new
// linearisation of the body helps more then.
constexpr int goes_in_circles = 3;

}  // namespace

bool ContactInTangent::serves(const std::vector<RigidContact>& contacts) {
  std::set<int> nodes;
  for (const RigidContact& contact : contacts) {
    if (contact.control || contact.adhesion) return false;
    for (int node : contact.nodes)
      if (!nodes.insert(node).second) return false;
  }
  return true;
}

ContactInTangent::ContactInTangent(const Assembler& body, const std::vector<RigidContact>& contacts,
                                   double stiffness)
    : pattern_(body.pattern()), rho_(stiffness > 0 ? stiffness : 1) {
  const Dofs& dofs = body.dofs();
  begins_.assign(static_cast<std::size_t>(pattern_.n), -1);
  for (std::size_t k = 0; k < contacts.size(); ++k)
    for (std::size_t i = 0; i < contacts[k].nodes.size(); ++i) {
      Candidate c;
      c.contact = static_cast<int>(k);
      c.candidate = static_cast<int>(i);
      c.node = contacts[k].nodes[i];
      c.mu = contacts[k].mu;
      for (int axis = 0; axis < 3; ++axis)
        if (const int row = dofs.equation[3 * c.node + axis]; row >= 0) {
          if (c.n == 0) c.first = row;
          c.axis[c.n++] = axis;
        }
      if (c.n == 0) continue;  // nothing moves it
      begins_[c.first] = static_cast<int>(candidates_.size());
      candidates_.push_back(c);
    }
  for (int column = 0; column < pattern_.n; ++column)
    for (int at = pattern_.column_start[column]; at < pattern_.column_start[column + 1]; ++at)
      if (const int row = pattern_.row[at]; row > column && begins_[row] >= 0)
        row_blocks_.push_back({at, begins_[row]});
}

// Q and G. Where some of its directions are held, n has to do with what is left of it in the
// others.
void ContactInTangent::own_axes(Candidate& c) const {
  Eigen::Matrix<double, 3, 3> in_free = Mat3::Zero();  // (n, 3): rows of the frame that are free
  for (int i = 0; i < c.n; ++i) in_free.row(i) = c.frame.row(c.axis[i]);
  c.Q.setIdentity();
  if (c.n == 3) {
    c.Q = c.frame;
  } else {
    const double size = in_free.col(0).norm();
    if (size > 1e-9) c.Q.col(0) = in_free.col(0) / size;
    if (c.n == 2) c.Q.col(1) = Vec3(-c.Q(1, 0), c.Q(0, 0), 0);
  }
  c.G.setZero();
  c.G.leftCols(c.n) = in_free.topRows(c.n).transpose() * c.Q.topLeftCorner(c.n, c.n);
  for (int m = 1; m < c.n; ++m) c.G(0, m) = 0;  // but for rounding
}

void ContactInTangent::linearise_at(const ContactState& state, bool with_frames) {
  for (Candidate& c : candidates_) {
    const auto k = static_cast<std::size_t>(c.contact);
    const Vec3 r = state.r[k][static_cast<std::size_t>(c.candidate)];
    const Vec3 x = state.X[c.node] + state.u.segment<3>(3 * c.node);
    const Vec3 x0 = state.X[c.node] + state.u_start[k].segment<3>(3 * c.node);
    const LinearisedContact law =
        linearise(state.contacts[k], x, x0, state.c[k], state.c_start[k], r);
    c.frame = law.frame;
    c.q = law.q;
    c.present = law.frame.transpose() * r;
    if (!with_frames) continue;
    c.T = law.T;
    c.D = law.D;
    own_axes(c);
  }
}

// A candidate that cannot move along its normal stays open.
void ContactInTangent::judge(Candidate& c, const Vec3& r, const Vec3& x) const {
  c.law = c.G(0, 0) < 1e-6 ? LawStatus{} : law_status(r, x, c.mu, rho_);
}

void ContactInTangent::turn_own_columns(const Candidate& c, std::vector<double>& values) const {
  const auto Q = c.Q.topLeftCorner(c.n, c.n);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3> own(c.n, c.n);
  const int* start = pattern_.column_start.data() + c.first;
  for (int j = 0; j < c.n; ++j)
    for (int i = j; i < c.n; ++i) own(i, j) = own(j, i) = values[start[j] + i - j];
  own = (Q.transpose() * own * Q).eval();
  for (int j = 0; j < c.n; ++j)
    for (int i = j; i < c.n; ++i) values[start[j] + i - j] = own(i, j);
  const int below = start[1] - start[0] - c.n;
  for (int l = 0; l < below; ++l) {
    double v[3] = {0, 0, 0};
    for (int j = 0; j < c.n; ++j) v[j] = values[start[j] + c.n - j + l];
    for (int m = 0; m < c.n; ++m) {
      double sum = 0;
      for (int j = 0; j < c.n; ++j) sum += v[j] * Q(j, m);
      values[start[m] + c.n - m + l] = sum;
    }
  }
}

// Q^T K Q
void ContactInTangent::turn(std::vector<double>& values) const {
  for (const RowBlock& block : row_blocks_) {
    const Candidate& c = candidates_[static_cast<std::size_t>(block.candidate)];
    double v[3] = {0, 0, 0};
    for (int i = 0; i < c.n; ++i) v[i] = values[block.position + i];
    for (int m = 0; m < c.n; ++m) {
      double sum = 0;
      for (int i = 0; i < c.n; ++i) sum += c.Q(i, m) * v[i];
      values[block.position + m] = sum;
    }
  }
  for (const Candidate& c : candidates_) turn_own_columns(c, values);
}

VecX ContactInTangent::turned(const VecX& free, bool back) const {
  VecX out = free;
  for (const Candidate& c : candidates_) {
    const auto Q = c.Q.topLeftCorner(c.n, c.n);
    if (back)
      out.segment(c.first, c.n) = Q * free.segment(c.first, c.n);
    else
      out.segment(c.first, c.n) = Q.transpose() * free.segment(c.first, c.n);
  }
  return out;
}

// The movements that the law knows already, 0 elsewhere.
VecX ContactInTangent::given(std::vector<char>& is_given) const {
  VecX y = VecX::Zero(pattern_.n);
  is_given.assign(static_cast<std::size_t>(pattern_.n), 0);
  for (const Candidate& c : candidates_) {
    if (c.law.status == ContactStatus::open) continue;
    y[c.first] = -c.q[0] / c.G(0, 0);
    is_given[c.first] = 1;
    if (c.law.status != ContactStatus::stick || c.n == 1) continue;
    const MatX S = c.T.bottomRightCorner<2, 2>() * c.G.block(1, 1, 2, c.n - 1);
    const Eigen::Vector2d left =
        c.q.tail<2>() + c.T.bottomRightCorner<2, 2>() * (c.G.block<2, 1>(1, 0) * y[c.first]);
    y.segment(c.first + 1, c.n - 1) = -PivotedQr(S).solve(left);
    for (int m = 1; m < c.n; ++m) is_given[c.first + m] = 1;
  }
  return y;
}

// symmetric part of the system in the own axes, given movements taken out; with_contact: of several
// ranks one adds it
std::vector<double> ContactInTangent::matrix(bool with_friction, bool with_contact) const {
  std::vector<double> values = K_;
  for (const Candidate& c : candidates_) {
    if (!with_contact || c.law.status != ContactStatus::slip || c.n == 1) continue;
    Mat3 follows = -c.D;
    if (with_friction && c.friction())
      follows.bottomRightCorner<2, 2>() +=
          c.law.k * across_direction(c.law.e) * c.T.bottomRightCorner<2, 2>();
    const Mat3 own = c.G.transpose() * (0.5 * (follows + follows.transpose())) * c.G;
    for (int j = 1; j < c.n; ++j)
      for (int i = j; i < c.n; ++i) values[pattern_.column_start[c.first + j] + i - j] += own(i, j);
  }
  std::vector<char> is_given;
  given(is_given);
  for (int column = 0; column < pattern_.n; ++column)
    for (int at = pattern_.column_start[column]; at < pattern_.column_start[column + 1]; ++at)
      if (is_given[column] || is_given[pattern_.row[at]]) {
        if (pattern_.row[at] == column) {
          values[at] = std::max(std::abs(values[at]), 1e-12);
        } else {
          values[at] = 0;
        }
      }
  return values;
}

VecX ContactInTangent::times(const VecX& y) const {
  VecX out = VecX::Zero(y.size());
  for (int column = 0; column < pattern_.n; ++column) {
    int at = pattern_.column_start[column];
    double sum = K_[at] * y[column];
    for (++at; at < pattern_.column_start[column + 1]; ++at) {
      const int row = pattern_.row[at];
      out[row] += K_[at] * y[column];
      sum += K_[at] * y[row];
    }
    out[column] += sum;
  }
  return out;
}

// s: of its reaction, where the body moves by y; constants 0: the part that is linear in y
Vec3 ContactInTangent::change_of(const Candidate& c, const VecX& y, const VecX& Ky,
                                 double constants) const {
  if (c.law.status == ContactStatus::open) return -constants * c.present;
  const auto own = y.segment(c.first, c.n);
  const Vec3 moved = c.G.leftCols(c.n) * own;
  const Vec3 follows = c.D * moved;
  const VecX left = Ky.segment(c.first, c.n) - constants * rhs_.segment(c.first, c.n);
  if (c.law.status == ContactStatus::stick) return c.G.leftCols(c.n) * left - follows;
  Vec3 s = Vec3::Zero();
  Vec3 by_normal(1, 0, 0);
  s.tail<2>() = -constants * c.present.tail<2>();
  if (c.friction()) {
    const Eigen::Vector2d x_t =
        constants * c.q.tail<2>() + c.T.bottomRightCorner<2, 2>() * moved.tail<2>();
    s.tail<2>() +=
        constants * c.mu * c.present[0] * c.law.e - c.law.k * across_direction(c.law.e) * x_t;
    by_normal.tail<2>() = c.mu * c.law.e;
  }
  const Vec3 n = c.G.col(0);
  return s + by_normal * ((left[0] - n.dot(s + follows)) / n.dot(by_normal));
}

// what is missing to balance on the rows whose movement is not given
VecX ContactInTangent::missing(const VecX& y, const VecX& Ky, double constants,
                               const std::vector<char>& is_given) const {
  VecX out = constants * rhs_ - Ky;
  for (const Candidate& c : candidates_) {
    if (c.law.status == ContactStatus::stick) continue;
    Vec3 force = change_of(c, y, Ky, constants);
    if (c.law.status == ContactStatus::slip)
      force += c.D * (c.G.leftCols(c.n) * y.segment(c.first, c.n));
    out.segment(c.first, c.n) += c.G.leftCols(c.n).transpose() * force;
  }
  for (Eigen::Index row = 0; row < out.size(); ++row)
    if (is_given[static_cast<std::size_t>(row)]) out[row] = 0;
  return out;
}

// exact: the factor is that of this system
std::optional<ContactInTangent::Solved> ContactInTangent::solution(const LinearSolver& linear,
                                                                   bool exact,
                                                                   int& solutions) const {
  std::vector<char> is_given;
  Solved at{given(is_given), {}};
  at.Ky = times(at.y);
  const VecX b = missing(at.y, at.Ky, 1, is_given);
  const auto by_factor = [&](const VecX& v) {
    ++solutions;
    return linear.solve(v);
  };
  VecX z;
  if (exact) {
    z = by_factor(b);
  } else {
    const auto system = [&](const VecX& v) {
      VecX own = v;
      for (Eigen::Index row = 0; row < own.size(); ++row)
        if (is_given[static_cast<std::size_t>(row)]) own[row] = 0;
      VecX out = -missing(own, times(own), 0, is_given);
      for (Eigen::Index row = 0; row < own.size(); ++row)
        if (is_given[static_cast<std::size_t>(row)])
          out[row] = K_[pattern_.column_start[row]] * v[row];
      return out;
    };
    constexpr double accurate = 1e-10, enough = 1e-5;
    z = solve_near_identity([&](const VecX& v) { return by_factor(system(v)); }, by_factor(b),
                            accurate, 40);
    if (!((b - system(z)).norm() <= enough * b.norm())) return std::nullopt;
  }
  if (!z.allFinite()) return std::nullopt;
  for (Eigen::Index row = 0; row < z.size(); ++row)
    if (!is_given[static_cast<std::size_t>(row)]) at.y[row] += z[row];
  at.Ky = times(at.y);
  return at;
}

ContactInTangent::Answer ContactInTangent::answer_of(const Solved& solved,
                                                     const ContactState& state) const {
  Answer out{turned(solved.y, true), state.r};
  for (auto& of_contact : out.r)
    std::fill(of_contact.begin(), of_contact.end(), Vec3(Vec3::Zero()));
  for (const Candidate& c : candidates_) {
    if (c.law.status == ContactStatus::open) continue;
    Vec3 r = c.present + change_of(c, solved.y, solved.Ky, 1);
    if (!(r[0] > 0)) continue;
    put_on_cone(r, c.mu, c.friction());
    out.r[static_cast<std::size_t>(c.contact)][static_cast<std::size_t>(c.candidate)] = c.frame * r;
  }
  return out;
}

std::optional<ContactInTangent::Answer> ContactInTangent::solve(const ContactState& state,
                                                                const std::vector<double>& K,
                                                                const VecX& rhs,
                                                                const LinearSolver& linear,
                                                                const Factorize& factorize) {
  linearise_at(state, true);
  K_ = K;
  turn(K_);
  rhs_ = turned(rhs, false);
  for (Candidate& c : candidates_) judge(c, c.present, c.q);
  std::optional<Answer> answer;
  int solutions = 0;
  bool factored = false;
  bool settled = false;
  int fewest = static_cast<int>(candidates_.size()) + 1;
  int since_fewest = 0;
  for (int step = 0; step < 20; ++step) {
    const auto differ =
        std::count_if(candidates_.begin(), candidates_.end(),
                      [](const Candidate& c) { return c.law.status != c.factored; });
    const bool anew = !factored || differ > left_to_gmres;
    if (anew) {
      if (!factorize(matrix(true))) return std::nullopt;
      factored = true;
      friction_in_factor_ = false;
      for (Candidate& c : candidates_) {
        c.factored = c.law.status;
        friction_in_factor_ = friction_in_factor_ || c.friction();
      }
    }
    const bool friction = std::any_of(candidates_.begin(), candidates_.end(),
                                      [](const Candidate& c) { return c.friction(); });
    const auto solved = solution(linear, !friction && (anew || differ == 0), solutions);
    if (!solved && anew) return std::nullopt;
    if (!solved) {
      factored = false;  // another factor
      continue;
    }
    answer = answer_of(*solved, state);
    const int changed = changes(*solved);
    settled = changed == 0;
    since_fewest = changed < fewest ? 0 : since_fewest + 1;
    fewest = std::min(fewest, changed);
    if (settled || since_fewest == goes_in_circles) break;
  }
  if (!answer) return std::nullopt;
  answer->solutions = solutions;
  answer->settled = settled;
  return answer;
}

// Judges all candidates anew; how many of them do something else now.
int ContactInTangent::changes(const Solved& solved) {
  int some = 0;
  for (Candidate& c : candidates_) {
    const ContactStatus before = c.law.status;
    const Vec3 r = c.present + change_of(c, solved.y, solved.Ky, 1);
    const Vec3 x = c.q + c.T * (c.G.leftCols(c.n) * solved.y.segment(c.first, c.n));
    judge(c, before == ContactStatus::open ? Vec3(Vec3::Zero()) : r, x);
    some += c.law.status != before;
  }
  return some;
}

std::optional<ContactInTangent::Answer> ContactInTangent::solve_again(const ContactState& state,
                                                                      const VecX& rhs,
                                                                      const LinearSolver& linear) {
  linearise_at(state, false);
  rhs_ = turned(rhs, false);
  bool friction = false;
  for (Candidate& c : candidates_) {
    judge(c, c.present, c.q);
    if (c.law.status != c.factored) return std::nullopt;
    friction = friction || c.friction();
  }
  int solutions = 0;
  const auto solved = solution(linear, !friction, solutions);
  if (!solved) return std::nullopt;
  Answer answer = answer_of(*solved, state);
  if (changes(*solved) > 0) return std::nullopt;
  answer.solutions = solutions;
  return answer;
}

std::vector<double> ContactInTangent::constrained(
    const ContactState& state, const std::vector<double>& K,
    const std::vector<std::vector<ContactStatus>>& status) {
  linearise_at(state, true);
  K_ = K;
  turn(K_);
  for (Candidate& c : candidates_)
    c.law.status =
        status[static_cast<std::size_t>(c.contact)][static_cast<std::size_t>(c.candidate)];
  return matrix(false);
}

bool ContactInTangent::factored(const std::vector<std::vector<ContactStatus>>& status) const {
  return !friction_in_factor_ &&
         std::all_of(candidates_.begin(), candidates_.end(), [&](const Candidate& c) {
           return c.factored == status[static_cast<std::size_t>(c.contact)]
                                      [static_cast<std::size_t>(c.candidate)];
         });
}

}  // namespace langer
