// A path as XDMF: a text of some kilobytes next to solution.h5 that says where the arrays of each
// step are in it. Viewers open it as a series in time. XDMF 2 and 3 write the rows of a step in
// different ways, and their readers do not understand each other's: ParaView opens version 3 by a
// double click, VisIt and ParaView's "XDMF Reader" need version 2. The arrays stay in
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
enum class XdmfVersion { two, three };
// `file` is the name of the solution as seen from the text.
std::string xdmf(XdmfVersion version, const Mesh& mesh, const std::string& file,
                 const std::vector<double>& times, const std::vector<XdmfArray>& arrays);

}  // namespace langer
