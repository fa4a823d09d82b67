// A path as XDMF 3: a text of some kilobytes beside solution.h5 that says where in it the arrays of
// each step lie, so that ParaView (5.11 too) and VisIt open the solution as it lies, as a series in
// time. The arrays stay in solution.h5, which must lie beside it. Vectors are marked as such; a
// symmetric tensor is a matrix of 6 columns in VTK's order 11 22 33 12 23 13, which XDMF's own
// Tensor6 has not.
#pragma once

#include <string>
#include <vector>

#include "mechanics/mesh/mesh.hpp"

namespace langer {

struct XdmfArray {
  std::string name;
  int components = 1;
  bool of_cells = false, of_mesh = false;  // of_mesh: the same in every step
};

// Cells that XDMF has no type for: why the text cannot be written; empty where it can.
std::string without_xdmf(const Mesh& mesh);
// file: the solution's name as seen from the text
std::string xdmf(const Mesh& mesh, const std::string& file, const std::vector<double>& times,
                 const std::vector<XdmfArray>& arrays);

}  // namespace langer
