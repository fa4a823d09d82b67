#include "results/post/contact_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mechanics/element/surface.hpp"
#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/hanging.hpp"
#include "mechanics/mesh/section.hpp"
#include "mechanics/mesh/select.hpp"

namespace langer {

ContactSurface::ContactSurface(const Mesh& mesh, std::vector<int> candidates)
    : mesh_(mesh), candidates_(std::move(candidates)) {
  std::vector<int> nodes = candidates_;
  if (mesh.section) nodes = through_layers(mesh, candidates_);
  facets_ = facets_within(mesh, boundary(mesh), with_hanging(mesh, nodes));
  if (!mesh.section) return;
  // Facets with all nodes in one layer are in the planes of the section, not on the surface.
  const int layer = n_front(mesh);
  std::erase_if(facets_, [&](const Facet& facet) {
    const auto nodes = facet_nodes(mesh, facet);
    return std::ranges::all_of(nodes, [&](int node) { return node / layer == nodes[0] / layer; });
  });
}

// Adds the areas of the nodes behind z = 0 of a section to those in front, which they move with.
// The elements count as often as the section says.
void ContactSurface::fold(std::vector<Vec3>& area) const {
  const auto layer = static_cast<std::size_t>(n_front(mesh_));
  for (std::size_t i = layer; i < area.size(); ++i) area[i % layer] += area[i];
  const double share = cell_share(*mesh_.section);
  for (std::size_t i = 0; i < area.size(); ++i) {
    if (i < layer) {
      area[i] = share * Vec3(area[i][0], area[i][1], 0);
    } else {
      area[i].setZero();
    }
  }
}

// Areas of the nodes first, then the reaction of each node in contact over its area. Hanging
// nodes give their area to the nodes that they hang on, and get their traction from them.
ContactPerArea ContactSurface::at(const std::vector<Vec3>& u, const ContactRecord& contact) const {
  // The nodal forces of a pressure of 1 MPa on the deformed facets are the areas, along the inward
  // normal.
  std::vector<Vec3> area(mesh_.X.size(), Vec3::Zero());
  for (const Facet& facet : facets_) {
    ElementNodes x = element_nodes(mesh_, facet.cell);
    const auto nodes = mesh_.cell(facet.cell);
    for (Eigen::Index a = 0; a < x.rows(); ++a)
      x.row(a) += u[static_cast<std::size_t>(nodes[static_cast<std::size_t>(a)])].transpose();
    const ElementNodes force = follower_pressure(mesh_.cell(), facet.local, x);
    for (Eigen::Index a = 0; a < x.rows(); ++a)
      area[static_cast<std::size_t>(nodes[static_cast<std::size_t>(a)])] +=
          force.row(a).transpose();
  }
  if (mesh_.section) fold(area);
  fold_hanging(mesh_, area);
  ContactPerArea state{std::vector<Vec3>(area.size(), Vec3::Zero()),
                       std::vector<double>(area.size(), 0)};
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const auto node = static_cast<std::size_t>(candidates_[i]);
    const double size = area[node].norm();
    if (contact.status[i] == 0 || !(size > 0)) continue;
    state.traction[node] = contact.r[i] / size;
    state.pressure[node] = state.traction[node].dot(area[node]) / size;
    state.area += size;
    state.pressure_max = std::max(state.pressure_max, state.pressure[node]);
  }
  spread_to_hanging(mesh_, state.traction);
  spread_to_hanging(mesh_, state.pressure);
  state.radius = std::sqrt(state.area / std::numbers::pi);
  return state;
}

void add_contact_numbers(std::map<std::string, double>& numbers,
                         const std::map<std::string, ContactSurface>& surfaces,
                         const StepRecord& record) {
  double area = 0, pressure = 0;
  for (const auto& [name, contact] : record.contacts) {
    const auto surface = surfaces.find(name);
    if (surface == surfaces.end()) continue;
    const ContactPerArea state = surface->second.at(record.u, contact);
    area += state.area;
    pressure = std::max(pressure, state.pressure_max);
  }
  if (surfaces.empty()) return;
  numbers["contact_area"] = area;
  numbers["contact_radius"] = std::sqrt(area / std::numbers::pi);
  numbers["contact_pressure_max"] = pressure;
}

void add_contact_nodes(std::vector<ContactNode>& nodes, const std::vector<int>& candidates,
                       const ContactPerArea& state, const ContactRecord& contact,
                       const std::vector<double>& slip) {
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const auto node = static_cast<std::size_t>(candidates[i]);
    ContactNode& here = nodes[node];
    const double pressure = state.pressure[node];
    const double traction = state.traction[node].norm();
    here.status = std::max(here.status, contact.status[i]);
    if (!slip.empty()) here.slip = std::max(here.slip, slip[i]);
    // Of several indenters the one with the greatest pressure is shown.
    if (traction == 0 || pressure < here.pressure) continue;
    here.pressure = pressure;
    here.friction = std::sqrt(std::max(0.0, traction * traction - pressure * pressure));
  }
}

bool is_contact_surface_column(std::string_view column) {
  return column == "contact_area" || column == "contact_radius" || column == "contact_pressure_max";
}

}  // namespace langer
