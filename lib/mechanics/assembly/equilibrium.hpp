// Balance of a meshed body: internal force, tangent and the pressures that the tangent uses. [A23]
// eqs 31-33
//   F_int(u) - F_ext - R = 0
// Vectors have one entry per dof (3 n); the tangent has the free rows only, lower triangle in the
// pattern's order. A cell's material is materials[body[e]]. A cell counts cell_share[e] times: for
// a body that symmetry reduces, the number of cells of the whole that it stands for. The parallel
// loop over elements lives here; sums are made in order, so the number of threads does not change a
// bit of the result. Divided among ranks, K() is what a rank's own cells make of it, in a pattern
// of their own, and so is what it knows of single cells; forces, energy and bounds are those of the
// whole body on every rank.
#pragma once

#include <optional>
#include <vector>

#include "mechanics/assembly/division.hpp"
#include "mechanics/assembly/dofs.hpp"
#include "mechanics/assembly/loads.hpp"
#include "mechanics/assembly/pattern.hpp"
#include "mechanics/element/packet_solid.hpp"
#include "mechanics/mesh/directions.hpp"
#include "mechanics/mesh/hanging.hpp"
#include "mechanics/mesh/mesh.hpp"

namespace langer {

enum class Kernel { packets, one_by_one };  // one_by_one: the scalar element, the oracle of tests

class Equilibrium {
 public:
  Equilibrium(const Mesh& mesh, std::vector<Material> materials, Directions directions,
              Formulation formulation, Dofs dofs, int threads = 1, Kernel kernel = Kernel::packets,
              std::vector<double> cell_share = {}, std::optional<Division> division = {});

  // Forces on the surface, at t from now on: K() then has the symmetric part of what pressures take
  // from the tangent.
  void set_loads(Loads loads);
  const Loads& loads() const { return loads_; }
  void load_to(double t) { t_loads_ = t; }
  const VecX& f_ext() const { return f_ext_; }  // (3 n) [N]; empty without loads

  // What the forces of pressures change by where the body, at u, moves by du, less what K() has of
  // it: (3 n) [N]. That is the free rim of a pressed region; 0 without pressures.
  VecX skew_pressures(const VecX& u, const VecX& du) const;

  // Forces and, if asked, the tangent at u. False where an element is turned inside out.
  // du_prescribed: the movement of prescribed dofs still to be made; its effect K du appears in
  // K_du().
  bool assemble(const VecX& u, bool with_tangent, const VecX* du_prescribed = nullptr);

  const VecX& f_int() const { return f_; }             // (3 n) [N]
  const std::vector<double>& K() const { return K_; }  // (nnz) [N/mm]
  const VecX& K_du() const { return K_du_; }           // (3 n) K times du_prescribed [N]
  double W() const {
    return W_;
  }  // stored energy [N mm]; of viscous bodies what is left after all has relaxed
  double J_min() const { return J_min_; }
  double smallest_J(const VecX& u) const;  // over all Gauss points, without assembling
  // what rounding leaves in the residual: kappa eps |grad u| through each element's dilatation
  // gradient [N]
  double rounding_floor() const { return floor_; }

  // Pressure of the linearised dilatation after u + du (fraction `step` of it taken): the next
  // tangent uses it. kept: with the gradients of the dilatations that were there at
  // keep_dilatations(), as a tangent of that time has them.
  void predict_pressures(const VecX& du, double step, bool kept = false);
  void keep_dilatations() { dJ_du_kept_ = dJ_du_; }
  // What a solution with the kept gradients b0 needs beside the residual at the u assembled last,
  // in the mixed equations of displacements and pressures condensed:  sum V (kappa t - p) (b - b0),
  // (3 n) [N]. Without it a tangent that is only a little old is of no use near incompressibility:
  // kappa (b - b0) is large. For modes, not for pressures of Gauss points.
  VecX turned_dilatations() const;
  void pressures_from(const VecX& u);  // forget predictions: kappa (J - 1) at u
  // p + s (p - p_before), p_before those at u_before; J - 1 at an extrapolated u would mean nothing
  void extrapolate_pressures(const VecX& u_before, double s);
  void move_pressures(const VecX& dp, double step);  // p + step dp, of cells with one dilatation

  // mean_dilatation: what K(), as assembled last, has from the volume,  sum of V kappa b b^T over
  // the cells, b = dJ_bar / du
  struct VolumetricPart {
    std::vector<double> b;  // by cell, (n_dofs) in the order of cell_dofs() [1/mm]
    VecX V, kappa;          // by cell [mm^3], [MPa]
    VecX missing;           // by cell: U'(J_bar) less the pressure of the tangent [MPa]
  };
  VolumetricPart volumetric_part() const;
  std::vector<int> cell_dofs() const;  // by cell: the dofs that move its nodes

  // Other numbers of the same laws, and directions of as many families in each cell, from the next
  // assembly on. Pressures that the tangent uses stay until pressures_from().
  void set_laws(std::vector<Material> materials, Directions directions);
  // The same for once: what such laws say at u, with the pressures that are theirs there. The body
  // keeps its own laws and forces.
  struct Forces {
    VecX f;        // (3 n) f_int [N]
    double W = 0;  // [N mm]
  };
  Forces with_laws(std::vector<Material> materials, Directions directions, const VecX& u);
  const std::vector<Material>& materials() const { return materials_; }
  const Directions& directions() const { return directions_; }

