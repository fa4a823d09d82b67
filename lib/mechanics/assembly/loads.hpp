// Forces on the surface of a body: dead tractions, which keep their direction and act on reference
// areas, and pressures, which follow the surface. Each is its largest value times a factor of its
// own along the path.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/base/history.hpp"
#include "mechanics/element/surface.hpp"
#include "mechanics/mesh/mesh.hpp"

namespace langer {

struct SurfaceLoad {
  std::vector<Facet> facets;
  Vec3 traction = Vec3::Zero();  // [MPa], per reference area
  double pressure = 0;           // [MPa], positive into the body
  LoadFactor factor = nullptr;
};

class Loads {
 public:
  Loads() = default;
  // cell_share: by cell, how many of the whole body it stands for; none: one. Refers to the mesh.
  Loads(const Mesh& mesh, std::vector<SurfaceLoad> loads, std::vector<double> cell_share = {});

  bool empty() const { return loads_.empty(); }
  bool follow() const;                    // some of them are pressures
  bool moves(double t0, double t) const;  // some load changes from t0 to t
  bool keeps_rate(double before, double now,
                  double next) const;  // at the same rates in both intervals

  // What acts on each facet at t, one row per node of its cell [N], and for a pressure -d force/dx,
  // symmetric, where it is asked for.
  using Displacements = std::function<ElementNodes(int cell)>;
  using OnFacet = std::function<void(int cell, const ElementNodes& force, const MatX* stiffness)>;
  void each(double t, const Displacements& u, bool with_stiffness, const OnFacet& on) const;
  // Of each facet under pressure at t: what its force changes by beyond the symmetric part where
  // the body moves by du [N].
  using OnRim = std::function<void(int cell, const ElementNodes& change)>;
  void each_skew(double t, const Displacements& u, const Displacements& du, const OnRim& on) const;
  VecX forces(double t, const VecX& u) const;  // (3 n) [N], of a body without tied nodes

 private:
  const Mesh* mesh_ = nullptr;
  std::vector<SurfaceLoad> loads_;
  std::vector<double> cell_share_;
};

}  // namespace langer
