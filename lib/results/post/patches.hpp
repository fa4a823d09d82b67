// Smooth fields from those of finite elements: polynomials fitted on a patch of elements around
// each corner of the mesh.
//
// A finite element field has jumps in its gradient, which are larger than the error of the field. A
// polynomial fitted to the values of several elements averages them out and is more accurate than
// the elements themselves, so that the difference estimates their error.
//   u   nodal values of the elements around the corner, a polynomial one degree higher than that of
//       the elements: its gradient converges one order faster, up to the surface           [ZN05]
//   p   values at Gauss points (hex8: one in the middle), of the degree of the elements    [ZZ92]
// Patches stay within one region: no field is smooth across the border of two materials. A corner
// on the surface or on a border uses the polynomials of the closest corners inside. Within an
// element the polynomials of its corners are blended with the shape functions of the corners. For
// hex8 only the values at the corners are interpolated, because its shape functions are not of
// higher degree. In a section (mesh/section.hpp) the polynomials are in x and y.
#pragma once

#include <array>
#include <vector>

#include "results/post/nodal_fields.hpp"

namespace langer {

// The patches of a mesh and the fits on them. Finding the patches costs more than a fit, so one
// object serves all states.
class Patches {
 public:
  explicit Patches(const Body& body);  // keeps a reference to it

  // Smooth fields at the Gauss points of an element, and their gradients: one row for each field.
  class Smooth {
   public:
    // (fields, 1)
    MatX values(int e, int g) const { return patches_->blended(fitted_, e, g, false); }
    // (fields, 3)
    MatX gradients(int e, int g) const { return patches_->blended(fitted_, e, g, true); }

   private:
    friend class Patches;
    const Patches* patches_ = nullptr;
    // By patch: the coefficients, a row for each monomial. For hex8 the values at the corner: the
    // field, or the components of its gradient.
    std::vector<MatX> fitted_;
  };
  // Fields of nodes (nodes, fields), for their gradients.
  Smooth fit_nodal_fields(const MatX& values) const;
  // Fields of Gauss points, for their values. By element: (Gauss points, fields), hex8 (1, fields).
  Smooth fit_gauss_fields(const std::vector<MatX>& values) const;

  // Share of the volume at corners without a corner inside within a few elements. The smooth fields
  // are hardly smoother there than those of the elements.
  double share_without_interior() const;

 private:
  struct Patch {
    Vec3 centre = Vec3::Zero();
    double size = 1;         // distance of the farthest node from the centre
    std::vector<int> cells;  // elements around the corner
    bool inside = false;     // not on the surface of its region
    bool is_used = false;    // by itself or by another patch
    std::vector<int> used;   // patches whose polynomials are used here; their mean is taken
  };
  int patch_at(int e, int corner) const {
    return patch_of_[static_cast<std::size_t>(e * n_corners_ + corner)];
  }
  // The monomials of a patch at a place, or their gradients.
  MatX terms(const Patch& patch, const Vec3& X, bool gradient) const;  // (monomials, 1 or 3)
  // The field of a patch at a place.
  MatX at(const std::vector<MatX>& fitted, const Patch& patch, const Vec3& X, bool gradient) const;
  int n_front_nodes() const;
  Smooth smooth_field(std::vector<MatX> fitted, bool gradient) const;
  // The field at a Gauss point, from those of the corners of its element.
  MatX blended(const std::vector<MatX>& fitted, int e, int g, bool gradient) const;
  void find_patches();
  void find_inside();
  void find_used_patches();

  const Body& body_;
  int dim_, n_corners_;
  int degree_;       // of nodal fields; fields of Gauss points have one degree less
  bool in_corners_;  // only the values at corners are used
  std::vector<Patch> patches_;
  std::vector<int> patch_of_;  // by element and corner
  std::vector<std::array<int, 3>> powers_of_nodes_, powers_of_points_;
};

}  // namespace langer
