// Stress, dilatation and fibre stretch of one state of a body: at Gauss points, as means of
// elements, at nodes.   [A23] eqs 17-21
//   a row of values   Cauchy stress 11 22 33 12 23 13 [MPa] | J [-] | fibre stretch sqrt(I4_bar) of
//                     each family [-]
//   element mean      weighted with the shares of the Gauss points in the reference volume
//   node, nodal_average   the trilinear field through the 8 Gauss points (hex27: closest to the
//                         27), extrapolated to the node of the element
//   node, nearest_gauss   the Gauss point closest to the node
// Both are averaged over the elements at a node, weighted with their reference volume. The average
// is taken within one region, because stress jumps between materials; a node between two regions
// shows the region with the lower number. J stays within the values at the Gauss points of its
// element: near incompressibility the extrapolated field oscillates. Rows are averaged first. Von
// Mises, pressure and principal stresses are computed from the averaged row, so that the columns of
// a table are consistent. Pressure is the mean stress tr(sigma)/3, positive in tension.
#pragma once

#include <span>
#include <vector>

#include "core/base/fields.hpp"
#include "core/tensor/voigt.hpp"
#include "mechanics/element/solid.hpp"
#include "mechanics/mesh/directions.hpp"
#include "mechanics/mesh/mesh.hpp"

namespace langer {

enum class StressAt { nodal_average, nearest_gauss };
constexpr auto names(StressAt) { return std::array{"nodal_average", "nearest_gauss"}; }

// The body of a solution, with everything that all its states share: geometry of the elements,
// materials and fibre directions.
class Body {
 public:
  // materials: one for all cells, or one per body of the mesh; the mesh must outlive this
  Body(const Mesh& mesh, std::vector<Material> materials, Directions directions,
       Formulation formulation);

  const Mesh& mesh() const { return mesh_; }
  Formulation formulation() const { return formulation_; }
  const Material& material(int e) const { return materials_[region(e)]; }
  int region(int e) const {
    if (materials_.size() > 1) return mesh_.body[e];
    return 0;
  }
  const ElementGeometry& geometry(int e) const { return geometry_[e]; }
  std::span<const Vec3> fibres(int e) const { return directions_.of(e); }  // unit, reference state
  int n_families() const { return n_families_; }    // the largest number in any element
  int n_values() const { return 7 + n_families_; }  // length of a row
  // The state of a viscous body: the sum of its branch stresses at the Gauss points of each element
  // [MPa]. gauss_values() adds the branches that were set last.
  void set_branches(std::vector<std::vector<Vec6>> branches) { branches_ = std::move(branches); }
  std::span<const Vec6> branches(int e) const {
    if (branches_.empty()) return std::span<const Vec6>();
    return branches_[static_cast<std::size_t>(e)];
  }
  bool viscous() const { return ViscousPoints::needed(materials_); }
  const std::vector<Material>& materials() const { return materials_; }
  // An element at a node and the number of the node in it. Only elements of the region that the
  // node shows are listed.
  struct Corner {
    int cell, local;
  };
  std::span<const Corner> corners(int node) const {
    return {corners_.data() + first_[node], corners_.data() + first_[node + 1]};
  }

 private:
  const Mesh& mesh_;
  std::vector<Material> materials_;
  Directions directions_;
  Formulation formulation_;
  int n_families_;
  std::vector<ElementGeometry> geometry_;
  std::vector<std::vector<Vec6>> branches_;
  std::vector<std::size_t> first_;
  std::vector<Corner> corners_;
};

// Row g: values at Gauss point g, or at local node g.
using ElementValues = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

ElementNodes element_displacements(const Mesh& mesh, const std::vector<Vec3>& u, int e);
// The rows of an element, u (n) [mm]. Fibre families that its material lacks have stretch 1.
ElementValues gauss_values(const Body& body, const std::vector<Vec3>& u, int e);
VecX element_mean(const Body& body, int e, const ElementValues& gauss);
Mat3 mean_deformation_gradient(const Body& body, const std::vector<Vec3>& u, int e);
Vec3 gauss_position(const Mesh& mesh, int e, int g);  // reference [mm]

// The Gauss values of a state by element. Elements that were not computed yet are empty.
using GaussValues = std::vector<ElementValues>;
GaussValues gauss_values(const Body& body, const std::vector<Vec3>& u);
// Computes the values of element e unless `gauss` has them.
void add_gauss_values(const Body& body, const std::vector<Vec3>& u, int e, GaussValues& gauss);

// The row of a node. `gauss` must have the values of the elements at the node.
VecX node_values(const Body& body, int node, const GaussValues& gauss, StressAt at);

// The parts of a row.
inline Mat3 sigma_of(const VecX& row) { return tensor(Vec6(row.head<6>())); }
inline double J_of(const VecX& row) { return row[6]; }
inline double fibre_stretch_of(const VecX& row, int family) { return row[7 + family]; }

}  // namespace langer
