// Forces on the surface of a body: dead tractions, which keep their direction and act on reference
// areas, and pressures, which follow the surface. Each is its largest value times a factor of its
// own along the path. Of a surface that is given a volume the pressure is an unknown: the volume is
// what the surface has swept from where it was at rest,
//   V(u) = sum over facets, integral over s from 0 to 1 of f(X + s u) . u,   f of unit pressure
// and dV = f(x) . du, so that K, f and f^T are the bordered system of solve/border.hpp.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
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
  std::optional<double> volume = {};  // [mm^3] times factor; `pressure` is then that of the state
  std::string on = {};                // the set, where a volume is given
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

  // Loads with a given volume, in their order; most scenes have none.
  int n_volumes() const;
  const SurfaceLoad& volume_load(int i) const { return loads_[volume_index(i)]; }
  double given_volume(int i, double t) const;                // [mm^3]
  double swept_volume(int i, const Displacements& u) const;  // [mm^3], of the whole body
  void set_pressures(const VecX& p);                         // of them, by volume [MPa]
  // forces of 1 MPa on each facet of such a load at u
  void each_unit(int i, const Displacements& u, const OnFacet& on) const;

 private:
  std::size_t volume_index(int i) const;
  double share_of(int cell) const;
  static double factor_of(const SurfaceLoad& load, double t);  // of traction and pressure
  const Mesh* mesh_ = nullptr;
  std::vector<SurfaceLoad> loads_;
  std::vector<double> cell_share_;
};

}  // namespace langer
