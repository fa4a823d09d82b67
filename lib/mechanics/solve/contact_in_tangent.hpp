// Contact of many candidates in the sparse tangent, instead of condensed to them: no matrix over
// pairs of candidates is formed.                                              [AC91], [HSW08]
//
// One linearised step of the body with contact reactions r = present + s is
//   K d = rhs + sum N (s + D N^T d)
// N: frame (n, t1, t2) of a candidate, D: turning of its reaction (contact/contact.hpp).
// The rows of each candidate are turned into its frame. What the law says of them depends on its
// state (solve/law_status.hpp):
//   open     r = 0: rows like any other
//   closed   the movement along n is known and leaves the system; r_n is what its row lacks
//   sticks   the same of all three movements
//   slips    r_t = mu r_n e - k (1 - e e^T) x_t
// The part of slip with k is symmetric and joins the matrix. That with r_n is not; GMRES finds it,
// with the factor as preconditioner. States are judged anew from each answer until none changes
// (semismooth Newton): few changes are left to GMRES, many need another factor. Closed gaps are
// exact in every answer. e is that of the answer before, and converges together with the body.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "mechanics/assembly/assembler.hpp"
#include "mechanics/linear/linear.hpp"
#include "mechanics/linear/mixed_tangent.hpp"
#include "mechanics/solve/contact_state.hpp"
#include "mechanics/solve/law_status.hpp"

namespace langer {

class ContactInTangent {
 public:
  // Candidates on it can be told apart: none belongs to two contacts, none is under force control
  // or adheres.
  static bool serves(const std::vector<RigidContact>& contacts);
  // refers to the body's pattern; stiffness: of the order of what the body opposes to a movement of
  // one node [N/mm]
  ContactInTangent(const Assembler& body, const std::vector<RigidContact>& contacts,
                   double stiffness);

  struct Answer {
    VecX move;    // of the free rows [mm]
    Reactions r;  // after the movement, in the frames before it
    int solutions = 0;
    bool settled = true;  // no candidate would do something else after it
  };
  using Factorize = std::function<bool(const std::vector<double>& values)>;
  // Nothing where the system is singular. factorize: into `linear`; how often, `factors` tells.
  std::optional<Answer> solve(const ContactState& state, const std::vector<double>& K,
                              const VecX& rhs, const LinearSolver& linear,
                              const Factorize& factorize);
  // The same without a factor, with the tangent of the body as `mixed` has split it; dp: change of
  // its pressures [MPa]. Nothing where that does not converge. Without candidates it solves for the
  // body alone.
  std::optional<Answer> solve(const ContactState& state, const Assembler& body, const VecX& rhs,
                              MixedTangent& mixed, VecX& dp);
  // What was solved before has no say any more: an interrupted path goes on with the same digits.
  void begin_increment() {
    fresh_ = lost_ = 0;
    residual_ = 0;
  }
  // With the K, the frames and the factor of the last solve(). Nothing where a candidate changes
  // what it does.
  std::optional<Answer> solve_again(const ContactState& state, const VecX& rhs,
                                    const LinearSolver& linear);

  // The tangent for movements that keep closed candidates closed and sticking ones in place;
  // slipping ones glide without friction.
  std::vector<double> constrained(const ContactState& state, const std::vector<double>& K,
                                  const std::vector<std::vector<ContactStatus>>& status);
  // whether the last factor is that of constrained()
  bool factored(const std::vector<std::vector<ContactStatus>>& status) const;

 private:
  struct Candidate {
    int contact = 0, candidate = 0, node = 0;
    int first = 0, n = 0;     // its free rows
    int axis[3] = {0, 0, 0};  // of each
    double mu = 0;
    // as of the last tangent
    Mat3 Q = Mat3::Identity();  // columns: its own axes in the free ones
    Mat3 G = Mat3::Zero();      // (3, n): local movement by those along its own axes
    Mat3 T = Mat3::Identity(), D = Mat3::Zero();
    // of this solution
    Mat3 frame = Mat3::Identity();
    Vec3 q = Vec3::Zero(), present = Vec3::Zero();  // local
    LawStatus law;
    ContactStatus factored = ContactStatus::open;
    bool friction() const { return mu > 0 && law.status == ContactStatus::slip; }
  };
  struct Solved {
    VecX y, Ky;
  };

  void linearise_at(const ContactState& state, bool with_frames);
  void own_axes(Candidate& c) const;
  void judge(Candidate& c, const Vec3& r, const Vec3& x) const;
  void turn(std::vector<double>& values) const;
  void turn_own_columns(const Candidate& c, std::vector<double>& values) const;
  VecX turned(const VecX& free, bool back) const;
  std::vector<double> matrix(bool with_friction, bool with_contact = true) const;
  VecX given(std::vector<char>& is_given) const;
  VecX times(const VecX& y) const;
  VecX force_of(MixedTangent& mixed, const VecX& y, const VecX* q = nullptr) const;
  Vec3 change_of(const Candidate& c, const VecX& y, const VecX& Ky, double constants) const;
  VecX missing(const VecX& y, const VecX& Ky, double constants,
               const std::vector<char>& is_given) const;
  std::optional<Solved> solution(const LinearSolver& linear, bool exact, int& solutions) const;
  std::optional<Solved> solution(MixedTangent& mixed, double relative, MixedSolver::Answer& from,
                                 VecX& dp) const;
  void turn_dyads(const std::vector<int>& cell_rows, std::vector<double>& b) const;
  bool precondition(MixedTangent& mixed);
  Answer answer_of(const Solved& solved, const ContactState& state) const;
  int changes(const Solved& solved);

  const Pattern& pattern_;
  double rho_;
  std::vector<Candidate> candidates_;
  struct RowBlock {
    int position, candidate;
  };
  std::vector<RowBlock> row_blocks_;  // entries of a candidate's rows in the columns before them
  std::vector<int> begins_;           // by row: the candidate whose first it is, or -1
  std::vector<double> K_;             // turned
  VecX rhs_;                          // turned
  bool friction_in_factor_ = false;
  // products of a solution with a new multigrid, and those that its age has cost since
  int fresh_ = 0, lost_ = 0;
  double residual_ = 0;  // before the last iterative correction [N]
};

}  // namespace langer
