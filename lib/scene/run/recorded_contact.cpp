#include "scene/run/recorded_contact.hpp"

#include <algorithm>
#include <limits>

namespace langer {

ContactStates::ContactStates(const SolutionReader& solution,
                             const std::vector<RigidContact>& indenters,
                             const std::vector<SurfaceContact>& touching)
    : solution_(solution), indenters_(indenters), touching_(touching) {
  for (const auto& [name, nodes] : solution.header().contact_nodes)
    surfaces_.emplace(name, ContactSurface(solution.header().mesh, nodes));
}

// Slip is a sum over the path: replays the steps up to `row`. Earlier rows start from the
// beginning.
void ContactStates::go_to(int row) const {
  const Mesh& mesh = solution_.header().mesh;
  if (!path_ || row < row_) {
    path_.emplace(energy_path(mesh, indenters_, solution_.header(), touching_));
    StepRecord rest;
    rest.u.assign(mesh.X.size(), Vec3::Zero());
    rest.reaction = rest.u;
    path_->add(energy_state(rest, indenters_, {}, touching_));
    row_ = 0;
  }
  for (; row_ < row; ++row_)
    path_->add(energy_state(solution_.step(row_), indenters_, {}, touching_));
}

std::vector<double> ContactStates::slip(const std::string& contact, int row) const {
  std::vector<std::string> names;
  for (const RigidContact& indenter : indenters_) names.push_back(indenter.name);
  for (const SurfaceContact& surface : touching_) names.push_back(surface.name);
  const auto found = std::ranges::find(names, contact);
  if (found == names.end()) return {};
  go_to(row);
  return path_->slip(static_cast<std::size_t>(found - names.begin()));
}

// The state of contact at each node of the mesh, over all indenters.
std::vector<ContactNode> ContactStates::nodes(int row, const StepRecord& record,
                                              bool with_slip) const {
  std::vector<ContactNode> nodes(solution_.header().mesh.X.size());
  for (const auto& [name, candidates] : solution_.header().contact_nodes) {
    const auto contact = record.contacts.find(name);
    if (contact == record.contacts.end()) {  // at rest
      for (int node : candidates) nodes[static_cast<std::size_t>(node)].status = 0;
      continue;
    }
    add_contact_nodes(nodes, candidates, surfaces_.at(name).at(record.u, contact->second),
                      contact->second, with_slip ? slip(name, row) : std::vector<double>());
  }
  return nodes;
}

namespace {

// Fields of one indenter as they were recorded at its candidates; other nodes have no value.
void add_record(std::vector<Field>& points, std::size_t n, const std::string& name,
                const std::vector<int>& nodes, const ContactRecord& contact) {
  Field status = field("contact_status_" + name, "-", 1, n, -1);  // -1: not a candidate
  Field force = field("contact_force_" + name, "N", 3, n);
  Field gap = field("contact_gap_" + name, "mm", 1, n, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto node = static_cast<std::size_t>(nodes[i]);
    status.values[node] = contact.status[i];
    put(force, node, contact.r[i]);
    gap.values[node] = contact.gap[i];
  }
  for (Field* f : {&status, &force, &gap}) points.push_back(std::move(*f));
  if (contact.beta.empty()) return;
  Field beta = field("adhesion_" + name, "-", 1, n, -1);
  Field bonds = field("adhesive_force_" + name, "N", 3, n);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto node = static_cast<std::size_t>(nodes[i]);
    beta.values[node] = contact.beta[i];
    put(bonds, node, contact.adhesive[i]);
  }
  for (Field* f : {&beta, &bonds}) points.push_back(std::move(*f));
}

}  // namespace

// Fields that follow from the record: tractions are forces by the area of each node.
void add_contact_fields(std::vector<Field>& points, const ContactStates& contacts,
                        const SolutionHeader& header, const StepRecord& record, int row) {
  const std::size_t n = header.mesh.X.size();
  for (const auto& [name, contact] : record.contacts) {
    const std::vector<int>& candidates = header.contact_nodes.at(name);
    add_record(points, n, name, candidates, contact);
    const ContactPerArea state = contacts.surfaces().at(name).at(record.u, contact);
    Field traction = field("contact_traction_" + name, "MPa", 3, n);
    for (std::size_t i = 0; i < n; ++i) put(traction, i, state.traction[i]);
    points.push_back(std::move(traction));
    points.push_back({"contact_pressure_" + name, "MPa", 1, state.pressure});
    const std::vector<double> slip = contacts.slip(name, row);
    if (slip.empty()) continue;
    Field way = field("contact_slip_" + name, "mm", 1, n);
    for (std::size_t i = 0; i < slip.size(); ++i)
      way.values[static_cast<std::size_t>(candidates[i])] = slip[i];
    points.push_back(std::move(way));
  }
}

}  // namespace langer
