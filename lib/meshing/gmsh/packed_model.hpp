// A MshModel as bytes, to be sent from the process that runs gmsh to ours.
// The sender has read a file of a stranger, so the receiver trusts nothing: every size is compared
// with the bytes that are there, and lists that belong together have fitting lengths.
#pragma once

#include <string>
#include <string_view>

#include "meshing/msh_model.hpp"

namespace langer {

std::string packed(const MshModel& model);
MshModel unpacked(std::string_view bytes);  // throws std::runtime_error

}  // namespace langer
