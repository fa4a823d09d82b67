// Energy along the path of a solution: the work of what moves the body, and what friction takes of
// it.
//   work        of the indenters (force along their way and torque over their angle), of imposed displacements and of forces on the surface, the integral of force over movement
//               [N mm]: a parabola through each three neighbouring states of a straight piece of the path (trapezoids would err by
//               the step squared)
//   dissipated  sum over steps and contact nodes of -r_t . x_t, the mean of both ends of the step, x_t the slip in it [N mm]; of
//               an indenter that turns the slip seen from half of its angle on, as long as the arc
//   balance     (work - stored - dissipated) over the largest work so far: what the steps are too long for [-]
//   path        length of the way that the first indenter has gone [mm]
//   hysteresis  work since the first indenter last began to go on after it had come back: at the end of a cycle what that has cost [N mm]
//   pull_off    greatest pull so far of bonds on an indenter, towards the body along the normal where they touch [N]
//   relaxation  force of the first indenter over its greatest so far [-]
// stored counts the work against viscous branches too (element/viscous_points.hpp), whether they
// still hold it or not.
#pragma once

#include <vector>

#include "mechanics/assembly/dofs.hpp"
#include "mechanics/contact/contact.hpp"
#include "mechanics/mesh/mesh.hpp"

namespace langer {

struct PathSums {
  double path = 0, work = 0, dissipated = 0, balance = 0, hysteresis = 0, relaxation = 1,
         pull_off = 0;
};

class EnergyPath {
 public:
  // kinks: places on the path at which an imposed displacement or a load changes its rate
  EnergyPath(const Mesh& mesh, std::vector<RigidContact> contacts, std::vector<double> kinks = {},
             std::vector<TurnedSet> turned = {});

  struct State {
    double t = 0;
    std::vector<Vec3> u, reaction;     // (n) [mm], [N]
    std::vector<std::vector<Vec3>> r;  // per contact and candidate: reaction on the body [N]
    double stored = 0;                 // [N mm]
    VecX loads = {};  // (3 n) forces on the surface [N]; empty where there are none
    // where indenters adhere: like r, what bonds do to the body (of a contact without them empty);
    // work done in increments with a jump
    std::vector<std::vector<Vec3>> bonds = {};
    double jumps = 0;
  };
  void add(State state);               // in the order of the path, from the unloaded one
  std::vector<PathSums> sums() const;  // one for each state added
  // Way of the candidates of a contact along its indenter up to the last state added, in increments
  // at both ends of which they touch [mm].
  const std::vector<double>& slip(std::size_t contact) const { return slips_[contact]; }

 private:
  struct Interval {
    double dt, begin, end;  // power per t at its two ends [N mm]
    bool goes_on;           // in the direction of the interval before
    double way, dissipated;
    double travel,
        force;  // of the first indenter at the end: distance from its start, length of the force
    double pull = 0;
  };
  struct Ends {
    std::vector<Vec3> begin, end;  // (n)
  };
  void add_contact(std::size_t k, const State& now, Interval& step, Ends& from_contact,
                   std::vector<Vec3>& rates);
  Ends imposed(
      const State& now) const;  // movement in the interval, at the rates of its two ends [mm]
  const Mesh& mesh_;
  std::vector<RigidContact> contacts_;
  std::vector<double> kinks_;
  std::vector<TurnedSet> turned_;
  State last_;
  bool jumped_ = false;  // in the last interval
  std::vector<Interval> intervals_;
  std::vector<double> stored_;
  std::vector<std::vector<double>> slips_;
  std::vector<Vec3>
      rates_;  // of the indenters in the last interval, per t: movement, and rotation after it
};

}  // namespace langer
