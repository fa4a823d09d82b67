// The mass matrix of a body, on the unknowns of its tangent.
//   M_ab = integral rho0 N_a N_b dV0 1          consistent
//   M_aa = sum_b M_ab                           lumped: sums of rows, hex8 only
// Densities are those of the undeformed body, so M is constant: velocities and accelerations are
// those of material points.
//
// Nodes that are tied (symmetry, a section) or hang on others have no unknowns. Their mass is
// carried by the nodes that they move with, u_a = T_a u_b: T_a' M_ab T_b. A cell of a body that
// symmetry reduces counts as often as it stands for one of the whole body, and a section as its
// whole circle: M, like the tangent, is that of the whole body. A point of a section that turns
// about the axis moves as fast as the one in front, so T is taken without the component along z.
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <vector>

#include "mechanics/assembly/body_model.hpp"
#include "mechanics/assembly/pattern.hpp"

namespace langer {

enum class MassKind { consistent, lumped };
constexpr auto names(MassKind) { return std::array{"consistent", "lumped"}; }

// 1 kg/m3 in t/mm3. With lengths in mm and forces in N, a mass is in tonnes: 1 N = 1 t mm/s2.
inline constexpr double tonne_per_mm3 = 1e-12;
// 1 g in t
inline constexpr double tonne_per_gram = 1e-6;

struct Mass {
  // (3 n, 3 n) [t], symmetric, both triangles. Dof 3 i + k is component k of node i, prescribed
  // ones included; rows of tied and hanging nodes are empty.
  Eigen::SparseMatrix<double> M;
  double total = 0;  // of the whole body [t]

  // The entries of the free rows in the order of the tangent's pattern: (nnz) [t].
  std::vector<double> in_pattern(const Pattern& pattern, const Dofs& dofs) const;
};

// density: by index in Mesh::bodies [t/mm3]. All cells of the mesh count, on whichever rank.
// Throws std::invalid_argument for a lumped mass of cells of second order: sums of rows would be
// negative at their corners.
//
// massless: by node of the mesh; empty: none. The rows of these nodes vanish, and so do those of
// nodes that move with them. What they had goes to the other nodes of their cells, and a small
// change of all entries, m_ab (1 + phi_a' L phi_b) with phi = (1, x, y, z), restores the mass, its
// centre and its moments of inertia, of each body that shares no node with others. [KLR08], cell by
// cell. Throws std::invalid_argument if a body is left without mass, or one of several with a
// negative one: too few layers of nodes are left.
Mass make_mass(const BodyModel& body, const std::vector<double>& density, MassKind kind,
               const std::vector<char>& massless = {});

// Mass of one cell by its nodes (nodes, nodes) [t], with density 1 [t/mm3].
MatX cell_mass(const ReferenceCell& cell, const ElementNodes& X);

}  // namespace langer
