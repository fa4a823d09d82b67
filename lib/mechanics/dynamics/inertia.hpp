// Inertia of a body in motion: what M a + C v adds to the balance of forces of one increment.
//
//   M a + F_int(u) + C v = F_ext(t) + M g + R
//
// Each scheme says how velocity and acceleration at the end of an increment of h seconds follow
// from the displacements there. The increment is then solved like one without inertia, with a force
// and a tangent more (assembly/added_term.hpp).
//   generalised_alpha  [CH93] in the form of [AB07]: the balance holds at the end of the increment,
//                      where the acceleration is a; b carries the average:
//                        u1 = u0 + h v0 + h^2 ((1/2 - beta) b0 + beta b1)
//                        v1 = v0 + h ((1 - gamma) b0 + gamma b1)
//                        (1 - am) b1 + am b0 = (1 - af) a1 + af a0
//                        am = (2 rho_inf - 1) / (rho_inf + 1),  af = rho_inf / (rho_inf + 1)
//                        gamma = 1/2 - am + af,  beta = (1 - am + af)^2 / 4
//                      second order; rho_inf is what is left of the highest frequencies in a step
//   energy_momentum    [ST92], [GO96]: balance in the middle of the increment, u_m = (u0 + u1)/2,
//                      which is its unknown, with internal forces whose work is exactly the change of
//                      energy (element/conserving_solid.hpp). Second order; keeps energy and angular
//                      momentum
//   theta              [FJCM05]: impulses instead of accelerations,
//                        M (v1 - v0) = h ((1 - xi) F0 + xi F1) + h R,  u1 = u0 + h ((1 - theta) v0 + theta v1)
//                      F without R, which is the mean reaction of the increment
// C = c_m M + c_k K(0), Rayleigh's damping: c_m damps rigid motions, too.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/tensor/types.hpp"
#include "mechanics/assembly/assembler.hpp"
#include "mechanics/assembly/mass.hpp"
#include "mechanics/dynamics/motion_state.hpp"

namespace langer {

enum class Scheme { generalised_alpha, energy_momentum, theta };
constexpr auto names(Scheme) { return std::array{"generalised_alpha", "energy_momentum", "theta"}; }

// One of several bodies that share no node, and how it moves at the beginning.
struct MovingBody {
  std::string name;
  std::vector<int> nodes;
  Vec3 velocity = Vec3::Zero();  // [mm/s]
  Vec3 spin = Vec3::Zero();      // [1/s]
  Vec3 spin_centre = Vec3::Zero();
};

struct InertiaOptions {
  std::vector<double> density;  // by body [t/mm3]
  MassKind mass = MassKind::consistent;
  Scheme scheme = Scheme::generalised_alpha;
  double rho_inf = 0.8;
  double theta = 0.5, xi = 0.5;
  double damping_mass = 0;       // c_m [1/s]
  double damping_stiffness = 0;  // c_k [s]
  Vec3 gravity = Vec3::Zero();   // [mm/s2]
  Vec3 velocity = Vec3::Zero();  // of the body at the beginning [mm/s]
  Vec3 spin = Vec3::Zero();      // of the body at the beginning [1/s]
  Vec3 spin_centre = Vec3::Zero();
  std::vector<MovingBody> bodies;  // several, each with a velocity of its own; empty: one
  double travel_mass = 0;          // of an indenter with inertia [t]
  double travel_velocity = 0;      // along its direction [mm/s]
  double travel_weight = 0;        // along its direction [N]
  std::vector<char> massless;  // by node: the mass of contact nodes is moved inwards; empty: none
  double seconds = 1;          // of the path
};

class Inertia : public AddedTerm {
 public:
  // Refers to the body. Throws std::invalid_argument where make_mass does.
  Inertia(const Assembler& body, InertiaOptions options);

  const InertiaOptions& options() const { return options_; }
  const Mass& mass() const { return mass_; }
  bool conserves() const { return options_.scheme == Scheme::energy_momentum; }
  bool uses_impulses() const { return options_.scheme == Scheme::theta; }
  // The reactions of the balance times this are those of the increment.
  double reaction_scale() const { return uses_impulses() ? options_.xi : 1; }

