// Contact as a result: what the reactions of the candidates are per area of the deformed surface
// that may touch.
//   area of a node     integral N_a da over the facets all of whose nodes are candidates, a vector along the outward normal [mm^2]
//   traction           force of the indenter on the body over that area [MPa];  pressure: its part along the inward normal
//   area of contact    sum of the areas of the nodes that touch: too large by about half a cell around its rim
// Of a section (mesh/section.hpp) areas are those of the whole circle, or of the slab, as its
// reactions are.
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

struct ContactPerArea {
  std::vector<Vec3> traction;                     // (n) [MPa]; 0 where nothing touches
  std::vector<double> pressure;                   // (n) [MPa]; 0 where nothing touches
  double area = 0, radius = 0, pressure_max = 0;  // [mm^2]; of a circle of that area [mm]; [MPa]
};

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

// Adds contact_area, contact_radius and contact_pressure_max of all indenters together to the
// numbers of a state; nothing without surfaces.
void add_contact_numbers(std::map<std::string, double>& numbers,
                         const std::map<std::string, ContactSurface>& surfaces,
                         const StepRecord& record);

// the columns that it gives: contact_area, contact_radius, contact_pressure_max
bool is_of_contact_surface(std::string_view column);

// Adds what one indenter does to the nodes; slip (k) of its candidates [mm], empty where it is not
// known.
void add_contact_nodes(std::vector<ContactNode>& nodes, const std::vector<int>& candidates,
                       const ContactPerArea& state, const ContactRecord& contact,
                       const std::vector<double>& slip);

}  // namespace langer
