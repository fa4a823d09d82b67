// Symmetries of a mesh: mirror planes and half turns whose planes and axes are parallel to the
// coordinate planes and axes, and the part of a mesh that stands for the whole of it.
//   X' = centre + S (X - centre),   S = diag(signs):  (-1, 1, 1) mirrors x;  (-1, 1, -1) turns by 180 degrees about y
// A field with the same symmetry satisfies u(X') = S u(X), so the kept cells and their nodes
// determine all others. A cell or node that is its own image is kept with its share: the reduced
// energy is exactly that of the whole body.
#pragma once

#include <optional>
#include <vector>

#include "mechanics/mesh/mesh.hpp"

namespace langer {

struct Symmetry {
  Vec3 signs = Vec3::Ones();
  Vec3 centre = Vec3::Zero();   // [mm]
  std::vector<int> node, cell;  // image of each
};

// Nothing where a node or cell has no image, or the image belongs to another body. Positions agree
// within 1e-9 of the size.
std::optional<Symmetry> find_symmetry(const Mesh& mesh, const Vec3& signs, const Vec3& centre);

// u(node) = T u(node of). T of a node that is its own image has zeros on its diagonal for
// components that symmetry forbids, and below it what the others bring with them.
struct Image {
  int of = 0;
  Mat3 T = Mat3::Identity();
};

struct Quotient {
  Mesh mesh;                      // kept cells with all their nodes; no sets
  std::vector<int> node, cell;    // kept -> whole
  std::vector<Image> tie;         // by kept node: the kept node it moves with; itself in most cases
  std::vector<Image> node_image;  // by whole node: in terms of kept nodes
  std::vector<int> cell_image;    // by whole cell: the kept cell that is like it
  std::vector<double> node_share,
      cell_share;  // by kept: how many of the whole body it stands for; 0 for tied nodes
};

// all products of commuting generators, the identity first
std::vector<Symmetry> group_of(const Mesh& mesh, const std::vector<Symmetry>& generators);

// By the group of one or two commuting symmetries.
Quotient quotient(const Mesh& mesh, const std::vector<Symmetry>& generators);

// Antisymmetric fields: u(X') = -S u(X) under some of the generators. Every displacement of the
// whole body is a sum of a symmetric field and one of each of these kinds, and a symmetric tangent
// does not couple them. The result is, by kind, the ties of the kept nodes.
std::vector<std::vector<Image>> symmetry_breaking_ties(const Mesh& mesh,
                                                       const std::vector<Symmetry>& generators,
                                                       const Quotient& q);

}  // namespace langer
