// Contact of two surfaces, linearised at a state: how gap and slip of each candidate, and the
// forces of its reaction, change when the nodes of both sides move by d.
//   law      x = q + L d               at each candidate (n, t1, t2)
//   forces   f = G (r + dr) + C d      on the nodes of both sides
// G spreads a reaction with the mortar weights. C comes from present reactions: they turn with
// their normals, and act with weights that change. All terms are differentiated exactly, also
// normals, overlaps and dual functions (automatic differentiation, jet.hpp), so that Newton's
// method converges quadratically.                                        [PGGW10], [GPGW10]
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "mechanics/mortar/mortar_facet.hpp"

namespace langer {

struct MortarLaw {
  std::vector<MortarNode> nodes;  // those with a row, in its order
  std::vector<Mat3> frames;       // columns n, t1, t2
  std::vector<Vec3> q, r;         // local
  std::vector<Vec3> beside;       // local forces that act like r, and are not the law's: bonds
};

// Entries of a sparse matrix. Those of the same place are summed up in their order.
class SparseEntries {
 public:
  void add(int row, int column, double value) { list_.emplace_back(row, column, value); }
  template <class Block>
  void add_block(int row, int column, const Block& block) {
    for (int j = 0; j < block.cols(); ++j)
      for (int i = 0; i < block.rows(); ++i) add(row + i, column + j, block(i, j));
  }
  Eigen::SparseMatrix<double> matrix(Eigen::Index rows, Eigen::Index columns) const {
    Eigen::SparseMatrix<double> out(rows, columns);
    out.setFromTriplets(list_.begin(), list_.end());
    return out;
  }

 private:
  std::vector<Eigen::Triplet<double>> list_;
};

struct MortarMatrices {
  SparseEntries L;  // (3 rows, columns)
  SparseEntries G;  // (columns, 3 rows): forces of local reactions
  SparseEntries C;  // (columns, columns)
};

// wanted: by candidate, whether it has a row. bonds: by candidate, global; empty: none. x0:
// positions that the slip is measured from. column_of (3 n): column of a degree of freedom, -1:
// none. first_row: of this contact's rows in `into`, to which all is added.
MortarLaw mortar_law(const std::vector<MortarNode>& nodes, const std::vector<char>& wanted,
                     const VecX& x, const VecX& x0, const std::vector<Vec3>& reactions,
                     const std::vector<Vec3>& bonds = {});
void add_mortar_matrices(const SurfaceContact& contact, const MortarLaw& law, const VecX& x,
                         const VecX& x0, const std::vector<int>& column_of, int first_row,
                         MortarMatrices& into);

}  // namespace langer
