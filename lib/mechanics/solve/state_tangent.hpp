// Direct differentiation of an accepted state with respect to numbers of the scene, through contact
// and friction: parameters of laws, friction, forces, and what is moved.
//   balance        K u' - r' = -f_p               f_p: what the number changes of f_int where u of the free dofs stands still
//   a candidate    open: r' = 0;  closed: gap' = 0, and without friction r' along the turning normal;  sticking: slip' = 0;
//                  slipping: r_t = -mu r_n s, s the direction of the slip, with all of it differentiated
//   slip           between what it is measured from, u_start (Statics, contact/touch.hpp), and u:  slip' needs u' of the increments before
//   force control  the sum of the reactions along its direction stands still, and the indenter's travel has a derivative
// All of them together are linear. They are solved with the factor of the accepted state, and
// corrected by what K has not: the remainder's modulus of linear_dilatation as a function of u,
// pressures on a free rim. Where a candidate stands on the edge between two states the derivative
// is that of the state which it has.
#pragma once

#include <optional>
#include <vector>

#include "core/tensor/dense.hpp"
#include "mechanics/solve/condensed_contact.hpp"
#include "mechanics/solve/statics.hpp"

namespace langer {

// Of a BodyState, per unit of the number.
struct StateDerivative {
  VecX u;             // (3 n)
  Reactions r;        // global
  double travel = 0;  // of the indenter under force control
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
};

class StateTangent {
 public:
  // Of the state that was accepted last, right after accept(): assembles and factorizes there.
  // `earlier`: the state before the one before it. Refers to statics.
  StateTangent(Statics& statics, const BodyState& earlier);

  // before, earlier: derivatives of the two states before. Nothing where the tangent is singular,
  // or the corrections end further from balance than `enough`, relative to what the change loads
  // the body with.
  std::optional<StateDerivative> derivative(const ParameterChange& change,
                                            const StateDerivative& before,
                                            const StateDerivative& earlier,
                                            double enough = 1e-7) const;
  // Of what the body bears at supports and contact nodes (Statics::reactions), one for each.
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
  VecX on_free_rows(const ParameterChange& change) const;
  std::optional<Change> solve(const VecX& rhs, const VecX& h) const;
  void add(const Change& change, StateDerivative& to) const;
  VecX on_free_rows(const StateDerivative& d) const;  // of the reactions less the change of f_int

  Statics& statics_;
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
