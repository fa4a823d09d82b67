// Derivatives of adhesive bonds with respect to numbers of the scene.
//
// The force of a bond follows from where its node is, from its state at the beginning of the
// increment, and from the numbers of its law (contact/adhesion.hpp). All of these may follow a
// number of the scene. The state at the end is the beginning of the next increment, so derivatives
// are carried along the path as those of friction are.
//
// A bond on the edge between holding and coming loose has the derivative of the side on which it
// is. Bonds that let go in a jump (solve/release.hpp) have none.
#pragma once

#include <vector>

#include "mechanics/solve/bonds.hpp"
#include "mechanics/solve/parameter_change.hpp"

namespace langer {

// Of a Bond, per unit of the number.
struct BondRate {
  double beta = 0;
  Vec3 at = Vec3::Zero();
  double opening = 0;
};
using BondRates = std::vector<std::vector<BondRate>>;  // as BondStates; empty: all 0

// A number of the scene: what it changes directly, and of the bonds at the beginning.
struct BondMoves {
  const ParameterChange& change;
  const BondRates& start;
};

class BondChanges {
 public:
  // At the end of an increment that `bonds` have begun and where they are evaluated: u (3 n), c by
  // contact. Refers to all but c.
  BondChanges(const Bonds& bonds, const std::vector<RigidContact>& contacts,
              const std::vector<Vec3>& X, const VecX& u, std::vector<Vec3> c);

  bool holds(std::size_t contact, std::size_t candidate) const {
    return bonds_.holds(contact, candidate);
  }
  const Mat3& tangent(std::size_t contact, std::size_t candidate) const {
    return bonds_.tangent(contact, candidate);
  }
  // of a node against its indenter; du (3 n): derivative of u
  Vec3 moved(std::size_t contact, std::size_t candidate, const ParameterChange& change,
             const VecX& du) const;
  // of a candidate; the force is that on the body [N]
  AdhesiveChange at(std::size_t contact, std::size_t candidate, const BondMoves& moves,
                    const VecX& du) const;
  std::vector<std::vector<Vec3>> forces(const BondMoves& moves, const VecX& du) const;
  // Of the bonds with which the next increment begins. r, r_0: reactions at the end and at the
  // beginning (Bonds::after).
  BondRates after(const BondMoves& moves, const VecX& du, const std::vector<std::vector<Vec3>>& r,
                  const std::vector<std::vector<Vec3>>& r_0) const;

 private:
  Mat3 curvature_change(std::size_t contact, const Vec3& x, const Vec3& moved) const;

  const Bonds& bonds_;
  const std::vector<RigidContact>& contacts_;
  const std::vector<Vec3>& X_;
  const VecX& u_;
  std::vector<Vec3> c_;
};

}  // namespace langer
