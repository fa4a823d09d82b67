// A path as XDMF 3: a text of some kilobytes next to solution.h5 that says where the arrays of each
// step are in it. ParaView (also 5.11) and VisIt open it as a series in time. The arrays stay in
// solution.h5, which must be in the same folder. Vectors are marked as such. A symmetric tensor is
// a matrix of 6 columns in VTK's order 11 22 33 12 23 13, because XDMF's own Tensor6 has another
// order.
#pragma once

#include <string>
#include <vector>

#include "mechanics/mesh/mesh.hpp"

namespace langer {

// An array of the solution that the text describes.
struct XdmfArray {
  std::string name;
  int components = 1;
  bool of_cells = false, of_mesh = false;  // of_mesh: the same in every step
};

// The reason why the text cannot be written, if XDMF has no type for the elements; otherwise
// empty.
std::string without_xdmf(const Mesh& mesh);
// `file` is the name of the solution as seen from the text.
std::string xdmf(const Mesh& mesh, const std::string& file, const std::vector<double>& times,
                 const std::vector<XdmfArray>& arrays);

}  // namespace langer
