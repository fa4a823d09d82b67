// Text -> a mesh of Abaqus or CalculiX whose indices all lead somewhere.
#include "fuzz.hpp"
#include "geometry/exchange.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace langer;
  fuzz::reads_or_refuses("input.inp", [&] {
    std::vector<std::string> notes;
    const Mesh mesh = parse_inp(std::string(reinterpret_cast<const char*>(data), size), "input.inp", notes);
    const auto need = [](bool good) {
      if (!good) std::abort();
    };
    need(mesh.n_cells() > 0 && static_cast<int>(mesh.body.size()) == mesh.n_cells());
    for (int node : mesh.connectivity) need(node >= 0 && node < mesh.n_nodes());
    for (int body : mesh.body) need(body >= 0 && body < static_cast<int>(mesh.bodies.size()));
    for (const Vec3& X : mesh.X) need(X.allFinite());
    for (const auto& [name, nodes] : mesh.node_sets)
      for (int node : nodes) need(node >= 0 && node < mesh.n_nodes());
    for (const auto& [name, facets] : mesh.facet_sets)
      for (const Facet& f : facets) need(f.cell >= 0 && f.cell < mesh.n_cells() && f.local >= 0 && f.local < 6);
  });
  return 0;
}
