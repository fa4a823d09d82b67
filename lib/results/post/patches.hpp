// Smooth fields from those of finite elements: polynomials fitted around each corner of a cell.
//   u     nodal values within the cells around the corner, a polynomial one degree higher than the cells': its gradient converges one
//         order faster than that of the cells, up to the surface                                                       [ZN05]
//   p     values at Gauss points (hex8: one in the middle), of the cells' own degree                                   [ZZ92]
// Patches stay within one region: no field is smooth across the border of two materials. A corner
// on the surface or on a border takes the polynomials of the nearest corner inside. In a cell, the
// polynomials of its corners are weighted with the corners' shape functions. Of hex8 the corners'
// values alone are interpolated. Of a section (mesh/section.hpp) polynomials in x and y.
#pragma once

#include <array>
#include <vector>

#include "results/post/nodal_fields.hpp"

namespace langer {

class Patches {
 public:
  explicit Patches(const Body& body);  // refers to it

  // Fields at the Gauss points of a cell, and their gradients, one row for each field.
  class Smooth {
   public:
    MatX values(int e, int g) const { return patches_->blended(of_, e, g, false); }  // (fields, 1)
    MatX gradients(int e, int g) const {
      return patches_->blended(of_, e, g, true);
    }  // (fields, 3)

   private:
    friend class Patches;
    const Patches* patches_ = nullptr;
    std::vector<MatX> of_;  // by patch: a row for each monomial, of hex8 for the field or the
                            // components of its gradient in the corner
  };
  Smooth of_nodes(const MatX& values) const;  // (nodes, fields); gradients are asked for
  Smooth of_points(const std::vector<MatX>& values)
      const;  // by cell: (Gauss points, fields), of hex8 (1, fields); values are asked for

  // share of the volume whose corners have no corner inside near them: there the fields are hardly
  // smoother than the cells'
  double alone() const;

 private:
  struct Patch {
    Vec3 centre = Vec3::Zero();
    double size = 1;
    std::vector<int> cells;
    bool inside = false, serves = false;  // for itself or another
    std::vector<int> deputies;            // patches whose polynomials serve here
  };
  int patch_at(int e, int corner) const {
    return patch_of_[static_cast<std::size_t>(e * n_corners_ + corner)];
  }
  MatX terms(const Patch& patch, const Vec3& X, bool gradient) const;  // (monomials, 1 or 3)
  MatX at(const std::vector<MatX>& fitted, const Patch& patch, const Vec3& X, bool gradient) const;
  Smooth told_in_corners(std::vector<MatX> fitted, bool gradient) const;
  MatX blended(const std::vector<MatX>& of, int e, int g, bool gradient) const;
  void find_patches();
  void find_inside();
  void find_deputies();

  const Body& body_;
  int dim_, degree_, n_corners_;  // degree: of the fields of nodes; those of points are of one less
  bool in_corners_;               // a linear function within a cell is as good
  std::vector<Patch> patches_;
  std::vector<int> patch_of_;  // by cell and corner
  std::vector<std::array<int, 3>> powers_of_nodes_, powers_of_points_;
};

}  // namespace langer
