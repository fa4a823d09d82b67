// Stress, dilatation and fibre stretch of one state of a body: at Gauss points, as element means,
// at nodes.   [A23] eqs 17-21
//   a row of values   Cauchy stress 11 22 33 12 23 13 [MPa] | J [-] | fibre stretch sqrt(I4_bar) of each family [-]
//   element mean      weighted with the Gauss points' shares of the reference volume
//   node              nodal_average: the trilinear field through the 8 Gauss points (hex27: nearest to the 27), taken at the
//                     element's node; nearest_gauss: the Gauss point nearest to the node. Both averaged over the elements at the node,
//                     weighted with reference volume, within one region (bodies of different materials never mix;
//                     a node between two regions shows the lower numbered one). J is kept within the values of each cell's own points:
//                     near incompressibility the field through them has swings that no material has.
// Rows are averaged; von Mises, pressure and principal stresses are taken of the averaged row, so
// that what a table shows fits together. Pressure is the mean stress tr(sigma)/3, positive in
// tension.
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

// What a solution says of the body, with what follows from it for every state.
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
  int n_families() const { return n_families_; }    // the most that any cell has
  int n_values() const { return 7 + n_families_; }  // length of a row
  // Of a viscous body's state: sum of the branch stresses at the Gauss points of each cell [MPa];
  // gauss_values() has those told last.
  void tell_branches(std::vector<std::vector<Vec6>> branches) { branches_ = std::move(branches); }
  std::span<const Vec6> branches(int e) const {
    if (branches_.empty()) return std::span<const Vec6>();
    return branches_[static_cast<std::size_t>(e)];
  }
  bool viscous() const { return ViscousPoints::needed(materials_); }
  const std::vector<Material>& materials() const { return materials_; }
  // (cell, its local node) at a node, of the region that the node shows
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
ElementValues gauss_values(const Body& body, const std::vector<Vec3>& u,
                           int e);  // u (n) [mm]; families a cell lacks: 1
VecX element_mean(const Body& body, int e, const ElementValues& gauss);
Mat3 mean_deformation_gradient(const Body& body, const std::vector<Vec3>& u, int e);
Vec3 gauss_position(const Mesh& mesh, int e, int g);  // reference [mm]

// A state's Gauss values by element; elements not asked for are empty.
using GaussValues = std::vector<ElementValues>;
GaussValues gauss_values(const Body& body, const std::vector<Vec3>& u);
void add_gauss_values(const Body& body, const std::vector<Vec3>& u, int e,
                      GaussValues& gauss);  // unless they are there

// needs the Gauss values of the elements at the node
VecX node_values(const Body& body, int node, const GaussValues& gauss, StressAt at);

// What a row holds.
inline Mat3 sigma_of(const VecX& row) { return tensor(Vec6(row.head<6>())); }
inline double J_of(const VecX& row) { return row[6]; }
inline double fibre_stretch_of(const VecX& row, int family) { return row[7 + family]; }

}  // namespace langer
