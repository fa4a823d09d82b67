#include "scene/run/body_mesh.hpp"

#include <fmt/format.h>

#include "mechanics/mesh/quality.hpp"
#include "results/store/mesh_file.hpp"
#include "scene/model/make_mesh.hpp"
#include "scene/model/scene_bodies.hpp"

namespace langer {

namespace {

// Meshes may come from elsewhere than langer-mesh.
void refuse_bad(const Mesh& mesh, const std::string& file) {
  const auto refuse = [&](std::string found, const char* expected) {
    throw Failure(Exit::input, Error{{file}, "", std::move(found), expected, ""});
  };
  const Quality q = quality(mesh);
  if (!(q.least_jacobian > 0))
    refuse(
        fmt::format("cell {} is folded or flat: Jacobian {:.3g} mm^3 at ({:.4g}, {:.4g}, {:.4g})",
                    q.at_cell, q.least_jacobian, q.at[0], q.at[1], q.at[2]),
        "a positive Jacobian everywhere");
  if (const auto pair = coincident_nodes(mesh, 1e-9 * q.shortest_edge)) {
    const Vec3& X = mesh.X[static_cast<std::size_t>((*pair)[0])];
    refuse(fmt::format(
               "nodes {} and {} are both at ({:.6g}, {:.6g}, {:.6g}) mm: the body is torn there",
               (*pair)[0], (*pair)[1], X[0], X[1], X[2]),
           "each place once");
  }
}

Mesh described(const SolveConfig& config, const std::function<Place(const std::string&)>& where,
               std::vector<std::string>* notes) {
  try {
    MadeMesh made = make_mesh(*config.mesh, [](const std::string&) { return Place{}; });
    if (notes) *notes = std::move(made.of_file);
    return std::move(made.mesh);
  } catch (const Failure& failure) {
    std::vector<Error> errors = failure.errors();
    for (Error& e : errors) {
      // What is wrong in the file of a mesh has a place there, which says more than the key.
      if (!e.where.file.empty()) continue;
      e.where = where("mesh." + e.key);
      e.key = "mesh." + e.key;
    }
    throw Failure(failure.code(), errors);
  }
}

}  // namespace

Mesh body_mesh(const SolveConfig& config, const std::string& file,
               const std::function<Place(const std::string&)>& where,
               std::vector<std::string>* notes) {
  if (file.empty() && !config.bodies.empty()) return mesh_of_bodies(config, where, notes);
  Mesh mesh = file.empty() ? described(config, where, notes) : read_mesh(file).mesh;
  refuse_bad(mesh, file);
  return mesh;
}

}  // namespace langer
