// What the set-up page draws of a scene before it is solved, and what it would cost.
//
// Of a pipeline the first step that solves is taken, with its own values of `set` and the first
// member of its sweep. Nothing has to be computed before: the mesh is made from the mesh node's
// config, and a law that a fit has yet to find has the start values of the fit.
#pragma once

#include <string>

namespace langer {

// JSON:
//   node, members       the node, and how many runs its sweep has
//   law                 where the material comes from, in words
//   X, facets           nodes (float32, mm) and quadrilaterals (int32) of the surface, in base64
//   sets                {name, nodes, facets: places in `facets`, points}
//   indenters           {name, points, triangles, motion: [[t, x, y, z], ...]}
//   fibres              {families: [{at, along}]}  float32
//   supports, loads     in words
//   forecast            {name: [value, unit]}
//   problem             why there is no forecast, in the words of langer-solve
// Throws Failure where there is no body to draw; {"node": null} where no node solves.
std::string scene_view(const std::string& pipeline_file, const std::string& run_folder);

}  // namespace langer
