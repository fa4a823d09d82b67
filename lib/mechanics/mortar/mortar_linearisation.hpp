// Contact of two surfaces, linearised at a state: positions of the law and forces of the reactions
// as they change with the nodes. All terms of the averages are followed: normals, overlaps, dual
// functions, areas.
//   law      q + L d   at each candidate (n, t1, t2): gap and slip
//   forces   G (r + dr) + C d   on the nodes; C: present reactions that turn with their normals, on
//            weights that change
#pragma once

#include <vector>

#include "mechanics/mortar/mortar_facet.hpp"

namespace langer {

struct MortarLaw {
  std::vector<MortarNode> nodes;  // those with a row, in its order
  std::vector<Mat3> frames;       // columns n, t1, t2
  std::vector<Vec3> q, r;         // local
};

struct MortarMatrices {
  MatX L;  // (3 rows, columns)
  MatX G;  // (columns, 3 rows): forces of local reactions
  MatX C;  // (columns, columns)
};

// wanted: by candidate, whether it has a row. x0: positions that the slip is measured from.
// column_of (3 n): column of a degree of freedom, -1: none. first_row: of this contact's rows in
// `into`, which is large enough and to which all is added.
MortarLaw mortar_law(const std::vector<MortarNode>& nodes, const std::vector<char>& wanted,
                     const VecX& x, const VecX& x0, const std::vector<Vec3>& reactions);
void add_mortar_matrices(const SurfaceContact& contact, const MortarLaw& law, const VecX& x,
                         const VecX& x0, const std::vector<int>& column_of, int first_row,
                         MortarMatrices& into);

}  // namespace langer
