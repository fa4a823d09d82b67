#include "run/post_files.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "config/reader.hpp"
#include "scene/solve_config.hpp"
#include "tensor/stress.hpp"

namespace langer {

namespace {

Field field(std::string name, std::string unit, int components, std::size_t rows, double value = 0) {
  return {std::move(name), std::move(unit), components, std::vector<double>(rows * components, value)};
}

void put(Field& f, std::size_t row, const auto& values) {
  for (int i = 0; i < f.components; ++i) f.values[row * f.components + i] = values[i];
}

// What follows from a row of values, at points and in cells alike.
struct StressFields {
  Field sigma, von_mises, pressure, principal, J;
  std::vector<Field> stretch;
  StressFields(std::size_t rows, int families)
      : sigma(field("sigma", "MPa", 6, rows)),
        von_mises(field("von_mises", "MPa", 1, rows)),
        pressure(field("pressure", "MPa", 1, rows)),
        principal(field("principal_stresses", "MPa", 3, rows)),
        J(field("J", "-", 1, rows)) {
    for (int k = 0; k < families; ++k) stretch.push_back(field(fmt::format("fibre_stretch_{}", k + 1), "-", 1, rows));
  }
  void put_row(std::size_t row, const VecX& values) {
    const Mat3 stress = sigma_of(values);
    put(sigma, row, values);
    von_mises.values[row] = langer::von_mises(stress);
    pressure.values[row] = mean_stress(stress);
    put(principal, row, principal_stresses(stress));
    J.values[row] = J_of(values);
    for (std::size_t k = 0; k < stretch.size(); ++k) stretch[k].values[row] = fibre_stretch_of(values, static_cast<int>(k));
  }
  void move_to(std::vector<Field>& fields) {
    for (Field* f : {&sigma, &von_mises, &pressure, &principal, &J}) fields.push_back(std::move(*f));
    for (Field& f : stretch) fields.push_back(std::move(f));
  }
};

void add_contact(std::vector<Field>& points, std::size_t n, const std::string& name, const std::vector<int>& nodes,
                 const ContactRecord& contact) {
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
}

}  // namespace

void BranchRows::go_to(int row) {
  if (!body_.viscous()) return;
  if (!path_ || row < row_) path_.emplace(body_), row_ = 0;
  for (; row_ < row; ++row_) {
    const StepRecord next = solution_.step(row_);
    path_->add(body_, next.scalars.at("time"), next.u);
  }
  path_->tell(body_);
}

Formulation formulation_of(const SolutionHeader& header, const std::string& path) {
  const auto words = names(Formulation{});
  for (std::size_t i = 0; i < words.size(); ++i)
    if (header.formulation == words[i]) return static_cast<Formulation>(i);
  throw Failure(
      Exit::input,
      Error{{path}, "formulation", "\"" + header.formulation + "\"", "mean_dilatation, displacement or linear_dilatation", ""});
}

StepState state_of(const StepRecord& record) {
  StepState state;
  state.t = record.t, state.increment = record.increment, state.residual = record.residual;
  state.iterations = record.iterations;
  state.u = record.u, state.reaction = record.reaction;
  state.u_ind = record.u_ind, state.force_ind = record.force_ind;
  for (const auto& [name, contact] : record.contacts)
    for (int status : contact.status) state.stick += status == 1, state.slip += status == 2;
  state.histories = record.scalars;
  return state;
}

SnapshotFields snapshot_fields(const Body& body, const SolutionHeader& header, const StepRecord& record, StressAt at) {
  const Mesh& mesh = body.mesh();
  const std::size_t n = mesh.X.size(), n_cells = static_cast<std::size_t>(mesh.n_cells());
  const GaussValues gauss = gauss_values(body, record.u);
  SnapshotFields out;

  Field u = field("u", "mm", 3, n), reaction = field("reaction", "N", 3, n);
  StressFields at_nodes(n, body.n_families());
  for (std::size_t i = 0; i < n; ++i) {
    put(u, i, record.u[i]);
    put(reaction, i, record.reaction[i]);
    at_nodes.put_row(i, node_values(body, static_cast<int>(i), gauss, at));
  }
  out.points = {std::move(u), std::move(reaction)};
  at_nodes.move_to(out.points);
  for (const auto& [name, contact] : record.contacts) add_contact(out.points, n, name, header.contact_nodes.at(name), contact);

  StressFields means(n_cells, body.n_families());
  std::vector<Field> before, after;
  for (int k = 0; k < body.n_families(); ++k) {
    before.push_back(field(fmt::format("fibre_{}", k + 1), "-", 3, n_cells));
    after.push_back(field(fmt::format("fibre_{}_deformed", k + 1), "-", 3, n_cells));
  }
  for (std::size_t e = 0; e < n_cells; ++e) {
    const int cell = static_cast<int>(e);
    means.put_row(e, element_mean(body, cell, gauss[e]));
    const Mat3 F = mean_deformation_gradient(body, record.u, cell);
    for (std::size_t k = 0; k < body.fibres(cell).size(); ++k) {
      put(before[k], e, body.fibres(cell)[k]);
      put(after[k], e, Vec3(F * body.fibres(cell)[k]));  // as long as the fibre is stretched
    }
  }
  means.move_to(out.cells);
  for (auto* fibres : {&before, &after})
    for (Field& f : *fibres) out.cells.push_back(std::move(f));
  return out;
}

std::vector<double> picture_values(const Body& body, const StepState& state, Quantity field, int family, StressAt at) {
  std::vector<double> values;
  if (const OfNodes* of = std::get_if<OfNodes>(&line_of(field).value)) {
    for (const Vec3& u : state.u) values.push_back((*of)(u));
    return values;
  }
  const GaussValues gauss = gauss_values(body, state.u);
  for (int node = 0; node < body.mesh().n_nodes(); ++node)
    values.push_back(value_of(field, node_values(body, node, gauss, at), family - 1));
  return values;
}

std::vector<RigidContact> indenters_of(const SolutionHeader& header) {
  std::vector<RigidContact> indenters;
  if (header.contact_nodes.empty()) return indenters;
  try {
    const auto solve = read_config<SolveConfig>(parse_yaml(header.identity.config, "the solution's config")).config;
    for (const auto& [name, contact] : solve.contacts) {
      if (!header.contact_nodes.count(name)) return {};
      RigidContact indenter{name, contact.rigid, contact.friction, header.contact_nodes.at(name), {}};
      if (auto* facets = std::get_if<Facets>(&indenter.shape)) {
        const auto surface = header.indenter_surfaces.find(name);
        if (surface == header.indenter_surfaces.end()) continue;
        facets->tree = std::make_shared<TriangleTree>(surface->second);
      }
      for (const WaypointConfig& w : contact.motion)
        indenter.motion.push_back({place(w, solve.path), Vec3(w.to[0], w.to[1], w.to[2])});
      indenters.push_back(std::move(indenter));
    }
  } catch (const Failure&) {
    return {};  // written by another version of solve
  }
  return indenters;
}

std::vector<Action> actions_of(const SolutionHeader& header, const std::vector<Vec3>& u) {
  constexpr std::size_t most = 9;
  const Mesh& mesh = header.mesh;
  std::vector<Action> actions;
  Vec3 middle = Vec3::Zero();
  for (const Vec3& X : mesh.X) middle += X / static_cast<double>(mesh.X.size());
  const auto add = [&](const std::string& set, int axis, double to) {
    const auto found = mesh.node_sets.find(set);
    if (found == mesh.node_sets.end() || found->second.empty()) return;
    const std::vector<int>& nodes = found->second;
    Action action;
    Vec3 centre = Vec3::Zero();
    for (int node : nodes) centre += mesh.X[node] / static_cast<double>(nodes.size());
    const std::size_t n = std::min(most, nodes.size());
    for (std::size_t i = 0; i < n; ++i) {
      const int node = nodes[n > 1 ? i * (nodes.size() - 1) / (n - 1) : 0];
      action.at.push_back(mesh.X[node] + u[node]);
    }
    action.moves = to != 0;
    const double way = action.moves ? to : middle[axis] - centre[axis];
    action.along = (way < 0 ? -1 : 1) * Vec3::Unit(axis);
    action.says = fmt::format("u_{} = {:g}{}", "xyz"[axis], to, action.moves ? " mm" : "");
    actions.push_back(std::move(action));
  };
  try {
    const auto solve = read_config<SolveConfig>(parse_yaml(header.identity.config, "the solution's config")).config;
    for (const SupportConfig& support : solve.supports)
      for (Axis axis : support.hold) add(support.on, static_cast<int>(axis), 0);
    for (const LoadConfig& load : solve.loads)
      for (int axis = 0; axis < 3; ++axis)
        if (const auto& to = axis == 0 ? load.displacement.x : axis == 1 ? load.displacement.y : load.displacement.z)
          add(load.on, axis, *to);
  } catch (const Failure&) {
    return {};  // written by another version of solve
  }
  return actions;
}

std::vector<std::string> indenters_missing(const SolutionHeader& header, const std::vector<RigidContact>& indenters) {
  std::vector<std::string> names;
  for (const auto& contact : header.contact_nodes) {
    const std::string& name = contact.first;
    if (std::none_of(indenters.begin(), indenters.end(), [&](const RigidContact& c) { return c.name == name; }))
      names.push_back(name);
  }
  return names;
}

Shown shown_of(const Mesh& mesh) {
  Vec3 low = mesh.X[0], high = mesh.X[0];
  for (const Vec3& X : mesh.X) low = low.cwiseMin(X), high = high.cwiseMax(X);
  return {0.5 * (low + high), (high - low).norm()};
}

Outline outline_at(const RigidContact& indenter, double t, const Shown& shown) {
  const Vec3 u = indenter_displacement(indenter, t);
  Outline moved = outline(indenter.shape, {shown.middle - u, shown.size, shown.parts});
  for (Vec3& x : moved.points) x += u;
  return moved;
}

EnergyPath::State energy_state(const StepRecord& record, const std::vector<RigidContact>& indenters) {
  EnergyPath::State state{record.t, record.u, record.reaction, {}, 0};
  for (const RigidContact& indenter : indenters) {
    const auto found = record.contacts.find(indenter.name);  // the unloaded state has none
    state.r.push_back(found == record.contacts.end() ? std::vector<Vec3>(indenter.nodes.size(), Vec3::Zero()) : found->second.r);
  }
  for (const char* part : {"energy", "viscous_work"})
    if (const auto stored = record.scalars.find(part); stored != record.scalars.end()) state.stored += stored->second;
  return state;
}

}  // namespace langer
