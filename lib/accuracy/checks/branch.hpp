// The critical point of the perfect body, found before a run with `branch` or `imperfection`.
//
// Its mode gives the direction in which a branch leaves the path, or the shape by which the nodes
// of the mesh are moved (accuracy/checks/critical_point.hpp).
#pragma once

#include <optional>

#include "accuracy/checks/critical_point.hpp"
#include "core/base/voice.hpp"

namespace langer {

// Where and how `branch` of the config leaves the path, and the bifurcation itself. Throws
// Failure(config) where the path has none.
struct Branch {
  Run::Switch at;
  CriticalPoint bifurcation;
};
Branch branch_of(const Voice& voice, const Mesh& mesh, const SolveConfig& config,
                 const std::optional<Material>& material, const Run::Where& where);

// The mesh with the nodes moved by `imperfection` of the config. Throws Failure(config) where the
// path has no critical point, or a cell would be folded.
Mesh imperfect_mesh(const Voice& voice, Mesh mesh, const SolveConfig& config,
                    const std::optional<Material>& material, const Run::Where& where);

}  // namespace langer
