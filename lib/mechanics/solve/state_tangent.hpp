// Derivatives of an accepted state with respect to numbers of the scene: parameters of the
// material, friction, forces, prescribed movements. Exact through contact and friction.
//
// A state satisfies balance and the contact law. Differentiated with respect to the number p, a
// prime, both are linear in u' and r':
//   balance    K u' - r' = -f_p     f_p: change of the internal force with p while u stands still
//   candidate  open       r' = 0
//              closed     gap' = 0; without friction r' follows the turning normal
//              sticking   gap' = 0 and slip' = 0
//              slipping   gap' = 0, and r_t = -mu r_n s differentiated; s: direction of the slip
// The slip of an increment is measured from u_start (contact/touch.hpp), so that slip' needs u' of
// the two states before: derivatives are computed along the path, increment by increment.
// Under force control the sum of the reactions is given, and the travel has a derivative.
//
// The factor of the accepted state solves the system, and iterations correct it for what K leaves
// out: the modulus of linear_dilatation as a function of u, and pressures on a free rim. On the
// edge between two states of a candidate, the derivative is that of the state which it has.
//
// Of a body in motion (generalised_alpha), accelerations are linear in the movement and in the
// state before: with that state's derivatives the balance gets M a' of the history, K the mass, and
// the force of an indenter with mass follows its travel.
#pragma once

#include <optional>
#include <vector>

#include "core/tensor/dense.hpp"
#include "mechanics/solve/condensed_contact.hpp"
#include "mechanics/solve/increment.hpp"

namespace langer {

// Of a BodyState, per unit of the number.
struct StateDerivative {
  VecX u;                   // (3 n)
  Reactions r;              // global
  double travel = 0;        // of the indenter under force control, or with mass
  MotionState motion = {};  // of a body in motion: v, a, b and those of an indenter with mass
};

// An indenter whose number is a little less, or more, by `width` in all.
struct ShapeChange {
  Indenter less, more;
  double width = 1;
};

// What a number changes where the state stands still; empty: nothing.
struct ParameterChange {
  VecX f = {};                  // (3 n) of f_int less the forces
  std::vector<double> mu = {};  // by contact: of its friction
  VecX prescribed = {};         // (3 n) of prescribed dofs [mm], 0 elsewhere
  std::vector<Vec3> indenters =
      {};  // by contact: of its place [mm], whose orientation stands still
  std::vector<std::optional<ShapeChange>> shapes = {};  // by contact: of its shape
  double control = 0;                                   // of the given force on an indenter [N]
};

class StateTangent {
 public:
  // Of the state that was accepted last, right after accept(): assembles and factorizes there.
  // `earlier`: the state before the one before it. Refers to the increment.
  StateTangent(Increment& increment, const BodyState& earlier);

  // before, earlier: derivatives of the two states before. Nothing where the tangent is singular,
  // or the corrections end further from balance than `enough`, relative to what the change loads
  // the body with.
  std::optional<StateDerivative> derivative(const ParameterChange& change,
                                            const StateDerivative& before,
                                            const StateDerivative& earlier,
                                            double enough = 1e-7) const;
  // Of what the body bears at supports and contact nodes (Increment::reactions), one for each.
  // energies: if given, takes what the movement adds to the derivative of the stored energy [N mm].
  std::vector<VecX> reactions(const std::vector<ParameterChange>& changes,
                              const std::vector<StateDerivative>& derivatives,
                              std::vector<double>* energies = nullptr) const;
  StateDerivative of_rest() const;  // nothing changes

 private:
  struct Rows {  // x x' + r r' = h of one candidate, local
    Mat3 x = Mat3::Zero(), r = Mat3::Zero();
  };
  struct Change {
    VecX move;  // of the free rows
    VecX s, d;  // Condensed: force on the body, movement of the candidates
    double travel = 0;
  };
  void take_candidates();
  void take_rows();
  Rows rows_of(std::size_t p, double typical) const;
  VecX local_of(
      const VecX& last) const;  // movement of the candidates from that of the rows of factor.last()
  IncrementMove increment_move() const;  // that led to the accepted state
  // x' where the body stands still, and what friction itself changes
  std::vector<Vec3> slip_of_history(const ParameterChange& change, const StateDerivative& before,
                                    const StateDerivative& earlier) const;
  struct ShapeEffect {  // local: on gap and slip, and on the force of a reaction that turns
    Vec3 x = Vec3::Zero(), r = Vec3::Zero();
  };
  ShapeEffect shape_effect(const ParameterChange& change, std::size_t p) const;
  Vec3 moved_against(const ParameterChange& change,
                     const Near& near) const;  // of prescribed dofs against the indenter, local
  VecX right_hand_side(const ParameterChange& change, const std::vector<Vec3>& history) const;
  double travel_force_change(const StateDerivative& before) const;  // travel standing still [N]
  VecX on_free_rows(const ParameterChange& change) const;
  std::optional<Change> solve(const VecX& rhs, const VecX& h) const;
  void add(const Change& change, StateDerivative& to) const;
  VecX on_free_rows(const StateDerivative& d) const;  // of the reactions less the change of f_int

  const IncrementState& increment_;
  TangentFactor& factor_;
  VecX expected_;                           // u that the increment was begun with
  bool solvable_ = false, pushed_ = false;  // an indenter under force control bears something
  std::vector<Near> near_;
  std::vector<ContactStatus> status_;
  std::vector<double> slip_;  // length [mm]
  std::vector<double>
      approach_;  // of the increment's movement against the indenter, along the normal
  std::vector<double> typical_;  // compliance that scales the rows
  Condensed c_;
  std::vector<Rows> rows_;
  Lu lu_;
  LeastNorm least_;
  bool singular_ = false;
};

}  // namespace langer
