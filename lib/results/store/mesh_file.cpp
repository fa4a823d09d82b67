#include "results/store/mesh_file.hpp"

#include "results/store/vtk_grid.hpp"

namespace langer {

// The identity, the grid, and everything that the grid of VTK cannot store: sections, hanging
// nodes and sets.
void write_mesh(const std::string& path, const Mesh& mesh, const Identity& identity,
                const std::vector<Summary>& summary) {
  h5::File file = h5::File::create(path);
  write_identity(file.root(), schema_of(mesh_schema, mesh), identity);
  write_grid(file.root(), mesh, {1, 0});
  write_section(file.root(), mesh);
  write_hanging(file.root(), mesh);
  write_sets(file.root(), mesh);
  if (!summary.empty()) write_summary(file.root(), summary);
  file.commit();
}

MeshFile read_mesh(const std::string& path) {
  const h5::File file = h5::File::open(path);
  const Identity identity = read_identity(file.root(), mesh_schema);
  return {read_grid(file.root()), content_id(identity, schema_version(file.root()))};
}

}  // namespace langer
