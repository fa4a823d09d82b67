// One facet of the non-mortar side with all that it overlaps: the weights of its corners, and their
// derivatives with respect to the corners of all these facets.
//   M = integral N_i N_j,  K = integral N_i N_k   over the overlaps
//   D_i = sum_j M_ij;   Phi = A N,  A = (1 - beta) 1 + beta D M^-1;   own = A M, other = A K
//   beta: 0 where little of the facet is covered, 1 where most of it is
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
