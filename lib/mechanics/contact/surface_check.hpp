// Checks a rigid indenter against the whole boundary of the body, also between its nodes.
// The contact law keeps the candidate nodes outside the shape. A facet between nodes that touch is
// a chord of the indenter and enters it by about a^2 / (2 R), with a half the diagonal between the
// nodes and R the radius of curvature: this is the resolution of the mesh. A deeper penetration, or
// a node inside that is no candidate, means that the indenter meets the body where no contact is
// computed.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "mechanics/contact/contact.hpp"
#include "mechanics/mesh/mesh.hpp"

namespace langer {

// The result of one check. Depths are distances from the indenter's surface [mm], places are
// reference positions.
struct SurfaceLook {
  struct Spot {
    double depth = 0;
    Vec3 X = Vec3::Zero();
  };
  double distance = std::numeric_limits<double>::infinity();  // from the boundary; negative inside
  Vec3 nearest = Vec3::Zero();
  Spot node;        // deepest node that is no candidate
  Spot facet;       // deepest point of any facet
  Spot unresolved;  // the same, deepest relative to a, or to the indenter's half width if that is
                    // less
  double unresolved_ratio = 0;
  double spacing =
      std::numeric_limits<double>::infinity();  // shortest distance a of what touches or is entered
  bool swallowed = false;  // nothing touches or is entered, and the indenter is inside the body
  int touching = 0;        // candidates with a reaction
  bool whole_facet =
      false;  // all nodes of some facet, or of a part of it between neighbouring nodes, touch
  double pressed =
      0;  // how much further than the rest the boundary is pushed along the indenter's force
};

class SurfaceCheck {
 public:
  explicit SurfaceCheck(const Mesh& mesh);  // refers to the mesh

  // u (n) displacements; c of the indenter; r reactions of the candidates, none: no reaction
  SurfaceLook look(const RigidContact& contact, const std::vector<Vec3>& u, const Vec3& c,
                   const std::vector<Vec3>& r = {}) const;
  // Nodes of the boundary, ascending, that the indenter reaches on its way through the body at
  // rest, or comes near to: within a quarter of its depth there, the longest diagonal of their
  // facets, and `moves`, what else moves the body [mm].
  std::vector<int> reached(const RigidContact& contact, double moves) const;

 private:
  struct Patch {
    std::vector<int> nodes;  // of a facet, or of its edge in z = 0
    bool axis = false;       // of an axisymmetric section: no surface
  };
  struct Deepest {
    double gap;
    Vec3 X;
  };
  using Weights = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 9, 1>;  // of the nodes of a facet
  Weights weights(const Patch& patch, double s, double t) const;
  Deepest deepest(const Patch& patch, const RigidContact& contact, const std::vector<Vec3>& x,
                  const Vec3& c) const;
  bool inside_body(const Vec3& p, const std::vector<Vec3>& x) const;
  double pressed_along(Vec3 along, const std::vector<Vec3>& u) const;
  double half_diagonal(const Patch& patch) const;  // between neighbouring nodes, at rest

  const Mesh& mesh_;
  std::vector<Patch> patches_;
  std::vector<std::vector<std::array<int, 4>>> quads_;  // of each patch
  std::vector<int> nodes_;
  std::vector<double> spacing_;  // by node: the longest half diagonal of its facets
};

}  // namespace langer
