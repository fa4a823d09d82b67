#include "results/store/vtu.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <cstring>

#include "core/base/text.hpp"
#include "core/base/xml.hpp"
#include "core/hdf5/seal.hpp"
#include "mechanics/mesh/reference.hpp"
#include "results/store/vtk_grid.hpp"

namespace langer {

namespace {

const char* const first_line = "<!-- made by langer-post -->\n";
static_assert(std::endian::native == std::endian::little);

// The file as it grows: its text, and the bytes of the arrays, which follow the text.
struct Vtu {
  std::string text, bytes;

  // Adds an array: its header to the text, its length and values to the bytes.
  template <class T>
  void array(const char* type, const std::string& name, int components,
             const std::vector<T>& values) {
    text += fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
        "offset=\"{}\"/>\n",
        type, xml_text(name), components, bytes.size());
    const std::uint64_t size = values.size() * sizeof(T);
    bytes.append(reinterpret_cast<const char*>(&size), sizeof size);
    bytes.append(reinterpret_cast<const char*>(values.data()), size);
  }

  // Adds the fields of points or elements.
  void place(const char* tag, const std::vector<Field>& fields) {
    const ActiveFields active = active_fields(fields);
    text += fmt::format("<{}", tag);
    for (const auto& [key, name] : {std::pair{"Scalars", active.scalars},
                                    {"Vectors", active.vectors},
                                    {"Tensors", active.tensors}})
      if (!name.empty()) text += fmt::format(" {}=\"{}\"", key, xml_text(name));
    text += ">\n";
    for (const Field& f : fields) array("Float64", f.name, f.components, f.values);
    text += fmt::format("</{}>\n", tag);
  }
};

}  // namespace

ActiveFields active_fields(const std::vector<Field>& fields) {
  ActiveFields active;
  for (const Field& f : fields) {
    if (f.components == 1) active.scalars = text_or(active.scalars, f.name);
    if (f.components == 3) active.vectors = text_or(active.vectors, f.name);
    if (f.components == 6) active.tensors = text_or(active.tensors, f.name);
  }
  return active;
}

// The text refers to the arrays by their offset in the bytes that follow it.
void write_vtu(const std::string& path, const Mesh& mesh, double time,
               const std::vector<Field>& point_fields, const std::vector<Field>& cell_fields) {
  const auto n_cells = static_cast<std::size_t>(mesh.n_cells());
  const std::vector<std::int64_t> connectivity(mesh.connectivity.begin(), mesh.connectivity.end());
  // Offsets in VTK XML are the ends of the elements, without the first 0.
  const std::size_t per_cell = connectivity.size() / std::max<std::size_t>(1, n_cells);
  std::vector<std::int64_t> offsets;
  for (std::size_t e = 1; e <= n_cells; ++e)
    offsets.push_back(static_cast<std::int64_t>(e * per_cell));
  Vtu file;
  file.text = fmt::format(
      "{}<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<UnstructuredGrid>\n"
      "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
      "format=\"ascii\">{}</DataArray>\n</FieldData>\n"
      "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<Points>\n",
      first_line, time, mesh.X.size(), n_cells);
  file.array("Float64", "Points", 3, flat(mesh.X));
  file.text += "</Points>\n<Cells>\n";
  file.array("Int64", "connectivity", 1, connectivity);
  file.array("Int64", "offsets", 1, offsets);
  file.array("UInt8", "types", 1,
             std::vector<std::uint8_t>(n_cells, static_cast<std::uint8_t>(mesh.cell().names.vtk)));
  file.text += "</Cells>\n";
  file.place("PointData", point_fields);
  file.place("CellData", cell_fields);
  file.text += "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
  write_text_file(path, file.text + file.bytes + "\n</AppendedData>\n</VTKFile>\n");
}

// The list of files of a series with their times.
void write_pvd(const std::string& path, const std::vector<std::pair<double, std::string>>& files) {
  std::string text = fmt::format(
      "{}<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n",
      first_line);
  for (const auto& [time, file] : files)
    text += fmt::format("<DataSet timestep=\"{}\" group=\"\" part=\"0\" file=\"{}\"/>\n", time,
                        xml_text(file));
  write_text_file(path, text + "</Collection>\n</VTKFile>\n");
}

}  // namespace langer
