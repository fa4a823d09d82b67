// langer-mesh: a mesh with named sets and local fibre frames.
//   langer-mesh indentation.yaml -o mesh.h5
#include "scene/make_mesh.hpp"
#include "stage.hpp"
#include "store/mesh_file.hpp"

namespace langer {
namespace {

std::vector<Summary> mesh(const Job<MeshConfig>& job) {
  const auto [mesh, quality, notes] = make_mesh(job.config, job.where);
  for (const std::string& note : notes) job.say("{}", note);
  job.say("{} nodes, {} cells {}, {:.6g} mm^3", mesh.n_nodes(), mesh.n_cells(), names(mesh.type)[static_cast<int>(mesh.type)],
          quality.volume);
  job.say("edges {:.3g} to {:.3g} mm, aspect up to {:.3g}, scaled Jacobian at least {:.3g}", quality.shortest_edge,
          quality.longest_edge, quality.largest_aspect, quality.least_scaled_jacobian);
  for (const auto& [name, nodes] : mesh.node_sets) {
    const auto facets = mesh.facet_sets.find(name);
    job.say("  {:<12} {:>6} nodes {:>6} facets", name, nodes.size(),
            facets == mesh.facet_sets.end() ? 0 : facets->second.size());
  }
  const std::vector<Summary> summary{{"nodes", static_cast<double>(mesh.n_nodes()), "-"},
                                     {"cells", static_cast<double>(mesh.n_cells()), "-"},
                                     {"shortest_edge", quality.shortest_edge, "mm"},
                                     {"longest_edge", quality.longest_edge, "mm"},
                                     {"aspect", quality.largest_aspect, "-"},
                                     {"scaled_jacobian", quality.least_scaled_jacobian, "-"}};
  write_mesh(job.output, mesh, job.identity, summary);
  return summary;
}

}  // namespace
}  // namespace langer

int main(int argc, char** argv) { return langer::run_stage<langer::MeshConfig>(argc, argv, "mesh", langer::mesh); }
