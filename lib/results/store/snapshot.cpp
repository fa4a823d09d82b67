#include "results/store/snapshot.hpp"

#include "results/store/provenance.hpp"
#include "results/store/vtk_grid.hpp"
#include "results/store/vtu.hpp"

namespace langer {

namespace {
// Writes the fields of points or elements and marks the active ones.
void write_fields(const h5::Group& group, std::size_t rows, const std::vector<Field>& fields) {
  for (const Field& f : fields) {
    h5::Shape shape{rows};
    if (f.components > 1) shape.push_back(static_cast<std::size_t>(f.components));
    group.write<double>(f.name, shape, f.values, f.unit);
  }
  const ActiveFields active = active_fields(fields);
  for (const auto& [key, name] : {std::pair{"Scalars", active.scalars},
                                  {"Vectors", active.vectors},
                                  {"Tensors", active.tensors}})
    if (!name.empty()) group.attribute(key, name);
}
}  // namespace

void write_snapshot(const std::string& path, const Mesh& mesh,
                    const std::vector<Field>& point_fields, const std::vector<Field>& cell_fields,
                    const Identity& identity, double time) {
  h5::File file = h5::File::create(path);
  write_identity(file.root(), snapshot_schema, identity);
  const h5::Group grid = write_grid(file.root(), mesh, {1, 0});
  grid.make_group("FieldData").write<double>("TimeValue", {1}, std::span(&time, 1), "-");
  write_fields(grid.make_group("PointData"), mesh.X.size(), point_fields);
  write_fields(grid.group("CellData"), static_cast<std::size_t>(mesh.n_cells()), cell_fields);
  write_sets(file.root(), mesh);
  file.commit();
}

}  // namespace langer
