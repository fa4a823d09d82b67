// Derivatives of a run with respect to numbers of its scene, increment by increment: the key
// `sensitivity`, and the Jacobian of fits to scenes.
//
// Every accepted state is differentiated directly (solve/state_tangent.hpp). For a parameter of the
// material, the change of the internal force with u fixed is a difference of two forces; it is
// exact for moduli, in which forces are linear. With friction an increment needs the derivatives of
// the two before it; with bonds that of their states; of a body in motion, those of velocities and
// accelerations. What a viscous body remembers is differentiated by neighbours of it
// (viscous_neighbours.hpp).
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "accuracy/checks/recording.hpp"
#include "identification/inverse/load_neighbours.hpp"
#include "identification/inverse/viscous_neighbours.hpp"
#include "mechanics/solve/state_tangent.hpp"
#include "scene/model/scene_parameters.hpp"
#include "scene/run/vibration.hpp"

namespace langer {

class Sensitivity {
 public:
  // Of the numbers that config.sensitivity names, which was there when the run was made. Refers to
  // the run.
  Sensitivity(Run& run, const SolveConfig& config, const Run::Where& where);

  const std::vector<SceneParameter>& parameters() const { return parameters_.list(); }
  const std::set<std::string>& moved() const {
    return moved_;
  }  // sets whose reactions are differentiated

  // `listener`, and the derivatives: made after its of_part, and put into the record of the whole
  // body before its of_whole. Throws Failure(not_converged) where the tangent of a state is
  // singular, or bonds have let go in a jump.
  RunListener along(RunListener listener);
  // Before a run is resumed: every step that is kept, in order.
  void kept(const StepRecord& whole);

  // At the end of the path: of the frequencies of these modes, which symmetry of the state does not
  // mix. Numbers of layers, of shapes of indenters and of loads are left out, and all of a viscous
  // body.
  void add_frequencies(const Modes& modes, const std::vector<double>& density, ModesRecord& record);

  Observer observer();  // of a Recording; empty without the key
  std::vector<Summary> summary(const StepRecord& last)
      const;  // at the end of the path; d_force_N_d_... of the force's length

  // At the increment accepted last, of the whole body, one for each number, per its unit:
  //   u (n) [mm], reaction (n) [N], force_ind, u_ind (under force control), contacts' r, scalars energy, force_<contact>_x|y|z of
  //   several indenters, travel_<contact> under force control
  const std::vector<StepRecord>& now() const { return now_; }

 private:
  bool has_mass_of_its_own() const;
  void refuse_jump() const;                   // of bonds, on the way to the accepted state
  BondRates kept_bonds(std::size_t i) const;  // at the last state that is kept
  void advance(const StepRecord& record);     // of the part
  std::vector<ParameterChange> changes(std::vector<double>& energies);
  void add_contact_change(std::size_t i, ParameterChange& change) const;
  Assembler::Forces change_by_thickness(std::size_t i);
  StepRecord of_part(const StepRecord& record, const StateDerivative& d, const VecX& reactions,
                     double energy) const;
  StepRecord of_whole(const StepRecord& derivative, const StepRecord& whole) const;
  StepRecord of_mesh(const StepRecord& derivative,
                     const StepRecord& whole) const;  // that a hexahedron stands for
  void write(StepRecord& whole) const;

  Run& run_;
  const std::set<std::string> moved_;  // sets
  SceneParameters parameters_;
  BodyState last_, earlier_;  // accepted states of the part
  std::vector<StateDerivative> d_last_, d_earlier_;
  std::vector<StepRecord> of_part_, now_;
  // by parameter: the part of the body where a layer is thinner and thicker, by steps of that size
  struct ThicknessSteps {
    double step = 0;
    std::vector<Mesh> meshes;
    std::vector<std::unique_ptr<Assembler>> bodies;
  };
  std::map<std::size_t, ThicknessSteps> by_thickness_;
  std::optional<ViscousNeighbours> neighbours_;  // of a viscous body
  LoadNeighbours loads_;
};

// Derivative of -force . way/|way| with a fixed direction; of |force| if there is no way.
double derivative_against(const Vec3& way, const Vec3& force, const Vec3& d_force);
// The force of the body on one of several indenters [N].
Vec3 force_on(const StepRecord& record, const std::string& contact);
// Derivative of the size of force_ind, from the derivatives in a record of the whole body.
double length_derivative(const StepRecord& whole, const SceneParameter& parameter);
// Derivative of the column `force` (post/curves.hpp). whole: the state.
double force_derivative(const StepRecord& whole, const StepRecord& derivative);

}  // namespace langer
