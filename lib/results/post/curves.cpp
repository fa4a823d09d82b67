#include "results/post/curves.hpp"

#include <algorithm>
#include <limits>

#include "core/base/text.hpp"
#include "core/tensor/stress.hpp"
#include "mechanics/element/surface.hpp"
#include "mechanics/mesh/section.hpp"

namespace langer {

namespace {

Vec3 mean(const std::vector<Vec3>& field, const std::vector<int>& nodes) {
  Vec3 sum = Vec3::Zero();
  for (int node : nodes) sum += field[node];
  return sum / static_cast<double>(nodes.size());
}

// The extremes of the body. The greatest von Mises stress is that of the nodal averages, which
// figures show and whose error the solver estimates; the others are over all Gauss points. The
// values of all elements are then in `gauss`.
Extremes extremes(const Body& body, const std::vector<Vec3>& u, GaussValues& gauss) {
  Extremes all;
  for (int e = 0; e < body.mesh().n_cells(); ++e) {
    add_gauss_values(body, u, e, gauss);
    for (int g = 0; g < gauss[e].rows(); ++g) {
      const VecX row = gauss[e].row(g).transpose();
      const Mat3 sigma = sigma_of(row);
      all.J = std::min(all.J, J_of(row));
      all.pressure_min = std::min(all.pressure_min, mean_stress(sigma));
      all.pressure_max = std::max(all.pressure_max, mean_stress(sigma));
      for (std::size_t k = 0; k < body.fibres(e).size(); ++k)
        all.fibre_stretch = std::max(all.fibre_stretch, fibre_stretch_of(row, static_cast<int>(k)));
    }
  }
  for (int n = 0; n < body.mesh().n_nodes(); ++n) {
    const double here = von_mises(sigma_of(node_values(body, n, gauss, StressAt::nodal_average)));
    if (!(here > all.von_mises)) continue;
    all.von_mises = here;
    all.place = body.mesh().X[n];
  }
  return all;
}

// The volume between the undeformed and the deformed surface. Each point of the surface moves
// along a straight line, so V is the integral over 0 <= s <= 1 of (integral of u . n da) with the
// surface at s u. The integrand is a polynomial of second degree in s, which Simpson's rule
// integrates exactly.
double swept_volume(const Mesh& mesh, const std::vector<Facet>& facets,
                    const std::vector<Vec3>& u) {
  double volume = 0;
  for (const Facet& facet : facets) {
    const auto nodes = mesh.cell(facet.cell);
    ElementNodes X = element_nodes(mesh, facet.cell);
    ElementNodes moved = X;
    for (std::size_t a = 0; a < nodes.size(); ++a)
      moved.row(static_cast<Eigen::Index>(a)) = u[nodes[a]].transpose();
    for (const auto& [s, weight] : {std::pair{0.0, 1.0 / 6}, {0.5, 4.0 / 6}, {1.0, 1.0 / 6}})
      volume -=
          weight *
          follower_pressure(mesh.cell(), facet.local, X + s * moved).cwiseProduct(moved).sum();
  }
  if (mesh.section) return cell_share(*mesh.section) * volume;
  return volume;
}

}  // namespace

StepState unloaded(const Mesh& mesh) {
  StepState state;
  state.u.assign(mesh.X.size(), Vec3::Zero());
  state.reaction = state.u;
  return state;
}

double value_of(Quantity quantity, const VecX& row, int family) {
  return std::get<OfPoint>(line_of(quantity).value)(row, family);
}

namespace {

// Calls the function of a quantity with the argument that it is defined for: the state, the mean
// displacement of a set, the values at its nodes, and so on.
struct Measurement {
  const Body& body;
  const Measure& m;
  StressAt at;
  const StepState& state;
  GaussValues& gauss;
  std::optional<Extremes>& all;  // computed once for all measures

  double operator()(OfState value) const { return value(state); }
  double operator()(OfNodes value) const { return value(mean(state.u, m.nodes)); }
  double operator()(OfContact value) const {
    double sum = 0;
    for (int node : m.nodes) {
      ContactNode here{0, 0, 0, 0};  // of the unloaded state
      if (!state.contact.empty()) here = state.contact[static_cast<std::size_t>(node)];
      sum += value(here);
    }
    return sum / static_cast<double>(m.nodes.size());
  }
  double operator()(OfSet value) const {
    SetState set;
    set.u = mean(state.u, m.nodes);
    set.length = m.length;
    if (!state.velocity.empty()) {
      set.velocity = mean(state.velocity, m.nodes);
      set.acceleration = mean(state.acceleration, m.nodes);
    }
    for (int node : m.nodes) set.reaction += state.reaction[node];
    if (!m.facets.empty()) set.swept = swept_volume(body.mesh(), m.facets, state.u);
    return value(set);
  }
  double operator()(OfPoint value) const {
    double sum = 0;
    for (int node : m.nodes) {
      for (const auto [e, a] : body.corners(node)) add_gauss_values(body, state.u, e, gauss);
      sum += value(node_values(body, node, gauss, at), m.family);
    }
    return sum / static_cast<double>(m.nodes.size());
  }
  double operator()(OfBody value) const {
    if (!all) all = extremes(body, state.u, gauss);
    return value(*all);
  }
};

}  // namespace

// The values of all columns in one state. Quotients are computed last, from the other columns.
std::vector<double> measured(const Body& body, const std::vector<Measure>& measures, StressAt at,
                             const StepState& state, GaussValues& gauss) {
  std::vector<double> values;
  std::optional<Extremes> all;
  for (const Measure& m : measures) {
    if (m.quotient) {
      values.push_back(std::numeric_limits<double>::quiet_NaN());
    } else if (m.quantity) {
      values.push_back(
          std::visit(Measurement{body, m, at, state, gauss, all}, line_of(*m.quantity).value));
    } else {
      values.push_back(value_or(state.histories, m.history, 0));
    }
  }
  // Quotients come after all other columns, which they name.
  const auto value_of_column = [&](const std::string& name) {
    const auto found = std::ranges::find(measures, name, &Measure::name);
    if (found == measures.end()) return 0.0;
    return values[static_cast<std::size_t>(found - measures.begin())];
  };
  for (std::size_t i = 0; i < measures.size(); ++i) {
    if (!measures[i].quotient) continue;
    const auto& [above, below] = *measures[i].quotient;
    const double divisor = value_of_column(below);
    if (divisor != 0) values[i] = value_of_column(above) / divisor;
  }
  for (double& value : values) value += 0.0;  // no -0 in tables
  return values;
}

}  // namespace langer
