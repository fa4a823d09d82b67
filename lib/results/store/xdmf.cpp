#include "results/store/xdmf.hpp"

#include <fmt/format.h>

#include "core/base/xml.hpp"
#include "mechanics/mesh/reference.hpp"

namespace langer {

namespace {

constexpr int vtk_hexahedron = 12, vtk_triquadratic = 29;

// The dimensions of n rows of an array.
std::string dimensions(const XdmfArray& array, std::size_t n) {
  if (array.components > 1) return fmt::format("{} {}", n, array.components);
  return fmt::format("{}", n);
}

// XDMF's word for the values of an array.
const char* attribute_type(const XdmfArray& array) {
  if (array.components == 1) return "Scalar";
  if (array.components == 3) return "Vector";
  if (array.components == 9) return "Tensor";
  return "Matrix";
}

const char* topology_of(const Mesh& mesh) {
  if (mesh.cell().names.vtk == vtk_hexahedron) return "Hexahedron";
  return "Hexahedron_27";
}

// Rows `first` to `first + rows` of an array of `all` rows.
struct Window {
  std::size_t first, rows, all;
};

std::string data_item(const std::string& dimensions, const std::string& place) {
  return fmt::format(
      "<DataItem Format=\"HDF\" NumberType=\"Float\" Precision=\"8\" "
      "Dimensions=\"{}\">{}</DataItem>",
      dimensions, place);
}

// Version 2 selects rows by a window of start, stride and count in each dimension.
std::string rows_by_window(const std::string& place, const XdmfArray& array, const Window& window) {
  int rank = 1;
  std::string numbers = fmt::format("{} 1 {}", window.first, window.rows);
  if (array.components > 1) {
    rank = 2;
    numbers = fmt::format("{} 0 1 1 {} {}", window.first, window.rows, array.components);
  }
  return fmt::format(
      "<DataItem ItemType=\"HyperSlab\" Dimensions=\"{}\"><DataItem Format=\"XML\" Dimensions=\"3 "
      "{}\">{}</DataItem>{}</DataItem>",
      dimensions(array, window.rows), rank, numbers,
      data_item(dimensions(array, window.all), place));
}

// Version 3 has start, stride, count and the whole size behind the name of the array.
std::string rows_by_name(const std::string& place, const XdmfArray& array, const Window& window) {
  std::string start = fmt::format("{}", window.first);
  std::string stride = "1";
  if (array.components > 1) {
    start += " 0";
    stride += " 1";
  }
  const std::string count = dimensions(array, window.rows);
  return data_item(count, fmt::format("{}|{}:{}:{}:{}", place, start, stride, count,
                                      dimensions(array, window.all)));
}

// An item of the text: a whole array, or the rows of a step.
std::string rows_of(XdmfVersion version, const std::string& file, const XdmfArray& array,
                    std::size_t rows, std::size_t step, std::size_t n_steps) {
  const char* const group = array.of_cells ? "CellData" : "PointData";
  const std::string place = fmt::format("{}:/VTKHDF/{}/{}", file, group, array.name);
  if (array.of_mesh) return data_item(dimensions(array, rows), place);
  const Window window{step * rows, rows, rows * n_steps};
  if (version == XdmfVersion::two) return rows_by_window(place, array, window);
  return rows_by_name(place, array, window);
}

}  // namespace

std::string without_xdmf(const Mesh& mesh) {
  const int type = mesh.cell().names.vtk;
  if (type == vtk_hexahedron || type == vtk_triquadratic) return "";
  return "XDMF has no cells of this kind";
}

// One grid per step. All grids share topology and geometry and select their own rows of the
// arrays.
std::string xdmf(XdmfVersion version, const Mesh& mesh, const std::string& file,
                 const std::vector<double>& times, const std::vector<XdmfArray>& arrays) {
  const std::size_t n = mesh.X.size();
  const std::size_t e = static_cast<std::size_t>(mesh.n_cells());
  const std::size_t per_cell = nodes_per_cell(mesh.type);
  const std::string name = xml_text(file);
  const char* const number = version == XdmfVersion::two ? "2.0" : "3.0";
  std::string s = fmt::format(
      "<?xml version=\"1.0\"?>\n<!-- made by langer for a solution -->\n<Xdmf "
      "Version=\"{}\">\n<Domain>\n"
      "<Grid Name=\"path\" GridType=\"Collection\" CollectionType=\"Temporal\">\n",
      number);
  for (std::size_t i = 0; i < times.size(); ++i) {
    // Each step has the time as value, so that viewers show it.
    s += fmt::format("<Grid Name=\"step_{}\" GridType=\"Uniform\">\n<Time Value=\"{}\"/>\n", i + 1,
                     times[i]);
    s += fmt::format(
        "<Topology TopologyType=\"{}\" NumberOfElements=\"{}\"><DataItem Format=\"HDF\" "
        "NumberType=\"Int\" Precision=\"8\" "
        "Dimensions=\"{}\">{}:/VTKHDF/Connectivity</DataItem></Topology>\n",
        topology_of(mesh), e, e * per_cell, name);
    s += fmt::format(
        "<Geometry GeometryType=\"XYZ\"><DataItem Format=\"HDF\" NumberType=\"Float\" "
        "Precision=\"8\" "
        "Dimensions=\"{} 3\">{}:/VTKHDF/Points</DataItem></Geometry>\n",
        n, name);
    for (const XdmfArray& array : arrays) {
      std::size_t rows = n;
      if (array.of_cells) rows = e;
      s +=
          fmt::format("<Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">{}</Attribute>\n",
                      xml_text(array.name), attribute_type(array), array.of_cells ? "Cell" : "Node",
                      rows_of(version, name, array, rows, i, times.size()));
    }
    s += "</Grid>\n";
  }
  return s + "</Grid>\n</Domain>\n</Xdmf>\n";
}

}  // namespace langer
