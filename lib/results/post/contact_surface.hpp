// Contact as a result: reactions of the contact candidates per deformed area.
//
// The solver gives a reaction for each node of the surface that may touch. Divided by the part of
// the deformed surface that belongs to the node, it is a traction.
//   area of a node     integral of N_a da over the facets all of whose nodes are candidates, a
//                      vector along the outward normal [mm^2]
//   traction           force of the indenter on the body over that area [MPa]
//   pressure           its part along the inward normal [MPa]
//   area of contact    sum of the areas of the nodes that touch. It is too large by about half an
//                      element around its rim, because a node belongs to it entirely or not at all.
// In a section (mesh/section.hpp) areas are those of the whole circle or slab, as its reactions
// are.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/tensor/types.hpp"
#include "mechanics/mesh/mesh.hpp"
#include "results/post/quantity.hpp"
#include "results/store/solution_file.hpp"

namespace langer {

// The contact of one indenter in one state, per deformed area.
struct ContactPerArea {
  std::vector<Vec3> traction;    // (n) [MPa]; 0 at nodes without contact
  std::vector<double> pressure;  // (n) [MPa]; 0 at nodes without contact
  double area = 0;               // [mm^2]
  double radius = 0;             // of a circle with that area [mm]
  double pressure_max = 0;       // [MPa]
};

// The facets of the body that one indenter may touch.
class ContactSurface {
 public:
  ContactSurface(const Mesh& mesh, std::vector<int> candidates);  // refers to the mesh
  bool empty() const { return facets_.empty(); }
  ContactPerArea at(const std::vector<Vec3>& u, const ContactRecord& contact) const;  // u (n) [mm]

 private:
  void fold(std::vector<Vec3>& area) const;
  const Mesh& mesh_;
  std::vector<int> candidates_;
  std::vector<Facet> facets_;
};

// Adds contact_area, contact_radius and contact_pressure_max to the numbers of a state: the sum
// over all indenters. Without surfaces nothing is added.
void add_contact_numbers(std::map<std::string, double>& numbers,
                         const std::map<std::string, ContactSurface>& surfaces,
                         const StepRecord& record);

// Whether a column is one of contact_area, contact_radius and contact_pressure_max.
bool is_contact_surface_column(std::string_view column);

// Adds the contact of one indenter to the values of the nodes. `slip` (k) is that of its
// candidates [mm]; it is empty if it is not known.
void add_contact_nodes(std::vector<ContactNode>& nodes, const std::vector<int>& candidates,
                       const ContactPerArea& state, const ContactRecord& contact,
                       const std::vector<double>& slip);

}  // namespace langer
