#include "mechanics/assembly/loads.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/mesh/reference.hpp"

namespace langer {

Loads::Loads(const Mesh& mesh, std::vector<SurfaceLoad> loads, std::vector<double> cell_share)
    : mesh_(&mesh), loads_(std::move(loads)), cell_share_(std::move(cell_share)) {}

bool Loads::follow() const {
  return std::any_of(loads_.begin(), loads_.end(),
                     [](const SurfaceLoad& load) { return load.pressure != 0; });
}

bool Loads::moves(double t0, double t) const {
  return std::any_of(loads_.begin(), loads_.end(), [&](const SurfaceLoad& load) {
    return factor_at(load.factor, t0) != factor_at(load.factor, t);
  });
}

bool Loads::keeps_rate(double before, double now, double next) const {
  return std::all_of(loads_.begin(), loads_.end(), [&](const SurfaceLoad& load) {
    const double f = factor_at(load.factor, now);
    const double rate = (factor_at(load.factor, next) - f) / (next - now);
    const double last = (f - factor_at(load.factor, before)) / (now - before);
    return std::abs(rate - last) <= 1e-6 * std::max(std::abs(rate), std::abs(last));
  });
}

void Loads::each(double t, const Displacements& u, bool with_stiffness, const OnFacet& on) const {
  for (const SurfaceLoad& load : loads_) {
    const double factor = factor_at(load.factor, t);
    if (factor == 0) continue;
    for (const Facet& facet : load.facets) {
      const double share = factor * (cell_share_.empty() ? 1 : cell_share_[facet.cell]);
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

void Loads::each_skew(double t, const Displacements& u, const Displacements& du,
                      const OnRim& on) const {
  const ReferenceCell& cell = mesh_->cell();
  for (const SurfaceLoad& load : loads_) {
    const double pressure = load.pressure * factor_at(load.factor, t);
    if (pressure == 0) continue;
    for (const Facet& facet : load.facets) {
      const ElementNodes dx = du(facet.cell);
      if (dx.isZero(0)) continue;
      const ElementNodes x = element_nodes(*mesh_, facet.cell) + u(facet.cell);
      const MatX symmetric = follower_stiffness(cell, facet.local, x);
      ElementNodes change = follower_pressure_change(cell, facet.local, x, dx);
      for (int a : cell.facet[facet.local])
        for (int b : cell.facet[facet.local])
          change.row(a) -=
              (symmetric.block<3, 3>(3 * a, 3 * b) * dx.row(b).transpose()).transpose();
      on(facet.cell, pressure * (cell_share_.empty() ? 1 : cell_share_[facet.cell]) * change);
    }
  }
}

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

}  // namespace langer
