// Assembly of a meshed body: internal and external forces, and the tangent.    [A23] eqs 31-33
//   F_int(u) - F_ext - R = 0
// Vectors have one entry per degree of freedom (3 n). The tangent has the free rows only, lower
// triangle in the order of its pattern.
//
// The parts of an assembly:
//   BodyModel        elements, materials, degrees of freedom        body_model.hpp
//   ElementPackets   forces and stiffness of eight elements at once  element_packets.hpp
//   ConservingForces those of an increment that keeps its energy   conserving_forces.hpp
//   PressureField    condensed pressures of mixed elements           pressure_field.hpp
//   ViscousState     branch stresses of viscous materials            viscous_state.hpp
//   SparseTangent    the global matrix                               sparse_tangent.hpp
//   Loads            tractions and pressures on the surface          loads.hpp
// The parallel loop over elements is here. Contributions are added in a fixed order, so that the
// number of threads does not change a bit of the result. On several ranks K() contains the elements
// of this rank only; forces, energy and bounds are those of the whole body on every rank.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "mechanics/assembly/added_term.hpp"
#include "mechanics/assembly/body_model.hpp"
#include "mechanics/assembly/conserving_forces.hpp"
#include "mechanics/assembly/element_packets.hpp"
#include "mechanics/assembly/loads.hpp"
#include "mechanics/assembly/pressure_field.hpp"
#include "mechanics/assembly/sparse_tangent.hpp"
#include "mechanics/assembly/viscous_state.hpp"

namespace langer {

// The tangent of a body under other constraints than its own.
struct OtherTangent {
  Dofs dofs;
  Pattern pattern;
  std::vector<double> K = {};  // (nnz) [N/mm]
};

class Assembler {
 public:
  Assembler(const Mesh& mesh, std::vector<Material> materials, Directions directions,
            Formulation formulation, Dofs dofs, int threads = 1, Kernel kernel = Kernel::packets,
            const std::vector<double>& cell_share = {}, std::optional<Division> division = {},
            Loads loads = {});
  Assembler(const Assembler&) = delete;  // its parts refer to its body
  Assembler& operator=(const Assembler&) = delete;

  // Forces on the surface, at t from now on. K() then contains the symmetric part of the stiffness
  // of pressures.
  void set_loads(Loads loads);
  const Loads& loads() const { return loads_; }
  void load_to(double t) { t_loads_ = t; }
  double loaded_to() const { return t_loads_; }
  void set_load_pressures(const VecX& p) { loads_.set_pressures(p); }  // of given volumes
  VecX unit_pressure(int volume, const VecX& u) const;                 // (3 n) [N/MPa]
  double swept_volume(int volume, const VecX& u) const;                // [mm^3]
  VecX load_forces(double t, const VecX& u) const;                     // (3 n) [N]

  // A further force with its tangent, from now on in f_int() and K(); nullptr: none. Refers to it.
  void set_added_term(AddedTerm* term) { added_ = term; }
  const AddedTerm* added_term() const { return added_; }
  struct Forces {
    VecX f;        // (3 n) f_int [N]
    double W = 0;  // [N mm]
  };

  // From now on internal forces are those of an increment from u0, which keep its energy and
  // angular momentum: assemble() then takes the middle of the increment, W() is the energy at its
  // end, and K() the symmetric part of the derivative. Elastic bodies, on one rank.
  void begin_conserving(const VecX& u0);
  bool conserves() const { return conserving_.active(); }
  // What K() omits of that derivative, times du (3 n) [N].
  VecX conserving_skew(const VecX& du) const { return conserving_.skew_times(du); }

  // Forces and, if requested, the tangent at u. False if an element is turned inside out, or a
  // force is not finite. du_prescribed: the displacement of prescribed unknowns that is still to be
  // made; K_du() is its effect.
  bool assemble(const VecX& u, bool with_tangent, const VecX* du_prescribed = nullptr);

  const VecX& f_int() const { return sums_.f; }      // (3 n) [N]
  const VecX& f_ext() const { return sums_.f_ext; }  // (3 n) [N]; empty without loads
  const std::vector<double>& K() const { return tangent_.values(); }  // (nnz) [N/mm]
  const VecX& K_du() const { return sums_.K_du; }                     // (3 n) [N]
  double W() const { return sums_.W; }  // energy [N mm]; of viscous bodies that of equilibrium
  double J_min() const { return sums_.J_min; }  // smallest det F
  double smallest_J(const VecX& u) const;       // the same, without assembling
  // Rounding error of the residual: kappa eps |grad u| through each element's dilatation [N].
  double rounding_floor() const { return sums_.floor; }

  // Pressures of the tangent.
  const PressureField& pressures() const { return pressures_; }
  // After a correction du, of which the fraction `step` was taken. kept: the correction was solved
  // with the tangent of keep_dilatations().
  void predict_pressures(const VecX& du, double step, bool kept = false) {
    pressures_.predict(du, step, kept);
  }
  void keep_dilatations() { pressures_.keep_gradients(); }
  void move_pressures(const VecX& dp, double step) { pressures_.move(dp, step); }
  void pressures_from(const VecX& u);  // kappa (J - 1) at u, without predictions
  // p + s (p - p_before), with p_before at u_before; J - 1 at an extrapolated u would mean nothing.
  void extrapolate_pressures(const VecX& u_before, double s);
  VecX dilatation_residual() const { return pressures_.dilatation_residual(); }
  using VolumetricPart = PressureField::VolumetricPart;
  VolumetricPart volumetric_part() const { return pressures_.volumetric_part(); }
  // Pressures and bubble moduli of the next assembly, until others follow from displacements.
  void set_pressures(const PressureField::State& state) { pressures_.restore(state); }

