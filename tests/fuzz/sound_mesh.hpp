// A mesh that a reader let through has indices that all lead somewhere; otherwise the fuzzer is
// told.
#pragma once

#include <cstdlib>

#include "mechanics/mesh/mesh.hpp"

namespace langer::fuzz {

inline void need(bool good) {
  if (!good) std::abort();
}

inline void need_sound(const Mesh& mesh) {
  need(static_cast<int>(mesh.body.size()) == mesh.n_cells());
  for (int node : mesh.connectivity) need(node >= 0 && node < mesh.n_nodes());
  for (int body : mesh.body) need(body >= 0 && body < static_cast<int>(mesh.bodies.size()));
  for (const Vec3& X : mesh.X) need(X.allFinite());
  for (const auto& [name, nodes] : mesh.node_sets)
    for (int node : nodes) need(node >= 0 && node < mesh.n_nodes());
  for (const auto& [name, facets] : mesh.facet_sets)
    for (const Facet& f : facets)
      need(f.cell >= 0 && f.cell < mesh.n_cells() && f.local >= 0 && f.local < 6);
}

}  // namespace langer::fuzz
