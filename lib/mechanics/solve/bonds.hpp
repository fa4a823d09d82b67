// Adhesive bonds of all contacts in an increment: which forces they exert at a trial state, and how
// their intensities change.
//
// The law of one bond is in contact/adhesion.hpp. Here it is multiplied by the area of each
// candidate and added to the forces on the body, beside the reactions. Signorini's and Coulomb's
// laws hold for these reactions alone, so the contact solvers do not know of bonds.
//
// Between deformable surfaces a candidate is a mortar node. Its bond opens by
//   d = sum over the increments of (sum_j w_ij dx_j - sum_k w_ik dy_k)       since it bonded
// with the weights at the end of each increment; d turns with the normal n. The gap of the law is
// n . d, the slip the rest. The force acts on both sides with the mortar weights, as a reaction
// does, and therefore does the work that d stores. Bond::at is -d. A candidate without anything
// opposite has lost its bond.
#pragma once

#include <vector>

#include "mechanics/contact/contact.hpp"

namespace langer {

class TouchingBodies;

// per contact, then per deformable surface; per candidate; none of those without adhesion
using BondStates = std::vector<std::vector<Bond>>;

// Energies of a path on which bonds come loose [N mm].
struct BondEnergy {
  double dissipated = 0;     // by loss of intensity, and by the viscosity of bonds
  double released = 0;       // in jumps (solve/release.hpp)
  double work_of_jumps = 0;  // done by what moves the body, in the increments that hold one
  double stored = 0;         // now, in the body and in the bonds
};

class Bonds {
 public:
  // refers to them; surfaces: nullptr where none adheres
  explicit Bonds(const std::vector<RigidContact>& contacts, TouchingBodies* surfaces = nullptr);
  bool none() const { return !any_; }
  BondStates at_rest(const std::vector<Vec3>& X) const;  // what touches there is bonded

  // An increment from `start`, where displacements are u and those of indenters c, takes `seconds`;
  // b without them would be infinite stiffness.
  void begin(const BondStates& start, double seconds, const std::vector<Vec3>& X, const VecX& u,
             const std::vector<Vec3>& c);
  // What the bonds bear at u, c: by contact, the indenter's displacement.
  void evaluate(const std::vector<Vec3>& X, const VecX& u, const std::vector<Vec3>& c);

  // Within an increment: bonds go on from where they are now; and what takes their place in b/dt
  // [N/mm].
  void go_on();
  void damp(double viscous) { damping_ = viscous; }

  bool holds(std::size_t contact, std::size_t candidate) const {
    return any_ && !now_[contact].empty() && now_[contact][candidate].beta > 0;
  }
  // of a candidate [N], [N/mm]; only of contacts with adhesion
  const Vec3& force(std::size_t contact, std::size_t candidate) const {
    return now_[contact][candidate].force;
  }
  const Mat3& tangent(std::size_t contact, std::size_t candidate) const {
    return now_[contact][candidate].tangent;
  }
  bool of(std::size_t contact) const { return any_ && !now_[contact].empty(); }
  std::vector<Vec3> forces(std::size_t contact) const;
  Vec3 sum(std::size_t contact) const;
  // on the bodies, of both sides of a surface: (3 n)
  void add_forces(VecX& f) const;
  double squared_norm() const;
  double stored() const;                                  // [N mm]
  double dissipated_since(const BondStates& from) const;  // by loss of intensity, w A [N mm]
  double dissipated() const;  // since begin() or go_on(), viscous work included
  double loosened() const;    // largest change of an intensity since then
  // What the length of the increment makes of the intensities of bonds with a viscosity, as a mean
  // over the area that has touched; 0 where there are none.
  double time_error() const;

  // The states with which the next increment begins: candidates that bear a reaction r have bonded;
  // with healing those that bore none before, r_0, do so anew, where they are.
  BondStates after(const std::vector<std::vector<Vec3>>& r,
                   const std::vector<std::vector<Vec3>>& r_0, const VecX& u,
                   const std::vector<Vec3>& c) const;
  // whether a candidate does
  bool made_anew(std::size_t contact, std::size_t candidate,
                 const std::vector<std::vector<Vec3>>& r,
                 const std::vector<std::vector<Vec3>>& r_0) const;
  // What a change of its own numbers, and of its beginning, changes of a bond at u; c: of its
  // indenter. Times the candidate's area.
  AdhesiveChange change(std::size_t contact, std::size_t candidate, const std::vector<Vec3>& X,
                        const VecX& u, const Vec3& c, const BondChange& by) const;

 private:
  const Adhesion& law(std::size_t contact) const;
  double area(std::size_t contact, std::size_t candidate) const;  // [mm^2]
  double viscous(std::size_t contact) const;                      // B [N/mm]
  // the law at a candidate, times its area
  Adhesive bond(std::size_t contact, std::size_t candidate, const ShapePoint& shape, const Vec3& v,
                const Bond& from) const;
  void begin_surfaces(const std::vector<Vec3>& X, const VecX& u);
  void evaluate_surfaces(const std::vector<Vec3>& X, const VecX& u);
  // how far bonds with a viscosity are open where an increment begins
  void find_openings(const std::vector<Vec3>& X, const VecX& u, const std::vector<Vec3>& c);

  const std::vector<RigidContact>& contacts_;
  TouchingBodies* surfaces_ = nullptr;
  bool any_ = false;
  BondStates start_;
  double seconds_ = 0, damping_ = 0;
  std::vector<std::vector<Adhesive>> now_;  // times the candidate's area
  // Of surfaces that adhere: where the increment begins, and what evaluate() found.
  VecX u_start_;
  std::vector<std::vector<Vec3>> normals_;   // there, by surface
  std::vector<std::vector<Vec3>> openings_;  // d of each candidate [mm]
  VecX on_both_sides_;                       // (3 n) [N]; empty: no surface adheres
};

}  // namespace langer
