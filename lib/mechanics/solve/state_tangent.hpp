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
// out: the modulus of linear_dilatation as a function of u, pressures on a free rim, and how the
// curvature of an indenter changes where a bond slides along it. On the edge between two states of
// a candidate, the derivative is that of the state which it has.
//
// Bonds of an adhesion join the candidate's force: their tangent turns with it, and what a number
// changes of their states before and of their law is a load (solve/bond_changes.hpp). Where they
// let go in a jump, the state behind it has no derivative.
//
// Deformable surfaces in place of indenters: solve/surface_tangent.hpp.
//
// Of a body in motion (generalised_alpha), accelerations are linear in the movement and in the
// state before: with that state's derivatives the balance gets M a' of the history, K the mass, and
// the force of an indenter with mass follows its travel.
#pragma once

#include <optional>
#include <vector>

#include "core/tensor/dense.hpp"
#include "mechanics/solve/bond_changes.hpp"
#include "mechanics/solve/condensed_contact.hpp"
#include "mechanics/solve/increment.hpp"
#include "mechanics/solve/law_rows.hpp"
#include "mechanics/solve/parameter_change.hpp"
#include "mechanics/solve/surface_tangent.hpp"

namespace langer {

// Of a BodyState, per unit of the number.
struct StateDerivative {
  VecX u;                   // (3 n)
  Reactions r;              // global
  double travel = 0;        // of the indenter under force control, or with mass
  MotionState motion = {};  // of a body in motion: v, a, b and those of an indenter with mass
  // of the bonds with which the next increment begins, and of what they bear; empty: none
  BondRates bonds = {};
  std::vector<std::vector<Vec3>> adhesive = {};
  VecX surface_forces = {};  // (3 n) of deformable surfaces on the body; empty: none
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
  std::optional<StateDerivative> derivative_with_surfaces(const ParameterChange& change,
                                                          const StateDerivative& before,
                                                          double enough) const;
  struct Touching {
    ContactStatus status = ContactStatus::open;
    bool bonded = false;
    double slip = 0;      // length [mm]
    double approach = 0;  // of the increment's movement against the indenter, along the normal
    double typical = 0;   // compliance that scales the rows
    LawRows rows = {};
    bool bears() const { return bonded || status != ContactStatus::open; }
  };
  struct Change {
    VecX move;  // of the free rows
    VecX s, d;  // Condensed: force on the body, movement of the candidates
    double travel = 0;
  };
  void take_candidates();
  void take_rows();
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
  // of bonds, what K and the candidates' laws do not have of them; du: all that moves (3 n)
  VecX bonds_on_free_rows(const BondMoves& moves, const VecX& du) const;
  void part_bonds_from_reactions(const BondMoves& moves, StateDerivative& d) const;

  const IncrementState& increment_;
  TangentFactor& factor_;
  VecX expected_;                           // u that the increment was begun with
  std::optional<BondChanges> bonds_;        // where something adheres
  std::optional<SurfaceTangent> surfaces_;  // deformable ones, of a scene without indenters
  bool solvable_ = false, pushed_ = false;  // an indenter under force control bears something
  std::vector<Near> near_;
  std::vector<Touching> touching_;  // of each
  Condensed c_;
  Lu lu_;
  LeastNorm least_;
  bool singular_ = false;
};

}  // namespace langer
