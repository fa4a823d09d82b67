#include "post/curves.hpp"

#include <algorithm>
#include <limits>

#include "tensor/stress.hpp"

namespace langer {

namespace {

Vec3 mean(const std::vector<Vec3>& field, const std::vector<int>& nodes) {
  Vec3 sum = Vec3::Zero();
  for (int node : nodes) sum += field[node];
  return sum / static_cast<double>(nodes.size());
}

// Extremes over all Gauss points of the body, found together.
struct Extremes {
  double von_mises = -1, J = std::numeric_limits<double>::infinity(), fibre_stretch = -1;
  double pressure_min = std::numeric_limits<double>::infinity(), pressure_max = -pressure_min;
  Vec3 place = Vec3::Zero();
};

Extremes extremes(const Body& body, const std::vector<Vec3>& u, GaussValues& gauss) {
  Extremes all;
  int cell = 0, point = 0;
  for (int e = 0; e < body.mesh().n_cells(); ++e) {
    add_gauss_values(body, u, e, gauss);
    for (int g = 0; g < gauss[e].rows(); ++g) {
      const VecX row = gauss[e].row(g).transpose();
      const Mat3 sigma = sigma_of(row);
      if (const double s = von_mises(sigma); s > all.von_mises) all.von_mises = s, cell = e, point = g;
      all.J = std::min(all.J, J_of(row));
      all.pressure_min = std::min(all.pressure_min, mean_stress(sigma));
      all.pressure_max = std::max(all.pressure_max, mean_stress(sigma));
      for (std::size_t k = 0; k < body.fibres(e).size(); ++k)
        all.fibre_stretch = std::max(all.fibre_stretch, fibre_stretch_of(row, static_cast<int>(k)));
    }
  }
  all.place = gauss_position(body.mesh(), cell, point);
  return all;
}

double of_step(Quantity quantity, const StepState& s) {
  const auto history = [&](const char* name) {
    const auto found = s.histories.find(name);
    return found == s.histories.end() ? 0 : found->second;
  };
  const double travel = s.u_ind.norm();
  switch (quantity) {
    case Quantity::t:
      return s.t;
    case Quantity::increment:
      return s.increment;
    case Quantity::newton_iterations:
      return s.iterations;
    case Quantity::residual:
      return s.residual;
    case Quantity::work:
      return s.sums.work;
    case Quantity::dissipated:
      return s.sums.dissipated;
    case Quantity::balance:
      return s.sums.balance;
    case Quantity::u_ind:
      return travel;
    case Quantity::u_ind_x:
    case Quantity::u_ind_y:
    case Quantity::u_ind_z:
      return s.u_ind[component_of(quantity, Quantity::u_ind_x)];
    case Quantity::path:
      return s.sums.path;
    case Quantity::force:
      return travel > 0 ? -s.force_ind.dot(s.u_ind) / travel : s.force_ind.norm();
    case Quantity::force_x:
    case Quantity::force_y:
    case Quantity::force_z:
      return s.force_ind[component_of(quantity, Quantity::force_x)];
    case Quantity::contact_nodes:
      return s.stick + s.slip;
    case Quantity::stick_nodes:
      return s.stick;
    case Quantity::slip_nodes:
      return s.slip;
    default:
      return history(line_of(quantity).word);  // stability, energy, penetration, cone, complementarity
  }
}

double of_body(Quantity quantity, const Extremes& all) {
  switch (quantity) {
    case Quantity::J_min:
      return all.J;
    case Quantity::von_mises_max:
      return all.von_mises;
    case Quantity::pressure_min:
      return all.pressure_min;
    case Quantity::pressure_max:
      return all.pressure_max;
    case Quantity::fibre_stretch_max:
      return all.fibre_stretch;
    default:
      return all.place[component_of(quantity, Quantity::von_mises_max_x)];
  }
}

double of_set(Quantity quantity, const Measure& m, const StepState& s) {
  if (quantity >= Quantity::reaction_x) {
    double sum = 0;
    for (int node : m.nodes) sum += s.reaction[node][component_of(quantity, Quantity::reaction_x)];
    return sum;
  }
  return mean(s.u, m.nodes)[component_of(quantity, Quantity::eps_xx)] / m.length;
}

}  // namespace

StepState unloaded(const Mesh& mesh) {
  StepState state;
  state.u.assign(mesh.X.size(), Vec3::Zero());
  state.reaction = state.u;
  return state;
}

double value_of(Quantity quantity, const VecX& row, int family) {
  const Mat3 sigma = sigma_of(row);
  switch (quantity) {
    case Quantity::von_mises:
      return von_mises(sigma);
    case Quantity::pressure:
      return mean_stress(sigma);
    case Quantity::J:
      return J_of(row);
    case Quantity::fibre_stretch:
      return fibre_stretch_of(row, family);
    case Quantity::sigma_1:
    case Quantity::sigma_2:
    case Quantity::sigma_3:
      return principal_stresses(sigma)[component_of(quantity, Quantity::sigma_1)];
    default:
      return row[component_of(quantity, Quantity::sigma_xx)];
  }
}

std::vector<double> measured(const Body& body, const std::vector<Measure>& measures, StressAt at, const StepState& state,
                             GaussValues& gauss) {
  std::vector<double> values;
  std::optional<Extremes> all;
  for (const Measure& m : measures) {
    if (m.quotient) {
      values.push_back(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    if (!m.quantity) {
      const auto found = state.histories.find(m.history);
      values.push_back(found == state.histories.end() ? 0 : found->second);
      continue;
    }
    const Quantity q = *m.quantity;
    switch (line_of(q).of) {
      case Of::step:
      case Of::indenter:
        values.push_back(of_step(q, state));
        break;
      case Of::nodes:
        values.push_back(mean(state.u, m.nodes)[component_of(q, Quantity::u_x)]);
        break;
      case Of::set:
        values.push_back(of_set(q, m, state));
        break;
      case Of::point: {
        double sum = 0;
        for (int node : m.nodes) {
          for (const auto [e, a] : body.corners(node)) add_gauss_values(body, state.u, e, gauss);
          sum += value_of(q, node_values(body, node, gauss, at), m.family);
        }
        values.push_back(sum / static_cast<double>(m.nodes.size()));
        break;
      }
      case Of::body:
        if (!all) all = extremes(body, state.u, gauss);
        values.push_back(of_body(q, *all));
        break;
    }
  }
  const auto named = [&](const std::string& name) {
    const auto found = std::find_if(measures.begin(), measures.end(), [&](const Measure& m) { return m.name == name; });
    return found == measures.end() ? 0 : values[static_cast<std::size_t>(found - measures.begin())];
  };
  for (std::size_t i = 0; i < measures.size(); ++i)
    if (const auto& pair = measures[i].quotient)
      if (const double below = named((*pair)[1]); below != 0) values[i] = named((*pair)[0]) / below;
  for (double& value : values) value += 0.0;  // no -0 in tables
  return values;
}

}  // namespace langer
