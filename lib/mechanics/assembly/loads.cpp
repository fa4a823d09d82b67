#include "mechanics/assembly/loads.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/mesh/reference.hpp"

namespace langer {

Loads::Loads(const Mesh& mesh, std::vector<SurfaceLoad> loads, std::vector<double> cell_share)
    : mesh_(&mesh), loads_(std::move(loads)), cell_share_(std::move(cell_share)) {}

// Pressures follow the surface as it turns and grows, and so add to the tangent; tractions keep
// their direction and their force per area at rest.
bool Loads::follow() const {
  return std::any_of(loads_.begin(), loads_.end(),
                     [](const SurfaceLoad& load) { return load.pressure != 0 || load.volume; });
}

// Whether a load changes between two times of the path.
bool Loads::moves(double t0, double t) const {
  return std::any_of(loads_.begin(), loads_.end(), [&](const SurfaceLoad& load) {
    return factor_at(load.factor, t0) != factor_at(load.factor, t);
  });
}

// Whether all factors change as fast in the next increment as in the last. A prediction of the next
// state by extrapolation is useful only then.
bool Loads::keeps_rate(double before, double now, double next) const {
  return std::all_of(loads_.begin(), loads_.end(), [&](const SurfaceLoad& load) {
    const double f = factor_at(load.factor, now);
    const double rate = (factor_at(load.factor, next) - f) / (next - now);
    const double last = (f - factor_at(load.factor, before)) / (now - before);
    return std::abs(rate - last) <= 1e-6 * std::max(std::abs(rate), std::abs(last));
  });
}

// The nodal forces of all loads, facet by facet, with the stiffness of pressures where it is
// requested. The stiffness is minus the derivative of the force, since K u = f has it on the left.
void Loads::each(double t, const Displacements& u, bool with_stiffness, const OnFacet& on) const {
  for (const SurfaceLoad& load : loads_) {
    const double factor = factor_of(load, t);
    // A closed cavity without pressure has no force, but its pressure is an unknown, not a factor.
    if (factor == 0 || (load.volume && load.pressure == 0)) continue;
    for (const Facet& facet : load.facets) {
      const double share = factor * share_of(facet.cell);
      const ReferenceCell& cell = mesh_->cell();
      const ElementNodes X = element_nodes(*mesh_, facet.cell);
      if (load.pressure == 0) {
        on(facet.cell, share * dead_traction(cell, facet.local, X, load.traction), nullptr);
        continue;
      }
      const ElementNodes x = X + u(facet.cell);
      const ElementNodes force = share * load.pressure * follower_pressure(cell, facet.local, x);
      MatX stiffness;
      if (with_stiffness)
        stiffness = -share * load.pressure * follower_stiffness(cell, facet.local, x);
      on(facet.cell, force, with_stiffness ? &stiffness : nullptr);
    }
  }
}

// What the stiffness above leaves out. The follower stiffness of a single facet is not symmetric;
// only its symmetric part is assembled, as the skew parts of neighbouring facets cancel. They
// remain on the rim of the loaded surface.
void Loads::each_skew(double t, const Displacements& u, const Displacements& du,
                      const OnRim& on) const {
  const ReferenceCell& cell = mesh_->cell();
  for (const SurfaceLoad& load : loads_) {
    const double pressure = load.pressure * factor_of(load, t);
    if (pressure == 0) continue;
    for (const Facet& facet : load.facets) {
      const ElementNodes dx = du(facet.cell);
      if (dx.isZero(0)) continue;
      const ElementNodes x = element_nodes(*mesh_, facet.cell) + u(facet.cell);
      const ElementNodes change = follower_skew_change(cell, facet.local, x, dx);
      on(facet.cell, pressure * share_of(facet.cell) * change);
    }
  }
}

// All loads at the time t as one vector of nodal forces [N].
VecX Loads::forces(double t, const VecX& u) const {
  VecX f = VecX::Zero(u.size());
  each(
      t, [&](int e) { return element_values(*mesh_, e, u); }, false,
      [&](int e, const ElementNodes& force, const MatX*) {
        const auto nodes = mesh_->cell(e);
        for (std::size_t a = 0; a < nodes.size(); ++a)
          f.segment<3>(3 * nodes[a]) += force.row(static_cast<Eigen::Index>(a)).transpose();
      });
  return f;
}

// How many such cells the whole body has: more than one where only a part of the body is meshed.
double Loads::share_of(int cell) const {
  if (cell_share_.empty()) return 1;
  return cell_share_[static_cast<std::size_t>(cell)];
}

// The factor of a cavity scales the volume that is given, not the pressure that results.
double Loads::factor_of(const SurfaceLoad& load, double t) {
  if (load.volume) return 1;  // its pressure is that of the state
  return factor_at(load.factor, t);
}

int Loads::n_volumes() const {
  int n = 0;
  for (const SurfaceLoad& load : loads_) n += load.volume.has_value();
  return n;
}

// The place in the list of loads of the i-th one with a given volume.
std::size_t Loads::volume_index(int i) const {
  std::size_t at = 0;
  while (!loads_[at].volume || i-- > 0) ++at;
  return at;
}

// The volume that must have entered the cavity at the time t [mm^3].
double Loads::given_volume(int i, double t) const {
  const SurfaceLoad& load = volume_load(i);
  return *load.volume * factor_at(load.factor, t);
}

// f is quadratic in s along a straight way from rest, so Simpson's rule is exact.
double Loads::swept_volume(int i, const Displacements& u) const {
  const ReferenceCell& cell = mesh_->cell();
  double volume = 0;
  for (const Facet& facet : volume_load(i).facets) {
    const ElementNodes X = element_nodes(*mesh_, facet.cell);
    const ElementNodes moved = u(facet.cell);
    const auto power = [&](double s) {
      return follower_pressure(cell, facet.local, X + s * moved).cwiseProduct(moved).sum();
    };
    volume += share_of(facet.cell) * (power(0) + 4 * power(0.5) + power(1)) / 6;
  }
  return volume;
}

// The pressures of the cavities are unknowns of the equilibrium; the solver passes them here.
void Loads::set_pressures(const VecX& p) {
  for (int i = 0; i < static_cast<int>(p.size()); ++i) loads_[volume_index(i)].pressure = p[i];
}

// The forces of a unit pressure in the i-th cavity: the column that belongs to this unknown, and at
// the same time the derivative of the swept volume with respect to the displacements.
void Loads::each_unit(int i, const Displacements& u, const OnFacet& on) const {
  const ReferenceCell& cell = mesh_->cell();
  for (const Facet& facet : volume_load(i).facets) {
    const ElementNodes x = element_nodes(*mesh_, facet.cell) + u(facet.cell);
    on(facet.cell, share_of(facet.cell) * follower_pressure(cell, facet.local, x), nullptr);
  }
}

}  // namespace langer
