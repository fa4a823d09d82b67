#include "scene/run/post_files.hpp"
#include "scene/model/scene_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/tensor/stress.hpp"
#include "mechanics/mesh/bounding_box.hpp"
#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/section.hpp"
#include "scene/model/scene_bodies.hpp"
#include "scene/model/scene_loads.hpp"
#include "scene/model/solve_config.hpp"
#include "scene/model/solve_config_io.hpp"
#include "scene/run/recorded_config.hpp"
#include "scene/run/recorded_contact.hpp"
#include "scene/run/step_record.hpp"

namespace langer {

namespace {

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
    for (int k = 0; k < families; ++k)
      stretch.push_back(field(fmt::format("fibre_stretch_{}", k + 1), "-", 1, rows));
  }
  void put_row(std::size_t row, const VecX& values) {
    const Mat3 stress = sigma_of(values);
    put(sigma, row, values);
    von_mises.values[row] = langer::von_mises(stress);
    pressure.values[row] = mean_stress(stress);
    put(principal, row, principal_stresses(stress));
    J.values[row] = J_of(values);
    for (std::size_t k = 0; k < stretch.size(); ++k)
      stretch[k].values[row] = fibre_stretch_of(values, static_cast<int>(k));
  }
  void move_to(std::vector<Field>& fields) {
    for (Field* f : {&sigma, &von_mises, &pressure, &principal, &J})
      fields.push_back(std::move(*f));
    for (Field& f : stretch) fields.push_back(std::move(f));
  }
};

}  // namespace

// Stresses of viscous branches depend on all states before. Rows are therefore followed from the
// first one; a row that lies before the last one starts again.
void BranchRows::go_to(int row) {
  if (!body_.viscous()) return;
  if (!path_ || row < row_) {
    path_.emplace(body_);
    row_ = 0;
  }
  for (; row_ < row; ++row_) {
    const StepRecord next = solution_.step(row_);
    path_->add(body_, next.scalars.at("time"), next.u);
  }
  path_->update(body_);
}

Formulation formulation_of(const SolutionHeader& header, const std::string& path) {
  const auto words = names(Formulation{});
  for (std::size_t i = 0; i < words.size(); ++i)
    if (header.formulation == words[i]) return static_cast<Formulation>(i);
  throw Failure(Exit::input, Error{{path},
                                   "formulation",
                                   "\"" + header.formulation + "\"",
                                   "mean_dilatation, displacement or linear_dilatation",
                                   ""});
}

// What a table or picture shows of a step. Statuses of contact: 1 sticks, 2 slips.
StepState state_of(const StepRecord& record) {
  StepState state;
  state.t = record.t;
  state.increment = record.increment;
  state.residual = record.residual;
  state.iterations = record.iterations;
  state.u = record.u;
  state.reaction = record.reaction;
  state.u_ind = record.u_ind;
  state.force_ind = record.force_ind;
  for (const auto& [name, contact] : record.contacts)
    for (int status : contact.status) {
      state.stick += status == 1;
      state.slip += status == 2;
    }
  state.histories = record.scalars;
  if (const auto v = record.point_fields.find(velocity_field); v != record.point_fields.end()) {
    state.velocity = v->second;
    state.acceleration = record.point_fields.at(acceleration_field);
  }
  return state;
}

SnapshotFields snapshot_fields(const Body& body, const SolutionHeader& header,
                               const StepRecord& record, int row, const ContactStates& contacts,
                               StressAt at) {
  const Mesh& mesh = body.mesh();
  const std::size_t n = mesh.X.size();
  const std::size_t n_cells = static_cast<std::size_t>(mesh.n_cells());
  const GaussValues gauss = gauss_values(body, record.u);
  SnapshotFields out;

  // Fields at nodes: stresses are averages of the elements around a node.

  Field u = field("u", "mm", 3, n);
  Field reaction = field("reaction", "N", 3, n);
  StressFields at_nodes(n, body.n_families());
  for (std::size_t i = 0; i < n; ++i) {
    put(u, i, record.u[i]);
    put(reaction, i, record.reaction[i]);
    at_nodes.put_row(i, node_values(body, static_cast<int>(i), gauss, at));
  }
  out.points = {std::move(u), std::move(reaction)};
  at_nodes.move_to(out.points);
  add_contact_fields(out.points, contacts, header, record, row);

  // Fields in elements: means over the Gauss points, and the fibres before and after deformation.
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
  out.cells.push_back(means.J);  // first, and so the one that viewers show: at nodes it is smoothed
  means.move_to(out.cells);
  out.cells.erase(std::find_if(out.cells.begin() + 1, out.cells.end(),
                               [](const Field& f) { return f.name == "J"; }));
  for (auto* fibres : {&before, &after})
    for (Field& f : *fibres) out.cells.push_back(std::move(f));
  return out;
}

