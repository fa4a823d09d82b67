// One facet of the non-mortar side and all facets that lie opposite: weights of its corners in the
// averages of surface_contact.hpp, and their derivatives with respect to all corners.
//
// Integrals over the overlaps (overlap.hpp), N_i of the own and N_k of the other facet:
//   M_ij = integral N_i N_j,   K_ik = integral N_i N_k,   D_i = sum_j M_ij
// The weight functions are Phi = A N with
//   A = (1 - beta) 1 + beta D M^-1
// beta = 1: dual functions, integral Phi_i N_j = D_i delta_ij, so that each node has a gap of its
// own. beta = 0: the usual functions, which stay positive where little of the facet is covered and
// M is nearly singular. beta goes smoothly from 0 to 1 with the share that is covered. The weights
// are A M for the own and A K for the other corners.                          [WO00], [CB11]
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mechanics/mortar/overlap.hpp"
#include "mechanics/mortar/surface_contact.hpp"

namespace langer {

using Mat4 = Eigen::Matrix4d;
using Vec4 = Eigen::Vector4d;

// Overlap with one facet of the other side; derivatives with respect to 24 coordinates: corners of
// the own facet, then of the other one. Empty derivatives where none are asked for.
struct FacetOverlap {
  int other = 0;  // index in SurfaceContact::other
  Mat4 M, K;
  std::vector<Mat4> dM, dK;
};

struct MortarFacet {
  int own = 0;  // index in SurfaceContact::own
  double area = 0;
  std::vector<FacetOverlap> overlaps;
  Mat4 M;
  Vec4 D;
  Mat4 A;
  double beta = 0;
  double beta_slope = 0;  // by the covered share
};

std::vector<MortarFacet> mortar_facets(const SurfaceContact& contact, const VecX& x,
                                       bool with_derivatives);

// the candidates of these facets
std::vector<MortarNode> mortar_nodes(const SurfaceContact& contact,
                                     const std::vector<MortarFacet>& facets, const VecX& x);

}  // namespace langer
