// A material as FEBio 4 has it (.feb, format 4.0): uncoupled, with the same volume term (pressure
// models "Abaqus" k (J-1)^2/2, "NIKE3D" k/4 (J^2 - 1 - 2 ln J) and "default" k/2 (ln J)^2). Fibres
// are solids of an "uncoupled solid mixture". Two models of FEBio 4.11 differ from their names:
//   Yeoh          sigma = dev(2/J sum c_i (I1_bar - 3)^(i-1) b_bar), without the factor i: c_i is
//                 written as i a_i
//   Arruda-Boyce  has the factor i of the derivative of the series twice: not written
// See its sources FEBioMech/FEYeoh.cpp and FEArrudaBoyce.cpp (github.com/febiosoftware/FEBio).
#pragma once

#include <string>
#include <vector>

#include "export/foreign_law.hpp"
#include "mechanics/material/material.hpp"

namespace langer {

// a vector as its files write one: "x,y,z"
std::string triple(const Vec3& x);

// `fibres` are the unit directions of the families [-].
ForeignLaw febio_material(const Material& material, const std::vector<Vec3>& fibres, int id,
                          const std::string& name);

}  // namespace langer
