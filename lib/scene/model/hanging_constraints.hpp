// What a scene may ask of a mesh some of whose cells are cut beside others that are not
// (mesh/cut.hpp).
#pragma once

#include <functional>
#include <vector>

#include "core/base/error.hpp"
#include "mechanics/assembly/dofs.hpp"
#include "scene/model/solve_config.hpp"

namespace langer {

// What nobody has tried on such cells: forces on a surface, adhesion, derivatives with respect to
// the config's numbers.
std::vector<Complaint> not_on_cut_cells(const SolveConfig& config);
// That, and supports that end in the middle of a facet. Nothing where no node hangs.
std::vector<Error> hanging_errors(const SolveConfig& config, const Mesh& mesh,
                                  const std::vector<Prescribed>& prescribed,
                                  const std::function<Place(const std::string&)>& where);

}  // namespace langer
