#include "scene/make_mesh.hpp"

#include <fmt/format.h>

#include "mesh/order.hpp"
#include "mesh/raise.hpp"

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

void name_bodies(Mesh& mesh, const MeshConfig& config) {
  mesh.bodies = {config.body};
  mesh.body.assign(static_cast<std::size_t>(mesh.n_cells()), 0);
  if (config.bodies.empty()) return;
  mesh.bodies.clear();
  const auto [bottom, height] = std::visit([](const auto& g) { return std::pair(g.origin[1], g.size[1]); }, config.geometry);
  double low = bottom;
  for (std::size_t b = 0; b < config.bodies.size(); ++b) {
    mesh.bodies.push_back(config.bodies[b].name);
    const double high = low + config.bodies[b].thickness, slack = 1e-9 * height;
    for (int e = 0; e < mesh.n_cells(); ++e) {
      double least = mesh.X[mesh.cell(e)[0]][1], most = least;
      for (int n : mesh.cell(e)) least = std::min(least, mesh.X[n][1]), most = std::max(most, mesh.X[n][1]);
      if (least > low - slack && most < high + slack) mesh.body[e] = static_cast<int>(b);
      if (least < high - slack && most > high + slack)
        throw Failure(Exit::config, Error{{},
                                          fmt::format("bodies[{}].thickness", b),
                                          fmt::format("its upper border y = {:g} mm cuts through cells from {:g} to {:g} mm",
                                                      high, least, most),
                                          "a border between cells",
                                          "change the thickness, or the divisions or layers of the geometry"});
    }
    low = high;
  }
}

MadeMesh made(const MeshConfig& config) {
  MadeMesh result;
  Mesh& mesh = result.mesh;
  mesh = std::visit([&](const auto& g) { return mesh_of(g, config.positions(), result.notes); }, config.geometry);
  if (config.cells != mesh.type) {
    mesh = raised(mesh, config.cells);
    number_in_order(mesh);
    make_symmetric(mesh, std::visit([](const auto& g) { return Vec3(g.origin[0] + 0.5 * g.size[0], 0, g.origin[2] + 0.5 * g.size[2]); },
                                    config.geometry));
  }
  name_points(mesh, config.positions());
  result.quality = quality(mesh);
  refuse_folded(result.quality, "geometry");
  name_bodies(mesh, config);
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
