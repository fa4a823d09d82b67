#include "results/store/xdmf.hpp"

#include <fmt/format.h>

#include "core/base/xml.hpp"
#include "mechanics/mesh/reference.hpp"

namespace langer {

namespace {

constexpr int vtk_hexahedron = 12, vtk_triquadratic = 29;

// an array of the file, or the rows of it that belong to a step
std::string rows_of(const std::string& file, const XdmfArray& array, std::size_t rows,
                    std::size_t step, std::size_t n_steps) {
  const std::string place =
      fmt::format("{}:/VTKHDF/{}/{}", file, array.of_cells ? "CellData" : "PointData", array.name);
  const bool many = array.components > 1;
  const auto sizes = [&](std::size_t n) {
    return many ? fmt::format("{} {}", n, array.components) : fmt::format("{}", n);
  };
  const auto item = [&](std::size_t n) {
    return fmt::format(
        "<DataItem Format=\"HDF\" NumberType=\"Float\" Precision=\"8\" Dimensions=\"{}\">{}</DataItem>",
        sizes(n), place);
  };
  if (array.of_mesh) return item(rows);
  std::string window;
  if (many) {
    window = fmt::format("{} 0 1 1 {} {}", step * rows, rows, array.components);
  } else {
    window = fmt::format("{} 1 {}", step * rows, rows);
  }
  return fmt::format(
      "<DataItem ItemType=\"HyperSlab\" Dimensions=\"{}\"><DataItem Format=\"XML\" Dimensions=\"3 {}\">{}</DataItem>{}</DataItem>",
      sizes(rows), many ? 2 : 1, window, item(rows * n_steps));
}

}  // namespace

std::string without_xdmf(const Mesh& mesh) {
  const int type = mesh.cell().names.vtk;
  if (type == vtk_hexahedron || type == vtk_triquadratic) return "";
  return "XDMF has no cells of this kind";
}

std::string xdmf(const Mesh& mesh, const std::string& file, const std::vector<double>& times,
                 const std::vector<XdmfArray>& arrays) {
  const std::size_t n = mesh.X.size();
  const std::size_t e = static_cast<std::size_t>(mesh.n_cells());
  const std::size_t per_cell = nodes_per_cell(mesh.type);
  const std::string name = xml_text(file);
  std::string s =
      "<?xml version=\"1.0\"?>\n<!-- made by langer beside a solution -->\n<Xdmf Version=\"3.0\">\n<Domain>\n"
      "<Grid Name=\"path\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (std::size_t i = 0; i < times.size(); ++i) {
    s += fmt::format("<Grid Name=\"step_{}\" GridType=\"Uniform\">\n<Time Value=\"{}\"/>\n", i + 1,
                     times[i]);
    s += fmt::format(
        "<Topology TopologyType=\"{}\" NumberOfElements=\"{}\"><DataItem Format=\"HDF\" NumberType=\"Int\" Precision=\"8\" "
        "Dimensions=\"{}\">{}:/VTKHDF/Connectivity</DataItem></Topology>\n",
        mesh.cell().names.vtk == vtk_hexahedron ? "Hexahedron" : "Hexahedron_27", e, e * per_cell,
        name);
    s += fmt::format(
        "<Geometry GeometryType=\"XYZ\"><DataItem Format=\"HDF\" NumberType=\"Float\" Precision=\"8\" "
        "Dimensions=\"{} 3\">{}:/VTKHDF/Points</DataItem></Geometry>\n",
        n, name);
    for (const XdmfArray& array : arrays)
      s += fmt::format("<Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">{}</Attribute>\n",
                       xml_text(array.name),
                       array.components == 1   ? "Scalar"
                       : array.components == 3 ? "Vector"
                       : array.components == 9 ? "Tensor"
                                               : "Matrix",
                       array.of_cells ? "Cell" : "Node",
                       rows_of(name, array, array.of_cells ? e : n, i, times.size()));
    s += "</Grid>\n";
  }
  return s + "</Grid>\n</Domain>\n</Xdmf>\n";
}

}  // namespace langer
