// Contact of many candidates of deformable surfaces in the sparse tangent, instead of condensed to
// them: no matrix over pairs of candidates is formed.                         [PGGW10], [GPGW10]
//
// With the laws of solve/surface_laws.hpp one linearised step of the body is
//   K d = rhs + G s + C d,   x = q + L d,   r = present + s
// The movement of a candidate's node is replaced by its jump y across the contact,
//   d = T y,   d_own = frame (y_own + sum of the weights of the other side times d_other)
// T is sparse, and T^T K T symmetric. There the law of a candidate has to do with the rows of its
// own node alone, but for what the turning of normals and the change of weights adds:
//   open     r = 0: rows like any other
//   closed   the jump along n is known and leaves the system; r_n is what its row lacks
//   sticks   the same of all three
//   slips    r_t = mu r_n e - k (1 - e e^T) x_t        (solve/law_status.hpp)
// The factor of that symmetric matrix, with the k of slip in it, preconditions GMRES for the whole
// step: unknowns are y, and a multiplier for each direction in which a candidate may be held.
// States are judged anew from each answer until none changes (semismooth Newton).
#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <optional>
#include <vector>

#include "mechanics/assembly/assembler.hpp"
#include "mechanics/linear/linear.hpp"
#include "mechanics/solve/jump_axes.hpp"
#include "mechanics/solve/law_status.hpp"
#include "mechanics/solve/touching_bodies.hpp"

namespace langer {

class BodiesInTangent {
 public:
  // Two-sided contact without indenters, bonds, ties or hanging nodes, whose candidates can be told
  // apart: none belongs to two contacts, none is on the other side of one.
  static bool serves(const Assembler& body, const std::vector<RigidContact>& contacts,
                     const TouchingBodies& bodies);
  // refers to the body and its pattern
  BodiesInTangent(const Assembler& body, TouchingBodies& bodies, int threads);

  // What was solved before has no say any more: an interrupted path goes on with the same digits.
  void begin_increment() { pattern_holds_ = false; }

  struct Answer {
    VecX move;    // of the free rows [mm]
    Reactions r;  // after the movement, in the frames before it
    int solutions = 0;
  };
  // Nothing where the tangent with contact is not positive definite, where a closed candidate
  // cannot move along its normal, or where GMRES does not converge. prescribed (3 n): what
  // prescribed degrees of freedom still move.
  std::optional<Answer> solve(const ContactState& state, TouchingBodies& bodies,
                              const VecX& u_begin, const VecX& prescribed,
                              const std::vector<double>& K, const VecX& rhs);
  // With the K and the factor of the last solve(). Nothing where a candidate changes what it does.
  std::optional<Answer> solve_again(const ContactState& state, TouchingBodies& bodies,
                                    const VecX& u_begin, const VecX& rhs);

  long factorizations() const { return factorizations_; }
  double seconds_of_factors() const { return seconds_; }  // CPU seconds
  LinearSolver::Size size() const { return size_; }       // with the bodies as they are at rest

 private:
  using Sparse = Eigen::SparseMatrix<double>;
  struct Candidate {
    std::size_t surface = 0, candidate = 0;
    double mu = 0;
    double rho = 1;  // of its law [N/mm]
    JumpAxes axes;
    LawStatus law;
    // in the factor: what it does, and the friction of slip along its axes 1 and 2 [N/mm]
    ContactStatus factored = ContactStatus::open;
    Eigen::Matrix2d friction_factored = Eigen::Matrix2d::Zero();
    bool friction() const { return mu > 0 && law.status == ContactStatus::slip; }
  };
  // A movement that balances, with what candidates then have, local.
  struct Step {
    VecX y, x, r;
    Step towards(const Step& other, double share) const;
  };
  // An entry of one row of a symmetric matrix.
  struct Entry {
    int at, position;  // the column, place in the values of the lower triangle
  };
  using Rows = std::vector<std::vector<Entry>>;

  bool linearise(const ContactState& state, TouchingBodies& bodies, const VecX& u_begin,
                 const VecX& prescribed, bool with_axes);
  void list_own_rows(const TouchingBodies& bodies);
  Rows rows_in(const Pattern& pattern) const;
  Sparse transformation(bool structure) const;
  void transform(const std::vector<double>& K);
  bool add_turned(const std::vector<double>& K);
  void make_pattern();
  void map_laws(const VecX& prescribed, const VecX& rhs);
  bool factorize();
  Vec3 change_of(const Candidate& c, const Vec3& multiplier, const Vec3& x, double constants,
                 const Vec3& present) const;
  Vec3 multiplier(const VecX& v, std::size_t row) const;
  VecX beyond_factor(const VecX& v) const;
  VecX right_side() const;
  VecX by_factor(const VecX& v) const;
  std::optional<VecX> solution(int& solutions) const;
  Step step_of(const VecX& v) const;
  double defect(const Step& step) const;
  int judge(const VecX& r, const VecX& x);
  Answer answer_of(const Step& step, const ContactState& state) const;

  const Assembler& body_;
  int threads_;
  std::vector<double> rho_;  // by surface: of the order of what its softer side opposes [N/mm]
  // by node of the other sides: those with which it shares a facet
  std::vector<std::vector<int>> around_;
  std::vector<int> own_rows_, own_of_;  // rows of all candidates' nodes; index in it by row, or -1
  Rows in_body_, in_turned_;            // own rows of K and of T^T K T

  SurfaceLaws laws_;
  VecX q_;                             // with what prescribed degrees of freedom move
  std::vector<Candidate> candidates_;  // by row of the laws
  Sparse T_;
  Sparse L_, G_, C_;  // of y
  VecX rhs_;
  Pattern pattern_;             // of T^T K T
  std::vector<int> made_of_;    // what it was made of: candidates, and the nodes opposite
  bool pattern_holds_ = false;  // in this increment
  std::vector<int> place_;      // in it, of each entry of K
  std::vector<double> values_;  // of T^T K T
  std::unique_ptr<LinearSolver> linear_;
  LinearSolver::Size size_;
  long factorizations_ = 0;
  double seconds_ = 0;
};

}  // namespace langer
