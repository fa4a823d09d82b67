// Contact of deformable surfaces in an increment, beside rigid indenters: the state of the mortar
// averages, and the reactions after the next movement.
//
// What forces on the contact nodes of both sides move them is known from the body's last factor:
//   d = move + F s,   s = G dr + C' d          F: compliance of the contact nodes
// with the forces G of the reactions on both sides, and C' the change of the present forces
// (normals turn, weights change, and springs that support the tangent are taken out). The law sees
// q + L d:
//   x = q + L d,   d = (1 - F C')^-1 (move + F G dr)
// which leaves one compliance W = L (1 - F C')^-1 F G, solved candidate by candidate with the cone
// projection (contact/local_problem.hpp). A body that only contact holds has no such W: springs
// kappa on the law's own directions make one, and are taken out again
// (contact/supported_problem.hpp).
#pragma once

#include <optional>
#include <vector>

#include "mechanics/mortar/mortar_linearisation.hpp"
#include "mechanics/solve/contact_linearisation.hpp"
#include "mechanics/solve/surface_laws.hpp"

namespace langer {

class TouchingBodies {
 public:
  explicit TouchingBodies(std::vector<SurfaceContact> surfaces) : surfaces_(std::move(surfaces)) {}

  bool empty() const { return surfaces_.empty(); }
  const std::vector<SurfaceContact>& surfaces() const { return surfaces_; }
  std::vector<int> nodes() const;  // of all sides, ascending

  // The averages at u; kept until another u comes.
  const std::vector<std::vector<MortarNode>>& at(const std::vector<Vec3>& X, const VecX& u);

  // first: index in r of the reactions of the first surface
  void add_forces(const std::vector<Vec3>& X, const VecX& u, const Reactions& r, std::size_t first,
                  VecX& f);
  std::vector<ContactDefect> defects(const std::vector<Vec3>& X, const VecX& u, const VecX& u0,
                                     const Reactions& r, std::size_t first, double motion);
  // what friction does on both sides in a movement du [N mm], with the forces and weights at u; not
  // positive where reactions are those of the law
  double work_of_friction(const std::vector<Vec3>& X, const VecX& u, const VecX& du,
                          const Reactions& r, std::size_t first);
  // of each pair the deepest node of either side inside the facets of the other [mm]
  std::vector<double> penetrations(const std::vector<Vec3>& X, const VecX& u) const;
  // reactions r_next (in the frames at u) after a movement to u + du; without overlap there is none
  void turn(const std::vector<Vec3>& X, const VecX& u, const VecX& du, Reactions& r,
            std::size_t first);

 private:
  std::vector<SurfaceContact> surfaces_;
  VecX at_;
  std::vector<std::vector<MortarNode>> averages_;
};

// state: rigid indenters as well; its r continues with the surfaces. prescribed (3 n): what
// prescribed degrees of freedom move in this correction. move: of the rows of factor.last().
std::optional<ContactChange> linearised_bodies(const ContactState& state, TouchingBodies& bodies,
                                               const VecX& u_begin, const VecX& prescribed,
                                               const TangentFactor& factor, const VecX& move);

// The contact of all candidates of deformable surfaces that bear something, linearised over the
// degrees of freedom that take part.
struct SurfaceSystem {
  struct Row {
    std::size_t surface, candidate;
    Mat3 frame;
  };
  SurfaceLaws laws;       // springs of the factor are taken out in C
  std::vector<Row> rows;  // three of the matrices each
  MatX F;                 // compliance (columns, columns)
};
// state: without indenters that bear something
SurfaceSystem surface_system(const ContactState& state, TouchingBodies& bodies, const VecX& u_begin,
                             const TangentFactor& factor);

}  // namespace langer