// A picture shows one quantity at nodes. Some follow from displacements or from contact alone; only
// the others need stresses.
std::vector<double> picture_values(const Body& body, const StepState& state, Quantity field,
                                   int family, StressAt at) {
  std::vector<double> values;
  if (const OfNodes* of = std::get_if<OfNodes>(&line_of(field).value)) {
    for (const Vec3& u : state.u) values.push_back((*of)(u));
    return values;
  }
  if (const OfContact* of = std::get_if<OfContact>(&line_of(field).value)) {
    values.assign(state.u.size(), (*of)(ContactNode()));
    for (std::size_t i = 0; i < state.contact.size(); ++i) values[i] = (*of)(state.contact[i]);
    return values;
  }
  const GaussValues gauss = gauss_values(body, state.u);
  for (int node = 0; node < body.mesh().n_nodes(); ++node)
    values.push_back(value_of(field, node_values(body, node, gauss, at), family - 1));
  return values;
}

// The indenters of a solution, from the config that it carries. Surfaces of scanned indenters are
// taken from the solution, so that their files need not be there any more.
std::vector<RigidContact> indenters_of(const SolutionHeader& header) {
  if (header.contact_nodes.empty()) return {};
  const auto solve = recorded_config(header);
  if (!solve) return {};
  std::vector<RigidContact> indenters;
  try {
    for (const auto& [name, contact] : solve->contacts) {
      if (!header.contact_nodes.count(name)) return {};
      RigidContact indenter = indenter_of(name, contact, solve->path);
      indenter.nodes = header.contact_nodes.at(name);
      if (is_from_file(indenter.shape)) {
        const auto surface = header.indenter_surfaces.find(name);
        if (surface == header.indenter_surfaces.end()) continue;
        set_triangles(indenter.shape, surface->second);
      }
      indenters.push_back(std::move(indenter));
    }
  } catch (const Failure&) {
    return {};  // numbers that this version refuses
  }
  return indenters;
}

std::vector<SurfaceContact> touching_surfaces(const SolutionHeader& header) {
  if (header.contact_nodes.empty()) return {};
  const auto solve = recorded_config(header);
  if (!solve) return {};
  std::vector<SurfaceContact> surfaces;
  const std::vector<char> held = held_by_supports(*solve, header.mesh);
  for (const auto& [name, contact] : solve->touching) {
    const auto nodes = header.contact_nodes.find(name);
    if (nodes == header.contact_nodes.end() || header.mesh.type != CellType::hex8) return {};
    const std::vector<Facet> own = surface_of(header.mesh, contact.on);
    if (contact.on == *contact.against) {
      surfaces.push_back(self_contact(name, contact.friction, header.mesh, own));
    } else {
      const std::vector<Facet> other = surface_of(header.mesh, *contact.against);
      surfaces.push_back(surface_contact(name, contact.friction, header.mesh, own, other));
    }
    if (surfaces.back().nodes != nodes->second) return {};
    find_mirrors(surfaces.back(), header.mesh, held);
  }
  return surfaces;
}

int steps_until(const SolutionReader& solution, double t) {
  int n = 0;
  while (n < solution.n_steps() && solution.step(n).t <= t) ++n;
  return n;
}

// Under force control, and where the load factor is a result, an indenter is where the steps found
// it.
void follow_records(std::vector<RigidContact>& indenters, const SolutionReader& solution) {
  for (RigidContact& indenter : indenters) {
    if (!indenter.control && !indenter.in_proportion) continue;
    std::vector<Waypoint> found;
    for (int i = 0; i < solution.n_steps(); ++i) {
      const StepRecord step = solution.step(i);
      found.push_back({step.t, indenter_at(indenter, step)});
    }
    indenter.motion = std::move(found);
    indenter.in_proportion = false;
  }
}

// Work is integrated over time. It needs the times at which a load changes its rate, so that no
// interval of the quadrature contains one.
EnergyPath energy_path(const Mesh& mesh, std::vector<RigidContact> indenters,
                       const SolutionHeader& header, std::vector<SurfaceContact> surfaces) {
  const auto solve = recorded_config(header);
  if (!solve) return {mesh, std::move(indenters)};
  std::vector<double> kinks;
  for (const LoadConfig& load : solve->loads)
    for (const HistoryConfig& history : load.histories())
      for (const HistoryPointConfig& point : history.points)
        kinks.push_back(place(point, solve->path.seconds));
  return {mesh, std::move(indenters), std::move(kinks), turned_sets(*solve, header.mesh),
          std::move(surfaces)};
}

