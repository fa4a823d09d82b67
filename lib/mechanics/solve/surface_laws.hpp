// The contact laws of deformable surfaces, and of indenters beside them, linearised at a state over
// the degrees of freedom that take part. With a movement d of these and a change dr of the
// reactions:
//   law      x = q + L d          gap and slip of each candidate (n, t1, t2)
//   forces   G dr + C d           on the nodes of both sides
// (mortar/mortar_linearisation.hpp; of indenters contact/contact.hpp).
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "mechanics/mortar/mortar_linearisation.hpp"
#include "mechanics/solve/contact_state.hpp"

namespace langer {

class TouchingBodies;

struct SurfaceLaws {
  // near: candidates whose gap the movement may close; bearing: those that bear something
  enum class Of { near, bearing };
  // all: the nodes of all candidates and of both sides take part, not only those of the rows
  enum class Nodes { involved, all };

  struct Rigid {
    std::size_t contact, candidate;
    LinearisedContact law;
    Vec3 r;  // local
  };
  std::vector<Rigid> rigid;       // first rows, three each
  std::vector<MortarLaw> mortar;  // by surface
  std::vector<int> column_of;     // (3 n), -1: none
  std::vector<int> dofs;          // by column
  Eigen::SparseMatrix<double> L, G, C;
  VecX q, r, mu;  // local positions and reactions (3 rows), friction (rows)

  int n_rows() const;
  // local reactions (3 rows) to the places of their candidates, global
  void give_reactions(const VecX& local, Reactions& out) const;
};

// state: its r continues behind the indenters with the surfaces. moves (3 n): how far the contact
// nodes move without any change of reaction, or about so.
SurfaceLaws surface_laws(const ContactState& state, TouchingBodies& bodies, const VecX& u_begin,
                         const VecX& moves, SurfaceLaws::Of of, SurfaceLaws::Nodes nodes);

}  // namespace langer
