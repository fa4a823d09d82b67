// Contact of two deformable surfaces by mortar elements with dual shape functions.
//
// The two meshes do not match. One surface is the non-mortar side: contact laws hold at its nodes.
// Gap and slip of such a node i are averages over its facets, with dual shape functions Phi_i as
// weights:
//   jump_i = (1 / a_i) integral Phi_i (x - y) dA = sum_j w_ij x_j - sum_k w_ik y_k
//   x on the non-mortar side, y the point of the other side on the projection of x, a_i the integral
//   of Phi_i; the integrals go over the overlap of the facets (mortar/overlap.hpp)
//   normal  nu_i: inward, the mean of the facets around i;   gap_i = nu_i . jump_i
//   slip    the same average of the movements in an increment, with the weights at its end
// A reaction r_i acts with w_ij r_i on the own nodes and with -w_ik r_i on those of the other side.
// The weights of each side sum up to 1: action equals reaction. So does the moment, by a couple on
// the other side that takes up jump_i x r_i.
//                                                              [WO00], [PL04], [PGGW10], [GPGW10]
//
// Dual functions are those of the covered part of a facet [CB11]. Where that part
// is small, they go over into the usual shape functions, which stay positive.
//
// A surface that touches itself is both sides. Each pair of facets counts once: of two facets the
// one that comes first along the longest direction of the surface at rest is the non-mortar one, so
// that of the two flanks of a fold one is the non-mortar side as a whole. Facets around a facet
// never touch it: those that share a node with it, and those that share one with these.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/tensor/types.hpp"
#include "mechanics/contact/contact.hpp"
#include "mechanics/mesh/mesh.hpp"

namespace langer {

using QuadNodes = std::array<int, 4>;  // counter-clockwise from outside

// of a node, in a nodal field (3 n)
inline Vec3 position(const VecX& x, int node) {
  return x.segment<3>(3 * static_cast<Eigen::Index>(node));
}

// of all nodes (3 n), from those at rest and displacements (3 n)
VecX positions(const std::vector<Vec3>& X, const VecX& u);
VecX positions(const std::vector<Vec3>& X);  // at rest

struct SurfaceContact {
  std::string name;
  double mu = 0;
  std::vector<QuadNodes> own;    // facets of the non-mortar side
  std::vector<QuadNodes> other;  // of the side that it touches
  std::vector<int> nodes;        // of `own`, ascending: the candidates
  std::vector<int> all_nodes;    // of both sides, ascending
  double reach = 0;              // facets further from each other do not touch [mm]
  std::optional<Adhesion> adhesion = {};
  std::vector<double> area = {};  // with adhesion: of the surface at rest, by candidate [mm^2]
  // of a surface that touches itself, by facet; empty: two surfaces
  std::vector<int> rank;                     // place along the surface at rest
  std::vector<std::vector<int>> neighbours;  // facets around it, ascending
  bool touches_itself() const { return !rank.empty(); }
  // By candidate, which axes are across a plane of symmetry that it lies on; empty: none. The other
  // half of the scene is a mirror image, so a candidate there has no normal, slip or reaction
  // across the plane.
  std::vector<std::array<bool, 3>> mirrors = {};
  Vec3 within_mirrors(std::size_t candidate, Vec3 v) const {
    if (mirrors.empty()) return v;
    for (int axis = 0; axis < 3; ++axis)
      if (mirrors[candidate][static_cast<std::size_t>(axis)]) v[axis] = 0;
    return v;
  }
  // How many images of these surfaces a symmetric scene has: they are a part of it, and reactions
  // are the sums over all images. Areas are those of the part.
  double images = 1;
  // Whether a facet of `own` may touch one of `other`, by where they are on the surface.
  bool may_pair(int own_facet, int other_facet) const;
};

// facets: of hex8; the reach follows from their size
SurfaceContact surface_contact(const std::string& name, double mu, const Mesh& mesh,
                               const std::vector<Facet>& own, const std::vector<Facet>& other);
// The same of one surface that may touch itself.
SurfaceContact self_contact(const std::string& name, double mu, const Mesh& mesh,
                            const std::vector<Facet>& facets);

// Finds the planes of symmetry: the first or last nodes of the two surfaces along an axis, where
// supports hold all of them along it. held (3 n): degrees of freedom that do not move
void find_mirrors(SurfaceContact& contact, const Mesh& mesh, const std::vector<char>& held);

struct Weight {
  int node = 0;
  double of = 0;  // positive sum on the own side, negative on the other
};

// A candidate that has something opposite.
struct MortarNode {
  int candidate = 0;  // index in SurfaceContact::nodes
  double area = 0;    // a_i [mm^2]
  Vec3 normal = Vec3::Zero();
  Vec3 jump = Vec3::Zero();
  std::vector<Weight> own, other;
  std::array<bool, 3> mirrored{};  // axes across which there is no jump, slip or reaction
  Vec3 within_mirrors(Vec3 v) const {
    for (int axis = 0; axis < 3; ++axis)
      if (mirrored[static_cast<std::size_t>(axis)]) v[axis] = 0;
    return v;
  }
  double gap() const { return normal.dot(jump); }
  Vec3 average(const VecX& u) const;  // of a nodal field (3 n), own side less the other one
  Vec3 slip(const VecX& u) const;     // its part along the surface
};

// x (3 n) [mm]: positions of all nodes. Candidates in ascending order.
std::vector<MortarNode> mortar_nodes(const SurfaceContact& contact, const VecX& x);

// inward mean normals of all candidates
std::vector<Vec3> mortar_normals(const SurfaceContact& contact, const VecX& x);

// One force of a reaction r at a candidate on a node.
struct NodalForce {
  int node = 0;
  Mat3 per_reaction;  // force = per_reaction r
};
std::vector<NodalForce> force_operator(const MortarNode& node, const VecX& x);

// adds the forces of the reactions to f (3 n) [N]; reactions: by candidate, global
void add_mortar_forces(const std::vector<MortarNode>& nodes, const VecX& x,
                       const std::vector<Vec3>& reactions, VecX& f);

// How well a state satisfies the law; by candidate as contact_defect() reports it. x0: positions
// that the slip is measured from
ContactDefect mortar_defect(const SurfaceContact& contact, const std::vector<MortarNode>& nodes,
                            const VecX& x, const VecX& x0, const std::vector<Vec3>& reactions,
                            double motion);

}  // namespace langer
