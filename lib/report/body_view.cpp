// Packs a deformed body for the page. Most of a page are displacements and fields of many states,
// so they are stored as 16-bit integers, and the number of states follows from the allowed size.
#include "report/body_view.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include "mechanics/mesh/bounding_box.hpp"
#include "mechanics/mesh/raise.hpp"
#include "report/labels.hpp"
#include "report/packed.hpp"
#include "results/post/render.hpp"
#include "scene/run/post_files.hpp"
#include "scene/run/recorded_contact.hpp"

namespace langer::report {

namespace {

// Fibres drawn on the surface; more would hide each other.
constexpr std::size_t most_glyphs = 2500;

// A field that the page can colour the body by, with its values at the sent nodes in all states.
struct ShownField {
  Quantity quantity;
  int family = 0;  // from 0
  std::string name, label, unit;
  Span span;
  std::vector<std::vector<double>> values;  // state, node
};

// One field for each quantity; a quantity of fibres has one field for each family.
std::vector<ShownField> fields_of(const std::vector<Quantity>& quantities, const Body& body) {
  std::vector<ShownField> fields;
  for (const Quantity q : quantities) {
    const QuantityLine& line = line_of(q);
    int n = 1;
    if (line.needs.fibres) n = body.n_families();
    for (int k = 0; k < n; ++k) {
      std::string name = line.word;
      std::string label = plain_label(line.label);
      if (n > 1) {
        name = fmt::format("{}_{}", line.word, k + 1);
        label = fmt::format("{} {}", line.label, k + 1);
      }
      fields.push_back({q, k, name, label, line.unit, {}, {}});
    }
  }
  return fields;
}

// Whether a contact node slips in any step.
bool has_slip(const SolutionReader& solution) {
  constexpr int slip = 2;  // code of a slipping node in a solution file
  for (int i = 0; i < solution.n_steps(); ++i)
    for (const auto& [name, contact] : solution.step(i).contacts)
      if (std::ranges::find(contact.status, slip) != contact.status.end()) return true;
  return false;
}

// Contact pressure if the solution has indenters; slip and contact status if anything slips.
std::vector<Quantity> contact_quantities(const SolutionReader& solution,
                                         const ContactStates& contacts) {
  std::vector<Quantity> shown;
  const auto& surfaces = contacts.surfaces();
  bool any_surface = false;
  for (const auto& [name, facets] : surfaces) any_surface = any_surface || !facets.empty();
  if (!any_surface) return shown;
  shown.push_back(quantity("contact_pressure"));
  if (!has_slip(solution)) return shown;
  if (contacts.knows_slip()) shown.push_back(quantity("slip"));
  shown.push_back(quantity("contact_status"));
  return shown;
}

// The states that the page shows, evenly spaced: 0 is the unloaded state, n_steps the last step.
std::vector<int> rows_shown(int n_steps, int most) {
  const int n = std::clamp(most, 2, n_steps + 1);
  if (n == 1) return {0};
  std::vector<int> rows;
  for (int i = 0; i < n; ++i)
    rows.push_back(static_cast<int>(std::lround(double(i) * n_steps / (n - 1))));
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

// The nodes whose data the page contains: all nodes of the mesh, or only those of the surface.
struct Chosen {
  std::vector<int> nodes;
  std::vector<int> place;  // index in `nodes` of each node of the mesh, or -1
  Chosen(const Mesh& mesh, const std::vector<std::array<int, 4>>& surface, bool all)
      : place(mesh.X.size(), -1) {
    std::set<int> used;
    for (const auto& facet : surface) used.insert(facet.begin(), facet.end());
    if (all)
      for (int i = 0; i < mesh.n_nodes(); ++i) used.insert(i);
    nodes.assign(used.begin(), used.end());
    for (std::size_t i = 0; i < nodes.size(); ++i)
      place[static_cast<std::size_t>(nodes[i])] = static_cast<int>(i);
  }
};

// Fibres drawn on the surface. The page draws each at the middle of its facet, along
// F a = sum_k x_k (grad N_k . a) with the eight nodes and weights of its element.
struct Glyphs {
  std::vector<std::int32_t> facet, cell_nodes;
  std::vector<float> weights;
};

std::array<int, 4> sorted_nodes(std::array<int, 4> facet) {
  std::ranges::sort(facet);
  return facet;
}

// The unit normal of a facet from its diagonals.
Vec3 facet_normal(const Mesh& mesh, const std::array<int, 4>& facet) {
  return (mesh.X[facet[2]] - mesh.X[facet[0]])
      .cross(mesh.X[facet[3]] - mesh.X[facet[1]])
      .normalized();
}

// The fibres on the surface, thinned out evenly. A fibre that is almost normal to its facet is
// left out: on the screen it would be a point.
Glyphs glyphs_of(const Body& body, const std::vector<std::array<int, 4>>& surface,
                 const Chosen& chosen) {
  const Mesh mesh = between_nodes(body.mesh());
  const int parts = mesh.n_cells() / body.mesh().n_cells();
  Glyphs glyphs;
  std::map<std::array<int, 4>, int> place;  // sorted nodes -> facet of the surface
  for (std::size_t f = 0; f < surface.size(); ++f)
    place[sorted_nodes(surface[f])] = static_cast<int>(f);
  // Only every n-th facet of the surface has a fibre.
  const std::size_t every = std::max<std::size_t>(1, surface.size() / most_glyphs);
  std::size_t seen = 0;
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (const auto& local : Hex8::facet) {
      std::array<int, 4> nodes{};
      for (int k = 0; k < 4; ++k) nodes[k] = mesh.cell(e)[local[k]];
      const auto found = place.find(sorted_nodes(nodes));
      if (found == place.end() || seen++ % every != 0) continue;
      const Vec3 normal = facet_normal(mesh, surface[static_cast<std::size_t>(found->second)]);
      // The weights are the directional derivative of the shape functions along the fibre, at the
      // middle of the element: w_k = grad N_k . a.
      const Hex8::Gradient dN = Hex8::gradient(Vec3::Zero());
      const Mat3 jacobian = element_nodes(mesh, e).transpose() * dN;  // dX/dxi
      for (const Vec3& a : body.fibres(e / parts)) {
        if (std::abs(a.dot(normal)) > 0.7) continue;
        const Eigen::Matrix<double, 8, 1> w = dN * jacobian.inverse() * a;
        glyphs.facet.push_back(found->second);
        for (int k = 0; k < 8; ++k) {
          glyphs.cell_nodes.push_back(chosen.place[mesh.cell(e)[k]]);
          glyphs.weights.push_back(static_cast<float>(w[k]));
        }
      }
    }
  return glyphs;
}

// Each indenter as triangles at its initial place, and its displacement in each state. Indenters
// whose shape the solution does not contain are listed by name.
Json indenters_view(const SolutionReader& solution, const std::vector<double>& t) {
  const SolutionHeader& header = solution.header();
  constexpr int parts = 24;
  std::vector<Json> shown, missing;
  std::vector<RigidContact> indenters = indenters_of(header);
  if (!t.empty()) follow_records(indenters, solution);
  Shown region = shown_of(header.mesh);
  region.parts = parts;
  for (const RigidContact& indenter : indenters) {
    // Faces with more than three corners become a fan of triangles.
    const Outline outline = langer::outline(indenter.shape, region);
    std::vector<float> points;
    for (const Vec3& x : outline.points)
      for (double c : x) points.push_back(static_cast<float>(c));
    std::vector<std::int32_t> triangles;
    for (const auto& face : outline.faces)
      for (std::size_t k = 2; k < face.size(); ++k)
        triangles.insert(triangles.end(), {face[0], face[k - 1], face[k]});
    std::vector<Json> moved;
    for (double at : t) {
      const Vec3 u = indenter_displacement(indenter, at);
      moved.push_back(numbers({u[0], u[1], u[2]}));
    }
    shown.push_back(object({{"name", words(indenter.name)},
                            {"points", packed(points)},
                            {"triangles", packed(triangles)},
                            {"u", list(moved)}}));
  }
  for (const std::string& name : indenters_missing(header, indenters, touching_surfaces(header)))
    missing.push_back(words(name));
  return object({{"shown", list(shown)}, {"missing", list(missing)}});
}

// How much of a body fits into the budget: all nodes with the elements, or only the nodes of the
// surface, and the number of states.
struct Extent {
  bool cells;
  int states;
};

// Sizes that the number of bytes of a body depends on.
struct BodySize {
  std::size_t n_corners, n_facets, n_fields;

  // Bytes in base64. A state has 6 bytes of displacement and 2 bytes per field at each node; a node
  // has its position, a facet four node numbers, an element its corners and fibres.
  double bytes(const Chosen& chosen, int states, bool cells) const {
    const double n = static_cast<double>(chosen.nodes.size());
    double sum = n * states * (6 + 2.0 * static_cast<double>(n_fields)) + 12 * n +
                 16.0 * static_cast<double>(n_facets);
    if (cells) {
      sum += 4.0 * n_corners;
      sum += 68.0 * static_cast<double>(std::min(n_facets, 2 * most_glyphs));
    }
    return 4.0 / 3 * sum;
  }

  // The most states within the budget; 0 if not even two fit.
  int fitting_states(const Chosen& chosen, bool cells, int wanted, double budget) const {
    int states = wanted;
    while (states > 2 && bytes(chosen, states, cells) > budget) --states;
    if (bytes(chosen, states, cells) > budget) return 0;
    return states;
  }
};

// Prefers whole bodies, which a plane can cut open, unless fewer than four states would fit.
Extent extent_of(const BodySize& size, const Chosen& whole, const Chosen& outside, int wanted,
                 double budget) {
  constexpr int few = 4;
  const int states = size.fitting_states(whole, true, wanted, budget);
  if (states >= std::min(few, wanted)) return {true, states};
  return {false, std::max(2, size.fitting_states(outside, false, wanted, budget))};
}

// Displacements of each state as 16-bit integers, in units of `step` mm.
Json moves_view(const std::vector<std::vector<double>>& u, double step) {
  std::vector<Json> moves;
  for (const auto& state : u) {
    std::vector<std::int16_t> whole_steps;
    for (double v : state) whole_steps.push_back(static_cast<std::int16_t>(std::lround(v / step)));
    moves.push_back(packed(whole_steps));
  }
  return list(moves);
}

// The fields as 16-bit integers between their smallest and largest value over all states. A field
// without a finite value is left out.
Json fields_view(std::vector<ShownField>& fields) {
  std::vector<Json> shown;
  for (ShownField& f : fields) {
    for (const auto& values : f.values) f.span.add(values);
    if (f.span.empty()) continue;
    const auto quantised_state = [&](const auto& values) {
      return packed(quantised(values, f.span));
    };
    shown.push_back(object({{"name", words(f.name)},
                            {"label", words(f.label)},
                            {"unit", words(f.unit)},
                            {"low", number(f.span.low)},
                            {"high", number(f.span.high)},
                            {"states", list(f.values, quantised_state)}}));
  }
  return list(shown);
}

// The states that the page shows: path parameter, displacements of the chosen nodes, and what the
// slider displays.
struct States {
  std::vector<double> t;
  std::vector<std::vector<double>> u;  // state, 3 node
  std::vector<Json> shown;
};

bool needs_contact(const ShownField& f) { return is<OfContact>(line_of(f.quantity)); }

// A body without its states: places of the chosen nodes, and the facets of its surface.
struct Outside {
  std::vector<float> X;
  std::vector<std::int32_t> facets;  // numbers of chosen nodes

  Outside(const Mesh& mesh, const std::vector<std::array<int, 4>>& surface, const Chosen& chosen) {
    for (const int node : chosen.nodes)
      for (double x : mesh.X[node]) X.push_back(static_cast<float>(x));
    for (const auto& facet : surface)
      for (int node : facet) facets.push_back(chosen.place[node]);
  }
};

// So that the largest displacement is the largest 16-bit integer [mm].
double step_of(const std::vector<std::vector<double>>& u) {
  double largest = 0;
  for (const auto& state : u)
    for (double v : state) largest = std::max(largest, std::abs(v));
  if (largest > 0) return largest / 32767;
  return 1;
}

// A movement that swings about a state.
struct Swing {
  std::string name;
  const std::vector<Vec3>* shape = nullptr;  // largest movement 1
  std::vector<Vec3> about;                   // displacements of the state [mm]
  double t = 0;                              // of it
};

std::vector<Swing> swings_of(const SolutionReader& solution, const VibrationRecord& record) {
  // row 0 is unloaded
  const auto about = [&](int row) {
    StepRecord state;
    state.u.assign(solution.header().mesh.X.size(), Vec3::Zero());
    if (row > 0) state = solution.step(row - 1);
    return state;
  };
  std::vector<Swing> swings;
  if (const auto& critical = record.critical)
    swings.push_back({fmt::format("{} at t = {:.4g}", critical->kind, critical->t),
                      &critical->shape, about(steps_until(solution, critical->t)).u, critical->t});
  if (!record.modes) return swings;
  const StepRecord last = about(solution.n_steps());
  for (std::size_t i = 0; i < record.modes->shape.size(); ++i)
    swings.push_back({fmt::format("mode {}, {:.4g} Hz", i + 1, record.modes->frequency[i]),
                      &record.modes->shape[i], last.u, last.t});
  return swings;
}

// Evaluates the states `rows`, and adds the values of the fields in each of them.
States states_of(const SolutionReader& solution, Body& body, const Chosen& chosen,
                 const std::vector<int>& rows, StressAt stress, const ContactStates& contacts,
                 std::vector<ShownField>& fields) {
  States states;
  BranchRows branches(body, solution);
  const bool touched = std::ranges::any_of(fields, needs_contact);
  for (const int row : rows) {
    // Viscous stresses depend on the history, so the branches follow the rows.
    branches.go_to(row);
    StepRecord record;
    StepState state = unloaded(body.mesh());
    if (row > 0) {
      record = solution.step(row - 1);
      state = state_of(record);
    }
    states.t.push_back(state.t);
    auto& here = states.u.emplace_back();
    for (const int node : chosen.nodes)
      here.insert(here.end(), state.u[node].begin(), state.u[node].end());
    const GaussValues gauss = gauss_values(body, state.u);
    for (ShownField& f : fields) f.values.emplace_back();
    std::vector<ContactNode> contact;
    if (touched) contact = contacts.nodes(row, record, contacts.knows_slip());
    for (const int node : chosen.nodes) {
      const VecX values = node_values(body, node, gauss, stress);
      for (ShownField& f : fields) {
        const OfContact* evaluate = std::get_if<OfContact>(&line_of(f.quantity).value);
        double value = 0;
        if (evaluate) {
          value = (*evaluate)(contact[static_cast<std::size_t>(node)]);
        } else {
          value = value_of(f.quantity, values, f.family);
        }
        f.values.back().push_back(value);
      }
    }
    states.shown.push_back(
        object({{"row", number(row)},
                {"t", number(state.t)},
                {"u_ind", numbers({state.u_ind[0], state.u_ind[1], state.u_ind[2]})}}));
  }
  return states;
}

}  // namespace

// The number of states and the nodes are chosen first, within the budget that the indenters leave.
// Then all states are evaluated, and packed with one scale for displacements and one for each
// field.
Json body_view(const std::string& label, const SolutionReader& solution, const std::string& path,
               const ReportConfig& config, double budget) {
  const SolutionHeader& header = solution.header();
  const Mesh& mesh = header.mesh;
  Body body(mesh, header.laws(), header.directions, formulation_of(header, path));
  const auto surface =
      outer_surface(mesh, std::vector<bool>(static_cast<std::size_t>(mesh.n_cells()), true));
  std::vector<ShownField> fields = fields_of(config.shown, body);
  std::vector<RigidContact> indenters = indenters_of(header);
  follow_records(indenters, solution);
  const std::vector<SurfaceContact> touching = touching_surfaces(header);
  const ContactStates contacts(solution, indenters, touching);
  for (const ShownField& f : fields_of(contact_quantities(solution, contacts), body))
    fields.push_back(f);

  const Chosen whole(mesh, surface, true);
  const Chosen outside(mesh, surface, false);
  // Indenters are needed in any case. The rest of the budget is for the body.
  const double left = budget - static_cast<double>(indenters_view(solution, {}).text.size());
  const BodySize size{between_nodes(mesh).connectivity.size(), surface.size(), fields.size()};
  const auto [cells, states] =
      extent_of(size, whole, outside, std::min(config.states, solution.n_steps() + 1), left);
  const Chosen& chosen = cells ? whole : outside;
  const std::vector<int> rows = rows_shown(solution.n_steps(), states);

  const States at = states_of(solution, body, chosen, rows, config.stress, contacts, fields);

  // One scale for the displacements of all states, so that the page can interpolate between them.
  const double step = step_of(at.u);
  const Outside shown(mesh, surface, chosen);
  std::vector<std::int32_t> cell_nodes;
  Json glyphs, connectivity;
  if (cells) {
    for (int node : between_nodes(mesh).connectivity) cell_nodes.push_back(chosen.place[node]);
    connectivity = packed(cell_nodes);
  }
  if (cells && body.n_families() > 0) {
    const Glyphs g = glyphs_of(body, surface, chosen);
    if (!g.facet.empty())
      glyphs = object({{"facet", packed(g.facet)},
                       {"nodes", packed(g.cell_nodes)},
                       {"weights", packed(g.weights)}});
  }
  return object({{"label", words(label)},
                 {"cells", connectivity},
                 {"n_cells", number(mesh.n_cells())},
                 {"n_nodes", number(mesh.n_nodes())},
                 {"n_states", number(solution.n_steps() + 1)},
                 {"X", packed(shown.X)},
                 {"facets", packed(shown.facets)},
                 {"states", list(at.shown)},
                 {"step", number(step)},
                 {"u", moves_view(at.u, step)},
                 {"fields", fields_view(fields)},
                 {"glyphs", glyphs},
                 {"indenters", indenters_view(solution, at.t)}});
}

std::vector<Json> mode_views(const std::string& label, const SolutionReader& solution,
                             const VibrationRecord& record, double budget) {
  if (!record.critical && !record.modes) return {};
  constexpr int phases = 16;
  constexpr double amplitude = 0.1;  // of the size of the body
  const Mesh& mesh = solution.header().mesh;
  const auto surface =
      outer_surface(mesh, std::vector<bool>(static_cast<std::size_t>(mesh.n_cells()), true));
  const Chosen chosen(mesh, surface, false);
  const Outside shown(mesh, surface, chosen);
  const double size = bounding_box(mesh.X).size().norm();
  std::vector<Json> views;
  for (const Swing& swing : swings_of(solution, record)) {
    std::vector<std::vector<double>> u;
    std::vector<Json> states;
    for (int phase = 0; phase < phases; ++phase) {
      const double part = amplitude * size * std::sin(2 * std::numbers::pi * phase / phases);
      auto& here = u.emplace_back();
      for (const int node : chosen.nodes) {
        const Vec3 moved = swing.about[static_cast<std::size_t>(node)] +
                           part * (*swing.shape)[static_cast<std::size_t>(node)];
        here.insert(here.end(), moved.begin(), moved.end());
      }
      states.push_back(
          object({{"row", number(phase)}, {"t", number(swing.t)}, {"u_ind", numbers({0, 0, 0})}}));
    }
    const double step = step_of(u);
    Json view = object({{"label", words(label + ": " + swing.name)},
                        {"cells", Json{}},
                        {"n_cells", number(mesh.n_cells())},
                        {"n_nodes", number(mesh.n_nodes())},
                        {"n_states", number(phases)},
                        {"X", packed(shown.X)},
                        {"facets", packed(shown.facets)},
                        {"states", list(states)},
                        {"step", number(step)},
                        {"u", moves_view(u, step)},
                        {"fields", list(std::vector<Json>{})},
                        {"glyphs", Json{}},
                        {"indenters", object({{"shown", list(std::vector<Json>{})},
                                              {"missing", list(std::vector<Json>{})}})}});
    budget -= static_cast<double>(view.text.size());
    if (budget < 0) break;
    views.push_back(std::move(view));
  }
  return views;
}

}  // namespace langer::report
