// A meshed body as the assembly sees it: elements, their materials and fibre directions, and the
// degrees of freedom that move their nodes.
//
// The body model does not depend on the displacements. It answers the same questions for every
// element e, whatever the mesh:
//   material(e), fibres(e), geometry(e)   what the element is made of, and its integration points
//   displacements(u, e)                   displacements of the nodes that move the element
//   add_force(f, node, e, force)          where the force of one of its nodes goes
// Nodes may be tied: by symmetry, by a section, or because they hang in the middle of a larger
// element's facet. An element of a body that symmetry reduces stands for several elements of the
// whole body; its weights are multiplied by their number (cell_share).
//
// On several ranks, every rank knows the mesh. A rank assembles only its own elements; only rank 0
// has the geometry of all of them.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mechanics/assembly/division.hpp"
#include "mechanics/assembly/dofs.hpp"
#include "mechanics/element/formulation.hpp"
#include "mechanics/element/geometry.hpp"
#include "mechanics/material/material.hpp"
#include "mechanics/mesh/directions.hpp"
#include "mechanics/mesh/hanging.hpp"
#include "mechanics/mesh/mesh.hpp"

namespace langer {

class BodyModel {
 public:
  // Refers to the mesh. cell_share: by element; empty: one each. division: none on a single rank.
  BodyModel(const Mesh& mesh, std::vector<Material> materials, Directions directions,
            Formulation formulation, Dofs dofs, const std::vector<double>& cell_share,
            std::optional<Division> division);

  const Mesh& mesh() const { return mesh_; }
  const Dofs& dofs() const { return dofs_; }
  const MovingNodes& moving_nodes() const { return moving_; }
  Formulation formulation() const { return formulation_; }

  // Elements that this rank assembles, ascending.
  const std::vector<int>& own_cells() const { return own_; }
  // How the elements are divided among ranks; nullptr: all of them belong to this one.
  const Division* division() const {
    if (division_) return &*division_;
    return nullptr;
  }

  // Numbers of one element: nodes, degrees of freedom, dilatations (or pressures).
  int n_nodes() const { return n_nodes_; }
  int n_dofs() const { return 3 * n_nodes_; }
  int n_pressures() const { return n_pressures_; }

  const std::vector<Material>& materials() const { return materials_; }
  const Directions& directions() const { return directions_; }
  const Material& material(int e) const {
    return materials_[mesh_.body.empty() ? 0 : mesh_.body[e]];
  }
  double bulk_modulus(int e) const { return langer::bulk_modulus(material(e)); }  // undeformed, MPa
  std::span<const Vec3> fibres(int e) const { return directions_.of(e); }
  void set_materials(std::vector<Material> materials, Directions directions);

  const ElementGeometry& geometry(int e) const { return geometry_[e]; }
  std::span<const int> nodes(int e) const { return moving_.of(e); }
  // True if a node of the element moves as another one does.
  bool tied(int e) const { return !tied_.empty() && tied_[e] != 0; }

  // Displacements (n_nodes, 3) of the nodes that move the element, of u (3 n).
  ElementNodes displacements(const VecX& u, int e) const;
  // Adds the force of a node of element e to the unknowns that the node moves with.
  void add_force(VecX& forces, int node, int e, const Vec3& force) const;
  // By element: the unknowns that move its nodes, (n_dofs) each.
  std::vector<int> element_dofs() const;

 private:
  void make_geometry(const std::vector<double>& cell_share);
  void find_tied_elements();

  const Mesh& mesh_;
  std::vector<Material> materials_;
  Directions directions_;
  Formulation formulation_;
  Dofs dofs_;
  std::optional<Division> division_;
  std::vector<int> own_;
  MovingNodes moving_;
  int n_nodes_;
  int n_pressures_;
  std::vector<ElementGeometry> geometry_;
  std::vector<char> tied_;  // by element; empty if no node is tied
};

}  // namespace langer
