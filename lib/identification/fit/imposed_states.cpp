#include "identification/fit/imposed_states.hpp"

#include <algorithm>
#include <limits>

#include "core/tensor/invariants.hpp"
#include "core/tensor/kinematics.hpp"
#include "core/tensor/stress.hpp"
#include "mechanics/material/terms.hpp"

namespace langer {

namespace {

// Whether a free width or a free shear depends on the law. It does not where all fibres lie along
// x.
bool is_imposed(const Test& test, const std::vector<Vec3>& a) {
  const bool axial =
      std::all_of(a.begin(), a.end(), [](const Vec3& one) { return one[1] == 0 && one[2] == 0; });
  const bool slides = test.kind == TestKind::simple_shear;
  const bool free_shear = test.shear == OffAxisShear::free && !slides;
  return axial || (test.kind != TestKind::uniaxial && !free_shear);
}

bool is_of_stretches(const Material& law) {
  return std::any_of(law.matrix.begin(), law.matrix.end(), [](const MatrixTerm& term) {
    return std::visit([]<class Law>(const Law&) { return Law::of == Invariant::squared_stretches; },
                      term);
  });
}

// A law without energy: its states are those that a test imposes.
Material without_energy(const Material& law) {
  Material none;
  for (const Fibre& fibre : law.fibres) none.fibres.push_back({HgoFibre{0, 0}, fibre.alpha_deg});
  return none;
}

}  // namespace

// The invariants of eight points, as for_each_term() asks for them.
class ImposedStates::State {
 public:
  explicit State(const Points& points) : p_(points) {}
  Packet I1_bar() const { return p_.I1; }
  Packet I2_bar() const { return p_.I2; }
  Packet m() const { return 1.0; }  // the states are isochoric
  struct Family {
    std::size_t k;
    double kappa;
    Packet I;
  };
  Family family(const Fibre& fibre, std::size_t k) const {
    return {k, fibre.kappa, fibre.kappa * p_.I1 + (1 - 3 * fibre.kappa) * p_.I4[k]};
  }

 private:
  const Points& p_;
};

std::optional<ImposedStates> ImposedStates::of(const Material& law, const Test& test) {
  const std::vector<Vec3> a = specimen_fibres(law, test.fibre_angle_deg);
  const bool has_past = is_viscous(law) && !test.time.empty();
  if (has_past || is_of_stretches(law) || !is_imposed(test, a)) return std::nullopt;
  ImposedStates states;
  states.alpha_deg_ = fibre_angles(law);
  states.n_points_ = test.points();
  states.has_z_ = !test.stress_z.empty();
  const Material none = without_energy(law);
  const std::size_t lanes = Packet::lanes;
  states.points_.resize((test.points() + lanes - 1) / lanes);
  for (std::size_t i = 0; i < lanes * states.points_.size(); ++i) {
    const std::size_t point = std::min(i, test.points() - 1);
    Points& eight = states.points_[i / lanes];
    const int lane = static_cast<int>(i % lanes);
    if (lane == 0) {
      eight.I4.resize(a.size());
      eight.x.of_I4.resize(a.size());
      eight.z.of_I4.resize(a.size());
    }
    const PlaneState state =
        plane_state(none, a, test.kind, test.first[point], test.second_at(point), test.shear);
    if (!state.converged) {
      states.exist_ = false;
      return states;
    }
    const Invariants v = invariants(right_cauchy_green(state.F));
    eight.I1.set(lane, linear_bar(v, identity6()));
    eight.I2.set(lane, I2_bar(v));
    const auto coefficients = [&](const Vec6& dI_dC, Packet& x, Packet& z) {
      PlaneState of_term = state;
      of_term.sigma = cauchy(state.F, 2 * dI_dC, 1);
      of_term.sigma -= of_term.sigma(1, 1) * Mat3::Identity();
      const auto both = measured_stress(of_term, test.kind, test.measure);
      x.set(lane, both[0]);
      z.set(lane, both[1]);
    };
    coefficients(dlinear_bar_dC(v, identity6()), eight.x.of_I1, eight.z.of_I1);
    coefficients(dI2_bar_dC(v), eight.x.of_I2, eight.z.of_I2);
    for (std::size_t k = 0; k < a.size(); ++k) {
      const Vec6 M = structural_tensor(a[k]);
      eight.I4[k].set(lane, linear_bar(v, M));
      coefficients(dlinear_bar_dC(v, M), eight.x.of_I4[k], eight.z.of_I4[k]);
    }
  }
  return states;
}

bool ImposedStates::hold_for(const Material& law) const { return fibre_angles(law) == alpha_deg_; }

bool ImposedStates::stress(const Material& law, double* stress) const {
  if (!exist_) return false;
  for (std::size_t eight = 0; eight < points_.size(); ++eight) {
    const Points& points = points_[eight];
    Packet W = 0.0;
    Packet dW_I1 = 0.0;
    Packet dW_I2 = 0.0;
    Packet x = 0.0;
    Packet z = 0.0;
    for_each_term<Packet>(law, State(points),
                          Overloaded{[&](OfI1, const Energy<Packet>& e) {
                                       W += e.W;
                                       dW_I1 += e.dW;
                                     },
                                     [&](OfI2, const Energy<Packet>& e) {
                                       W += e.W;
                                       dW_I2 += e.dW;
                                     },
                                     [&](const State::Family& family, const Energy<Packet>& e) {
                                       W += e.W;
                                       dW_I1 += family.kappa * e.dW;
                                       const Packet of_a = (1 - 3 * family.kappa) * e.dW;
                                       x += of_a * points.x.of_I4[family.k];
                                       z += of_a * points.z.of_I4[family.k];
                                     }});
    x += dW_I1 * points.x.of_I1 + dW_I2 * points.x.of_I2;
    z += dW_I1 * points.z.of_I1 + dW_I2 * points.z.of_I2;
    constexpr double finite = std::numeric_limits<double>::infinity();
    if (!within(W, finite) || !within(x, finite) || !within(z, finite)) return false;
    const std::size_t first = Packet::lanes * eight;
    for (std::size_t i = first; i < std::min(first + Packet::lanes, n_points_); ++i) {
      const int lane = static_cast<int>(i - first);
      stress[i] = x[lane];
      if (has_z_) stress[n_points_ + i] = z[lane];
    }
  }
  return true;
}

}  // namespace langer
