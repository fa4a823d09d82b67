// Materials that many tests use.
#pragma once

#include <algorithm>
#include <cmath>

#include "mechanics/element/solid.hpp"
#include "mechanics/material/material.hpp"

namespace langer::test {

inline Material neo_hooke(double a1, double d) {
  Material m;
  m.matrix = {NeoHooke{a1}};
  m.volume = QuadraticVolume{d};
  return m;
}

// [A23] Table 1, HGO-Yeoh; c1 may be turned to see what its sign does
inline Material table1(double alpha_deg, double d, double c1 = -0.317) {
  Material m;
  m.matrix = {Yeoh{0.269, 0.376, 0.415}};
  m.volume = QuadraticVolume{d};
  if (c1 != 0) m.fibres = {Fibre{HgoFibre{c1, 0.319}, alpha_deg, FibreSwitch::I4_bar}};
  return m;
}

// stable in every direction that the tests reach
inline Material stable(double alpha_deg, double d) {
  Material m;
  m.matrix = {Yeoh{0.05, 0.05, 0.02}};
  m.volume = QuadraticVolume{d};
  m.fibres = {Fibre{HgoFibre{0.10, 0.30}, alpha_deg, FibreSwitch::I4_bar}};
  return m;
}

// a modulus of what the modes leave of J - 1, of the order that pressures have
inline double local_modulus(Formulation formulation, const Material& material) {
  if (formulation != Formulation::linear_dilatation) return 0;
  return std::min(bulk_modulus(material), 4 * std::abs(shear_modulus(material)));
}

}  // namespace langer::test
