#include "material/path.hpp"

#include <cmath>

#include "tensor/kinematics.hpp"
#include "tensor/stress.hpp"

namespace langer {

namespace {

// every fibre along x: the lateral stretches of a pull are equal by symmetry
bool axial(const Material& material) {
  for (const Fibre& fibre : material.fibres)
    if (fibre.alpha_deg != 0) return false;
  return true;
}

}  // namespace

PathState on_path(const Material& material, Path path, double amount) {
  PathState s;
  const double l = 1 + amount;
  if (path != Path::simple_shear && !(l > 0)) return s;
  switch (path) {
    case Path::uniaxial:
      if (axial(material)) {
        s.F = Vec3(l, 1 / std::sqrt(l), 1 / std::sqrt(l)).asDiagonal();
      } else {
        const Uniaxial u = uniaxial_incompressible(material, l);
        if (!u.converged) return s;
        s.F = u.stretch.asDiagonal();
      }
      break;
    case Path::equibiaxial:
      s.F = Vec3(l, 1 / (l * l), l).asDiagonal();
      break;
    case Path::pure_shear:
      s.F = Vec3(l, 1 / l, 1).asDiagonal();
      break;
    case Path::simple_shear:
      s.F(0, 2) = amount;
      break;
  }
  const Response r = isochoric(material, right_cauchy_green(s.F), fibre_directions(material), false);
  const Mat3 sigma = cauchy(s.F, r.S, 1.);
  s.W = r.W;
  if (path == Path::simple_shear) {
    s.cauchy = s.nominal = s.work = sigma(0, 2);
  } else {
    s.cauchy = sigma(0, 0) - sigma(1, 1);
    s.nominal = s.cauchy / l;
    s.work = path == Path::equibiaxial ? 0.5 * (s.cauchy + sigma(2, 2) - sigma(1, 1)) / l : s.nominal;
  }
  s.exists = std::isfinite(s.W) && std::isfinite(s.cauchy);
  return s;
}

Material turned(Material material, double degrees) {
  for (Fibre& fibre : material.fibres) fibre.alpha_deg += degrees;
  return material;
}

std::optional<std::vector<double>> path_curve(const Material& material, Path path, std::span<const double> amount,
                                              StressMeasure measure) {
  std::vector<double> stress;
  stress.reserve(amount.size());
  for (double x : amount) {
    const PathState s = on_path(material, path, x);
    if (!s.exists) return std::nullopt;
    stress.push_back(measure == StressMeasure::cauchy ? s.cauchy : s.nominal);
  }
  return stress;
}

}  // namespace langer
