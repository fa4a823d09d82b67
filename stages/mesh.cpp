// langer-mesh: a mesh with named sets and local fibre frames. The mesh is a block, a body of
// revolution, a section, or read from a file of another program.
//   langer-mesh indentation.yaml -o mesh.h5
#include <filesystem>

#include "core/hdf5/seal.hpp"
#include "results/store/mesh_file.hpp"
#include "scene/model/make_mesh.hpp"
#include "scene/model/solve_config_io.hpp"
#include "stage.hpp"

namespace langer {
namespace {

// The name of an exported mesh: that of the output with another extension.
std::string export_name(const std::string& output, MeshFormat format) {
  return std::filesystem::path(output)
      .replace_extension(names(format)[static_cast<int>(format)])
      .string();
}

// Refuses to export to the file that the mesh is read from.
void check_exports(const Job<MeshConfig>& job) {
  const auto* from = std::get_if<FromFile>(&job.config.geometry);
  if (!from) return;
  std::error_code unreadable;
  for (const MeshFormat format : job.config.exports) {
    const std::string path = export_name(job.output, format);
    if (!std::filesystem::equivalent(path, from->file.path, unreadable)) continue;
    throw Failure(Exit::config,
                  Error{job.where("export"), "export", path + " is the file that geometry names",
                        "another name of the output", ""});
  }
}

// Makes the mesh, prints its quality and sets, and exports it to other formats if the config asks.
std::vector<Summary> mesh(const Job<MeshConfig>& job) {
  check_exports(job);
  const auto [mesh, quality, notes, of_file] = make_mesh(job.config, job.where);
  for (const std::string& note : notes) job.detail("{}", note);
  // What was read otherwise than its file says may change a result.
  for (const std::string& note : of_file) job.say("{}", note);
  job.say("{} nodes, {} cells {}, {:.6g} mm^3", mesh.n_nodes(), mesh.n_cells(),
          names(mesh.type)[static_cast<int>(mesh.type)], quality.volume);
  job.detail("edges {:.3g} to {:.3g} mm, aspect up to {:.3g}, scaled Jacobian at least {:.3g}",
             quality.shortest_edge, quality.longest_edge, quality.largest_aspect,
             quality.least_scaled_jacobian);
  for (const auto& [name, nodes] : mesh.node_sets) {
    const auto facets = mesh.facet_sets.find(name);
    std::size_t n_facets = 0;
    if (facets != mesh.facet_sets.end()) n_facets = facets->second.size();
    job.detail("  {:<12} {:>6} nodes {:>6} facets", name, nodes.size(), n_facets);
  }
  const std::vector<Summary> summary{{"nodes", static_cast<double>(mesh.n_nodes()), "-"},
                                     {"cells", static_cast<double>(mesh.n_cells()), "-"},
                                     {"shortest_edge", quality.shortest_edge, "mm"},
                                     {"longest_edge", quality.longest_edge, "mm"},
                                     {"aspect", quality.largest_aspect, "-"},
                                     {"scaled_jacobian", quality.least_scaled_jacobian, "-"}};
  for (const MeshFormat format : job.config.exports) {
    const std::string path = export_name(job.output, format);
    if (format == MeshFormat::msh)
      write_text_file(path, msh_text(mesh));
    else
      write_text_file(path, inp_text(mesh));
    job.say("{}", path);
  }
  write_mesh(job.output, mesh, job.identity, summary);
  return summary;
}

}  // namespace
}  // namespace langer

int main(int argc, char** argv) {
  return langer::run_stage<langer::MeshConfig>(argc, argv, "mesh", langer::mesh);
}