  // Derivatives of f_int - f_ext at the u assembled last, where K() has been made with the
  // pressures of that u (assembly/directional.cpp).
  VecX K_times(const VecX& v) const;  // free rows: K() v, v of the free rows
  // What K() has not: the modulus `local` is a function of u, and pressures on a free rim are not
  // symmetric. (3 n), for v (3 n) that moves no prescribed dof. Empty where there is nothing. W:
  // takes what that modulus adds to the change of W(), f_int . v.
  VecX beside_K(const VecX& u, const VecX& v, double* W = nullptr);
  // On the rows of prescribed dofs, d f_int of each v, others 0; (3 n) each.
  std::vector<VecX> on_prescribed(const VecX& u, const std::vector<VecX>& v) const;

  // Increments of a viscous body, of `seconds`: what it remembers at the begin stands in every
  // assembly until the next one. None of this has an effect on an elastic body.
  bool viscous() const { return viscous_.has_value(); }
  void begin_increment(double seconds);
  double end_increment(const VecX& u);  // found; ViscousPoints::error()
  void accept_increment(const VecX& u0, const VecX& u);
  const std::optional<ViscousPoints>& memory() const { return viscous_; }
  double viscous_work() const;  // integral of the branch stresses over the strain since rest [N mm]

  const Division* division() const {
    return division_ ? &*division_ : nullptr;
  }                                                           // nullptr: all cells are this rank's
  const std::vector<int>& own_cells() const { return own_; }  // ascending
  const Dofs& dofs() const { return dofs_; }
  const Pattern& pattern() const { return pattern_; }
  const Mesh& mesh() const { return mesh_; }
  Formulation formulation() const { return formulation_; }
  const Material& material(int e) const {
    return materials_[mesh_.body.empty() ? 0 : mesh_.body[e]];
  }
  std::span<const Vec3> fibres(int e) const { return directions_.of(e); }
  // of all cells on rank 0; else of a rank's own
  const ElementGeometry& geometry(int e) const { return geometry_[e]; }
  ElementNodes element_displacements(const VecX& u,
                                     int e) const;  // of the nodes that move the cell (MovingNodes)

 private:
  double bulk_modulus(int e) const { return langer::bulk_modulus(material(e)); }  // at rest [MPa]
  // of the modes, at the pressure p_ of the tangent: what is not left to `local`
  double modal_pressure(int e, int k) const;
  void pressures_of(int e, const double* J_minus_1, double* p) const;
  void follow_pressures();  // local_ from p_
  void pack_fibres();
  VecX loads_times(const VecX& u, const VecX& v) const;
  VecX local_beside_K(const VecX& u, const VecX& v, double* W);
  // up to eight cells of one material; short blocks repeat their last cell
  struct Block {
    int cells[Packet::lanes];
    int n;
  };
  void sum_over_ranks(bool with_tangent);
  void make_blocks();
  void find_beginnings();
  void load(const Block& block, const VecX& u, Packet* q) const;
  void compute(const Block& block, const VecX& u, bool with_tangent, PacketElement& out) const;
  void add_force(VecX& forces, int node, bool tied,
                 const Vec3& force) const;  // to the dofs that the node moves with
  void add_stiffness(int e, const PacketElement& out, int lane);
  void add_tied(int e, const PacketElement& out, int lane, bool with_tangent);
  void add_loads(const VecX& u, bool with_tangent, const VecX* du_prescribed);
  int position(int e, int row, int column) const;  // of a cell's entry, row >= column, in K
  void add(const Block& block, const PacketElement& out, const VecX& u, bool with_tangent,
           const VecX* du_prescribed);

  const Mesh& mesh_;
  std::vector<Material> materials_;
  Directions directions_;
  Formulation formulation_;
  int n_nodes_, n_dofs_, n_p_;  // of a cell; dilatations
  Dofs dofs_;
  std::optional<Division> division_;
  std::vector<int> own_;
  MovingNodes moving_;
  Pattern pattern_;
  int threads_;
  Kernel asked_, kernel_;  // packets where they can
  std::vector<Block> blocks_;
  // K is not cleared as a whole: whoever comes first to a block of two nodes writes it
  std::vector<char> begins_;  // by element and pair of nodes, as pattern_.blocks()
  std::vector<int> cleared_;  // positions to which a scattered element comes first
  std::vector<PacketGeometry> packet_geometry_;  // per block
  std::vector<std::vector<PacketFibre>> packet_fibres_;
  std::vector<ElementGeometry> geometry_;
  std::vector<char>
      tied_;  // by cell: one of its nodes moves as another does; empty without symmetry
  std::vector<double>
      p_;  // n_p_ for each element: kappa times the dilatations of its modes or Gauss points
  std::vector<double> J_minus_1_;  // same shape
  std::vector<double> dJ_du_;      // n_dofs_ for each of them
  std::vector<double> dJ_du_kept_;
  std::vector<double> local_;  // by cell: modulus of what its modes leave of J - 1 [MPa]
  std::optional<ViscousPoints> viscous_;
  std::vector<std::vector<Packet>> packet_H_;  // per block, as PacketMemory has it
  Loads loads_;
  double t_loads_ = 0;
  VecX f_, K_du_, f_ext_;
  VecX J_at_;  // u that J_minus_1_ and dJ_du_ are those of; empty: of none
  std::vector<double> K_;
  double W_ = 0, J_min_ = 1, floor_ = 0;
};

}  // namespace langer
