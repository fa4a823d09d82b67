// Energy along the path of a solution: the work of everything that moves the body, and the part
// that friction dissipates.
//   work        of the indenters (force over movement, torque over angle), of imposed displacements
//               and of forces on the surface: the integral of force over movement [N mm]. It is
//               integrated by a parabola through each three neighbouring states of a straight piece
//               of the path, because trapezoids have an error of the step squared.
//   dissipated  sum over steps and contact nodes of -r_t . x_t [N mm]: r_t the mean tangential
//               force of both ends of the step, x_t the slip in it. It never falls: a force that
//               would drive the slip is that of a node that stuck first, and the force of the other
//               end counts instead. For an indenter that turns, the
//               slip is seen from half of its angle and is as long as the arc. Of deformable
//               surfaces the slip is that of the mortar nodes (mortar/surface_contact.hpp).
//   balance     (work - stored - dissipated) over the largest work so far: the error of the
//               increments [-]
//   path        distance that the first indenter has travelled [mm]
//   hysteresis  work since the first indenter last began to advance after a return [N mm]; at the
//               end of a cycle its energy loss
//   pull_off    greatest pull so far of bonds on an indenter, towards the body along the normal of
//               the contact [N]
//   relaxation  force of the first indenter over its greatest so far [-]
// `stored` includes the whole work against viscous branches (element/viscous_points.hpp), whether
// they still store it or have dissipated it.
#pragma once

#include <span>
#include <vector>

#include "mechanics/assembly/dofs.hpp"
#include "mechanics/contact/contact.hpp"
#include "mechanics/mesh/mesh.hpp"
#include "mechanics/mortar/surface_contact.hpp"

namespace langer {

// The sums up to one state; see above.
struct PathSums {
  double path = 0, work = 0, dissipated = 0, balance = 0, hysteresis = 0, relaxation = 1,
         pull_off = 0;
};

// The force with which an indenter at c and its bonds pull the body towards it, along the mean
// normal of the nodes in contact [N]. u: of all nodes; r, bonds: of the candidates
double pull_force(const RigidContact& contact, const Mesh& mesh, std::span<const Vec3> u,
                  std::span<const Vec3> r, std::span<const Vec3> bonds, const Vec3& c);
// The same of two deformable surfaces: what pulls the non-mortar side towards the other one.
double pull_force(const std::vector<MortarNode>& nodes, std::span<const Vec3> r,
                  std::span<const Vec3> bonds);
// of all nodes (3 n), with the displacements u of a record
VecX positions(const Mesh& mesh, const std::vector<Vec3>& u);

// Adds up energies state by state. The sums of a state also depend on the state after it, because
// the parabola uses both neighbours, so they are computed at the end.
class EnergyPath {
 public:
  // kinks: places on the path at which an imposed displacement or a load changes its rate;
  // surfaces: deformable ones that touch
  EnergyPath(const Mesh& mesh, std::vector<RigidContact> contacts, std::vector<double> kinks = {},
             std::vector<TurnedSet> turned = {}, std::vector<SurfaceContact> surfaces = {});

  // What the sums need of each state of the path.
  struct State {
    double t = 0;
    std::vector<Vec3> u, reaction;  // (n) [mm], [N]
    // per contact, then per surface, and candidate: reaction on the body [N]
    std::vector<std::vector<Vec3>> r;
    double stored = 0;  // [N mm]
    VecX loads = {};    // (3 n) forces on the surface [N]; empty without loads
    // Forces of bonds on the body, like r; empty for a contact or a surface without adhesion.
    std::vector<std::vector<Vec3>> bonds = {};
    double jumps = 0;  // work done since rest in increments that hold a jump
  };
  void add(State state);               // in the order of the path, from the unloaded one
  std::vector<PathSums> sums() const;  // one for each state added
  // The slip of the candidates of a contact along what they touch, up to the last state added [mm].
  // Only increments with contact at both ends count.
  const std::vector<double>& slip(std::size_t contact) const { return slips_[contact]; }

 private:
  // The increment between two states.
  struct Interval {
    double dt;
    double begin, end;     // power per t at its two ends [N mm]
    bool continues;        // with the rates of the interval before
    double way;            // of the first indenter [mm]
    double dissipated;     // [N mm]
    double travel, force;  // of the first indenter at the end: distance from its start, force
    double pull = 0;
  };
  // A field of nodes at the two ends of an interval.
  struct Ends {
    std::vector<Vec3> begin, end;  // (n)
  };
  // The part of one contact in the interval that ends with `now`.
  void add_contact(std::size_t k, const State& now, Interval& step, Ends& from_contact,
                   std::vector<Vec3>& rates);
  // The same of a pair of surfaces; their forces do no work but that of friction.
  void add_surfaces(const State& now, Interval& step, Ends& from_contact);
  // The movement in the interval, extrapolated from the rates at its two ends [mm].
  Ends imposed(const State& now) const;
  const Mesh& mesh_;
  std::vector<RigidContact> contacts_;
  std::vector<double> kinks_;
  std::vector<TurnedSet> turned_;
  std::vector<SurfaceContact> surfaces_;
  State last_;
  std::vector<std::vector<MortarNode>> last_nodes_;  // of the surfaces in it
  bool jumped_ = false;                              // in the last interval
  std::vector<Interval> intervals_;
  std::vector<double> stored_;
  std::vector<std::vector<double>> slips_;
  // The rates of the indenters in the last interval: of the movement and of the rotation, per t.
  std::vector<Vec3> rates_;
};

}  // namespace langer
