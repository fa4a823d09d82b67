#include "mechanics/dynamics/inertia.hpp"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <utility>

namespace langer {

namespace {

// Dofs of nodes whose mass is taken away; empty where none is.
std::vector<char> massless_dofs(const Dofs& dofs, const std::vector<char>& nodes) {
  std::vector<char> out;
  if (nodes.empty()) return out;
  out.assign(static_cast<std::size_t>(dofs.n), 0);
  for (int i = 0; i < dofs.n; ++i) out[i] = nodes[dofs.node(i / 3)];
  return out;
}

// A node with unknowns of its own.
bool moves_itself(const Assembler& body, int node) {
  return body.dofs().node(node) == node && !hanging_at(body.mesh().hanging, node);
}

Mat3 own_movement(const Dofs& dofs, int node) {
  if (dofs.tie.empty()) return Mat3::Identity();
  return dofs.tie[node].T;
}

// The tangent of the body at rest on all of its unknowns, prescribed ones included: (3 n, 3 n).
Eigen::SparseMatrix<double> stiffness_at_rest(const Assembler& body) {
  const Dofs& own = body.dofs();
  OtherTangent all =
      body.tangent_under(number_dofs(body.mesh().n_nodes(), {}, own.tie, body.mesh().hanging).dofs);
  body.assemble_under(VecX::Zero(own.n), std::span(&all, 1));
  std::vector<Eigen::Triplet<double>> entries;
  for (int column = 0; column < all.pattern.n; ++column) {
    const int j = all.dofs.free[column];
    for (int k = all.pattern.column_start[column]; k < all.pattern.column_start[column + 1]; ++k) {
      const int i = all.dofs.free[all.pattern.row[k]];
      entries.emplace_back(i, j, all.K[k]);
      if (i != j) entries.emplace_back(j, i, all.K[k]);
    }
  }
  Eigen::SparseMatrix<double> K(own.n, own.n);
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

// The averaged acceleration b1 of generalised_alpha after an increment of h seconds that moved by
// `moved`, from the velocity and the averaged acceleration before. T: VecX, or the double of a
// travel.
template <class T>
T averaged_acceleration(double h, double beta, const T& moved, const T& v, const T& b) {
  return (moved - h * v) / (beta * h * h) - (0.5 - beta) / beta * b;
}

}  // namespace

Inertia::Inertia(const Assembler& body, InertiaOptions options)
    : body_(body),
      options_(std::move(options)),
      mass_(make_mass(body.model(), options_.density, options_.mass, options_.massless)),
      massless_(massless_dofs(body.dofs(), options_.massless)) {
  const Dofs& dofs = body_.dofs();
  M_values_ = mass_.in_pattern(body_.pattern(), dofs);
  tangent_ = M_values_;
  if (options_.damping_mass > 0 || options_.damping_stiffness > 0) {
    damping_ = options_.damping_mass * mass_.M;
    if (options_.damping_stiffness > 0) {
      *damping_ += options_.damping_stiffness * stiffness_at_rest(body_);
    }
    C_values_ = Mass{*damping_, 0}.in_pattern(body_.pattern(), dofs);
  }
  translates_ = {true, true, true};
  whole_ = dofs.tie.empty();
  for (std::size_t i = 0; i < dofs.tie.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      if (dofs.tie[i].T.col(k) != Vec3::Unit(k)) translates_[k] = false;
    }
  }
  VecX g = VecX::Zero(dofs.n);
  for (int i = 0; i < body_.mesh().n_nodes(); ++i) {
    if (moves_itself(body_, i)) g.segment<3>(3 * i) = own_movement(dofs, i) * options_.gravity;
  }
  weight_ = mass_.M * g;
  acceleration_ = VecX::Zero(dofs.n);
  const MotionState start = at_start();
  start_values_.kinetic = start.kinetic;
  start_values_.momentum = momentum(start);
  for (const MovingBody& one : options_.bodies) {
    start_values_.momentum_of.push_back(momentum(start, one));
  }
  start_values_.travel_v = start.travel_v;
  // A forecast assembles before any increment has begun: one of the whole path serves for it.
  begin(VecX::Zero(dofs.n), 0, start, options_.seconds);
}

MotionState Inertia::at_start() const {
  const Dofs& dofs = body_.dofs();
  MotionState start;
  start.v = VecX::Zero(dofs.n);
  start.a = start.v;
  start.b = start.v;
  start.reactions = start.v;
  for (int i = 0; i < body_.mesh().n_nodes(); ++i) {
    if (!moves_itself(body_, i)) continue;
    const Vec3 arm = body_.mesh().X[i] - options_.spin_centre;
    const Vec3 v = options_.velocity + options_.spin.cross(arm);
    start.v.segment<3>(3 * i) = own_movement(dofs, i) * v;
  }
  for (const MovingBody& moving : options_.bodies) {
    for (int node : moving.nodes) {
      if (!moves_itself(body_, node)) continue;
      const Vec3 arm = body_.mesh().X[static_cast<std::size_t>(node)] - moving.spin_centre;
      start.v.segment<3>(3 * node) =
          own_movement(dofs, node) * (moving.velocity + moving.spin.cross(arm));
    }
  }
  for (const Prescribed& p : dofs.prescribed) start.v[p.dof] = p.rate(0) / options_.seconds;

  VecX f = weight_;
  if (damping_) f -= *damping_ * start.v;
  std::vector<int> heavy;  // free dofs with mass
  std::vector<int> row(static_cast<std::size_t>(dofs.n), -1);
  for (int dof : dofs.free) {
    if (!massless_.empty() && massless_[dof]) continue;
    row[dof] = static_cast<int>(heavy.size());
    heavy.push_back(dof);
  }
  if (!heavy.empty() && !f.isZero(0)) {
    std::vector<Eigen::Triplet<double>> entries;
    VecX rhs(static_cast<Eigen::Index>(heavy.size()));
    for (std::size_t j = 0; j < heavy.size(); ++j) {
      rhs[static_cast<Eigen::Index>(j)] = f[heavy[j]];
      for (Eigen::SparseMatrix<double>::InnerIterator entry(mass_.M, heavy[j]); entry; ++entry) {
        const int i = row[static_cast<std::size_t>(entry.row())];
        if (i >= 0) entries.emplace_back(i, static_cast<int>(j), entry.value());
      }
    }
    const auto n = static_cast<Eigen::Index>(heavy.size());
    Eigen::SparseMatrix<double> M(n, n);
    M.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(M);
    const VecX a = factor.solve(rhs);
    for (std::size_t j = 0; j < heavy.size(); ++j) {
      start.a[heavy[j]] = a[static_cast<Eigen::Index>(j)];
    }
  }
  if (uses_impulses()) {
    start.b = f;
  } else {
    start.b = start.a;
  }
  start.travel_v = options_.travel_velocity;
  if (options_.travel_mass > 0) start.travel_a = options_.travel_weight / options_.travel_mass;
  start.travel_b = start.travel_a;
  start.kinetic = kinetic(start);
  start.total = start.kinetic;
  return start;
}

void Inertia::begin(const VecX& u, double travel, const MotionState& motion, double seconds) {
  step_.u0 = u;
  step_.travel0 = travel;
  step_.start = motion;
  step_.h = seconds;
  const double rho = options_.rho_inf;
  step_.am = (2 * rho - 1) / (rho + 1);
  step_.af = rho / (rho + 1);
  step_.gamma = 0.5 - step_.am + step_.af;
  step_.beta = 0.25 * (1 - step_.am + step_.af) * (1 - step_.am + step_.af);
  switch (options_.scheme) {
    case Scheme::generalised_alpha:
      step_.a_u = (1 - step_.am) / ((1 - step_.af) * step_.beta * step_.h * step_.h);
      step_.v_u = step_.gamma / (step_.beta * step_.h);
      break;
    case Scheme::energy_momentum:
      step_.a_u = 4 / (step_.h * step_.h);
      step_.v_u = 2 / step_.h;
      break;
    case Scheme::theta:
      step_.a_u = 1 / (options_.theta * options_.xi * step_.h * step_.h);
      step_.v_u = 1 / (options_.theta * step_.h);
      break;
  }
  step_.travel_k = options_.travel_mass * step_.a_u;
  for (std::size_t i = 0; i < M_values_.size(); ++i) tangent_[i] = step_.a_u * M_values_[i];
  for (std::size_t i = 0; i < C_values_.size(); ++i) tangent_[i] += step_.v_u * C_values_[i];
}

double Inertia::force_scale() const { return (mass_.M * acceleration_).norm(); }

VecX Inertia::predicted() const {
  const double h = conserves() ? 0.5 * step_.h : step_.h;
  VecX du = VecX::Zero(step_.u0.size());
  for (int dof : body_.dofs().free) du[dof] = h * step_.start.v[dof];
  return du;
}

double Inertia::predicted_travel() const {
  return step_.h * step_.start.travel_v + 0.5 * step_.h * step_.h * step_.start.travel_a;
}

// The acceleration that M meets in the balance.
VecX Inertia::acceleration_of(const VecX& moved, const MotionState& start) const {
  switch (options_.scheme) {
    case Scheme::generalised_alpha: {
      const VecX b1 = averaged_acceleration<VecX>(step_.h, step_.beta, moved, start.v, start.b);
      return ((1 - step_.am) * b1 + step_.am * start.b - step_.af * start.a) / (1 - step_.af);
    }
    case Scheme::energy_momentum:
      return (4 / step_.h * moved - 2 * start.v) / step_.h;
    case Scheme::theta:
      break;
  }
  return (velocity_of(moved, start) - start.v) / (step_.h * options_.xi);
}

// The velocity that C meets in the balance.
VecX Inertia::velocity_of(const VecX& moved, const MotionState& start) const {
  switch (options_.scheme) {
    case Scheme::generalised_alpha: {
      const VecX b1 = averaged_acceleration<VecX>(step_.h, step_.beta, moved, start.v, start.b);
      return start.v + step_.h * ((1 - step_.gamma) * start.b + step_.gamma * b1);
    }
    case Scheme::energy_momentum:
      return 2 / step_.h * moved;
    case Scheme::theta:
      break;
  }
  return (moved / step_.h - (1 - options_.theta) * start.v) / options_.theta;
}

// Of an indenter with mass, by generalised_alpha.
double Inertia::travel_acceleration_of(double moved, const MotionState& start) const {
  const double b1 =
      averaged_acceleration(step_.h, step_.beta, moved, start.travel_v, start.travel_b);
  return ((1 - step_.am) * b1 + step_.am * start.travel_b - step_.af * start.travel_a) /
         (1 - step_.af);
}

VecX Inertia::force(const VecX& u) {
  const VecX moved = u - step_.u0;
  acceleration_ = acceleration_of(moved, step_.start);
  last_force_ = mass_.M * acceleration_ - weight_;
  if (damping_) last_force_ += *damping_ * velocity_of(moved, step_.start);
  if (uses_impulses()) last_force_ -= (1 - options_.xi) / options_.xi * step_.start.b;
  return last_force_;
}

VecX Inertia::tangent_times(const VecX& du) const {
  VecX out = step_.a_u * (mass_.M * du);
  if (damping_) out += step_.v_u * (*damping_ * du);
  return out;
}

double Inertia::travel_force(double travel) const {
  const double m = options_.travel_mass;
  const double moved = travel - step_.travel0;
  if (uses_impulses()) {
    const double v1 =
        (moved / step_.h - (1 - options_.theta) * step_.start.travel_v) / options_.theta;
    return (options_.travel_weight - m * (v1 - step_.start.travel_v) / step_.h) / options_.xi;
  }
  return options_.travel_weight - m * travel_acceleration_of(moved, step_.start);
}

VecX Inertia::end_of(const VecX& u) const {
  if (conserves()) return VecX(2 * u - step_.u0);
  return u;
}

// By generalised_alpha.
MotionState Inertia::end_of_move(const VecX& moved, double travelled,
                                 const MotionState& start) const {
  MotionState end;
  end.b = averaged_acceleration<VecX>(step_.h, step_.beta, moved, start.v, start.b);
  end.a = acceleration_of(moved, start);
  end.v = velocity_of(moved, start);
  end.travel_b =
      averaged_acceleration(step_.h, step_.beta, travelled, start.travel_v, start.travel_b);
  end.travel_a = travel_acceleration_of(travelled, start);
  end.travel_v =
      start.travel_v + step_.h * ((1 - step_.gamma) * start.travel_b + step_.gamma * end.travel_b);
  settle_massless(moved, end);
  return end;
}

MotionState Inertia::end(const VecX& u1, double travel1, const VecX& net) const {
  MotionState end;
  const VecX moved = u1 - step_.u0;
  const double travelled = travel1 - step_.travel0;
  switch (options_.scheme) {
    case Scheme::generalised_alpha:
      end = end_of_move(moved, travelled, step_.start);
      break;
    case Scheme::energy_momentum:
      end.v = 2 / step_.h * moved - step_.start.v;
      end.a = (end.v - step_.start.v) / step_.h;
      end.b = end.a;
      settle_massless(moved, end);
      break;
    case Scheme::theta:
      end.v = velocity_of(moved, step_.start);
      end.a = (end.v - step_.start.v) / step_.h;
      end.b = net + weight_;
      if (damping_) end.b -= *damping_ * end.v;
      end.travel_v =
          (travelled / step_.h - (1 - options_.theta) * step_.start.travel_v) / options_.theta;
      end.travel_a = (end.travel_v - step_.start.travel_v) / step_.h;
      settle_massless(moved, end);
      break;
  }
  end.kinetic = kinetic(end);
  return end;
}

// A node without mass follows the others. Its velocity is that of the increment: differences of
// second order would remember the one with which it met an indenter.
void Inertia::settle_massless(const VecX& moved, MotionState& end) const {
  for (std::size_t dof = 0; dof < massless_.size(); ++dof) {
    if (!massless_[dof]) continue;
    const auto i = static_cast<Eigen::Index>(dof);
    end.v[i] = moved[i] / step_.h;
    end.a[i] = 0;
    if (!uses_impulses()) end.b[i] = 0;
  }
}

VecX Inertia::force_of(const MotionState& motion) const {
  VecX f = mass_.M * motion.a;
  if (damping_) f += *damping_ * motion.v;
  return f;
}

VecX Inertia::force_of_history(const VecX& u0, const MotionState& start) const {
  VecX f = mass_.M * acceleration_of(-u0, start);
  if (damping_) f += *damping_ * velocity_of(-u0, start);
  return f;
}

double Inertia::travel_force_of_history(double travel0, const MotionState& start) const {
  return -options_.travel_mass * travel_acceleration_of(-travel0, start);
}

double Inertia::kinetic(const MotionState& motion) const {
  return 0.5 * motion.v.dot(mass_.M * motion.v) +
         0.5 * options_.travel_mass * motion.travel_v * motion.travel_v;
}

Vec3 Inertia::momentum(const MotionState& motion) const {
  const VecX Mv = mass_.M * motion.v;
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index i = 0; i < Mv.size(); i += 3) sum += Mv.segment<3>(i);
  for (int k = 0; k < 3; ++k) {
    if (!translates_[k]) sum[k] = 0;  // of the parts that symmetry adds, the sum vanishes
  }
  return sum;
}

