#include "post/contact_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "element/surface.hpp"
#include "mesh/select.hpp"

namespace langer {

ContactSurface::ContactSurface(const Mesh& mesh, std::vector<int> candidates) : mesh_(mesh), candidates_(std::move(candidates)) {
  std::vector<int> sorted = candidates_;
  std::sort(sorted.begin(), sorted.end());
  facets_ = facets_within(mesh, boundary(mesh), sorted);
}

ContactPerArea ContactSurface::at(const std::vector<Vec3>& u, const ContactRecord& contact) const {
  std::vector<Vec3> area(mesh_.X.size(), Vec3::Zero());  // inward
  for (const Facet& facet : facets_) {
    ElementNodes x = element_nodes(mesh_, facet.cell);
    const auto nodes = mesh_.cell(facet.cell);
    for (Eigen::Index a = 0; a < x.rows(); ++a)
      x.row(a) += u[static_cast<std::size_t>(nodes[static_cast<std::size_t>(a)])].transpose();
    const ElementNodes force = follower_pressure(mesh_.cell(), facet.local, x);  // of 1 MPa: the area, inwards
    for (Eigen::Index a = 0; a < x.rows(); ++a)
      area[static_cast<std::size_t>(nodes[static_cast<std::size_t>(a)])] += force.row(a).transpose();
  }
  ContactPerArea state{std::vector<Vec3>(area.size(), Vec3::Zero()), std::vector<double>(area.size(), 0)};
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const auto node = static_cast<std::size_t>(candidates_[i]);
    const double size = area[node].norm();
    if (contact.status[i] == 0 || !(size > 0)) continue;
    state.traction[node] = contact.r[i] / size;
    state.pressure[node] = state.traction[node].dot(area[node]) / size;
    state.area += size;
    state.pressure_max = std::max(state.pressure_max, state.pressure[node]);
  }
  state.radius = std::sqrt(state.area / std::numbers::pi);
  return state;
}

void add_contact_numbers(std::map<std::string, double>& numbers, const std::map<std::string, ContactSurface>& surfaces,
                         const StepRecord& record) {
  double area = 0, pressure = 0;
  for (const auto& [name, contact] : record.contacts) {
    const auto surface = surfaces.find(name);
    if (surface == surfaces.end()) continue;
    const ContactPerArea state = surface->second.at(record.u, contact);
    area += state.area, pressure = std::max(pressure, state.pressure_max);
  }
  if (surfaces.empty()) return;
  numbers["contact_area"] = area, numbers["contact_radius"] = std::sqrt(area / std::numbers::pi);
  numbers["contact_pressure_max"] = pressure;
}

bool is_of_contact_surface(std::string_view column) {
  return column == "contact_area" || column == "contact_radius" || column == "contact_pressure_max";
}

}  // namespace langer
