// Cells are cut where the error of a force comes from, until an accuracy is reached:
//   solve -> estimate (dual or by recovery) -> mark -> cut -> solve ...
// Doerfler's marking [D96]: the cells with the largest parts of the error, as many as have to be
// cut so that the rest is within the request. Neighbours are cut too where sizes would differ by
// more than one cut (2:1, mesh/cut.hpp). Sets keep the area that they have on the first mesh.
#pragma once

#include <string>
#include <vector>

#include "mechanics/mesh/cut.hpp"
#include "scene/model/solve_config.hpp"

namespace langer {

// The cells with the largest parts, so that `wanted` times their sum is left where each cut takes a
// part to 2^-order of it; at least three tenths of the sum and a seventh of the cells, at most nine
// tenths. Parts that are alike, as symmetry makes them, are marked together.
std::vector<char> largest_parts(const std::vector<double>& parts, double wanted, double order);

// Why cells are not cut in such a scene, on such a mesh; empty where they are: hex8 of a body whose
// errors are known by cells, and nothing that hanging nodes do not know
// (scene/model/hanging_constraints.hpp).
std::string reason_not_refinable(const SolveConfig& config);
std::string reason_not_refinable(const Mesh& mesh);

// Under each indenter that reaches the top, until cells there are at most half as long as what
// touches is to its side: with longer ones the first solution tells nothing. How many times they
// are cut; 0: they are short enough.
int shorten_under(const SolveConfig& config, CutMesh& cells);

}  // namespace langer
