// How the tangent of a body with contact candidates is factorized, and what serves where it is not
// positive definite.
//   whole       K by Cholesky
//   supported   K with springs gamma on the diagonal of the candidates, by Cholesky: a body that is not held, or not stable,
//               without its contacts; linearised_contact() takes the springs out again exactly
//   indefinite  with stabilisation springs in the body, which LinearSolver takes out; without contact K as it is, by UMFPACK
// Contact is either condensed to its candidates, which are eliminated last
// (solve/contact_linearisation.hpp), or where they are many stands in the tangent itself
// (solve/contact_in_tangent.hpp). Large bodies have no factor at all (linear/mixed_tangent.hpp).
#pragma once

#include <memory>
#include <vector>

#include "mechanics/assembly/assembler.hpp"
#include "mechanics/contact/contact.hpp"
#include "mechanics/linear/linear.hpp"
#include "mechanics/linear/linear_by.hpp"
#include "mechanics/linear/mixed_tangent.hpp"
#include "mechanics/solve/candidate_levels.hpp"
#include "mechanics/solve/contact_in_tangent.hpp"

namespace langer {

// by_cost: in the tangent where candidates are many, it serves, and factorizations are cheap beside
// a condensed law (many_candidates and deep in tangent_factor.cpp)
enum class ContactBy { by_cost, compliance, tangent };

// Why a body has to be solved by a factor; "" where it may be solved without (if PETSc is at hand).
// follows: pressures the surface
std::string why_by_factor(const Mesh& mesh, const Dofs& dofs, Formulation formulation,
                          const std::vector<RigidContact>& contacts, bool follows,
                          LinearBy linear_by);

class TangentFactor {
 public:
  enum class Kind { none, whole, supported, indefinite };

  // threads: of the BLAS; refers to the pattern of the body. Failure(config) where
  // LinearBy::iterative is asked for and does not serve.
  TangentFactor(const Assembler& body, const std::vector<RigidContact>& contacts, int threads,
                ContactBy contact_by = ContactBy::by_cost, LinearBy linear_by = LinearBy::direct);
  // with further nodes in contact, of deformable surfaces: contact is condensed
  TangentFactor(const Assembler& body, const std::vector<RigidContact>& contacts,
                const std::vector<int>& further, int threads);

  // Which candidates are eliminated last. Where that changes, the next thing is a factorization.
  const CandidateLevels& levels() const { return levels_; }
  int level() const { return level_; }
  void take_level(const Assembler& body, int level);
  bool may_leave_out() const {
    return !candidates_.empty() && !last_.empty() && springs_.loose == 0;
  }

  // Springs that one tangent of an increment needed are there for all that follow in it.
  void begin_increment();
  // The body's K; false where it is singular.
  bool factorize(const Assembler& body);
  // K as it is, without springs; false where it is not positive definite.
  bool factorize_whole(const Assembler& body);
  // What contact makes of the tangent, where it stands in it: by Cholesky, or by UMFPACK.
  bool factorize_with_contact(const std::vector<double>& values);
  // The body's K where reactions of contacts are fixed: K as it is, by UMFPACK where it is not
  // positive definite.
  bool factorize_fixed_reactions(const Assembler& body);

  // Without a factor: the tangent as it is solved iteratively, contact in it. nullptr: by a factor.
  MixedTangent* mixed() const {
    if (by_factor_) return nullptr;
    return mixed_.get();
  }
  bool iterative() const { return mixed_ != nullptr; }
  // In the rest of this increment by a factor, which only one rank can make, as the iterative
  // solution did not converge. The next one begins as if nothing had been, so that an interrupted
  // path goes on with the same digits.
  void take_factor(const Assembler& body);
  bool gave_up_iterating() const { return gave_up_; }  // ever
  LinearSolver::Size size() const;

  Kind kind() const { return kind_; }
  ContactInTangent* in_tangent() const { return in_tangent_.get(); }  // none: contact is condensed
  bool with_springs() const { return springs_.act; }                  // on the candidates
  double gamma() const { return springs_.gamma; }                     // [N/mm]
  bool held_by_contact() const { return springs_.loose > 0; }  // the supports leave rigid motions
  const std::vector<int>& last() const {
    return last_;
  }  // free rows of the candidates, eliminated last
  int last_of(int dof) const { return last_of_[dof]; }  // index in last(), or -1

  const LinearSolver& linear() const { return *linear_; }
  LinearSolver& linear() { return *linear_; }

  struct Counts {
    long factorizations = 0;
    int indefinite = 0;  // tangents that were not positive definite without contact
    int unstable = 0;    // among them those that were not with contact
  };
  const Counts& counts() const { return counts_; }
  void go_on_counting(const Counts& from) { counts_ = from; }
  void uncount(const Counts& before) {
    counts_.indefinite = before.indefinite;
    counts_.unstable = before.unstable;
  }

 private:
  bool take_iterative(const Assembler& body, const std::vector<RigidContact>& contacts,
                      LinearBy linear_by);
  void take_into_tangent(const Assembler& body, const std::vector<RigidContact>& contacts);
  bool factorize_supported(const Assembler& body);
  void list_last(const Dofs& dofs);
  void eliminate_last(const Dofs& dofs, const std::vector<int>& nodes);

  std::vector<std::vector<int>> candidates_;  // nodes of each contact
  CandidateLevels levels_;
  int level_ = 0;
  std::vector<int> last_, last_of_;
  std::unique_ptr<ContactInTangent> in_tangent_;
  std::unique_ptr<LinearSolver> linear_;
  std::unique_ptr<MixedTangent> mixed_;
  int threads_;
  bool by_factor_ = false, gave_up_ = false;
  Kind kind_ = Kind::none;
  struct Springs {  // on the candidates
    bool act = false;
    double gamma = 0;  // [N/mm]
    double loose = 0;  // gamma to begin with where the supports leave rigid motions [N/mm]
  };
  Springs springs_;
  Counts counts_;
};

}  // namespace langer
