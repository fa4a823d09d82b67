// Whether short waves grow on the free faces of a body, shorter than its cells can show.
//
// A half-space that is stretched homogeneously and free of traction is stable against waves along
// its principal direction 1 (2: the normal) as long as [DO90]
//   margin = a / g + 2 sqrt(a / g) (b + g) / g - 1 > 0
//   a = A_1212, g = A_2121, 2 b = A_1111 + A_2222 - 2 A_1122 - 2 A_1221
// with A the moduli of the deformed state; the pressure cancels. In neo-Hooke's law that is Biot's
// condition, stretch 0.54369 in plane strain [B63]. A body whose surface violates it is creased,
// whatever its mesh shows. A crease itself comes earlier, by a finite disturbance that no
// linearisation finds: 0.646 instead of 0.544 there.
//
// Looked at in the middle of each facet of the boundary that is neither held, moved, loaded nor
// touched, along those principal directions of the surface that are shorter than its normal, with
// the deformation of the Gauss point next to it. Isotropic laws only: with fibres the directions
// are not those of the law.
#pragma once

#include <optional>
#include <vector>

#include "mechanics/solve/increment.hpp"

namespace langer {

// For a stretch of an isotropic material; n: unit normal of the surface in the reference state.
// The smaller one of the two directions; infinity where none is compressed.
double surface_margin(const Material& material, const Mat3& F, const Vec3& n);

class FreeSurface {
 public:
  // loads: on faces that are not free
  FreeSurface(const Assembler& body, const std::vector<SurfaceLoad>& loads);

  struct Weakest {
    double margin = 0;
    Vec3 place = Vec3::Zero();  // in the reference state [mm]
  };
  // Nothing where no free facet is shortened by a fifth.
  std::optional<Weakest> weakest(const Assembler& body, const BodyState& state,
                                 const std::vector<RigidContact>& contacts) const;

 private:
  struct Facet {
    int cell = 0;
    int point = 0;  // Gauss point
    Vec3 normal = Vec3::Zero();
    Vec3 place = Vec3::Zero();
    std::vector<int> nodes;
  };
  std::vector<Facet> facets_;
};

}  // namespace langer
