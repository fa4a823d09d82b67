#include "scene/make_mesh.hpp"

#include <fmt/format.h>

namespace langer {

namespace {

void name_sets(Mesh& mesh, const MeshConfig& config) {
  const std::vector<int> all = all_nodes(mesh);
  const std::vector<Facet> outer = boundary(mesh);
  for (const auto& [name, set] : config.sets) {
    const std::vector<int> nodes = select(mesh, set.within, set.of ? mesh.node_sets.at(*set.of) : all);
    if (nodes.empty())
      throw Failure(Exit::config, Error{{}, "sets." + name, "no node of the mesh is in this set", "at least one", ""});
    const std::vector<Facet> facets = facets_within(mesh, set.of ? mesh.facet_sets.at(*set.of) : outer, nodes);
    mesh.node_sets[name] = nodes;
    if (!facets.empty()) mesh.facet_sets[name] = facets;
  }
}

MadeMesh made(const MeshConfig& config) {
  MadeMesh result;
  Mesh& mesh = result.mesh;
  mesh = std::visit([&](const auto& g) { return mesh_of(g, config.positions(), result.notes); }, config.geometry);
  name_points(mesh, config.positions());
  result.quality = quality(mesh);
  refuse_folded(result.quality, "geometry");
  mesh.bodies = {config.body};
  mesh.body.assign(static_cast<std::size_t>(mesh.n_cells()), 0);
  mesh.frames = frames(mesh, config.frames);
  name_sides(mesh);
  name_sets(mesh, config);
  return result;
}

}  // namespace

MadeMesh make_mesh(const MeshConfig& config, const std::function<Place(const std::string&)>& where) {
  try {
    return made(config);
  } catch (const Failure& failure) {
    std::vector<Error> errors = failure.errors();
    for (Error& e : errors)
      if (e.where.file.empty()) e.where = where(e.key);
    throw Failure(failure.code(), errors);
  }
}

}  // namespace langer
