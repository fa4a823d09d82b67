#include "report/body_view.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "mechanics/mesh/raise.hpp"
#include "report/labels.hpp"
#include "report/packed.hpp"
#include "results/post/render.hpp"
#include "scene/run/post_files.hpp"
#include "scene/run/recorded_contact.hpp"

namespace langer::report {

namespace {

constexpr std::size_t most_glyphs = 2500;

struct ShownField {
  Quantity quantity;
  int family = 0;  // from 0
  std::string name, label, unit;
  Span span;
  std::vector<std::vector<double>> values;  // state, node
};

std::vector<ShownField> fields_of(const std::vector<Quantity>& quantities, const Body& body) {
  std::vector<ShownField> fields;
  for (const Quantity q : quantities) {
    const QuantityLine& line = line_of(q);
    int n = 1;
    if (line.needs.fibres) n = body.n_families();
    for (int k = 0; k < n; ++k)
      fields.push_back({q,
                        k,
                        n > 1 ? fmt::format("{}_{}", line.word, k + 1) : line.word,
                        n > 1 ? fmt::format("{} {}", line.label, k + 1) : plain_label(line.label),
                        line.unit,
                        {},
                        {}});
  }
  return fields;
}

// what indenters do to the surface; slip and status where anything slips
std::vector<Quantity> contact_quantities(const SolutionReader& solution,
                                         const ContactStates& contacts) {
  std::vector<Quantity> shown;
  const auto& surfaces = contacts.surfaces();
  if (std::all_of(surfaces.begin(), surfaces.end(),
                  [](const auto& named) { return named.second.empty(); }))
    return shown;
  shown.push_back(quantity("contact_pressure"));
  bool slips = false;
  for (int i = 0; i < solution.n_steps() && !slips; ++i)
    for (const auto& [name, contact] : solution.step(i).contacts)
      slips = slips ||
              std::find(contact.status.begin(), contact.status.end(), 2) != contact.status.end();
  if (!slips) return shown;
  if (contacts.knows_slip()) shown.push_back(quantity("slip"));
  shown.push_back(quantity("contact_status"));
  return shown;
}

// rows of the table of states: 0 is the unloaded one
std::vector<int> rows_shown(int n_steps, int most) {
  std::vector<int> rows;
  const int n = std::clamp(most, 2, n_steps + 1);
  for (int i = 0; i < n; ++i)
    rows.push_back(n > 1 ? static_cast<int>(std::lround(double(i) * n_steps / (n - 1))) : 0);
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

// The nodes that travel: all, or those of the surface.
struct Chosen {
  std::vector<int> nodes, place;  // place: of each node of the mesh among them, or -1
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

Json text_of(const std::string& packed) { return {'"' + packed + '"'}; }

template <class T>
Json packed(const std::vector<T>& values) {
  return text_of(base64(values));
}

// Fibres on the facets of the surface, thinned out evenly.
struct Glyphs {
  std::vector<std::int32_t> facet, cell_nodes;
  std::vector<float> weights;
};

Glyphs glyphs_of(const Body& body, const std::vector<std::array<int, 4>>& surface,
                 const Chosen& chosen) {
  const Mesh mesh = between_nodes(body.mesh());
  const int parts = mesh.n_cells() / body.mesh().n_cells();
  Glyphs glyphs;
  std::map<std::array<int, 4>, int> place;  // sorted nodes -> facet of the surface
  for (std::size_t f = 0; f < surface.size(); ++f) {
    auto key = surface[f];
    std::sort(key.begin(), key.end());
    place[key] = static_cast<int>(f);
  }
  const std::size_t every = std::max<std::size_t>(1, surface.size() / most_glyphs);
  std::size_t seen = 0;
  for (int e = 0; e < mesh.n_cells(); ++e)
    for (const auto& local : Hex8::facet) {
      std::array<int, 4> nodes{};
      for (int k = 0; k < 4; ++k) nodes[k] = mesh.cell(e)[local[k]];
      auto key = nodes;
      std::sort(key.begin(), key.end());
      const auto found = place.find(key);
      if (found == place.end() || seen++ % every != 0) continue;
      const auto& facet = surface[static_cast<std::size_t>(found->second)];
      const Vec3 normal = (mesh.X[facet[2]] - mesh.X[facet[0]])
                              .cross(mesh.X[facet[3]] - mesh.X[facet[1]])
                              .normalized();
      const Hex8::Gradient dN = Hex8::gradient(Vec3::Zero());
      const Mat3 jacobian = element_nodes(mesh, e).transpose() * dN;  // dX/dxi
      for (const Vec3& a : body.fibres(e / parts)) {
        if (std::abs(a.dot(normal)) > 0.7) continue;  // seen from its end
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

// Each as triangles where it starts, and how far it has moved in each state; those that the
// solution does not hold by name.
Json indenters_view(const SolutionReader& solution, const std::vector<double>& t) {
  const SolutionHeader& header = solution.header();
  constexpr int parts = 24;
  std::vector<Json> shown, missing;
  std::vector<RigidContact> indenters = indenters_of(header);
  if (!t.empty()) follow_records(indenters, solution);
  Shown region = shown_of(header.mesh);
  region.parts = parts;
  for (const RigidContact& indenter : indenters) {
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
                            {"u", list(moved, [](const Json& j) { return j; })}}));
  }
  for (const std::string& name : indenters_missing(header, indenters))
    missing.push_back(words(name));
  const auto as_is = [](const Json& j) {
    return j;
  };
  return object({{"shown", list(shown, as_is)}, {"missing", list(missing, as_is)}});
}

// What travels within the budget: all nodes with the cells, or those of the surface, and how many
// states.
struct Extent {
  bool cells;
  int states;
};
Extent extent_of(const Mesh& mesh, const Chosen& whole, const Chosen& outside, std::size_t n_facets,
                 std::size_t n_fields, int wanted, double budget) {
  constexpr int few = 4;
  const std::size_t n_corners = between_nodes(mesh).connectivity.size();
  // bytes in base64: per node and state, per node, per cell and facet
  const auto size = [&](const Chosen& nodes, int states, bool cells) {
    const double n = static_cast<double>(nodes.nodes.size());
    return 4.0 / 3 *
           (n * states * (6 + 2.0 * static_cast<double>(n_fields)) + 12 * n +
            16.0 * static_cast<double>(n_facets) + (cells ? 4.0 * n_corners : 0) +
            (cells ? 68.0 * static_cast<double>(std::min(n_facets, 2 * most_glyphs)) : 0));
  };
  const auto fitting = [&](const Chosen& nodes, bool cells) {
    int states = wanted;
    while (states > 2 && size(nodes, states, cells) > budget) --states;
    return size(nodes, states, cells) > budget ? 0 : states;
  };
  const int states = fitting(whole, true);
  if (states >= std::min(few, wanted)) return {true, states};
  return {false, std::max(2, fitting(outside, false))};
}

// displacements in whole steps of a share of the largest
Json moves_view(const std::vector<std::vector<double>>& u, double step) {
  std::vector<Json> moves;
  for (const auto& state : u) {
    std::vector<std::int16_t> whole_steps;
    for (double v : state) whole_steps.push_back(static_cast<std::int16_t>(std::lround(v / step)));
    moves.push_back(packed(whole_steps));
  }
  return list(moves, [](const Json& j) { return j; });
}

Json fields_view(std::vector<ShownField>& fields) {
  std::vector<Json> shown;
  for (ShownField& f : fields) {
    for (const auto& values : f.values) f.span.add(values);
    if (f.span.empty()) continue;
    shown.push_back(object(
        {{"name", words(f.name)},
         {"label", words(f.label)},
         {"unit", words(f.unit)},
         {"low", number(f.span.low)},
         {"high", number(f.span.high)},
         {"states", list(f.values, [&](const auto& v) { return packed(quantised(v, f.span)); })}}));
  }
  return list(shown, [](const Json& j) { return j; });
}

struct States {
  std::vector<double> t;
  std::vector<std::vector<double>> u;  // state, 3 node
  std::vector<Json> told;
};

// of these rows of the table of states; fields: their values are added
States states_of(const SolutionReader& solution, Body& body, const Chosen& chosen,
                 const std::vector<int>& rows, StressAt stress, const ContactStates& contacts,
                 std::vector<ShownField>& fields) {
  States states;
  BranchRows branches(body, solution);
  const bool touched = std::any_of(fields.begin(), fields.end(), [](const ShownField& f) {
    return is<OfContact>(line_of(f.quantity));
  });
  for (const int row : rows) {
    branches.go_to(row);
    const StepRecord record = row == 0 ? StepRecord{} : solution.step(row - 1);
    const StepState state = row == 0 ? unloaded(body.mesh()) : state_of(record);
    states.t.push_back(state.t);
    auto& here = states.u.emplace_back();
    for (const int node : chosen.nodes)
      here.insert(here.end(), state.u[node].begin(), state.u[node].end());
    const GaussValues gauss = gauss_values(body, state.u);
    for (ShownField& f : fields) f.values.emplace_back();
    std::vector<ContactNode> contact;
    if (touched) {
      contact = contacts.nodes(row, record, contacts.knows_slip());
    } else {
      contact = std::vector<ContactNode>();
    }
    for (const int node : chosen.nodes) {
      const VecX values = node_values(body, node, gauss, stress);
      for (ShownField& f : fields) {
        const OfContact* of = std::get_if<OfContact>(&line_of(f.quantity).value);
        f.values.back().push_back(of ? (*of)(contact[static_cast<std::size_t>(node)])
                                     : value_of(f.quantity, values, f.family));
      }
    }
    states.told.push_back(
        object({{"row", number(row)},
                {"t", number(state.t)},
                {"u_ind", numbers({state.u_ind[0], state.u_ind[1], state.u_ind[2]})}}));
  }
  return states;
}

}  // namespace

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
  const ContactStates contacts(solution, indenters);
  for (const ShownField& f : fields_of(contact_quantities(solution, contacts), body))
    fields.push_back(f);

  const Chosen whole(mesh, surface, true), outside(mesh, surface, false);
  const double left = budget - static_cast<double>(indenters_view(solution, {}).text.size());
  const auto [cells, states] = extent_of(mesh, whole, outside, surface.size(), fields.size(),
                                         std::min(config.states, solution.n_steps() + 1), left);
  const Chosen& chosen = cells ? whole : outside;
  const std::vector<int> rows = rows_shown(solution.n_steps(), states);

  const States at = states_of(solution, body, chosen, rows, config.stress, contacts, fields);

  double largest = 0;
  for (const auto& state : at.u)
    for (double v : state) largest = std::max(largest, std::abs(v));
  double step = 1;
  if (largest > 0) step = largest / 32767;
  std::vector<float> X;
  for (const int node : chosen.nodes)
    for (double x : mesh.X[node]) X.push_back(static_cast<float>(x));
  std::vector<std::int32_t> facets, cell_nodes;
  for (const auto& facet : surface)
    for (int node : facet) facets.push_back(chosen.place[node]);
  Json glyphs, connectivity;
  if (cells) {
    for (int node : between_nodes(mesh).connectivity) cell_nodes.push_back(chosen.place[node]);
    connectivity = packed(cell_nodes);
  }
  if (const Glyphs g = cells && body.n_families() > 0 ? glyphs_of(body, surface, chosen) : Glyphs{};
      !g.facet.empty())
    glyphs = object({{"facet", packed(g.facet)},
                     {"nodes", packed(g.cell_nodes)},
                     {"weights", packed(g.weights)}});
  const auto as_is = [](const Json& j) {
    return j;
  };
  return object({{"label", words(label)},
                 {"cells", connectivity},
                 {"n_cells", number(mesh.n_cells())},
                 {"n_nodes", number(mesh.n_nodes())},
                 {"n_states", number(solution.n_steps() + 1)},
                 {"X", packed(X)},
                 {"facets", packed(facets)},
                 {"states", list(at.told, as_is)},
                 {"step", number(step)},
                 {"u", moves_view(at.u, step)},
                 {"fields", fields_view(fields)},
                 {"glyphs", glyphs},
                 {"indenters", indenters_view(solution, at.t)}});
}

}  // namespace langer::report
