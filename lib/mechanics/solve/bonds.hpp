// Adhesive bonds of all contacts in an increment: which forces they exert at a trial state, and how
// their intensities change.
//
// The law of one bond is in contact/adhesion.hpp. Here it is multiplied by the area of each
// candidate and added to the forces on the body, beside the reactions. Signorini's and Coulomb's
// laws hold for these reactions alone, so the contact solvers do not know of bonds.
#pragma once

#include <vector>

#include "mechanics/contact/contact.hpp"

namespace langer {

// per contact, per candidate; none of a contact without adhesion
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
  explicit Bonds(const std::vector<RigidContact>& contacts);  // refers to them
  bool none() const { return !any_; }
  BondStates at_rest(const std::vector<Vec3>& X) const;  // what touches there is bonded

  // An increment from `start` takes `seconds`; b without them would be infinite stiffness.
  void begin(const BondStates& start, double seconds);
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
  void add_forces(VecX& f) const;  // (3 n)
  double squared_norm() const;
  double stored() const;                                  // [N mm]
  double dissipated_since(const BondStates& from) const;  // by loss of intensity, w A [N mm]
  double dissipated() const;  // since begin() or go_on(), viscous work included
  double loosened() const;    // largest change of an intensity since then

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
  double viscous(std::size_t contact) const;  // B [N/mm]

  const std::vector<RigidContact>& contacts_;
  bool any_ = false;
  BondStates start_;
  double seconds_ = 0, damping_ = 0;
  std::vector<std::vector<Adhesive>> now_;  // times the candidate's area
};

}  // namespace langer