// Bodies share no node, so the columns of M at the nodes of one have entries at its nodes only.
Vec3 Inertia::momentum(const MotionState& motion, const MovingBody& body) const {
  Vec3 sum = Vec3::Zero();
  for (int node : body.nodes) {
    for (int k = 0; k < 3; ++k) {
      const int dof = 3 * node + k;
      for (Eigen::SparseMatrix<double>::InnerIterator entry(mass_.M, dof); entry; ++entry) {
        if (translates_[k]) sum[k] += entry.value() * motion.v[entry.row()];
      }
    }
  }
  return sum;
}

double Inertia::mass_of(const MovingBody& body) const {
  double sum = 0;
  for (int node : body.nodes) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(mass_.M, 3 * node); entry; ++entry) {
      sum += entry.value();
    }
  }
  return sum;
}

// Of a part or a section, the components that symmetry keeps from vanishing are not known here.
Vec3 Inertia::angular_momentum(const VecX& u, const MotionState& motion) const {
  Vec3 sum = Vec3::Zero();
  if (!whole_) return sum;
  const VecX Mv = mass_.M * motion.v;
  for (int i = 0; i < body_.mesh().n_nodes(); ++i) {
    const Vec3 x = body_.mesh().X[i] + u.segment<3>(3 * i);
    sum += x.cross(Vec3(Mv.segment<3>(3 * i)));
  }
  return sum;
}

double Inertia::work_of_gravity(const VecX& du, double dtravel) const {
  return weight_.dot(du) + options_.travel_weight * dtravel;
}

double Inertia::damped(const MotionState& before, const MotionState& after) const {
  if (!damping_) return 0;
  const VecX v = 0.5 * (before.v + after.v);
  return step_.h * v.dot(*damping_ * v);
}

double Inertia::error(const MotionState& after, double energy) const {
  if (!(energy > 0)) return 0;
  const double factor = uses_impulses() ? 0.5 : std::abs(step_.beta - 1. / 6);
  const VecX change = factor * step_.h * (after.a - step_.start.a);
  const double travel = factor * step_.h * (after.travel_a - step_.start.travel_a);
  const double squared = change.dot(mass_.M * change) + options_.travel_mass * travel * travel;
  return std::sqrt(squared / (2 * energy));
}

}  // namespace langer
