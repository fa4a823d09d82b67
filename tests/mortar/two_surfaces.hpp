// Two surfaces that face each other, as quadrilaterals of their own: a lower one on y = 0, an upper
// one above it, on other divisions.
#pragma once

#include <cmath>

#include "mechanics/mortar/surface_contact.hpp"

namespace langer {

struct TwoSurfaces {
  SurfaceContact contact;  // the upper one is the non-mortar side
  VecX x;
};

struct PlaneSurface {
  int n_x, n_z;
  double from_x, to_x, from_z, to_z;
};

// height(x, z) of each; facets counter-clockwise seen from outside of the body
template <class Upper, class Lower>
TwoSurfaces two_surfaces(const PlaneSurface& upper, const PlaneSurface& lower,
                         const Upper& upper_height, const Lower& lower_height) {
  TwoSurfaces out;
  std::vector<Vec3> X;
  const auto add = [&](const PlaneSurface& patch, const auto& height, bool faces_down,
                       std::vector<QuadNodes>& facets) {
    const int first = static_cast<int>(X.size());
    for (int k = 0; k <= patch.n_z; ++k)
      for (int i = 0; i <= patch.n_x; ++i) {
        const double px = patch.from_x + (patch.to_x - patch.from_x) * i / patch.n_x;
        const double pz = patch.from_z + (patch.to_z - patch.from_z) * k / patch.n_z;
        X.emplace_back(px, height(px, pz), pz);
      }
    const auto at = [&](int i, int k) {
      return first + k * (patch.n_x + 1) + i;
    };
    for (int k = 0; k < patch.n_z; ++k)
      for (int i = 0; i < patch.n_x; ++i) {
        if (faces_down) {
          facets.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)});
        } else {
          facets.push_back({at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)});
        }
      }
    return first;
  };
  add(upper, upper_height, true, out.contact.own);
  const int n_own = static_cast<int>(X.size());
  add(lower, lower_height, false, out.contact.other);
  out.contact.name = "pad";
  for (int n = 0; n < n_own; ++n) out.contact.nodes.push_back(n);
  for (int n = 0; n < static_cast<int>(X.size()); ++n) out.contact.all_nodes.push_back(n);
  out.contact.reach = 2;
  out.x.resize(3 * static_cast<Eigen::Index>(X.size()));
  for (std::size_t n = 0; n < X.size(); ++n)
    out.x.segment<3>(3 * static_cast<Eigen::Index>(n)) = X[n];
  return out;
}

}  // namespace langer
