// mesh.h5 as edited by others -> a mesh whose indices all lead somewhere.
#include "edited_h5.hpp"
#include "store/example.hpp"
#include "store/mesh_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace langer;
  static const std::string path = fuzz::scratch("mesh.h5");
  static const std::string good = [] {
    write_mesh(path, example::bar(), example::identity());
    return fuzz::unsealed(path);
  }();
  fuzz::write_edited(good, path, {data, size});
  fuzz::reads_or_refuses(path, [&] {
    const Mesh mesh = read_mesh(path).mesh;
    const auto need = [](bool good) {
      if (!good) std::abort();
    };
    need(static_cast<int>(mesh.body.size()) == mesh.n_cells() && static_cast<int>(mesh.frames.size()) == mesh.n_cells());
    for (int node : mesh.connectivity) need(node >= 0 && node < mesh.n_nodes());
    for (int body : mesh.body) need(body >= 0 && body < static_cast<int>(mesh.bodies.size()));
    for (const Vec3& X : mesh.X) need(X.allFinite());
    for (const auto& [name, nodes] : mesh.node_sets)
      for (int node : nodes) need(node >= 0 && node < mesh.n_nodes());
    for (const auto& [name, facets] : mesh.facet_sets)
      for (const Facet& f : facets) need(f.cell >= 0 && f.cell < mesh.n_cells() && f.local >= 0 && f.local < 6);
  });
  std::filesystem::remove(path);
  return 0;
}
