// The module with PETSc, loaded when it is asked for the first time.
#pragma once

#include <string>

#include "mechanics/linear/petsc/petsc_interface.hpp"

namespace langer {

// nullptr: there is none; `why`: which library is missing and what to do
const petsc_module::Functions* petsc(std::string& why);
// The ranks that were started together with this process (base/ranks.hpp), from the first call on;
// nullptr: alone, or `why`.
Ranks* begin_ranks(std::string& why);
void end_petsc();  // nothing, where it was not loaded

}  // namespace langer
