// Stability at the Gauss points of a cell: F, and the smallest shear stiffness
// (material/ellipticity.hpp) over a fixed grid of wave normals, eight points at once.
//   A(n, m) J = n.B n + sum 4 W_k'' (m.h_k n)^2,   B = sum 2 W_k' h_k,   m normal to n
//   h_k  isochoric push-forward of an invariant's tensor: b_bar of I1_bar, kappa b_bar + (1 - 3 kappa) f f^T of a fibre family
// because a shear  1 + eps m n^T  does not change J and changes an invariant to  I + 2 eps m.h n +
// eps^2 n.h n. The minimum over the grid is an upper bound, too high by at most a few percent of
// the spread of A; if the exact minimum matters, smallest_shear_stiffness() computes it. Materials
// outside packet_form() are sampled by that function more coarsely, point by point.
// Where only the lowest points are asked for, a bound from below spares most of the others the
// grid:
//   A J >= n.M n,   M = sum (2 W_k' + min(0, 4 W_k'' tr h_k)) h_k,   as (m.h n)^2 <= (m.h m) (n.h n)
// so that M - s J 1 positive definite means A > s.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "mechanics/element/packet_solid.hpp"

namespace langer {

struct PointCheck {
  std::vector<Mat3> F;
  std::vector<double> J;
  std::vector<double> stiffness;  // [MPa]; NaN where the energy has no value
};

// enough: eight points that are all surely stiffer than this and than 0 [MPa] may get the largest
// number instead of their stiffness
void check_points(const Material& material, const ElementGeometry& geometry,
                  std::span<const Vec3> a, const ElementNodes& u, PointCheck& out,
                  double enough = std::numeric_limits<double>::infinity());

}  // namespace langer