std::vector<std::string> indenters_missing(const SolutionHeader& header,
                                           const std::vector<RigidContact>& indenters,
                                           const std::vector<SurfaceContact>& surfaces) {
  std::vector<std::string> names;
  for (const auto& contact : header.contact_nodes) {
    const std::string& name = contact.first;
    const bool is_rigid =
        std::ranges::find(indenters, name, &RigidContact::name) != indenters.end();
    const bool is_surface =
        std::ranges::find(surfaces, name, &SurfaceContact::name) != surfaces.end();
    if (!is_rigid && !is_surface) names.push_back(name);
  }
  return names;
}

bool knows_work(const SolutionHeader& header, const std::vector<SurfaceContact>& surfaces) {
  if (surfaces.empty()) return true;
  const auto solve = recorded_config(header);
  return !solve || !solve->in_motion();
}

Shown shown_of(const Mesh& mesh) {
  const BoundingBox box = bounding_box(mesh.X);
  return {box.middle(), box.size().norm()};
}

// An indenter can be wider than the picture. Its outline is therefore drawn around the part that is
// shown, seen from the indenter, and then moved with it.
Outline outline_at(const RigidContact& indenter, double t, const Shown& shown) {
  const Vec3 u = indenter_displacement(indenter, t);
  Outline moved = outline(indenter.shape, {shown.middle - u, shown.size, shown.parts});
  for (Vec3& x : moved.points) x += u;
  return moved;
}

namespace {

// Tractions and pressures of a solution, from the config that it carries; none if it has none.
std::vector<SurfaceLoad> surface_loads_of(const SolutionHeader& header) {
  const auto solve = recorded_config(header);
  if (!solve) return {};
  try {
    std::vector<Error> errors;
    std::vector<SurfaceLoad> loads = surface_loads(
        *solve, header.mesh, [](const std::string&) { return Place{}; }, errors);
    if (!errors.empty()) return {};
    return loads;
  } catch (const Failure&) {
    return {};  // numbers that this version refuses
  }
}

}  // namespace

Loads loads_of(const SolutionHeader& header) {
  std::vector<SurfaceLoad> loads = surface_loads_of(header);
  if (loads.empty()) return {};
  const Section* section = header.mesh.section ? &*header.mesh.section : nullptr;
  std::size_t n = 0;
  if (section) n = static_cast<std::size_t>(header.mesh.n_cells());
  return {header.mesh, std::move(loads),
          std::vector<double>(n, section ? cell_share(*section) : 1)};
}

std::function<double(double)> applied_pressure(const SolutionHeader& header) {
  // A history is a factor of the largest value, so the largest factor is that of the largest load.
  SurfaceLoad largest;
  for (SurfaceLoad& load : surface_loads_of(header)) {
    if (!load.volume && std::abs(load.pressure) > std::abs(largest.pressure))
      largest = std::move(load);
  }
  return [pressure = largest.pressure, factor = largest.factor](double t) {
    if (pressure == 0) return 0.0;
    return pressure * factor_at(factor, t);
  };
}

// What the balance of energy needs of a step: displacements, forces at supports, at contacts and of
// loads, and the energies that the solver recorded.
EnergyPath::State energy_state(const StepRecord& record, const std::vector<RigidContact>& indenters,
                               const Loads& loads, const std::vector<SurfaceContact>& surfaces) {
  EnergyPath::State state{record.t, record.u, record.reaction, {}, 0};
  for (const RigidContact& indenter : indenters) {
    const auto found = record.contacts.find(indenter.name);  // the unloaded state has none
    state.r.push_back(found == record.contacts.end()
                          ? std::vector<Vec3>(indenter.nodes.size(), Vec3::Zero())
                          : found->second.r);
    state.bonds.push_back(found == record.contacts.end() ? std::vector<Vec3>{}
                                                         : found->second.adhesive);
  }
  for (const SurfaceContact& surface : surfaces) {
    const auto found = record.contacts.find(surface.name);
    if (found == record.contacts.end()) {
      state.r.emplace_back(surface.nodes.size(), Vec3::Zero());
      state.bonds.emplace_back();
    } else {
      state.r.push_back(found->second.r);
      state.bonds.push_back(found->second.adhesive);
    }
  }
  if (const auto jumps = record.scalars.find("work_of_jumps"); jumps != record.scalars.end())
    state.jumps = jumps->second;
  if (!loads.empty()) {
    VecX u(3 * static_cast<Eigen::Index>(record.u.size()));
    for (std::size_t i = 0; i < record.u.size(); ++i)
      u.segment<3>(3 * static_cast<Eigen::Index>(i)) = record.u[i];
    Loads now = loads;
    now.set_pressures(pressures_of(record, loads));
    state.loads = now.forces(load_factor_of(record), u);
  }
  for (const char* part :
       {"energy", "viscous_work", "adhesion_stored", "adhesion_dissipated", "energy_released"})
    if (const auto stored = record.scalars.find(part); stored != record.scalars.end())
      state.stored += stored->second;
  return state;
}

}  // namespace langer
