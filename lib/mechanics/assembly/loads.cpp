#include "mechanics/assembly/loads.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/mesh/reference.hpp"

namespace langer {

Loads::Loads(const Mesh& mesh, std::vector<SurfaceLoad> loads, std::vector<double> cell_share)
    : mesh_(&mesh), loads_(std::move(loads)), cell_share_(std::move(cell_share)) {}

bool Loads::follow() const {
  return std::any_of(loads_.begin(), loads_.end(),
                     [](const SurfaceLoad& load) { return load.pressure != 0 || load.volume; });
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
    const double factor = factor_of(load, t);
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
      const MatX symmetric = follower_stiffness(cell, facet.local, x);
      ElementNodes change = follower_pressure_change(cell, facet.local, x, dx);
      for (int a : cell.facet[facet.local])
        for (int b : cell.facet[facet.local])
          change.row(a) -=
              (symmetric.block<3, 3>(3 * a, 3 * b) * dx.row(b).transpose()).transpose();
      on(facet.cell, pressure * share_of(facet.cell) * change);
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

double Loads::share_of(int cell) const {
  if (cell_share_.empty()) return 1;
  return cell_share_[static_cast<std::size_t>(cell)];
}

double Loads::factor_of(const SurfaceLoad& load, double t) {
  if (load.volume) return 1;  // its pressure is that of the state
  return factor_at(load.factor, t);
}

int Loads::n_volumes() const {
  int n = 0;
  for (const SurfaceLoad& load : loads_) n += load.volume.has_value();
  return n;
}

std::size_t Loads::volume_index(int i) const {
  std::size_t at = 0;
  while (!loads_[at].volume || i-- > 0) ++at;
  return at;
}

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

void Loads::set_pressures(const VecX& p) {
  for (int i = 0; i < static_cast<int>(p.size()); ++i) loads_[volume_index(i)].pressure = p[i];
}

void Loads::each_unit(int i, const Displacements& u, const OnFacet& on) const {
  const ReferenceCell& cell = mesh_->cell();
  for (const Facet& facet : volume_load(i).facets) {
    const ElementNodes x = element_nodes(*mesh_, facet.cell) + u(facet.cell);
    on(facet.cell, share_of(facet.cell) * follower_pressure(cell, facet.local, x), nullptr);
  }
}

}  // namespace langer
