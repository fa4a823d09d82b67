// Derivatives of contact between deformable surfaces at an accepted state
// (solve/state_tangent.hpp).
//
// With the matrices of solve/touching_bodies.hpp, and a prime for the derivative with respect to a
// number, the contact nodes of both sides move by
//   d = move + F (G r' + C d)          move: by what the number changes where reactions stand still
// and each candidate that bears something keeps its law
//   X (L d + x') + R r' = h            solve/law_rows.hpp
// x' is what the number changes of the slip before: slip is measured from the state before, which
// follows the number, too. Both are one dense system for d and r'.
//
// The nodal forces of reactions change as differences say, so that the corrections of a derivative
// end at the exact balance, also for what C leaves out of the couples on the other side.
#pragma once

#include <optional>
#include <vector>

#include "core/tensor/dense.hpp"
#include "mechanics/solve/increment_state.hpp"
#include "mechanics/solve/law_rows.hpp"
#include "mechanics/solve/parameter_change.hpp"

namespace langer {

class SurfaceTangent {
 public:
  // Of the accepted state, with its factor. Refers to both.
  SurfaceTangent(const IncrementState& state, const TangentFactor& factor);

  // What a number does to the candidates, beside forces on the free rows; empty: nothing.
  struct Loads {
    VecX h;           // of the law
    VecX prescribed;  // of the columns: of imposed displacements [mm]
  };
  // before (3 n): derivative of the displacements before
  Loads loads(const ParameterChange& change, const VecX& before) const;

  struct Change {
    VecX move;  // of the free rows
    VecX r;     // local, of the rows
  };
  std::optional<Change> solve(const VecX& rhs, const Loads& loads) const;
  // Adds local changes to those of the reactions (global, in the frames of the state).
  void add_reactions(const Change& change, Reactions& r) const;
  // Derivative of the nodal forces (3 n), of such changes r and the movement du (3 n).
  VecX forces(const VecX& du, const Reactions& r) const;
  // Adds to r what reactions turn with their normals.
  void turn_reactions(const VecX& du, Reactions& r) const;

 private:
  // positions and reactions moved by a step along their derivatives
  struct Moved {
    VecX x;
    Reactions r;
  };
  Moved moved(const VecX& du, const Reactions& r, double step) const;
  double step(const VecX& du, const Reactions& r) const;

  const IncrementState& state_;
  const TangentFactor& factor_;
  std::size_t first_ = 0;  // of the surfaces among the reactions
  SurfaceSystem system_;
  std::vector<CandidateState> candidates_;  // by row
  std::vector<LawRows> rows_;
  double typical_ = 1;  // compliance [mm/N]
  VecX x_;              // positions (3 n)
  Lu lu_;               // of d and typical * r'
  LeastNorm least_;
  bool singular_ = false;
};

}  // namespace langer
