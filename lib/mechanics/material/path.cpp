#include "mechanics/material/path.hpp"

#include <cmath>

#include "mechanics/material/states.hpp"

namespace langer {

namespace {

TestKind kind(Path path) {
  switch (path) {
    case Path::uniaxial:
      return TestKind::uniaxial;
    case Path::equibiaxial:
      return TestKind::equibiaxial;
    case Path::pure_shear:
      return TestKind::pure_shear;
    case Path::simple_shear:
      break;
  }
  return TestKind::simple_shear;
}

}  // namespace

PathState on_path(const Material& material, Path path, double amount) {
  const TestKind test = kind(path);
  const bool slides = test == TestKind::simple_shear;
  const PlaneState state =
      plane_state(material, fibre_directions(material), test, slides ? amount : 1 + amount);
  PathState s;
  if (!state.converged) return s;
  const auto nominal = measured_stress(state, test, StressMeasure::nominal);
  s.exists = true;
  s.F = state.F;
  s.W = state.W;
  s.cauchy = measured_stress(state, test, StressMeasure::cauchy)[0];
  s.nominal = nominal[0];
  if (path == Path::equibiaxial) {
    s.work = 0.5 * (nominal[0] + nominal[1]);
  } else {
    s.work = nominal[0];
  }
  return s;
}

Material turned(Material material, double degrees) {
  for (Fibre& fibre : material.fibres) fibre.alpha_deg += degrees;
  return material;
}

std::optional<std::vector<double>> path_curve(const Material& material, Path path,
                                              std::span<const double> amount,
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
