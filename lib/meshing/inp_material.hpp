// *MATERIAL of an Abaqus or CalculiX input file, as keys of a solve config.
//
// A mesh has no material. What *HYPERELASTIC says is therefore printed as text that a user can copy
// into a solve config. The energies are those of Abaqus:
//   polynomials  W = sum C_i0 (I1_bar - 3)^i + sum C_0j (I2_bar - 3)^j + (J - 1)^2/D1
//                NEO HOOKE, MOONEY-RIVLIN, YEOH, REDUCED POLYNOMIAL, POLYNOMIAL; N at most 3
//   OGDEN        W = sum 2 mu_i/alpha_i^2 (l_1^alpha_i + l_2^alpha_i + l_3^alpha_i - 3) + (J - 1)^2/D1
//   ARRUDA-BOYCE with ((J^2 - 1)/2 - ln J)/D
#pragma once

#include <string>
#include <vector>

#include "meshing/inp_scanner.hpp"

namespace langer {

struct InpMaterial {
  InpCard hyperelastic;         // no word: the material has no such card
  std::vector<double> numbers;  // of its data lines, eight for each but the last
  int n_lines = 0;              // of data so far
  std::string fault;            // why these cannot be used; empty if they can
};

// Reads a data line below *HYPERELASTIC. What is not understood becomes the material's fault.
void read_hyperelastic(InpMaterial& material, const InpLine& line);

struct MaterialKeys {
  std::string keys;    // "matrix: {...}, volume: {...}"; empty if there are none
  std::string remark;  // on what was chosen, or why there are no keys
};
MaterialKeys material_keys(const InpMaterial& material);

}  // namespace langer
