// The tangent of a body of 8-node hexahedra with one dilatation each, split for an iterative
// solution (linear/mixed.hpp):
//   K = A + B^T D B,   A with a bulk modulus of a few shear moduli in place of kappa
// The pressures are unknowns of their own. In an approach with J_bar alone, the error of an inexact
// solution would be multiplied by kappa, in residuals and in predictions.
#pragma once

#include <memory>
#include <string>

#include "mechanics/assembly/assembler.hpp"
#include "mechanics/linear/mixed.hpp"

namespace langer {

class MixedTangent {
 public:
  // body: of 8-node hexahedra with a mean dilatation. nullptr: PETSc is not at hand, `why`
  static std::unique_ptr<MixedTangent> of(const Assembler& body, int threads, std::string& why);

  // As assembled last; du_prescribed: (3 n) movement of prescribed dofs still to be made. b() is
  // then in the axes of the free rows.
  void linearise(const Assembler& body, const VecX& du_prescribed);
  std::vector<double> rest_of(const Assembler& body) const;  // A, from K()
  std::vector<double>& b() { return b_; }                    // for who turns rows into other axes
  const VecX& D() const { return D_; }
  const std::vector<int>& cell_rows() const { return cell_rows_; }
  const MatX& rigid() const { return rigid_; }  // (rows, 6)

  // The right side that belongs to rhs, that of K: f = rhs + B^T known_force(), g = known_strain()
  VecX known_force() const { return missing_ + D_.cwiseProduct(of_prescribed_); }
  VecX known_strain() const { return -missing_.cwiseQuotient(D_) - of_prescribed_; }
  // change of the pressures of the tangent [MPa]; Bd: B d
  VecX pressures(const VecX& Bd, const VecX& q) const;

  MixedSolver& solver() { return *solver_; }
  const MixedSolver& solver() const { return *solver_; }
  // Residual of f and g together at which a solution ends, relative to its right side. A more
  // accurate one than `usual` takes more products than it saves corrections, except where the
  // strains g outweigh the forces f.
  static constexpr double usual = 1e-2, accurate = 1e-4;
  static constexpr int most = 120;  // products of one solution

 private:
  std::vector<int> cell_dofs_, cell_rows_;
  std::vector<double> b_;
  VecX scale_;     // of the unknown of a cell: all have about the same weight then
  VecX softened_;  // what A keeps of the bulk modulus, over the scale [MPa]
  VecX D_, V_, missing_, of_prescribed_;
  MatX rigid_;
  std::unique_ptr<MixedSolver> solver_;
};

}  // namespace langer