  // Other parameters of the same materials, and directions of as many families, from the next
  // assembly on. Pressures of the tangent stay until pressures_from().
  void set_materials(std::vector<Material> materials, Directions directions);
  // Forces of such materials at u, with the pressures that belong to them. The body keeps its own
  // materials and forces.
  Forces forces_of(std::vector<Material> materials, Directions directions, const VecX& u);

  // Derivatives of f_int - f_ext at the u assembled last, if K() was made with the pressures of
  // that u (directional_derivative.cpp).
  VecX K_times(const VecX& v) const { return tangent_.times(v); }  // v of the free rows
  // What K() omits: the bubble modulus depends on u, and pressures on a free rim are not symmetric.
  // (3 n), for v (3 n) that moves no prescribed unknown; empty if there is nothing. W: the part of
  // the bubble modulus in the change of W(), f_int . v.
  VecX nonsymmetric_part(const VecX& u, const VecX& v, double* W = nullptr);
  // Derivative of f_int and W at the u assembled last where the bubble moduli change, by element
  // [MPa].
  Forces bubble_change(const VecX& u, const std::vector<double>& change);
  // Forces of pressures that change when the body at u moves by du, without what K() has: (3 n)
  // [N].
  VecX skew_pressures(const VecX& u, const VecX& du) const;
  // On the rows of prescribed unknowns, d f_int of each v; 0 elsewhere; (3 n) each.
  std::vector<VecX> prescribed_rows_times(const VecX& u, const std::vector<VecX>& v) const;

  // The tangent at u, with the pressures of the tangent, under other constraints. A reduced body
  // shows in this way how it resists movements that break its symmetry. Elements are evaluated once
  // for all of them; nothing else of the body changes. False if an element is turned inside out.
  OtherTangent tangent_under(Dofs dofs) const;
  bool assemble_under(const VecX& u, std::span<OtherTangent> others) const;

  // Increments of a viscous body, of `seconds`. Without effect on an elastic body.
  bool viscous() const { return viscous_.present(); }
  void begin_increment(double seconds);
  // Small movements away from the accepted state (mechanics/vibration): the stiffness has `follow`
  // of each branch added to the isochoric moduli, and the stress of the state stays.
  void begin_small_movements(const std::function<double(const ViscousBranch&)>& follow);
  double end_increment(const VecX& u) { return viscous_.end(u); }  // found; error of the time step
  void accept_increment(const VecX& u0, const VecX& u) { viscous_.accept(u0, u); }
  const std::optional<ViscousPoints>& viscous_points() const { return viscous_.points(); }
  double viscous_work() const { return viscous_.work(); }  // [N mm]

  const BodyModel& model() const { return body_; }
  const Pattern& pattern() const { return tangent_.pattern(); }
  const Mesh& mesh() const { return body_.mesh(); }
  const Dofs& dofs() const { return body_.dofs(); }
  const Division* division() const { return body_.division(); }
  const std::vector<int>& own_cells() const { return body_.own_cells(); }
  Formulation formulation() const { return body_.formulation(); }
  const std::vector<Material>& materials() const { return body_.materials(); }
  const Directions& directions() const { return body_.directions(); }
  const Material& material(int e) const { return body_.material(e); }
  std::span<const Vec3> fibres(int e) const { return body_.fibres(e); }
  const ElementGeometry& geometry(int e) const { return body_.geometry(e); }
  std::vector<int> element_dofs() const { return body_.element_dofs(); }
  ElementNodes element_displacements(const VecX& u, int e) const {
    return body_.displacements(u, e);
  }

 private:
  void add_block(std::size_t b, const PacketElement& element, const VecX& u, bool with_tangent,
                 const VecX* du_prescribed);
  void add_internal_force(int e, const PacketElement& element, int lane);
  double rounding_error(int e, const VecX& u) const;
  void add_prescribed_effect(int e, const PacketElement& element, int lane, const VecX& du);
  void add_loads(const VecX& u, bool with_tangent, const VecX* du_prescribed);
  void add_forces(int e, const ElementNodes& force, VecX& to) const;
  void add_load_stiffness(int e, const MatX& stiffness, const VecX* du_prescribed);
  void sum_over_ranks(bool with_tangent);
  VecX loads_times(const VecX& u, const VecX& v) const;
  VecX bubble_part(const VecX& u, const VecX& v, double* W);

  BodyModel body_;
  ElementPackets packets_;
  PressureField pressures_;
  ViscousState viscous_;
  SparseTangent tangent_;
  Loads loads_;
  AddedTerm* added_ = nullptr;
  double t_loads_ = 0;
  int threads_;
  // What an assembly adds up.
  struct Sums {
    VecX f, K_du, f_ext;
    double W = 0;
    double J_min = 1;
    double floor = 0;
  };
  Sums sums_;
  ConservingForces conserving_;
};

}  // namespace langer
