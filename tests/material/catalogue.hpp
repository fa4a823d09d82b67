// Materials that every property of the law is tested on: one per term and per way of combining
// terms.
#pragma once

#include <string>
#include <vector>

#include "mechanics/material/material.hpp"

namespace langer {

struct NamedMaterial {
  std::string name;
  Material material;
};

inline Fibre hgo_fibre(double c1, double c2, double alpha_deg,
                       FibreSwitch tension_switch = FibreSwitch::I4_bar, double kappa = 0) {
  return {HgoFibre{c1, c2}, alpha_deg, tension_switch, kappa};
}

inline Material table1_hgo_yeoh(double alpha_deg = 0, double d = 1e-6) {
  return {{Yeoh{0.269, 0.376, 0.415}}, {hgo_fibre(-0.317, 0.319, alpha_deg)}, {QuadraticVolume{d}}};
}

// the set PP: positive fibre modulus, so that W is bounded below
inline Material positive_hgo_yeoh(double alpha_deg = 0, double d = 1e-6) {
  return {{Yeoh{0.05, 0.05, 0.02}}, {hgo_fibre(0.10, 0.30, alpha_deg)}, {QuadraticVolume{d}}};
}

inline std::vector<NamedMaterial> catalogue() {
  const Volume volume{QuadraticVolume{0.5}};
  return {
      {"neo-Hooke", {{NeoHooke{0.3}}, {}, volume}},
      {"Yeoh", {{Yeoh{0.2, 0.1, 0.05}}, {}, volume}},
      {"Yeoh of I2", {{YeohI2{0.2, 0.1, 0.05}}, {}, volume}},
      {"Mooney-Rivlin", {{NeoHooke{0.2}, YeohI2{0.1, 0, 0}}, {}, volume}},
      {"Mooney-Rivlin in one term", {{MooneyRivlin{0.2, 0.1}}, {}, volume}},
      {"Signorini", {{Signorini{0.2, 0.1, 0.05}}, {}, volume}},
      {"Ogden, three terms", {{Ogden{0.63, 1.3, 0.0012, 5, -0.01, -2}}, {}, volume}},
      {"Ogden, one term with fibres", {{Ogden{0.02, 9}}, {hgo_fibre(0.1, 0.3, 60)}, volume}},
      {"Arruda-Boyce", {{ArrudaBoyce{0.3, 2.1}}, {}, volume}},
      {"Gent", {{Gent{0.3, 4.5}}, {}, volume}},
      {"dispersed fibres (GOH)",
       {{NeoHooke{0.1}},
        {hgo_fibre(0.2, 0.4, 35, FibreSwitch::I4_bar, 0.2),
         hgo_fibre(0.1, 0.9, -50, FibreSwitch::off, 0.1)},
        volume}},
      {"dispersed fibres without direction",
       {{NeoHooke{0.1}}, {hgo_fibre(0.2, 0.4, 35, FibreSwitch::off, 1. / 3)}, volume}},
      {"HGO, linear fibre", {{NeoHooke{0.3}}, {hgo_fibre(0.2, 0, 20)}, volume}},
      {"exp_pow, two families",
       {{NeoHooke{0.1}},
        {{ExpPowFibre{0.3, 0.8, 2.5}, 35}, {ExpPowFibre{0.1, 0.4, 3}, -50, FibreSwitch::off, 0.1}},
        LogarithmicVolume{4}}},
      {"pow_linear in a matrix of I2",
       {{MooneyRivlin{0.2, 0.1}}, {{PowLinearFibre{2, 1.09, 3}, 20}}, SimoTaylorVolume{4}}},
      {"dispersed pow_linear and HGO",
       {{NeoHooke{0.1}},
        {{PowLinearFibre{0.4, 1.23, 4}, 35, FibreSwitch::I4_bar, 0.1}, hgo_fibre(0.1, 0.9, -50)},
        volume}},
      {"HGO-Yeoh of Table 1", table1_hgo_yeoh(30, 0.5)},
      {"HGO-Yeoh, positive", positive_hgo_yeoh(60, 0.5)},
      {"HGO-Yeoh, switch on I4",
       {{Yeoh{0.05, 0.05, 0.02}}, {hgo_fibre(0.1, 0.3, 60, FibreSwitch::I4)}, volume}},
      {"HGO-Yeoh, fibre without switch",
       {{Yeoh{0.05, 0.05, 0.02}}, {hgo_fibre(0.1, 0.3, 60, FibreSwitch::off)}, volume}},
      {"law (44): I1, I2 and two families",
       {{Yeoh{0.1, 0.05, 0.01}, YeohI2{0.05, 0.02, 0.01}},
        {hgo_fibre(0.2, 0.4, 35), hgo_fibre(0.1, 0.9, -50)},
        volume}},
  };
}

}  // namespace langer