  // Velocities as prescribed, accelerations from the balance at rest: M a = M g - C v.
  MotionState at_start() const;
  // An increment of `seconds` from there.
  void begin(const VecX& u, double travel, const MotionState& motion, double seconds);
  // What the velocity at the beginning adds to the displacements of free dofs until the unknown is
  // found.
  VecX predicted() const;
  double predicted_travel() const;

  VecX force(const VecX& u) override;
  const std::vector<double>& tangent() const override { return tangent_; }
  VecX tangent_times(const VecX& du) const override;
  const VecX& last_force() const { return last_force_; }  // (3 n) of the last call of force()

  // The force that the indenter with mass gives to the body at this travel, and how fast it falls.
  double travel_force(double travel) const;
  double travel_stiffness() const { return step_.travel_k; }

  // The displacements at the end, of the unknown of the scheme.
  VecX end_of(const VecX& u) const;

  // The state at the end of the increment. net: F_ext - F_int without inertia at the end (theta).
  MotionState end(const VecX& u1, double travel1, const VecX& net) const;

  // For derivatives of a path, of generalised_alpha only, where all of this is linear. `start` and
  // the movements are derivatives of the state that the increment began with and of the movement in
  // it.
  // Change of force() where the unknown stands still, and the same of travel_force().
  VecX force_of_history(const VecX& u0, const MotionState& start) const;
  double travel_force_of_history(double travel0, const MotionState& start) const;
  // Velocities and accelerations at the end; energies are left out.
  MotionState end_of_move(const VecX& moved, double travelled, const MotionState& start) const;
  // M a + C v of such a state (3 n).
  VecX force_of(const MotionState& motion) const;

  // What the results say of the beginning, which is no increment.
  struct StartValues {
    double kinetic = 0;               // [N mm]
    Vec3 momentum = Vec3::Zero();     // of all bodies [N s]
    std::vector<Vec3> momentum_of{};  // of each of several bodies
    double travel_v = 0;              // of an indenter with mass [mm/s]
  };
  const StartValues& start_values() const { return start_values_; }
  double kinetic(const MotionState& motion) const;  // with the indenter [N mm]
  Vec3 momentum(const MotionState& motion) const;   // of all bodies [N s]
  Vec3 momentum(const MotionState& motion, const MovingBody& body) const;
  double mass_of(const MovingBody& body) const;  // [t]
  // Of all bodies at displacements u, about the origin [N mm s].
  Vec3 angular_momentum(const VecX& u, const MotionState& motion) const;
  double work_of_gravity(const VecX& du, double dtravel) const;              // [N mm]
  double damped(const MotionState& before, const MotionState& after) const;  // [N mm]
  // Error of displacement in the increment, per time and in the norm of the kinetic energy, over
  // the speed that belongs to `energy` [ZX91].
  double error(const MotionState& after, double energy) const;
  // Size of M a [N].
  double force_scale() const;

 private:
  // Of the unknown of the scheme after the movement `moved` from u0; linear in both.
  VecX acceleration_of(const VecX& moved, const MotionState& start) const;
  VecX velocity_of(const VecX& moved, const MotionState& start) const;
  double travel_acceleration_of(double moved, const MotionState& start) const;
  void settle_massless(const VecX& moved, MotionState& end) const;

  const Assembler& body_;
  InertiaOptions options_;
  Mass mass_;
  std::optional<Eigen::SparseMatrix<double>> damping_;  // C
  std::vector<double> M_values_, C_values_;             // in the tangent's pattern
  VecX weight_;                                         // M g (3 n)
  std::vector<char> massless_;                          // by dof
  std::array<bool, 3> translates_{};  // ties allow a translation of the body along an axis
  bool whole_ = true;                 // nothing is tied: the body is not a part or a section

  // of the increment
  struct Step {
    double h = 1;                                     // [s]
    double am = 0, af = 0, beta = 0.25, gamma = 0.5;  // of generalised_alpha
    double a_u = 0, v_u = 0;                          // d a/du, d v/du of the unknown
    double travel_k = 0;                              // how fast travel_force() falls [N/mm]
    VecX u0;                                          // where it began
    double travel0 = 0;
    MotionState start;
  };
  Step step_;
  std::vector<double> tangent_;
  VecX last_force_, acceleration_;
  StartValues start_values_;
};

}  // namespace langer
